//! What a scene has beside its surfaces: camera, picture, sampling, background and lights. Input: those of a model, and
//! settings. Output: their text in a scene file, or what they are once the settings have changed that text.

use std::fmt::Write;
use std::path::Path;

use glam::DVec3;
use toml::de::DeTable;

use super::names::Names;
use super::samplers::Known;
use super::shapes::is_shape;
use super::source::Source;
use super::table::Table;
use super::{SINGLE, lights, place, samplers, sections, settings, syntax_error};
use crate::core::error::Result;
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{Background, Camera, Light, PixelFilter, Projection, Sampling};
use crate::scene::setting::Setting;

/// Camera, picture, sampling, background and lights of a scene. The camera is a pinhole at rest.
#[derive(Clone)]
pub(in crate::scene) struct View {
    pub camera: Camera,
    pub size: [u32; 2],
    pub pixel_filter: PixelFilter,
    pub sampling: Sampling,
    pub background: DVec3,
    pub lights: Vec<Light>,
}

impl View {
    /// Gives a builder all of it.
    pub fn build(self, builder: &mut SceneBuilder) {
        builder.view(self.camera, self.size[0], self.size[1]);
        builder.pixel_filter(self.pixel_filter).sampling(self.sampling);
        builder.background(Background { color: self.background, environment: None });
        for light in self.lights {
            builder.light(light);
        }
    }

    /// Returns the view as the settings change it; the model's surfaces are its own.
    pub fn changed(self, path: &Path, changes: &[Setting]) -> Result<View> {
        let text = self.text();
        let source = Source { path, text: &text, settings: changes };
        for (setting, base) in source.placed_settings() {
            check_section(source, setting, base)?;
        }
        let mut document = DeTable::parse(&text).map_err(|error| syntax_error(source, &error))?.into_inner();
        settings::apply(&mut document, source, &["light"])?;
        let root = Table::root(source, &document, &[SINGLE, &["light"]].concat())?;
        let image = root.required_single("image", sections::IMAGE, "width and height")?;
        let (width, height) = sections::image(&image)?;
        let none = Names::collect("texture", &[])?;
        let known = Known { textures: &none, sources: &[], samplers: &none };
        let background = root.single("background", samplers::BACKGROUND)?;
        let camera = root.required_single("camera", sections::CAMERA, "eye and look_at")?;
        let view = View {
            camera: sections::camera(&camera)?,
            size: [width, height],
            pixel_filter: sections::pixel_filter(&image)?,
            sampling: sections::sampling(root.single("sampling", sections::SAMPLING)?.as_ref())?,
            background: samplers::background(background.as_ref(), &known)?.color,
            lights: root
                .repeated("light", lights::LIGHT)?
                .iter()
                .map(lights::light)
                .collect::<Result<_>>()?,
        };
        let mut alone = SceneBuilder::new(view.camera, width, height);
        view.clone().build(&mut alone);
        alone.check().map_err(|refusal| place::error(&root, &refusal))?;
        Ok(view)
    }

    /// Returns the view as text of a scene file.
    pub fn text(&self) -> String {
        self.parts().concat()
    }

    /// Returns the text in parts: camera, picture and sampling; background; lights.
    pub fn parts(&self) -> [String; 3] {
        let background = format!("\n[background]\ncolor = {}\n", vector(self.background));
        let light = |light: &Light| {
            let lines = entries(light).into_iter().map(|(key, value)| format!("{key} = {value}\n"));
            format!("\n[[light]]\n{}", lines.collect::<String>())
        };
        [self.camera_text(), background, self.lights.iter().map(light).collect()]
    }

    fn camera_text(&self) -> String {
        let mut text = String::new();
        let mut line = |words: std::fmt::Arguments<'_>| {
            // Writing into a string does not fail.
            let _ = writeln!(text, "{words}");
        };
        let (camera, [width, height], sampling) = (&self.camera, self.size, &self.sampling);
        line(format_args!("[camera]\neye = {}\nlook_at = {}", vector(camera.eye), vector(camera.look_at)));
        if camera.up != DVec3::Y {
            line(format_args!("up = {}", vector(camera.up)));
        }
        let (key, size) = match camera.projection {
            Projection::VerticalFov(angle) => ("vertical_fov", angle),
            Projection::CameraConstant(constant) => ("camera_constant", constant),
            Projection::Orthographic(height) => ("orthographic_height", height),
        };
        line(format_args!("{key} = {size:?}"));
        line(format_args!("\n[image]\nwidth = {width}\nheight = {height}"));
        line(format_args!(
            "\n[sampling]\npattern = \"{}\"\nspp = {}\nfootprint = \"{}\"",
            sampling.pattern, sampling.spp, sampling.footprint
        ));
        text
    }
}

/// Refuses a setting of what only scene files have.
fn check_section(source: Source<'_>, setting: &Setting, base: usize) -> Result<()> {
    let section = &setting.keys[0];
    let is_surface = ["texture", "sampler", "material", "mesh"].contains(&section.name.as_str());
    if !is_surface && !is_shape(&section.name) {
        return Ok(());
    }
    let what = format!(
        "{} is a model, whose surfaces are its own; allowed: camera, image, sampling, background, light",
        source.path.display()
    );
    let help = "write a scene that has the model as [[mesh]], and other materials for it";
    let span = base + section.span.start..base + section.span.end;
    Err(source.error(span, &what, "not of a model").and_help(Some(help.into())))
}

fn vector(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

/// Returns the keys of a light and their values.
fn entries(light: &Light) -> Vec<(&'static str, String)> {
    let kind = |name: &str| ("kind", format!("\"{name}\""));
    match *light {
        Light::Point { position, intensity } => {
            vec![kind("point"), ("position", vector(position)), ("intensity", vector(intensity))]
        }
        Light::Spot { position, direction, intensity, inner, outer, range } => {
            let mut entries = vec![
                kind("spot"),
                ("position", vector(position)),
                ("direction", vector(direction)),
                ("intensity", vector(intensity)),
                ("inner", format!("{inner:?}")),
                ("outer", format!("{outer:?}")),
            ];
            entries.extend(range.is_finite().then(|| ("range", format!("{range:?}"))));
            entries
        }
        Light::Environment => vec![kind("environment")],
        Light::Directional { direction, irradiance } => {
            vec![kind("directional"), ("direction", vector(direction)), ("irradiance", vector(irradiance))]
        }
        Light::Sun { direction, angle, irradiance } => vec![
            kind("directional"),
            ("direction", vector(direction)),
            ("angle", format!("{angle:?}")),
            ("irradiance", vector(irradiance)),
        ],
        Light::Sphere { position, radius, intensity } => vec![
            kind("sphere"),
            ("position", vector(position)),
            ("radius", format!("{radius:?}")),
            ("intensity", vector(intensity)),
        ],
        Light::Rectangle { position, edge_u, edge_v, radiance } => vec![
            kind("rectangle"),
            ("position", vector(position)),
            ("edge_u", vector(edge_u)),
            ("edge_v", vector(edge_v)),
            ("radiance", vector(radiance)),
        ],
    }
}
