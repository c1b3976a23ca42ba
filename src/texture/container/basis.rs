//! KTX2 files of Basis Universal: ETC1S with BasisLZ, and UASTC, also within Zstandard. Takes a header and the bytes of the
//! file; returns its levels in 8 bits, as the reference transcoder unpacks them.

use basisu::{DecodeFlags, TargetFormat, Transcoder};

use super::ktx2_header::{BasisChannels, Header, LevelIndex, Scheme};
use super::{blocks, inflate, level_size, normal};
use crate::texture::data::{Component, Dimension, TexelFormat};
use crate::texture::decoder::Fault;
use crate::texture::read_file::Texels;

/// The texels of level 0 that any file may have, however short it is; more must be borne out by its length.
const ALWAYS_PLAUSIBLE: u64 = 1 << 26;
const MAX_TEXELS_PER_BYTE: u64 = 1 << 12;
const UASTC_BLOCK_BYTES: u64 = 16;
/// Where a header has the supercompression scheme, and the index of levels.
const SCHEME_AT: usize = 44;
const LEVELS_AT: usize = 80;
const LEVEL_BYTES: usize = 24;

/// Decodes all levels.
pub(super) fn levels(
    file: &[u8],
    header: &Header,
    dimension: Dimension,
    size: [u32; 3],
) -> Result<Vec<Texels>, Fault> {
    let texels = size.iter().map(|&side| u64::from(side)).product::<u64>();
    if texels > ALWAYS_PLAUSIBLE.max(MAX_TEXELS_PER_BYTE.saturating_mul(file.len() as u64)) {
        return Err(Fault::Damaged(format!(
            "{} bytes cannot hold {}×{} texels",
            file.len(),
            size[0],
            size[1]
        )));
    }
    let inflated;
    let file = match header.scheme {
        Scheme::Zstd => {
            inflated = without_zstd(file, header, dimension, size)?;
            &inflated
        }
        Scheme::None | Scheme::BasisLz => file,
        _ => return Err(Fault::Unsupported("Basis Universal within this supercompression scheme".into())),
    };
    let transcoder = Transcoder::new(file).map_err(|e| fault(&e))?;
    let faces = if dimension == Dimension::Cube { 6 } else { 1 };
    let level = |index: u32| {
        let [width, height, _] = level_size(dimension, size, index);
        let mut rgba = Vec::new();
        for face in 0..faces {
            let image = transcoder.transcode_image(index, 0, face, TargetFormat::Rgba32, DecodeFlags::NONE);
            rgba.extend(image.map_err(|e| fault(&e))?);
        }
        if rgba.len() != width as usize * height as usize * faces as usize * 4 {
            return Err(Fault::Damaged(format!("level {index} has not {width}×{height} texels")));
        }
        Ok(texels_of(rgba, [width, height], header.basis_channels, transcoder.has_alpha()))
    };
    (0..header.levels.len() as u32).map(level).collect()
}

fn fault(error: &basisu::Error) -> Fault {
    Fault::Damaged(format!("no Basis Universal ({error:?})"))
}

/// Returns the file with the levels of UASTC uncompressed behind it: the transcoder leaves Zstandard to others.
fn without_zstd(
    file: &[u8],
    header: &Header,
    dimension: Dimension,
    size: [u32; 3],
) -> Result<Vec<u8>, Fault> {
    let mut whole = file.to_vec();
    whole[SCHEME_AT..SCHEME_AT + 4].fill(0);
    for (index, LevelIndex { place, bytes }) in header.levels.iter().enumerate() {
        let [width, height, depth] = level_size(dimension, size, index as u32).map(u64::from);
        let count = |side: u64| side.div_ceil(blocks::SIDE as u64);
        let due = count(width) * count(height) * depth * UASTC_BLOCK_BYTES;
        if *bytes != due {
            return Err(Fault::Damaged(format!("level {index} takes {due} bytes, and the file has {bytes}")));
        }
        let level = inflate::zstd(&file[place.clone()], due)?;
        let at = LEVELS_AT + index * LEVEL_BYTES;
        let entry = [whole.len() as u64, due, due].map(u64::to_le_bytes).concat();
        whole[at..at + LEVEL_BYTES].copy_from_slice(&entry);
        whole.extend(level);
    }
    Ok(whole)
}

/// Returns the texels in the format of their channels.
fn texels_of(rgba: Vec<u8>, [width, height]: [u32; 2], channels: BasisChannels, has_alpha: bool) -> Texels {
    let texels = rgba.chunks_exact(4);
    let normals = |green: usize| {
        let codes = texels
            .clone()
            .flat_map(move |t| normal::with_z([t[0], t[green]].map(|code| f64::from(code) / 255.0)));
        codes.map(|value| (value * 255.0).round() as u8).collect()
    };
    let (count, file_channels, bytes) = match channels {
        BasisChannels::Grey => (1, 1, texels.map(|t| t[0]).collect()),
        BasisChannels::RedInColorGreenInAlpha => (4, 2, normals(3)),
        BasisChannels::RedGreen => (4, 2, normals(1)),
        BasisChannels::Color => (4, if has_alpha { 4 } else { 3 }, rgba),
    };
    Texels { width, height, format: TexelFormat::new(count, Component::Unorm8), file_channels, bytes }
}
