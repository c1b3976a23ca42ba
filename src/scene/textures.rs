//! `[[texture]]`: where the texels come from and what they mean. In: the section's table and the
//! scene file's folder. Out: a [`TextureSource`] whose keys fit together. Nothing is opened here.

use std::path::{Path, PathBuf};

use super::procedural::{PROCEDURAL, procedural};
use super::reader::{COORDINATE, Field};
use super::table::Table;
use crate::core::error::Result;
use crate::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat};
use crate::texture::source::{
    CubeLayout, Endian, OrientationUse, Reading, TextureContent, TextureSource, VolumeSource,
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
    "layer",
    "flip_v",
    "mip_filter",
];
/// Exactly one of them says where the texels come from.
const CONTENTS: [&str; 5] = ["file", "faces", "slices", "volume", "ramp"];
const VOLUME: &[&str] = &["file", "size", "format", "offset", "endian"];
const FACES: &str = "6 files, the faces +x, -x, +y, -y, +z and -z";
/// Texels of a ramp, files of a stack, and texels along each side of a raw volume.
const MOST: u32 = 65_536;

pub(super) fn texture(table: &Table<'_>, folder: &Path) -> Result<TextureSource> {
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
            reading: Reading::default(),
            flip_v: false,
            mip_kernel: MipKernel::Box,
        });
    }
    let field = only_content(table)?;
    table.allow_only(TEXTURE)?;
    let dimension = dimension(table, field)?;
    let content = content(table, field, dimension, folder)?;

    let mut color_space = ColorSpace::Linear;
    if let Some(given) = table.get("color_space") {
        color_space = given.choice(ColorSpace::NAMES, ColorSpace::ALL)?;
        if color_space == ColorSpace::Srgb && field.key == "ramp" {
            let what = "the numbers of a ramp are linear light, not sRGB; leave color_space out";
            return Err(given.error(what, "ramps are linear"));
        }
    }
    let reading = reading(table, &content, dimension)?;
    let mut flip_v = false;
    if let Some(given) = table.get("flip_v") {
        flip_v = given.boolean()?;
        let reason = match dimension {
            Dimension::One => "a texture of dimension \"1d\" has no v to flip",
            Dimension::Cube => {
                "the rows of a cube's faces are fixed by its table; flip the pictures themselves"
            }
            Dimension::Two | Dimension::Three => "",
        };
        if flip_v && !reason.is_empty() {
            return Err(given.error(&format!("{reason}; leave flip_v out"), "nothing to flip"));
        }
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

/// What only files of pictures have.
fn reading(table: &Table<'_>, content: &TextureContent, dimension: Dimension) -> Result<Reading> {
    let mut reading = Reading::default();
    let is_picture = match content {
        TextureContent::File(_) => dimension != Dimension::Three,
        TextureContent::CubeFile(..) | TextureContent::Faces(_) | TextureContent::Slices(_) => true,
        TextureContent::Ramp(_) | TextureContent::Volume(_) | TextureContent::Procedural(_) => false,
    };
    if let (false, Some(field)) = (is_picture, ["orientation", "layer"].iter().find_map(|k| table.get(k))) {
        let what = "it says how a file of a picture is read, and these texels come from none; leave it out";
        return Err(field.error(what, "no picture"));
    }
    if let Some(field) = table.get("orientation") {
        reading.orientation = field.choice(OrientationUse::NAMES, OrientationUse::ALL)?;
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

/// What the content is, unless `dimension` says it; only a single file can be any of them.
fn dimension(table: &Table<'_>, content: Field<'_>) -> Result<Dimension> {
    let (implied, reason) = match content.key {
        "faces" => (Dimension::Cube, "faces are those of a cube"),
        "slices" => (Dimension::Three, "slices are those of a volume"),
        "volume" => (Dimension::Three, "volume has three axes"),
        "ramp" => (Dimension::One, "ramp has one axis"),
        _ if table.get("layout").is_some() => (Dimension::Cube, "layout says how a file holds a cube"),
        _ if is_volume(Path::new(content.string()?)) => (Dimension::Three, "an NRRD file is a volume"),
        _ => (Dimension::Two, ""),
    };
    let Some(field) = table.get("dimension") else { return Ok(implied) };
    let given = field.choice(Dimension::NAMES, Dimension::ALL)?;
    if given != implied && !reason.is_empty() {
        let what =
            format!("\"{given}\" contradicts {}: {reason}, so the dimension is \"{implied}\"", content.key);
        return Err(field.error(&what, format!("is \"{implied}\"")));
    }
    if given == Dimension::Three && content.key == "file" && !is_volume(Path::new(content.string()?)) {
        let what =
            "a picture is no volume; give slices = [files], volume = { … } or an NRRD file (.nrrd, .nhdr)";
        return Err(field.error(what, "not from one picture"));
    }
    Ok(given)
}

/// By the ending: the file is not opened here.
fn is_volume(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("nrrd") || e.eq_ignore_ascii_case("nhdr"))
}

fn content(
    table: &Table<'_>,
    field: Field<'_>,
    dimension: Dimension,
    folder: &Path,
) -> Result<TextureContent> {
    let file = |field: Field<'_>| field.string().map(|name| folder.join(name));
    let layout = layout(table, field, dimension)?;
    Ok(match field.key {
        "faces" => {
            let empty: [PathBuf; 6] = Default::default();
            TextureContent::Faces(field.array(FACES, empty, file)?)
        }
        "slices" => TextureContent::Slices(field.list("files", MOST, file)?),
        "volume" => TextureContent::Volume(volume(&Table::inline(field, "texture.volume", VOLUME)?, folder)?),
        "ramp" => TextureContent::Ramp(field.list("colors", MOST, color)?),
        _ if dimension == Dimension::Cube => TextureContent::CubeFile(file(field)?, layout),
        _ => TextureContent::File(file(field)?),
    })
}

fn layout(table: &Table<'_>, content: Field<'_>, dimension: Dimension) -> Result<Option<CubeLayout>> {
    let Some(field) = table.get("layout") else { return Ok(None) };
    let layout = field.choice(CubeLayout::NAMES, CubeLayout::ALL)?;
    if content.key != "file" || dimension != Dimension::Cube {
        let what = format!(
            "it says how one file holds the faces of a cube, and the texels come from {}; leave it out",
            content.key
        );
        return Err(field.error(&what, "only with file and dimension \"cube\""));
    }
    Ok(Some(layout))
}

fn volume(table: &Table<'_>, folder: &Path) -> Result<VolumeSource> {
    let wanted = "3 sizes, width, height and depth";
    let endian = table.get("endian").map_or(Ok(Endian::Little), |f| f.choice(Endian::NAMES, Endian::ALL))?;
    Ok(VolumeSource {
        file: folder.join(table.required("file")?.string()?),
        size: table.required("size")?.array(wanted, [0; 3], |f| f.integer(1..=MOST))?,
        format: table.required("format")?.choice(TexelFormat::NAMES, TexelFormat::ALL)?,
        offset: table.get("offset").map_or(Ok(0), |f| f.integer(0..=u32::MAX))?.into(),
        endian,
    })
}

/// Three numbers, or four with alpha.
fn color(field: Field<'_>) -> Result<[f32; 4]> {
    let has_alpha = field.value().as_array().is_some_and(|array| array.len() == 4);
    let [r, g, b, a] = if has_alpha {
        field.numbers::<4>(&COORDINATE)?
    } else {
        let [r, g, b] = field.numbers::<3>(&COORDINATE)?;
        [r, g, b, 1.0]
    };
    Ok([r, g, b, a].map(|value| value as f32))
}
