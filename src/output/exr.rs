//! Encodes a film as OpenEXR: red, green and blue, and beside them any number of layers, whose channels are named
//! `layer.channel` as compositing programs expect. The crate writes the header, this file the rows behind it.

use std::io;
use std::ops::Range;

use exr::meta::attribute::{AttributeValue, ChannelDescription, SampleType};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::meta::{BlockDescription, MetaData, magic_number};
use exr::prelude::{Compression, IntegerBounds, LineOrder, Text, Vec2};

use super::WriteOptions;
use super::bands::{BAND_BYTES, write_bands};
use super::record::{KEY, SOFTWARE};
use super::sink::{Sink, write_at};
use crate::core::film::{Film, Placement};

/// The bytes before the values of a row: its number and its size.
const ROW_HEAD_BYTES: usize = 8;

/// The values of a channel, pixel by pixel.
enum Values<'a> {
    /// A component of the film's colours.
    Color(&'a [[f32; 3]], usize),
    Layer(&'a [f32]),
}

impl Values<'_> {
    /// Appends the values of some pixels.
    fn append(&self, pixels: Range<usize>, row: &mut Vec<u8>) {
        let first = row.len();
        row.resize(first + pixels.len() * size_of::<f32>(), 0);
        let to = row[first..].chunks_exact_mut(size_of::<f32>());
        match self {
            Values::Color(colors, component) => {
                for (to, pixel) in to.zip(&colors[pixels]) {
                    to.copy_from_slice(&pixel[*component].to_le_bytes());
                }
            }
            Values::Layer(values) => {
                to.zip(&values[pixels]).for_each(|(to, value)| to.copy_from_slice(&value.to_le_bytes()));
            }
        }
    }
}

/// Writes the film, if there are colours, and all layers in one part, as uncompressed scan lines: the low significand
/// bits of a rendered f32 picture are noise, so that ZIP saves 4 % of a 512² file and takes 110 ms where this takes 4
/// (RLE: nothing, 15 ms; PIZ: 4 %, 170 ms).
///
/// The display window is the whole picture, the data window the film's part of it.
pub(super) fn write(film: &Film, options: &WriteOptions, to: &mut dyn Sink) -> Result<(), String> {
    let colors = ["R", "G", "B"].iter().enumerate().filter(|_| options.has_colors);
    let colors = colors.map(|(i, name)| ((*name).to_owned(), Values::Color(&film.pixels, i)));
    let layers = options.layers.iter().flat_map(|layer| {
        layer.channels.iter().map(|c| (format!("{}.{}", layer.name, c.name), Values::Layer(&c.values)))
    });
    let mut channels: Vec<(String, Values<'_>)> = colors.chain(layers).collect();
    channels.sort_by(|(a, _), (b, _)| a.cmp(b));

    let mut head = Vec::new();
    let names = channels.iter().map(|(name, _)| name.as_str());
    write_head(film, options, names, &mut head).map_err(|e| e.to_string())?;
    let row_bytes = film.width as usize * channels.len() * size_of::<f32>();
    let top = options.placement.map_or(0, |placement| placement.corner[1]);
    write_rows(film, top, row_bytes, &channels, head, to).map_err(|e| e.to_string())
}

/// Writes everything before the offsets of the rows.
fn write_head<'a>(
    film: &Film,
    options: &WriteOptions,
    channels: impl Iterator<Item = &'a str>,
    head: &mut Vec<u8>,
) -> exr::error::UnitResult {
    let placement = options.placement.unwrap_or(Placement::whole(film.width, film.height));
    let [x, y] = placement.corner.map(|at| at as i32);
    let [width, height] = placement.full.map(|size| size as usize);
    let channels = channels.map(|name| ChannelDescription::named(name, SampleType::F32)).collect();
    let mut own = LayerAttributes { layer_position: Vec2(x, y), ..LayerAttributes::default() };
    if let Some(record) = options.record {
        own.software_name = Some(SOFTWARE.into());
        own.other.insert(KEY.into(), AttributeValue::Text(record.into()));
    }
    let shared = ImageAttributes::new(IntegerBounds::from_dimensions(Vec2(width, height)));
    let header = Header::new(Text::default(), (film.width as usize, film.height as usize), channels)
        .with_encoding(Compression::Uncompressed, BlockDescription::ScanLines, LineOrder::Increasing)
        .with_attributes(own)
        .with_shared_attributes(shared);
    let headers = [header];
    let requirements = MetaData::validate(&headers, true)?;
    magic_number::write(head)?;
    requirements.write(head)?;
    Header::write_all(&headers, head, requirements.has_multiple_layers)
}

/// Writes the head, the offset of each row in the file, and the rows.
fn write_rows(
    film: &Film,
    top: u32,
    row_bytes: usize,
    channels: &[(String, Values<'_>)],
    mut head: Vec<u8>,
    to: &mut dyn Sink,
) -> io::Result<()> {
    let (width, height) = (film.width as usize, film.height as usize);
    let first = head.len() + height * size_of::<u64>();
    let offset = |row: usize| (first + row * (ROW_HEAD_BYTES + row_bytes)) as u64;
    head.extend((0..height).flat_map(|row| offset(row).to_le_bytes()));
    to.write_all(&head)?;
    let encode = |rows: Range<usize>, band: &mut Vec<u8>| {
        band.clear();
        for row in rows {
            band.extend((top + row as u32).to_le_bytes());
            band.extend((row_bytes as u32).to_le_bytes());
            channels.iter().for_each(|(_, values)| values.append(row * width..(row + 1) * width, band));
        }
    };
    // The buffer of the head is in front of the file.
    to.flush()?;
    if let Some(file) = to.file() {
        let step = (BAND_BYTES / row_bytes.max(1)).max(1);
        let part = |part: usize, band: &mut Vec<u8>| {
            let rows = part * step..height.min((part + 1) * step);
            encode(rows.clone(), band);
            offset(rows.start)
        };
        if write_at(file, height.div_ceil(step), part)? {
            return Ok(());
        }
    }
    write_bands(height, row_bytes, Vec::new, encode, |band| to.write_all(band))
}
