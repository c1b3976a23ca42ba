//! A picture of colours with the opacity of another one. Input: the two files. Output: one picture of four channels in
//! the size of the colours, whose alpha is that of the other file, or its first channel where that has none.

use std::path::{Path, PathBuf};

use super::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use super::decode::{AllowedFloats, check_picture, texture_of};
use super::read_file::{FileFacts, Picture, Texels, read_as};
use super::source::ReadOptions;
use crate::core::error::Result;

/// Reads the colours, white without any, and the opacity.
pub(super) fn read(
    color: Option<&PathBuf>,
    opacity: &Path,
    reading: &ReadOptions,
    space: ColorSpace,
    values: AllowedFloats,
) -> Result<Picture> {
    let read = |path: &Path, space| check_picture(read_as(path, reading)?, space, values, path);
    let mut covering = read(opacity, ColorSpace::Linear)?;
    let mut notes = std::mem::take(&mut covering.notes);
    let covering = texture_of("", Dimension::Two, ColorSpace::Linear, covering);
    let (mut found, facts) = match color {
        Some(path) => {
            let picture = read(path, space)?;
            notes.extend(picture.notes);
            (picture.texels, FileFacts { color_space: picture.facts.color_space, ..FileFacts::default() })
        }
        None => (white(covering.width, covering.height), FileFacts::default()),
    };
    if [found.width, found.height] != [covering.width, covering.height] {
        let [of_color, of_opacity] =
            [[found.width, found.height], [covering.width, covering.height]].map(|[w, h]| format!("{w}×{h}"));
        let what =
            format!("its opacity has {of_opacity} texels, the colours {of_color}; the nearest is taken");
        notes.push(format!("{}: {what}", opacity.display()));
    }
    let component = found.format.component();
    let width = component.bytes();
    found.bytes = of_four_channels(&found);
    found.format = TexelFormat::new(4, component);
    found.file_channels = 4;
    let [columns, rows] = [found.width, found.height];
    for (index, texel) in found.bytes.chunks_exact_mut(4 * width).enumerate() {
        let (x, y) = (index as u32 % columns, index as u32 / columns);
        let nearest =
            |at: u32, of: u32, in_all: u32| (2 * u64::from(at) + 1) * u64::from(in_all) / (2 * u64::from(of));
        let at = [nearest(x, columns, covering.width), nearest(y, rows, covering.height)];
        component.store(share(&covering, at), &mut texel[3 * width..]);
    }
    Ok(Picture { facts, ..Picture::noted(found, notes) })
}

fn white(width: u32, height: u32) -> Texels {
    let format = TexelFormat::new(4, Component::Unorm8);
    Texels { width, height, format, file_channels: 4, bytes: vec![255; 4 * width as usize * height as usize] }
}

/// Returns the opacity of a texel.
fn share(covering: &TextureData, [x, y]: [u64; 2]) -> f64 {
    let channels = covering.format.channels();
    let has_alpha = [2, 4].contains(&covering.file_channels);
    covering.value(x as u32, y as u32, if has_alpha { channels - 1 } else { 0 })
}

/// Returns the texels with red, green and blue of their grey, and room for alpha.
fn of_four_channels(texels: &Texels) -> Vec<u8> {
    let (channels, width) = (texels.format.channels(), texels.format.component().bytes());
    if channels == 4 {
        return texels.bytes.clone();
    }
    let grey = |texel: &[u8]| texel[..width].repeat(4);
    texels.bytes.chunks_exact(channels * width).flat_map(grey).collect()
}
