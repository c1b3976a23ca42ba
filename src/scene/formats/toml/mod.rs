//! Reads scene files in TOML. Input: the bytes of a file and the path by which it is known. Output: the scene that the
//! builder makes from them, or the first error, with its line and key.

mod lights;
mod materials;
mod meshes;
mod names;
mod place;
mod procedural;
mod reader;
mod samplers;
mod sections;
mod settings;
mod shapes;
mod source;
mod table;
mod textures;
mod view;
mod vocabulary;

use std::path::Path;

use toml::de::DeTable;

use super::{Format, Reading};
use crate::core::error::{Error, ErrorKind, Result};
use crate::scene::builder::SceneBuilder;
use crate::scene::geometry;
use crate::scene::limits::check_filters;
use crate::scene::model::{EnvironmentLayout, Scene};
use crate::texture::sampler_spec::Address;
use names::Names;
use procedural::PROCEDURAL;
use samplers::Known;
use source::Source;
use table::Table;
pub(in crate::scene) use view::View;
pub use vocabulary::{path_of, setting_keys};

/// 65535 triangles with texture coordinates take 7 MB of text.
const MAX_BYTES: u64 = 64 << 20;
const SINGLE: &[&str] = &["camera", "image", "sampling", "background"];
/// Sections that are lists of tables, beside those of shapes.
const REPEATED: &[&str] = &["texture", "sampler", "material", "mesh", "light"];

pub(super) const FORMAT: Format = Format { name: "TOML", endings: &["toml"], max_bytes: MAX_BYTES, read };

/// Reads a scene; paths in the file are relative to the folder of `path`.
fn read(path: &Path, bytes: Vec<u8>, reading: &Reading<'_>) -> Result<Scene> {
    let text = String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let byte = error.as_bytes()[valid];
        let shown = path.display();
        let message = format!(
            "cannot read scene {shown}: not UTF-8 text (byte 0x{byte:02x} at offset {valid}, line {line})"
        );
        Error::with_help(message, "scene files are TOML text: save the file as UTF-8")
            .of_kind(ErrorKind::File)
    })?;
    parse_as(path, &text, reading)
}

/// Parses scene text; paths in it are relative to the folder of `path_for_messages`.
pub fn parse(path_for_messages: &Path, text: &str) -> Result<Scene> {
    parse_as(path_for_messages, text, &Reading::default())
}

/// Parses scene text as [`parse`] does, in the stated way.
pub fn parse_as(path_for_messages: &Path, text: &str, reading: &Reading<'_>) -> Result<Scene> {
    let source = Source { path: path_for_messages, text, settings: reading.settings };
    let mut document = DeTable::parse(text).map_err(|error| syntax_error(source, &error))?.into_inner();
    let shapes: Vec<&str> = geometry::sections().map(|kind| kind.name).collect();
    settings::apply(&mut document, source, &[REPEATED, &shapes].concat())?;
    let root = Table::root(source, &document, &[SINGLE, REPEATED, &shapes].concat())?;
    assemble(path_for_messages, &root, reading)
}

fn syntax_error(source: Source<'_>, error: &toml::de::Error) -> Error {
    let span = error.span().unwrap_or(0..0);
    let found = match source.excerpt(span.clone()) {
        empty if empty.is_empty() => String::new(),
        excerpt => format!(", found {excerpt}"),
    };
    let place = span.start;
    let mut told = source.error(span, &format!("TOML syntax: {}{found}", error.message()), error.message());
    if let Error::Scene { help, .. } = &mut told
        && error.message().contains("escape")
        && source.line(place).contains('\\')
    {
        *help = Some(
            "within \"…\" a backslash begins an escape; write folders with / (textures/brick.png), or the path in \
             single quotes ('textures\\brick.png')"
                .into(),
        );
    }
    told
}

fn assemble(path: &Path, root: &Table<'_>, reading: &Reading<'_>) -> Result<Scene> {
    const CAMERA_NEEDS: &str = "eye, look_at and one of vertical_fov, camera_constant, orthographic_height";
    let camera = sections::camera(&root.required_single("camera", sections::CAMERA, CAMERA_NEEDS)?)?;
    let image = root.required_single("image", sections::IMAGE, "width and height")?;
    let (width, height) = sections::image(&image)?;
    let mut builder = SceneBuilder::new(camera, width, height);
    builder.path(path);
    builder.settings(reading.settings);
    builder.keep_meshes(reading.keeps_meshes);
    builder.pixel_filter(sections::pixel_filter(&image)?);
    builder.sampling(sections::sampling(root.single("sampling", sections::SAMPLING)?.as_ref())?);
    let materials = surfaces(root, &mut builder)?;
    let dropped = shapes::add_all(root, &materials, &mut builder)?;
    meshes::add_all(root, &materials, &mut builder)?;
    for table in root.repeated("light", lights::LIGHT)? {
        builder.light(lights::light(&table)?);
    }
    let mut scene = builder.check().map_err(|refusal| place::error(root, &refusal))?;
    check_filters(&scene)?;
    if let Some(place) = dropped {
        scene.first_dropped = place;
    }
    Ok(scene)
}

/// Adds textures, samplers, materials and the background; returns the materials' names.
fn surfaces<'a>(root: &Table<'a>, builder: &mut SceneBuilder) -> Result<Names<'a>> {
    let tables = root.repeated("texture", &[textures::TEXTURE, PROCEDURAL].concat())?;
    let texture_names = Names::collect("texture", &tables)?;
    let textures = tables.iter().map(textures::texture).collect::<Result<Vec<_>>>()?;

    let tables = root.repeated("sampler", samplers::SAMPLER)?;
    let sampler_names = Names::collect("sampler", &tables)?;
    let mut addresses = Vec::with_capacity(tables.len());
    for table in &tables {
        let sampler = samplers::sampler(table)?;
        addresses.push(table.get("address").map(|_| sampler.address));
        builder.sampler(sampler);
    }

    let tables = root.repeated("material", materials::MATERIAL)?;
    let names = Names::collect("material", &tables)?;
    let known = Known { textures: &texture_names, sources: &textures, samplers: &sampler_names };
    for table in &tables {
        builder.material(materials::material(table, &known)?);
    }
    let table = root.single("background", samplers::BACKGROUND)?;
    let mut background = samplers::background(table.as_ref(), &known)?;
    if let Some(environment) = &mut background.environment
        && environment.layout == EnvironmentLayout::Equirectangular
        && let Some(Some([_, v])) = addresses.get(environment.sampler)
    {
        environment.idle_address = (*v != Address::ClampToEdge).then_some(*v);
    }
    builder.background(background);
    for texture in textures {
        builder.texture(texture);
    }
    Ok(names)
}
