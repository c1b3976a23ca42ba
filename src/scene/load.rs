//! Entry of the scene layer. In: a path, or text and the path it is known by. Out: the whole
//! validated scene, with every reference an index, or the first error.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

use toml::de::DeTable;

use super::geometry::{self, MaterialIndex, Shapes};
use super::lights;
use super::materials;
use super::model::{Background, EnvironmentLayout, Material, Scene, TextureSource};
use super::names::Names;
use super::pixel_filter::pixel_filter;
use super::procedural::PROCEDURAL;
use super::samplers::{self, Known};
use super::sections;
use super::source::Source;
use super::table::Table;
use super::textures;
use super::validate::{MAX_TEXTURES, check_filters};
use crate::core::error::{Error, Result};
use crate::core::panics;
use crate::texture::open_file::odd_path;
use crate::texture::sampler_spec::{Address, SamplerSpec};

/// 65535 triangles with texture coordinates take 7 MB of text.
const MAX_BYTES: u64 = 64 << 20;
const SECTIONS: &[&str] = &[
    "camera",
    "image",
    "sampling",
    "background",
    "texture",
    "sampler",
    "material",
    "plane",
    "sphere",
    "triangle",
    "light",
];

/// What a scene is called that was not read from a file.
pub const STANDARD_INPUT: &str = "<stdin>";

/// Whether a path stands for standard input.
pub fn is_standard_input(path: &Path) -> bool {
    path == Path::new("-")
}

/// Reads a scene file, or standard input where the path is `-`: paths in it are then relative to the current
/// folder. Textures are named, not opened.
pub fn load(path: &Path) -> Result<Scene> {
    let is_stdin = is_standard_input(path);
    let stage = if is_stdin { STANDARD_INPUT.into() } else { path.display().to_string() };
    panics::contain(&format_args!("{stage}: reading this scene"), || {
        if is_stdin {
            return parse(Path::new(STANDARD_INPUT), &text_of(std::io::stdin().lock(), STANDARD_INPUT)?);
        }
        parse(path, &read(path)?)
    })
}

/// Parses scene text. Paths in it are relative to the folder of `path_for_messages`.
pub fn parse(path_for_messages: &Path, text: &str) -> Result<Scene> {
    let source = Source { path: path_for_messages, text };
    let document = DeTable::parse(text).map_err(|error| syntax_error(source, &error))?;
    let root = Table::root(source, document.get_ref(), SECTIONS)?;
    assemble(path_for_messages, &root)
}

fn read(path: &Path) -> Result<String> {
    let shown = path.display();
    if path.is_dir() {
        let message = format!("cannot read scene {shown}: it is a folder");
        return Err(Error::with_help(message, "name a scene file (TOML) in it"));
    }
    let file = File::open(path).map_err(|error| {
        let help = odd_path(path).filter(|_| error.kind() == ErrorKind::NotFound);
        Error::new(format!("cannot read scene {shown}: {error}")).and_help(help)
    })?;
    text_of(file, &shown.to_string())
}

fn text_of(source: impl Read, shown: &str) -> Result<String> {
    let mut bytes = Vec::new();
    source
        .take(MAX_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| Error::new(format!("cannot read scene {shown}: {error}")))?;
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Error::new(format!(
            "cannot read scene {shown}: it is larger than {} MiB, the most a scene file may have",
            MAX_BYTES >> 20
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let valid = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..valid].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let byte = error.as_bytes()[valid];
        let message = format!(
            "cannot read scene {shown}: not UTF-8 text (byte 0x{byte:02x} at offset {valid}, line {line})"
        );
        Error::with_help(message, "scene files are TOML text: save the file as UTF-8")
    })
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

fn assemble(path: &Path, root: &Table<'_>) -> Result<Scene> {
    root.check_counts("textures", MAX_TEXTURES, &["texture"])?;
    geometry::check_count(root)?;

    const CAMERA_NEEDS: &str = "eye, look_at and one of vertical_fov, camera_constant, orthographic_height";
    let camera = sections::camera(&root.required_single("camera", sections::CAMERA, CAMERA_NEEDS)?)?;
    let image = root.required_single("image", sections::IMAGE, "width and height")?;
    let (width, height) = sections::image(&image)?;
    let pixel_filter = pixel_filter(&image)?;
    let sampling = sections::sampling(root.single("sampling", sections::SAMPLING)?.as_ref())?;
    let Surfaces { textures, samplers, mut materials, background, names } = surfaces(path, root)?;
    let index = MaterialIndex { names: &names, fallback: materials.len() };
    let Shapes { planes, spheres, triangles, dropped_triangles, first_dropped, use_fallback } =
        geometry::read(root, &index, &materials)?;
    let lights = each(root.repeated("light", lights::LIGHT)?, lights::light)?;
    if use_fallback {
        materials.push(Material::default());
    }
    let path = path.to_owned();
    let scene = Scene {
        path,
        camera,
        width,
        height,
        pixel_filter,
        sampling,
        background,
        textures,
        samplers,
        materials,
        planes,
        spheres,
        triangles,
        dropped_triangles,
        first_dropped,
        lights,
    };
    check_filters(&scene)?;
    Ok(scene)
}

struct Surfaces<'a> {
    textures: Vec<TextureSource>,
    samplers: Vec<SamplerSpec>,
    materials: Vec<Material>,
    background: Background,
    /// Of the materials.
    names: Names<'a>,
}

fn surfaces<'a>(path: &Path, root: &Table<'a>) -> Result<Surfaces<'a>> {
    let tables = root.repeated("texture", &[textures::TEXTURE, PROCEDURAL].concat())?;
    let texture_names = Names::collect("texture", &tables)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let textures = each(tables, |table| textures::texture(table, folder))?;

    let tables = root.repeated("sampler", samplers::SAMPLER)?;
    let sampler_names = Names::collect("sampler", &tables)?;
    let states_address: Vec<bool> = tables.iter().map(|table| table.get("address").is_some()).collect();
    let mut samplers = each(tables, samplers::sampler)?;

    let tables = root.repeated("material", materials::MATERIAL)?;
    let names = Names::collect("material", &tables)?;
    let fallback = samplers.len();
    let known = Known {
        textures: &texture_names,
        sources: &textures,
        samplers: &sampler_names,
        default_sampler: fallback,
    };
    let materials = each(tables, |table| materials::material(table, &known))?;
    let table = root.single("background", samplers::BACKGROUND)?;
    let mut background = samplers::background(table.as_ref(), &known)?;
    if let Some(environment) = &mut background.environment
        && environment.layout == EnvironmentLayout::Equirectangular
        && states_address.get(environment.sampler) == Some(&true)
    {
        let [_, v] = samplers[environment.sampler].address;
        environment.idle_address = (v != Address::ClampToEdge).then_some(v);
    }
    let mut used = materials.iter().filter(|m: &&Material| m.is_mapped()).map(|m| m.sampler);
    if used.any(|s| s == fallback) || background.environment.is_some_and(|e| e.sampler == fallback) {
        samplers.push(SamplerSpec::default());
    }
    Ok(Surfaces { textures, samplers, materials, background, names })
}

fn each<'a, T>(tables: Vec<Table<'a>>, read: impl Fn(&Table<'a>) -> Result<T>) -> Result<Vec<T>> {
    tables.iter().map(read).collect()
}
