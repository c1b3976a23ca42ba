//! The material of a new scene. Input: what is shown, and its pictures. Output: the text of its textures, sampler and
//! material; comments say what was found in the files, and what was chosen for that.

use std::fmt::Write as _;
use std::path::Path;

use super::Kind;
use super::paths::{relative, toml_string};
use super::photo::Photo;
use super::surface::Surface;
use crate::core::error::Result;
use crate::texture::data::ColorSpace;

pub(super) struct MaterialWriter<'a> {
    pub kind: Kind,
    pub surface: &'a Surface,
    /// The folder in which the scene lies.
    pub folder: &'a Path,
}

impl MaterialWriter<'_> {
    /// Returns all textures, that of the sky among them.
    pub fn textures(&self) -> Result<String> {
        let surface = self.surface;
        let maps = [
            ("sky", &surface.sky, true),
            ("color", &surface.color, true),
            ("normal", &surface.normal, false),
            ("height", &surface.height, false),
            ("roughness", &surface.roughness, false),
            ("packed", &surface.packed, false),
            ("occlusion", &surface.occlusion, false),
            ("emission", &surface.emission, true),
        ];
        let given =
            maps.into_iter().filter_map(|(name, photo, is_color)| Some((name, photo.as_ref()?, is_color)));
        given.map(|(name, photo, is_color)| self.texture(name, photo, is_color)).collect()
    }

    fn texture(&self, name: &str, photo: &Photo, is_color: bool) -> Result<String> {
        let [width, height] = photo.size;
        let mut text = format!("\n[[texture]]                   # {width} x {height} texels");
        if photo.is_turned {
            text += ", turned upright as the file's orientation says";
        }
        let converted = photo.profile.as_ref().filter(|profile| profile.is_converted());
        let profile = converted.map(|profile| format!("converted from {}", one_line(&profile.name)));
        let (space, why) = match (is_color, photo.is_float, photo.stated) {
            (_, true, _) => (ColorSpace::Linear, "floats are linear light"),
            (true, _, Some(ColorSpace::Linear)) => (ColorSpace::Linear, "the file says so"),
            (true, ..) => (ColorSpace::Srgb, profile.as_deref().unwrap_or("colors for screens are")),
            (false, ..) => (ColorSpace::Linear, "numbers, not colors"),
        };
        let file = toml_string(&relative(&photo.path, self.folder)?);
        let _ = writeln!(text, "\nname = \"{name}\"\nfile = {file}");
        if let Some(layer) = photo.layers.first() {
            let all = one_line(&photo.layers.join(", "));
            let _ =
                writeln!(text, "layer = {:23}# the first of those with colors: {all}", toml_string(layer));
        }
        let _ = write!(text, "color_space = \"{space}\"");
        let _ = writeln!(text, "{:1$}# {why}", "", 14 - space.name().len());
        Ok(text)
    }

    /// Returns whether opposite borders fit together in all maps. A map that does not tell follows the others.
    fn tiles(&self) -> [bool; 2] {
        let s = self.surface;
        let maps = [&s.color, &s.normal, &s.packed, &s.roughness, &s.height, &s.occlusion, &s.emission];
        let maps: Vec<&Photo> = maps.into_iter().flatten().collect();
        [0, 1].map(|axis| {
            let told: Vec<bool> = maps.iter().filter_map(|photo| photo.tiles[axis]).collect();
            told.iter().all(|tiles| *tiles) && (maps.is_empty() || !told.is_empty())
        })
    }

    /// Returns sampler and material; nothing for a model that keeps its own.
    pub fn material(&self) -> String {
        let surface = self.surface;
        if self.kind == Kind::Model && !self.replaces_own() {
            return String::new();
        }
        let is_lit = self.kind == Kind::Ball || self.kind == Kind::Model || surface.is_lit();
        let mut text = self.sampler();
        text += "\n[[material]]\nname = \"surface\"\n";
        let mut line = |words: &str| text.extend([words, "\n"]);
        line(match (is_lit, &surface.color) {
            (true, _) => "model = \"metallic-roughness\"",
            (false, Some(_)) => "model = \"unlit\"               # shows the picture's own colors",
            (false, None) => "model = \"unlit\"",
        });
        line(match surface.color {
            Some(_) => "texture = \"color\"",
            None => "color = [0.4, 0.4, 0.4]       # no picture of its colors is given",
        });
        line("sampler = \"surface\"");
        if let Some(normal) = &surface.normal {
            line("normal_map = \"normal\"");
            line(&green(normal));
        }
        if surface.height.is_some() {
            line("bump_map = \"height\"\nstrength = 0.02               # scene units from black to white");
        }
        if is_lit {
            self.reflection(&mut line);
        }
        if surface.occlusion.is_some() {
            line("occlusion_map = \"occlusion\"");
        } else if surface.packed.is_some() && surface.is_sky_light() {
            line("occlusion_map = \"packed\"");
        }
        if surface.emission.is_some() {
            line("emission_map = \"emission\"");
        }
        match surface.color.as_ref().and_then(|color| color.mask) {
            Some(true) => line("alpha = \"mask\"                # its alpha is 0 or 1 nearly everywhere"),
            Some(false) => line("alpha = \"blend\"               # its alpha has shares between 0 and 1"),
            None => {}
        }
        line(&self.mapping());
        text.trim_end().to_owned() + "\n"
    }

    /// Returns true if pictures take the place of the materials of a model.
    pub fn replaces_own(&self) -> bool {
        let surface = self.surface;
        surface.color.is_some() || surface.emission.is_some() || surface.has_relief_or_gloss()
    }

    fn reflection(&self, line: &mut impl FnMut(&str)) {
        let surface = self.surface;
        let mean = |value: f64| format!("{:?}", (100.0 * value.clamp(0.0, 1.0)).round() / 100.0);
        if surface.packed.is_some() {
            let red = if surface.is_sky_light() { "" } else { "; red, occlusion, needs the light of a sky" };
            line(&format!("metallic_roughness_map = \"packed\" # green is roughness, blue metal{red}"));
            return;
        }
        match (&surface.roughness, surface.mean_roughness) {
            (Some(_), _) => line("metallic_roughness_map = \"roughness\""),
            (None, Some(roughness)) => line(&format!("roughness = {}", mean(roughness))),
            (None, None) => line("roughness = 0.5"),
        }
        line(&format!("metallic = {}", mean(surface.mean_metal.unwrap_or(0.0))));
    }

    fn sampler(&self) -> String {
        let (address, why) = match (self.kind, self.tiles()) {
            (Kind::Quad, _) => ("\"clamp-to-edge\"".to_owned(), "the picture is shown once"),
            (Kind::Model, _) => ("\"repeat\"".to_owned(), "as models take it"),
            (_, [true, true]) => ("\"repeat\"".to_owned(), "opposite borders fit together"),
            (_, _) if self.surface.normal.is_some() => (
                "\"repeat\"".to_owned(),
                "borders differ, but mirrored copies would turn the relief inside out",
            ),
            (_, [false, false]) => {
                ("\"mirrored-repeat\"".to_owned(), "opposite borders differ: this shows no seam")
            }
            (_, [u, _]) => {
                let word = |tiles: bool| if tiles { "\"repeat\"" } else { "\"mirrored-repeat\"" };
                let which = if u {
                    "left and right borders fit, upper and lower differ"
                } else {
                    "upper and lower borders fit, left and right differ"
                };
                (format!("[{}, {}] ", word(u), word(!u)), which)
            }
        };
        let filter = if self.kind == Kind::Quad { "linear" } else { "anisotropic" };
        format!(
            "\n[[sampler]]\nname = \"surface\"\naddress = {address:20}# {why}\nfilter = \"{filter}\"\nmip = \"linear\"\n"
        )
    }

    /// Returns the mapping, in the proportions of the picture.
    fn mapping(&self) -> String {
        let aspect = self.surface.color.as_ref().map_or(1.0, Photo::aspect);
        match self.kind {
            Kind::Floor => format!(
                "mapping = {{ kind = \"surface\", scale = [{:.4}, 1.0] }} # tiles a unit: each is 1 deep and not distorted",
                1.0 / aspect
            ),
            // Four around the ball, whose circumference is 2 pi.
            Kind::Ball => format!(
                "mapping = {{ kind = \"cylindrical\", entity = \"centroid\", scale = [-4.0, {:.4}] }} # four around the ball",
                -aspect * 2.0 / std::f64::consts::PI
            ),
            Kind::Quad => "mapping = { kind = \"surface\", scale = [0.5, 0.5], offset = [0.5, 0.5] }".into(),
            Kind::Model => String::new(),
        }
    }
}

/// Returns where the green of a normal map points, as the scene has it: v grows downwards in the picture.
fn green(normal: &Photo) -> String {
    let (is_up, why) = match (normal.green_named, normal.green_found) {
        (Some(up), _) => (up, "by its name"),
        (None, Some(up)) => (up, "by its texels"),
        (None, None) => (true, "as most; if bumps look like dents, it is \"up\""),
    };
    match is_up {
        true => format!(
            "green = \"down\"                # v grows downwards; the map's green points up (OpenGL), {why}"
        ),
        false => format!(
            "green = \"up\"                  # v grows downwards, as the map's green points (DirectX), {why}"
        ),
    }
}

/// Returns text without what would end a comment.
pub(super) fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
