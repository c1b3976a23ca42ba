//! Loads the texels of a texture from its description in a scene, ready for upload. Errors in the
//! files name the texture and the file.

use std::path::Path;

use super::data::{Component, Dimension, TexelFormat, TextureData};
use super::decode::{AllowedFloats, check_picture, in_texture, read_checked, read_embedded, texture_of};
use super::read_file::{self, FileFacts, Picture, Texels};
use super::source::{TextureContent, TextureSource};
use super::{cube, cutout, nrrd, stack, tiles, volume};
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
    let mut picture =
        panics::contain(&stage, || read(source, values).map_err(|e| in_texture(&source.name, e)))?;
    if source.flip_v {
        picture.reverse_rows();
    }
    let notes = picture.notes.iter().map(|note| format!("texture \"{}\": {note}", source.name)).collect();
    let of_file = picture.facts.color_space.filter(|_| !source.color_space_stated);
    let color_space = of_file.unwrap_or(source.color_space);
    Ok((texture_of(&source.name, source.dimension, color_space, picture), notes))
}

/// Reads the texels, with the number of slices or faces.
fn read(source: &TextureSource, values: AllowedFloats) -> Result<Picture> {
    let space = source.color_space;
    let reading = &source.reading;
    let picture = |path: &Path| read_checked(path, reading, space, values);
    let container = |path: &Path| {
        let picture = read_file::read_any(path, reading)?;
        read_file::check_dimension(&picture, source.dimension, path)?;
        check_picture(picture, space, values, path)
    };
    let volume = |path: &Path, texels, depth| check_picture(deep(texels, depth), space, values, path);
    match &source.content {
        TextureContent::File(file) if source.dimension == Dimension::Three => {
            if read_file::is_container(file) {
                return container(file);
            }
            let (texels, depth) = nrrd::read(file)?;
            volume(file, texels, depth)
        }
        TextureContent::File(file) => {
            let picture = picture(file)?;
            if source.dimension == Dimension::One {
                check_row(&picture.texels, file)?;
            }
            Ok(picture)
        }
        TextureContent::FirstOf(pictures) => first_of(pictures, source, values),
        TextureContent::Embedded(name, bytes) => read_embedded(name, bytes, reading, space),
        TextureContent::Ramp(colors) => Ok(ramp(colors).into()),
        TextureContent::CubeFile(file, None) if cube::is_whole(file, reading)? => container(file),
        TextureContent::CubeFile(file, layout) => {
            let Picture { texels, notes, facts, .. } = picture(file)?;
            let faces = Picture::noted(cube::cut(&texels, *layout, file)?, notes);
            Ok(Picture {
                facts: FileFacts { depth: 6, color_space: facts.color_space, ..FileFacts::default() },
                ..faces
            })
        }
        TextureContent::Faces(files) => cube::join(files, reading, space, values),
        TextureContent::Slices(files) => stack::read(files, reading, space, values, "slice"),
        TextureContent::Cutout { color, opacity } => {
            cutout::read(color.as_ref(), opacity, reading, space, values)
        }
        TextureContent::Tiles(set) => tiles::read(set, reading, space, values),
        TextureContent::Procedural(_) => Ok(ramp(&[[0.0; 4]]).into()),
        TextureContent::Texels(plain) => {
            let texels = Texels {
                width: plain.width,
                height: plain.height,
                format: plain.format,
                file_channels: plain.format.channels(),
                bytes: plain.bytes.clone(),
            };
            check_picture(texels.into(), space, values, Path::new("in memory"))
        }
        TextureContent::Volume(raw) => volume(&raw.file, volume::read(raw)?, raw.size[2]),
    }
}

/// Reads the first picture that can be read, with a note of why those before it cannot; or says why none can.
fn first_of(
    pictures: &[(String, TextureContent)],
    source: &TextureSource,
    values: AllowedFloats,
) -> Result<Picture> {
    let mut faults: Vec<String> = Vec::new();
    for (place, content) in pictures {
        let alone = TextureSource { content: content.clone(), ..source.clone() };
        match panics::contain(place, || read(&alone, values)) {
            Ok(mut picture) => {
                let note = || format!("{place} is read in place of {}", faults.join(" and of "));
                picture.notes.extend((!faults.is_empty()).then(note));
                return Ok(picture);
            }
            Err(error) if pictures.len() == 1 => return Err(error.within(place)),
            Err(error) => faults.push(format!("{place}: {error}")),
        }
    }
    Err(Error::new(faults.join("; ")))
}

/// Returns a volume of so many slices.
fn deep(texels: Texels, depth: u32) -> Picture {
    Picture { facts: FileFacts { depth, ..FileFacts::default() }, ..Picture::from(texels) }
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
