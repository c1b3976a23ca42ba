//! Reads `[[texture]]`: the source of the texels and their meaning. Input: the section's table. Output: a
//! [`TextureSource`]. No file is opened here.

use std::path::{Path, PathBuf};

use super::procedural::{PROCEDURAL, procedural};
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::limits::{MAX_TEXELS, TEXELS};
use crate::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat};
use crate::texture::open_file::is_volume;
use crate::texture::source::{
    CubeLayout, Endian, OrientationUse, ProfileUse, ReadOptions, TextureContent, TextureSource, VolumeSource,
};

pub(super) const TEXTURE: &[&str] = &[
    "name",
    "file",
    "faces",
    "slices",
    "volume",
    "ramp",
    "dimension",
    "layout",
    "color_space",
    "orientation",
    "color_profile",
    "layer",
    "flip_v",
    "mip_filter",
];
/// Exactly one of these keys names the source of the texels.
const CONTENTS: [&str; 5] = ["file", "faces", "slices", "volume", "ramp"];
const VOLUME: &[&str] = &["file", "size", "format", "offset", "endian"];
const FACES: &str = "6 files, the faces +x, -x, +y, -y, +z and -z";

pub(super) fn texture(table: &Table<'_>) -> Result<TextureSource> {
    let name = table.required("name")?.string()?.to_owned();
    if table.get("procedural").is_some() {
        if let Some(other) = CONTENTS.iter().find_map(|key| table.get(key)) {
            let what = "a procedural texture has no texels; keep procedural or this";
            return Err(other.error(what, "excludes procedural"));
        }
        table.allow_only(&[&["name"], PROCEDURAL].concat())?;
        let content = TextureContent::Procedural(procedural(table)?);
        let (dimension, color_space) = (Dimension::Two, ColorSpace::Linear);
        return Ok(TextureSource {
            name,
            content,
            dimension,
            color_space,
            color_space_stated: false,
            reading: ReadOptions::default(),
            flip_v: false,
            mip_kernel: MipKernel::Box,
        });
    }
    let field = only_content(table)?;
    table.allow_only(TEXTURE)?;
    let dimension = dimension(table, field)?;
    let content = content(table, field, dimension)?;

    let mut color_space = ColorSpace::Linear;
    if let Some(given) = table.get("color_space") {
        color_space = given.choice(ColorSpace::NAMES, ColorSpace::ALL)?;
    }
    let reading = reading(table, &content, dimension)?;
    let mut flip_v = false;
    if let Some(given) = table.get("flip_v") {
        flip_v = given.boolean()?;
    }
    let mip_kernel = match table.get("mip_filter") {
        Some(given) => given.choice(MipKernel::NAMES, MipKernel::ALL)?,
        None => MipKernel::Box,
    };
    Ok(TextureSource {
        name,
        content,
        dimension,
        color_space,
        color_space_stated: table.get("color_space").is_some(),
        reading,
        flip_v,
        mip_kernel,
    })
}

/// Reads the keys that only picture files have.
fn reading(table: &Table<'_>, content: &TextureContent, dimension: Dimension) -> Result<ReadOptions> {
    let mut reading = ReadOptions::default();
    let is_picture = match content {
        TextureContent::File(_) => dimension != Dimension::Three,
        TextureContent::CubeFile(..)
        | TextureContent::Faces(_)
        | TextureContent::Tiles(_)
        | TextureContent::Slices(_) => true,
        _ => false,
    };
    if let (false, Some(field)) =
        (is_picture, ["orientation", "color_profile", "layer"].iter().find_map(|k| table.get(k)))
    {
        let what = "it says how a file of a picture is read, and these texels come from none; leave it out";
        return Err(field.error(what, "no picture"));
    }
    if let Some(field) = table.get("orientation") {
        reading.orientation = field.choice(OrientationUse::NAMES, OrientationUse::ALL)?;
    }
    if let Some(field) = table.get("color_profile") {
        reading.color_profile = field.choice(ProfileUse::NAMES, ProfileUse::ALL)?;
    }
    if let Some(field) = table.get("layer") {
        reading.layer = Some(field.string()?.to_owned());
    }
    Ok(reading)
}

fn only_content<'a>(table: &Table<'a>) -> Result<Field<'a>> {
    let given: Vec<Field<'a>> = CONTENTS.iter().filter_map(|key| table.get(key)).collect();
    match given.as_slice() {
        [] => {
            let what = format!(
                "key \"texture.file\" is missing in [[texture]]: give one of {}",
                [&CONTENTS[..], &["procedural"]].concat().join(", ")
            );
            Err(table.error(&what, "no texels"))
        }
        [field] => Ok(*field),
        [first, second, ..] => {
            let what = format!("{} is given too; keep exactly one of {}", first.key, CONTENTS.join(", "));
            Err(second.error(&what, format!("excludes {}", first.key)))
        }
    }
}

/// Returns the dimension of the content, unless `dimension` overrides it.
fn dimension(table: &Table<'_>, content: Field<'_>) -> Result<Dimension> {
    if let Some(field) = table.get("dimension") {
        return field.choice(Dimension::NAMES, Dimension::ALL);
    }
    Ok(match content.key {
        "faces" => Dimension::Cube,
        "slices" | "volume" => Dimension::Three,
        "ramp" => Dimension::One,
        _ if table.get("layout").is_some() => Dimension::Cube,
        _ if is_volume(Path::new(content.string()?)) => Dimension::Three,
        _ => Dimension::Two,
    })
}

fn content(table: &Table<'_>, field: Field<'_>, dimension: Dimension) -> Result<TextureContent> {
    let layout = layout(table, field)?;
    Ok(match field.key {
        "faces" => {
            let empty: [PathBuf; 6] = Default::default();
            TextureContent::Faces(field.array(FACES, empty, Field::path)?)
        }
        "slices" => TextureContent::Slices(field.list("files", MAX_TEXELS, Field::path)?),
        "volume" => TextureContent::Volume(volume(&Table::inline(field, "texture.volume", VOLUME)?)?),
        "ramp" => TextureContent::Ramp(field.list("colors", MAX_TEXELS, color)?),
        _ if dimension == Dimension::Cube || layout.is_some() => {
            TextureContent::CubeFile(field.path()?, layout)
        }
        _ if dimension == Dimension::Two => TextureContent::flat_file(field.path()?),
        _ => TextureContent::File(field.path()?),
    })
}

fn layout(table: &Table<'_>, content: Field<'_>) -> Result<Option<CubeLayout>> {
    let Some(field) = table.get("layout") else { return Ok(None) };
    let layout = field.choice(CubeLayout::NAMES, CubeLayout::ALL)?;
    if content.key != "file" {
        let what = format!(
            "it says how one file holds the faces of a cube, and the texels come from {}; leave it out",
            content.key
        );
        return Err(field.error(&what, "only with file and dimension \"cube\""));
    }
    Ok(Some(layout))
}

fn volume(table: &Table<'_>) -> Result<VolumeSource> {
    let wanted = "3 sizes, width, height and depth";
    let endian = table.get("endian").map_or(Ok(Endian::Little), |f| f.choice(Endian::NAMES, Endian::ALL))?;
    Ok(VolumeSource {
        file: table.required("file")?.path()?,
        size: table.required("size")?.array(wanted, [0; 3], |f| f.integer(&TEXELS))?,
        format: table.required("format")?.choice(TexelFormat::NAMES, TexelFormat::ALL)?,
        offset: table.get("offset").map_or(Ok(0), |f| f.integer(&(0..=u32::MAX)))?.into(),
        endian,
    })
}

/// Reads three numbers, or four with alpha.
fn color(field: Field<'_>) -> Result<[f32; 4]> {
    let has_alpha = field.value().as_array().is_some_and(|array| array.len() == 4);
    let [r, g, b, a] = if has_alpha {
        field.numbers::<4>()?
    } else {
        let [r, g, b] = field.numbers::<3>()?;
        [r, g, b, 1.0]
    };
    Ok([r, g, b, a].map(|value| value as f32))
}
