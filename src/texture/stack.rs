//! Joins several pictures into one texture: slices of a volume or faces of a cube, one after the
//! other. All must have one size. Formats may differ where conversion is lossless: each is widened
//! to the most channels (grey is replicated, missing alpha is 1) and from 8 to 16 bits (times 257,
//! so that 255 stays 1). Floats cannot be mixed with integers: an 8-bit picture may be
//! sRGB-encoded, while a float one is linear.

use std::path::PathBuf;

use rayon::prelude::*;

use super::data::{ColorSpace, Component, TexelFormat};
use super::decode::{AllowedFloats, read_checked};
use super::read_file::{FileFacts, Picture, Texels, check_volume};
use super::source::ReadOptions;
use crate::core::error::{Error, Result};

/// Reads the files. `what` names their kind in messages and is followed by the ordinal, from 1.
pub(super) fn read(
    files: &[PathBuf],
    reading: &ReadOptions,
    space: ColorSpace,
    values: AllowedFloats,
    what: &str,
) -> Result<Picture> {
    let pictures: Vec<Result<Picture>> =
        files.par_iter().map(|file| read_checked(file, reading, space, values)).collect();
    // The reported error is the first in the order of the files, whichever was found first.
    let pictures = pictures.into_iter().collect::<Result<Vec<_>>>()?;
    // Files that say different things about their values say nothing together; stored levels of slices are none of the
    // stack.
    let stated = |picture: &Picture| picture.facts.color_space;
    let color_space = pictures.first().and_then(stated);
    let color_space = color_space.filter(|space| pictures.iter().all(|p| stated(p) == Some(*space)));
    let (pictures, notes): (Vec<Texels>, Vec<Vec<String>>) =
        pictures.into_iter().map(|picture| (picture.texels, picture.notes)).unzip();
    let Some(first) = pictures.first() else { return Err(Error::new(format!("no {what} is given"))) };
    let (width, height) = (first.width, first.height);
    let mut channels = 0;
    let mut widest = first.format.component();
    for (index, (picture, file)) in pictures.iter().zip(files).enumerate() {
        let label = format!("{}: {what} {} of {}", file.display(), index + 1, files.len());
        if (picture.width, picture.height) != (width, height) {
            return Err(Error::with_help(
                format!(
                    "{label} has {}×{} texels, and the first, {}, has {width}×{height}",
                    picture.width,
                    picture.height,
                    files[0].display()
                ),
                format!("all {what}s of a texture have one size: scale this one"),
            ));
        }
        let component = picture.format.component();
        if (component == Component::Float32) != (widest == Component::Float32) {
            let (this, other) = (picture.format, first.format);
            return Err(Error::with_help(
                format!("{label} holds {this}, and the first, {}, {other}", files[0].display()),
                "float texels are linear light and integers may be sRGB: store all files alike",
            ));
        }
        widest = widest.max(component);
        channels = channels.max(picture.format.channels());
    }
    let format = TexelFormat::new(channels, widest);
    check_volume(&files[0], [width, height, files.len() as u32], format.bytes_per_texel())?;
    let file_channels = pictures.iter().map(|p| p.file_channels).max().unwrap_or(channels);
    let mut bytes = Vec::with_capacity(pictures.iter().map(|p| p.bytes.len()).sum());
    for picture in pictures {
        append(&mut bytes, &picture, format);
    }
    let joined = Picture::noted(Texels { width, height, format, file_channels, bytes }, notes.concat());
    let facts = FileFacts { depth: files.len() as u32, color_space, ..FileFacts::default() };
    Ok(Picture { facts, ..joined })
}

fn append(bytes: &mut Vec<u8>, picture: &Texels, format: TexelFormat) {
    if picture.format == format {
        bytes.extend_from_slice(&picture.bytes);
        return;
    }
    let (from, to) = (picture.format.component(), format.component());
    let size = from.bytes();
    for texel in picture.bytes.chunks_exact(picture.format.bytes_per_texel()) {
        let channel = |c: usize| &texel[c * size..(c + 1) * size];
        let mut put = |value: &[u8]| match (from, to) {
            (Component::Unorm8, Component::Unorm16) => bytes.extend_from_slice(&[value[0]; 2]),
            _ => bytes.extend_from_slice(value),
        };
        let opaque = &from.one()[..size];
        match (picture.format.channels(), format.channels()) {
            (1, 2) => [channel(0), opaque].into_iter().for_each(&mut put),
            (1, 4) => [channel(0), channel(0), channel(0), opaque].into_iter().for_each(&mut put),
            (2, 4) => [channel(0), channel(0), channel(0), channel(1)].into_iter().for_each(&mut put),
            (own, _) => (0..own).map(channel).for_each(&mut put),
        }
    }
}
