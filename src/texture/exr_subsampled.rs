//! Subsampled channels of OpenEXR files, such as the chroma of luminance/chroma files. Returns the
//! values of a file's channels at every texel, linearly interpolated between samples.
//!
//! The `exr` crate decompresses such blocks but refuses to open such files. It is therefore given a
//! patched header that claims one sample per texel, and the blocks, which hold the actual data, are
//! decompressed here.

use exr::block::BlockIndex;
use exr::block::chunk::CompressedBlock;
use exr::block::reader::Reader;
use exr::compression::Compression;
use exr::error::{Error, Result};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, IntegerBounds, LineOrder, SampleType};
use exr::meta::header::Header;
use exr::prelude::SmallVec;

use super::read_exr::{Source, samples};

/// The file patched to one sample per texel, and its original sampling: the texels per sample on
/// each axis, for each channel of each part.
pub(super) struct Patched {
    pub bytes: Vec<u8>,
    pub samplings: Vec<Vec<Vec2<usize>>>,
}

/// Returns `None` if the bytes are no OpenEXR file or have one sample per texel already.
pub(super) fn patch(mut bytes: Vec<u8>) -> Option<Patched> {
    const SEVERAL_PARTS: u32 = 0x1000;
    let several = u32::from_le_bytes(*bytes.get(4..)?.first_chunk()?) & SEVERAL_PARTS != 0;
    let mut samplings = Vec::new();
    let mut offset = 8;
    loop {
        samplings.push(patch_header(&mut bytes, &mut offset)?);
        if !several || *bytes.get(offset)? == 0 {
            break;
        }
    }
    let sparse = samplings.iter().flatten().any(|s| *s != Vec2(1, 1));
    sparse.then_some(Patched { bytes, samplings })
}

/// Patches attributes up to the empty name that ends a header, and returns the original sampling.
fn patch_header(bytes: &mut [u8], offset: &mut usize) -> Option<Vec<Vec2<usize>>> {
    let mut samplings = Vec::new();
    loop {
        let name = skip_text(bytes, offset)?;
        if name.is_empty() {
            return Some(samplings);
        }
        let is_channels = bytes.get(name)? == b"channels";
        skip_text(bytes, offset)?;
        let size = usize::try_from(number(bytes, *offset)?).ok()?;
        *offset += 4;
        let end = offset.checked_add(size).filter(|end| *end <= bytes.len())?;
        if is_channels {
            if !samplings.is_empty() {
                return None;
            }
            // Name, type, flags, and texels per sample along x and y.
            let mut attribute = *offset;
            while !skip_text(bytes, &mut attribute)?.is_empty() {
                let [x, y] = [number(bytes, attribute + 8)?, number(bytes, attribute + 12)?];
                samplings.push(Vec2(usize::try_from(x).ok()?, usize::try_from(y).ok()?));
                bytes.get_mut(attribute + 8..attribute + 16)?.copy_from_slice(&[1, 0, 0, 0, 1, 0, 0, 0]);
                attribute += 16;
            }
        }
        *offset = end;
    }
}

/// Skips a zero-terminated text and returns its range without the terminator.
fn skip_text(bytes: &[u8], offset: &mut usize) -> Option<std::ops::Range<usize>> {
    let length = bytes.get(*offset..)?.iter().position(|&b| b == 0)?;
    let text = *offset..*offset + length;
    *offset += length + 1;
    Some(text)
}

fn number(bytes: &[u8], offset: usize) -> Option<i32> {
    Some(i32::from_le_bytes(*bytes.get(offset..)?.first_chunk()?))
}

/// The samples of one channel, one per `sampling` texels along each axis, starting at the first
/// texel.
pub(super) struct Plane {
    sampling: Vec2<usize>,
    size: Vec2<usize>,
    values: Vec<f32>,
}

impl Plane {
    /// Returns the value at a texel; beyond the last sample the last one is continued.
    pub fn at(&self, x: usize, y: usize) -> f32 {
        let Vec2(across, down) = self.sampling;
        let value = |column: usize, row: usize| {
            let (column, row) = (column.min(self.size.0 - 1), row.min(self.size.1 - 1));
            self.values[row * self.size.0 + column]
        };
        let mix = |a: f32, b: f32, part: usize, of: usize| match part {
            0 => a,
            _ => a + (b - a) * (part as f32 / of as f32),
        };
        let (column, row) = (x / across, y / down);
        let along = |row: usize| mix(value(column, row), value(column + 1, row), x % across, across);
        if y.is_multiple_of(down) { along(row) } else { mix(along(row), along(row + 1), y % down, down) }
    }
}

/// Returns the planes of the given channels of a part, in this order.
pub(super) fn planes(
    reader: Reader<&mut dyn Source>,
    part: usize,
    wanted: &[usize],
    samplings: &[Vec2<usize>],
) -> Result<Vec<Plane>> {
    let mut header = reader.headers()[part].clone();
    if header.blocks != BlockDescription::ScanLines {
        return Err(Error::NotSupported("channel subsampling in tiles".into()));
    }
    let Vec2(width, height) = header.layer_size;
    let corner = header.own_attributes.layer_position;
    for (channel, sampling) in header.channels.list.iter_mut().zip(samplings) {
        let Vec2(x, y) = *sampling;
        let fits = |n: usize, of: i64| n > 0 && of % n as i64 == 0;
        let fit_x = fits(x, width as i64) && fits(x, corner.0.into());
        if !fit_x || !fits(y, height as i64) || !fits(y, corner.1.into()) {
            return Err(Error::Invalid("channel sampling that does not divide the data window".into()));
        }
        channel.sampling = *sampling;
    }
    let of_channel = |&channel: &usize| {
        let sampling = samplings[channel];
        let size = header.layer_size / sampling;
        Plane { sampling, size, values: vec![0.0; size.area()] }
    };
    let mut planes: Vec<Plane> = wanted.iter().map(of_channel).collect();
    let of_part = |_: &_, _, block: BlockIndex| block.layer == part;
    for chunk in reader.filter_chunks(false, of_part)? {
        let CompressedBlock::ScanLine(block) = chunk?.compressed_block else {
            return Err(Error::Invalid("block of scan lines".into()));
        };
        let first = i64::from(block.y_coordinate) - i64::from(corner.1);
        let first = usize::try_from(first).ok().filter(|y| *y < height);
        let first = first.ok_or_else(|| Error::Invalid("block position".into()))?;
        let rows = first..height.min(first + header.compression.scan_lines_per_block());
        let bytes = decompress(&header, block.compressed_pixels_le, rows.clone())?;
        let mut rest = bytes.as_slice();
        for y in rows {
            for (index, channel) in header.channels.list.iter().enumerate() {
                let Vec2(across, down) = channel.sampling;
                if y % down != 0 {
                    continue;
                }
                let length = width / across * channel.sample_type.bytes_per_sample();
                let (line, after) = rest.split_at_checked(length).ok_or_else(short)?;
                rest = after;
                for plane in wanted.iter().zip(&mut planes).filter(|(w, _)| **w == index).map(|(_, p)| p) {
                    let start = y / down * plane.size.0;
                    let row = &mut plane.values[start..start + plane.size.0];
                    row.iter_mut().zip(samples(line, channel.sample_type)).for_each(|(to, v)| *to = v);
                }
            }
        }
    }
    Ok(planes)
}

fn short() -> Error {
    Error::Invalid("length of a block".into())
}

/// Decompresses some rows: row by row, and within a row channel by channel.
fn decompress(header: &Header, compressed: Vec<u8>, rows: std::ops::Range<usize>) -> Result<Vec<u8>> {
    let Vec2(width, _) = header.layer_size;
    let of_channel = |channel: &ChannelDescription| {
        let lines = rows.clone().filter(|y| y % channel.sampling.1 == 0).count();
        lines * (width / channel.sampling.0) * channel.sample_type.bytes_per_sample()
    };
    let length: usize = header.channels.list.iter().map(of_channel).sum();
    if compressed.len() == length {
        return Ok(compressed);
    }
    let area = width * rows.len();
    let (header, size) = match header.compression {
        // These codecs are agnostic of the layout: the bytes come out unchanged as one line of one
        // channel of two bytes per sample.
        Compression::RLE | Compression::ZIP1 | Compression::ZIP16 => {
            let size = Vec2(length / 2, 1);
            let channel = ChannelDescription::named("Y", SampleType::F16);
            let line = Header::new("".into(), size, SmallVec::from_vec(vec![channel]));
            (line.with_encoding(header.compression, BlockDescription::ScanLines, LineOrder::Increasing), size)
        }
        // B44 is missing here because the crate decompresses it only with one sample per texel.
        Compression::PIZ | Compression::PXR24 if length.is_multiple_of(area) => {
            let mut header = header.clone();
            // The crate computes the length as the product of this number and the area.
            header.channels.bytes_per_pixel = length / area;
            (header, Vec2(width, rows.len()))
        }
        other => {
            return Err(Error::NotSupported(format!("channel subsampling with {other}").into()));
        }
    };
    let position = Vec2(0, if size.0 == width { rows.start as i32 } else { 0 });
    let section = IntegerBounds::new(position, size);
    header.compression.decompress_image_section_from_le(&header, compressed, section, false)
}
