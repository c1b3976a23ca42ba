//! Loads the texels of a texture from its description in a scene, ready for upload. Errors in the
//! files name the texture and the file.

use std::path::Path;

use super::data::{Component, Dimension, TexelFormat, TextureData};
use super::decode::{
    AllowedFloats, check_meaning, check_values, in_texture, read_checked, read_embedded, reverse_rows,
    texture_of,
};
use super::read_file::{Picture, Texels};
use super::source::{TextureContent, TextureSource};
use super::{cube, nrrd, stack, volume};
use crate::core::error::{Error, Result};
use crate::core::panics;

/// Loads a texture. For a procedural one, which has no texels, returns a placeholder that is never
/// read.
pub fn load(source: &TextureSource) -> Result<TextureData> {
    load_with(source, AllowedFloats::Finite)
}

/// Loads a texture whose float values may be those that `values` allows.
pub fn load_with(source: &TextureSource, values: AllowedFloats) -> Result<TextureData> {
    load_with_notes(source, values).map(|(texture, _)| texture)
}

/// Loads a texture and also returns notes about how its files were read.
pub fn load_with_notes(source: &TextureSource, values: AllowedFloats) -> Result<(TextureData, Vec<String>)> {
    let stage = format!("texture \"{}\"", source.name);
    let (picture, depth) =
        panics::contain(&stage, || read(source, values).map_err(|e| in_texture(&source.name, e)))?;
    let mut texels = picture.texels;
    if source.flip_v {
        let height = texels.height;
        reverse_rows(&mut texels, height);
    }
    let texture = texture_of(&source.name, source.dimension, source.color_space, texels, depth);
    Ok((texture, picture.notes.iter().map(|note| format!("texture \"{}\": {note}", source.name)).collect()))
}

/// Reads the texels and returns the number of slices or faces with them.
fn read(source: &TextureSource, values: AllowedFloats) -> Result<(Picture, u32)> {
    let space = source.color_space;
    let reading = &source.reading;
    let picture = |path: &Path| read_checked(path, reading, space, values);
    let volume = |path: &Path, (texels, depth): (Texels, u32)| {
        check_meaning(texels.format, space, path)?;
        check_values(&texels, values, path)?;
        Ok((texels.into(), depth))
    };
    match &source.content {
        TextureContent::File(file) if source.dimension == Dimension::Three => volume(file, nrrd::read(file)?),
        TextureContent::File(file) => {
            let picture = picture(file)?;
            if source.dimension == Dimension::One {
                check_row(&picture.texels, file)?;
            }
            Ok((picture, 1))
        }
        TextureContent::Embedded(name, bytes) => Ok((read_embedded(name, bytes, reading, space)?, 1)),
        TextureContent::Ramp(colors) => Ok((ramp(colors).into(), 1)),
        TextureContent::CubeFile(file, layout) => {
            let Picture { texels, notes, .. } = picture(file)?;
            Ok((Picture::noted(cube::cut(&texels, *layout, file)?, notes), 6))
        }
        TextureContent::Faces(files) => cube::join(files, reading, space, values).map(|t| (t, 6)),
        TextureContent::Slices(files) => {
            stack::read(files, reading, space, values, "slice").map(|t| (t, files.len() as u32))
        }
        TextureContent::Procedural(_) => Ok((ramp(&[[0.0; 4]]).into(), 1)),
        TextureContent::Texels(plain) => {
            let texels = Texels {
                width: plain.width,
                height: plain.height,
                format: plain.format,
                file_channels: plain.format.channels(),
                bytes: plain.bytes.clone(),
            };
            check_meaning(texels.format, space, Path::new("in memory"))?;
            check_values(&texels, values, Path::new("in memory"))?;
            Ok((texels.into(), 1))
        }
        TextureContent::Volume(raw) => volume(&raw.file, (volume::read(raw)?, raw.size[2])),
    }
}

fn ramp(colors: &[[f32; 4]]) -> Texels {
    Texels {
        width: colors.len() as u32,
        height: 1,
        format: TexelFormat::new(4, Component::Float32),
        file_channels: if colors.iter().all(|c| c[3] == 1.0) { 3 } else { 4 },
        bytes: bytemuck::cast_slice(colors).to_vec(),
    }
}

fn check_row(texels: &Texels, path: &Path) -> Result<()> {
    if texels.height == 1 {
        return Ok(());
    }
    Err(Error::with_help(
        format!(
            "{}: {}×{} texels, and a texture of dimension \"1d\" is one texel high",
            path.display(),
            texels.width,
            texels.height
        ),
        "cut one row out of the picture, or set dimension = \"2d\"",
    ))
}
