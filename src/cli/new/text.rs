//! The text of a new scene. Input: what is shown, its pictures or model, and the folder of the scene. Output: a commented
//! scene file; comments say what was found in the files, and what was chosen for that.

use std::fmt::Write as _;
use std::path::Path;

use super::Kind;
use super::paths::{relative, toml_string};
use super::photo::Photo;
use super::surface::Surface;
use crate::core::error::Result;
use crate::scene::model_view;
use crate::texture::data::ColorSpace;

const SAMPLING: &str = "\n[sampling]\npattern = \"sobol-owen\"\nspp = 16                      # samples a pixel\n\
                        footprint = \"cone\"            # each look-up averages over what its sample covers\n";
const LAMP: &str = "\n[[light]]                     # a large lamp: soft shadows\nkind = \"sphere\"\n\
                    position = [-3.0, 5.0, 4.0]\nradius = 0.8\nintensity = [110.0, 105.0, 95.0]\n\n\
                    [[light]]                     # the sky's share\nkind = \"directional\"\n\
                    direction = [0.5, 1.0, 0.6]\nirradiance = [0.5, 0.6, 0.8]\n";
/// Most pixels of a side of the picture of a quad.
const MAX_SIDE: u32 = 512;

pub(super) struct Writer<'a> {
    pub kind: Kind,
    pub surface: &'a Surface,
    pub model: Option<&'a Path>,
    /// The folder in which the scene lies.
    pub folder: &'a Path,
}

impl Writer<'_> {
    pub fn scene(&self) -> Result<String> {
        let mut text = self.head()?;
        for why in &self.surface.left_out {
            let _ = writeln!(text, "# Left out: {}", one_line(why));
        }
        text += "\n";
        text += &self.view()?;
        if self.kind != Kind::Model {
            text += SAMPLING;
            text += &self.background();
        }
        text += &self.textures()?;
        text += &self.material();
        text += &self.shape()?;
        if self.is_lit() && self.kind != Kind::Model {
            let is_sky_light = self.surface.sky.as_ref().is_some_and(|sky| sky.is_float);
            text += if is_sky_light {
                "\n[[light]]\nkind = \"environment\"          # the sky lights the scene\n"
            } else {
                LAMP
            };
        }
        Ok(text)
    }

    fn is_lit(&self) -> bool {
        self.kind == Kind::Ball || self.surface.is_lit()
    }

    fn head(&self) -> Result<String> {
        let what = match self.kind {
            Kind::Floor => "A floor to the horizon",
            Kind::Ball => "A ball on the ground",
            Kind::Quad => "A picture that fills the image",
            Kind::Model => "A model, seen whole",
        };
        Ok(format!("# {what}. Paths are relative to this file; docs/scene-format.md has all keys.\n"))
    }

    fn view(&self) -> Result<String> {
        Ok(match self.kind {
            Kind::Floor => {
                "[camera]\neye = [0.0, 1.6, 0.0]         # as high as a person's eyes, if a unit is a metre\n\
                            look_at = [0.4, 1.15, -2.0]\nvertical_fov = 50.0\n\n[image]\nsize = [384, 288]\n"
                    .into()
            }
            Kind::Ball => {
                "[camera]\neye = [0.0, 1.5, 4.0]\nlook_at = [0.0, 0.95, 0.0]\nvertical_fov = 40.0\n\n\
                           [image]\nsize = [384, 288]\n"
                    .into()
            }
            Kind::Quad => {
                let [width, height] = self.quad_size();
                format!(
                    "[camera]\neye = [0.0, 0.0, 1.0]\nlook_at = [0.0, 0.0, 0.0]\n\
                     orthographic_height = 2.0     # parallel rays: the picture from -1 to 1\n\n\
                     [image]\nsize = [{width}, {height}]\n"
                )
            }
            Kind::Model => model_view(self.model.unwrap_or(Path::new("")))?,
        })
    }

    /// Returns the size of the picture, in the shape of the texture.
    fn quad_size(&self) -> [u32; 2] {
        let [width, height] = self.surface.color.as_ref().map_or([MAX_SIDE; 2], |color| color.size);
        let longest = width.max(height);
        let of = |side: u32| {
            (u64::from(side) * u64::from(MAX_SIDE.min(longest)) / u64::from(longest)).max(1) as u32
        };
        [of(width), of(height)]
    }

    fn background(&self) -> String {
        match &self.surface.sky {
            Some(_) => "\n[background]\nenvironment = \"sky\"\n".into(),
            None => "\n[background]\ncolor = [0.45, 0.6, 0.85]     # the sky\n".into(),
        }
    }

    fn textures(&self) -> Result<String> {
        let surface = self.surface;
        let normal = surface.normal.as_ref().map(|(photo, _)| photo);
        let maps = [
            ("sky", surface.sky.as_ref(), true),
            ("color", surface.color.as_ref(), true),
            ("normal", normal, false),
            ("height", surface.height.as_ref(), false),
            ("roughness", surface.roughness.as_ref(), false),
            ("packed", surface.packed.as_ref(), false),
            ("occlusion", surface.occlusion.as_ref(), false),
            ("emission", surface.emission.as_ref(), true),
        ];
        let mut text = String::new();
        for (name, photo, is_color) in maps {
            if let Some(photo) = photo
                && (self.kind != Kind::Model || name != "sky")
            {
                text += &self.texture(name, photo, is_color)?;
            }
        }
        Ok(text)
    }

    fn texture(&self, name: &str, photo: &Photo, is_color: bool) -> Result<String> {
        let [width, height] = photo.size;
        let mut text = format!("\n[[texture]]                   # {width} x {height} texels");
        if photo.is_turned {
            text += ", turned upright as the file's orientation says";
        }
        let (space, why) = match (is_color, photo.is_float, photo.stated) {
            (_, true, _) => (ColorSpace::Linear, "floats are linear light"),
            (true, _, Some(ColorSpace::Linear)) => (ColorSpace::Linear, "the file says so"),
            (true, ..) => (ColorSpace::Srgb, "colors for screens are"),
            (false, ..) => (ColorSpace::Linear, "numbers, not colors"),
        };
        let file = toml_string(&relative(&photo.path, self.folder)?);
        let _ = write!(text, "\nname = \"{name}\"\nfile = {file}\ncolor_space = \"{space}\"");
        let _ = writeln!(text, "{:1$}# {why}", "", 14 - space.name().len());
        Ok(text)
    }

    fn material(&self) -> String {
        let surface = self.surface;
        let has_maps = surface.color.is_some() || surface.is_lit();
        if self.kind == Kind::Model && !has_maps {
            return String::new();
        }
        let mut text = self.sampler();
        text += "\n[[material]]\nname = \"surface\"\n";
        let mut line = |words: &str| text.extend([words, "\n"]);
        if self.is_lit() || self.kind == Kind::Model {
            line("model = \"metallic-roughness\"");
        } else {
            line("model = \"unlit\"               # shows the picture's own colors");
        }
        if surface.color.is_some() {
            line("texture = \"color\"");
        }
        line("sampler = \"surface\"");
        if let Some((_, is_up)) = surface.normal {
            line("normal_map = \"normal\"");
            // v grows downwards in the picture.
            match is_up {
                true => line(
                    "green = \"down\"                # v grows downwards, and the map's green points up (OpenGL)",
                ),
                false => line(
                    "green = \"up\"                  # v grows downwards, as the map's green points (DirectX)",
                ),
            }
        }
        if surface.height.is_some() {
            line("bump_map = \"height\"\nstrength = 0.02               # scene units from black to white");
        }
        if self.is_lit() || self.kind == Kind::Model {
            self.reflection(&mut line);
        }
        if surface.occlusion.is_some() {
            line("occlusion_map = \"occlusion\"");
        } else if surface.packed.is_some() && surface.sky.is_some() && self.kind != Kind::Model {
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

    fn reflection(&self, line: &mut impl FnMut(&str)) {
        let surface = self.surface;
        let mean = |value: f64| format!("{:?}", (100.0 * value.clamp(0.0, 1.0)).round() / 100.0);
        if surface.packed.is_some() {
            line("metallic_roughness_map = \"packed\"");
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
        let tiles = self.surface.color.as_ref().map_or([true; 2], |color| color.tiles);
        let (address, why) = match (self.kind, tiles) {
            (Kind::Quad, _) => ("\"clamp-to-edge\"".to_owned(), "the picture is shown once"),
            (Kind::Model, _) => ("\"repeat\"".to_owned(), "as models take it"),
            (_, [true, true]) => ("\"repeat\"".to_owned(), "opposite borders fit together"),
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
                (format!("[{}, {}]", word(u), word(!u)), which)
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

    fn shape(&self) -> Result<String> {
        Ok(match self.kind {
            Kind::Floor => "\n[[plane]]\norigin = [0.0, 0.0, 0.0]\n\
                            tangent = [1.0, 0.0, 0.0]     # u grows to the right,\n\
                            bitangent = [0.0, 0.0, 1.0]   # v towards the viewer, as rows of a picture grow downwards\n\
                            material = \"surface\"\n"
                .into(),
            Kind::Ball => "\n[[material]]\nname = \"ground\"\ncolor = [0.35, 0.33, 0.3]\n\n\
                           [[sphere]]\ncenter = [0.0, 1.0, 0.0]\nradius = 1.0\nmaterial = \"surface\"\n\n\
                           [[plane]]\norigin = [0.0, 0.0, 0.0]\ntangent = [1.0, 0.0, 0.0]\n\
                           bitangent = [0.0, 0.0, -1.0]\nhalf_extent = 3.0\nmaterial = \"ground\"\n"
                .into(),
            Kind::Quad => {
                let [width, height] = self.quad_size();
                format!(
                    "\n[[plane]]                     # u from left to right, v from the upper edge to the lower\n\
                     origin = [0.0, 0.0, 0.0]\ntangent = [{:?}, 0.0, 0.0]\nbitangent = [0.0, -1.0, 0.0]\n\
                     half_extent = 1.0\nmaterial = \"surface\"\n",
                    f64::from(width) / f64::from(height)
                )
            }
            Kind::Model => {
                let file = toml_string(&relative(self.model.unwrap_or(Path::new("")), self.folder)?);
                let material = if self.material().is_empty() { "" } else { "material = \"surface\"          # in place of its own\n" };
                format!("\n[[mesh]]\nfile = {file}\n{material}")
            }
        })
    }
}

fn one_line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
