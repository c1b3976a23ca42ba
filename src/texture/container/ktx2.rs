//! Reads KTX2 files (Khronos, KTX File Format 2.0): one to three axes and cubes with their levels, uncompressed, in blocks
//! of BC1 to BC7, or in those of Basis Universal. Takes the bytes of a file; returns its decoded levels.

use std::borrow::Cow;
use std::path::Path;

use super::fields::Channels;
use super::ktx2_header::{Header, Scheme, TRANSFER_LINEAR, TRANSFER_SRGB};
use super::pixel_format::{Layout, PixelFormat};
use super::{Level, Stored, basis, inflate, level_size, max_levels, of_levels};
use crate::core::error::Result;
use crate::texture::data::{ColorSpace, Dimension};
use crate::texture::decoder::Fault;
use crate::texture::read_file::{FileFacts, Picture, check_volume, unsupported_kind};

pub(in crate::texture) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let header = Header::read(file).map_err(|fault| fault.in_file(path, "KTX2"))?;
    let refused = |what: String| unsupported_kind(path, &format!("a KTX2 file {what}"));
    if header.layers > 1 {
        return Err(refused(format!("of an array of {} textures", header.layers)));
    }
    let (dimension, size) = shape(&header).map_err(|fault| fault.in_file(path, "KTX2"))?;
    let mut notes = Vec::new();
    if header.is_premultiplied {
        notes.push(format!("{}: its colours are multiplied by alpha, and stay so", path.display()));
    }
    let color_space = match header.transfer {
        TRANSFER_SRGB => Some(ColorSpace::Srgb),
        TRANSFER_LINEAR => Some(ColorSpace::Linear),
        _ => None,
    };
    if let (0, Some(codec)) = (header.format, header.basis) {
        check_volume(path, size, 4)?;
        let levels =
            basis::levels(file, &header, dimension, size).map_err(|fault| fault.in_file(path, "KTX2"))?;
        let encoding = Some(format!("KTX2, Basis Universal {codec}"));
        let facts =
            FileFacts { dimension, depth: size[2], levels: Vec::new(), color_space, encoding, profile: None };
        return turned(of_levels(levels, facts, notes, path)?, &header);
    }
    let mut format = PixelFormat::of_vulkan(header.format)
        .ok_or_else(|| refused(format!("of Vulkan format {}", header.format)))?;
    match (header.swizzle.as_deref(), &mut format.layout) {
        (Some("rrrg"), Layout::Fields(fields)) if fields.channels == Channels::RedGreen => {
            fields.channels = Channels::GreyAlpha;
        }
        (None | Some("rgba" | "rgb1" | "rg01" | "r001" | "rrr1"), _) => {}
        (Some(swizzle), _) => {
            let swizzle: String = swizzle.chars().take(8).collect();
            notes.push(format!(
                "{}: its swizzle {swizzle:?} is ignored; channels are read as stored",
                path.display()
            ));
        }
    }
    let decoded = format.layout.texel_format();
    check_volume(path, size, decoded.bytes_per_texel())?;
    let levels =
        levels(file, &header, dimension, size, format).map_err(|fault| fault.in_file(path, "KTX2"))?;
    let color_space = if format.is_srgb { Some(ColorSpace::Srgb) } else { color_space };
    turned(
        Stored { kind: "KTX2", dimension, size, format, color_space, levels, notes }.picture(path)?,
        &header,
    )
}

/// Returns the picture with its first row on top.
fn turned(mut picture: Picture, header: &Header) -> Result<Picture> {
    if header.rows_up {
        picture.reverse_rows();
    }
    Ok(picture)
}

/// Returns the axes and the size, with the faces of a cube as depth.
fn shape(header: &Header) -> std::result::Result<(Dimension, [u32; 3]), Fault> {
    let Header { width, height, depth, faces, .. } = *header;
    let (dimension, size) = match (faces, depth) {
        (6, 0) => (Dimension::Cube, [width, height, 6]),
        (0 | 1, 0) => (Dimension::Two, [width, height.max(1), 1]),
        (0 | 1, _) => (Dimension::Three, [width, height, depth]),
        _ => return Err(Fault::Damaged(format!("{faces} faces of depth {depth}"))),
    };
    if size.contains(&0) {
        return Err(Fault::ZeroSize);
    }
    if dimension == Dimension::Cube && width != height {
        return Err(Fault::Damaged(format!("a cube's faces of {width}×{height} texels")));
    }
    let count = header.levels.len();
    if count > max_levels(dimension, size) as usize {
        return Err(Fault::Damaged(format!("{count} levels of {width}×{height} texels")));
    }
    Ok((dimension, size))
}

/// Returns the bytes of each level as they were before they were compressed once more.
fn levels<'a>(
    file: &'a [u8],
    header: &Header,
    dimension: Dimension,
    size: [u32; 3],
    format: PixelFormat,
) -> std::result::Result<Vec<Level<'a>>, Fault> {
    let level = |index: usize| {
        let found = &header.levels[index];
        let due = format.layout.bytes(level_size(dimension, size, index as u32));
        let stored = &file[found.place.clone()];
        let has = if header.scheme == Scheme::None { stored.len() as u64 } else { found.bytes };
        if has != due {
            return Err(Fault::Damaged(format!("level {index} takes {due} bytes, and the file has {has}")));
        }
        Ok(vec![match header.scheme {
            Scheme::None => Cow::Borrowed(stored),
            Scheme::Zstd => Cow::Owned(inflate::zstd(stored, due)?),
            Scheme::Zlib => Cow::Owned(inflate::zlib(stored, due)?),
            Scheme::BasisLz => {
                return Err(Fault::Unsupported("BasisLZ of a format that is not ETC1S".into()));
            }
            Scheme::Other(scheme) => {
                return Err(Fault::Unsupported(format!("supercompression scheme {scheme}")));
            }
        }])
    };
    (0..header.levels.len()).map(level).collect()
}
