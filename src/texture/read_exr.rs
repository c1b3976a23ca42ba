//! Reads OpenEXR files: one layer of one part at its largest level, with half, float and unsigned
//! integer samples converted to f32. The picture covers the display window, with black beyond the
//! data window, transparent if the layer has alpha; or it covers the intersection of both windows,
//! with its placement.

use std::io::{BufRead, Cursor, Seek};
use std::path::Path;

use exr::block::reader::{ChunksReader, Reader};
use exr::meta::attribute::{Chromaticities, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Vec2, f16};

use super::data::{Component, TexelFormat};
use super::exr_color;
use super::exr_layers::{self, Colors, Layer};
use super::exr_subsampled::{self, Patched};
use super::open_file::open as open_file;
use super::read_file::{Texels, check_memory, check_size, damaged, unreadable};
use crate::core::error::{Error, Result};
use crate::core::film::Placement;

/// The window of the file that the picture covers.
#[derive(Clone, Copy, PartialEq)]
pub enum ExrWindow {
    Display,
    /// The intersection of data window and display window.
    Data,
}

/// The bytes of a file or of a repaired copy: one type for both, so that the reader is compiled once.
pub(super) trait Source: BufRead + Seek {}

impl<T: BufRead + Seek> Source for T {}

pub(super) fn read(
    source: &mut dyn Source,
    layer: Option<&str>,
    window: ExrWindow,
    path: &Path,
) -> Result<(Texels, Placement)> {
    let refused = match open(source) {
        Ok(reader) => return read_layer(reader, layer, window, path),
        Err(error) => error,
    };
    // The file may have subsampled chroma.
    let mut bytes = Vec::new();
    source.rewind().and_then(|()| source.read_to_end(&mut bytes)).map_err(|e| unreadable(path, &e))?;
    let Some(Patched { bytes, samplings }) = exr_subsampled::patch(bytes) else {
        return Err(exr_error(path, refused));
    };
    let mut repaired = Cursor::new(bytes);
    let reader = open(&mut repaired).map_err(|e| exr_error(path, e))?;
    let choice = exr_layers::choose(reader.headers(), layer, path)?;
    match samplings.get(choice.part) {
        Some(samplings) if samplings.iter().any(|s| *s != Vec2(1, 1)) => {
            read_subsampled(reader, choice, samplings, window, path)
        }
        _ => read_chosen(reader, choice, window, path),
    }
}

/// Returns the names of the layers with colours, as scenes name them; none of a file that is not OpenEXR.
pub fn color_layers(path: &Path) -> Vec<String> {
    let Ok(source) = open_file(path) else { return Vec::new() };
    let mut source = std::io::BufReader::new(source);
    open(&mut source).map_or_else(|_| Vec::new(), |reader| exr_layers::colored(reader.headers()))
}

fn open(source: &mut dyn Source) -> exr::error::Result<Reader<&mut dyn Source>> {
    exr::block::read(source, false)
}

fn read_layer(
    reader: Reader<&mut dyn Source>,
    layer: Option<&str>,
    window: ExrWindow,
    path: &Path,
) -> Result<(Texels, Placement)> {
    let choice = exr_layers::choose(reader.headers(), layer, path)?;
    read_chosen(reader, choice, window, path)
}

fn read_chosen(
    reader: Reader<&mut dyn Source>,
    layer: Layer,
    window: ExrWindow,
    path: &Path,
) -> Result<(Texels, Placement)> {
    let header = &reader.headers()[layer.part];
    let mut picture = Canvas::new(header, &layer, window, path)?;
    let chromaticities = header.shared_attributes.chromaticities;
    let channels = layer.channels();
    let largest =
        |_: &_, _, block: exr::block::BlockIndex| block.layer == layer.part && block.level == Vec2(0, 0);
    reader
        .filter_chunks(false, largest)
        .and_then(|chunks| {
            chunks.decompress_sequential(false, |meta, block| {
                let list = &meta.headers[layer.part].channels;
                for line in block.lines(list) {
                    let Some(to) = channels.iter().position(|&c| c == line.location.channel) else {
                        continue;
                    };
                    let kind = list.list[line.location.channel].sample_type;
                    picture.put_line(to, line.location.position, samples(line.value, kind));
                }
                Ok(())
            })
        })
        .map_err(|e| exr_error(path, e))?;
    picture.finish(&layer, chromaticities, path)
}

fn read_subsampled(
    reader: Reader<&mut dyn Source>,
    layer: Layer,
    samplings: &[Vec2<usize>],
    window: ExrWindow,
    path: &Path,
) -> Result<(Texels, Placement)> {
    let header = reader.headers()[layer.part].clone();
    let mut picture = Canvas::new(&header, &layer, window, path)?;
    let planes = exr_subsampled::planes(reader, layer.part, &layer.channels(), samplings)
        .map_err(|e| exr_error(path, e))?;
    for (to, plane) in planes.iter().enumerate() {
        for y in 0..header.layer_size.height() {
            let row = (0..header.layer_size.width()).map(|x| plane.at(x, y));
            picture.put_line(to, Vec2(0, y), row);
        }
    }
    picture.finish(&layer, header.shared_attributes.chromaticities, path)
}

/// Returns the samples of one channel of a scan line.
pub(super) fn samples(line: &[u8], kind: SampleType) -> impl Iterator<Item = f32> {
    line.chunks_exact(kind.bytes_per_sample()).map(move |b| match kind {
        SampleType::F16 => f16::from_ne_bytes([b[0], b[1]]).to_f32(),
        SampleType::F32 => f32::from_ne_bytes([b[0], b[1], b[2], b[3]]),
        SampleType::U32 => u32::from_ne_bytes([b[0], b[1], b[2], b[3]]) as f32,
    })
}

/// The texels of the display window, or of a part of it, while they are filled.
struct Canvas {
    width: usize,
    height: usize,
    /// The corner of the data window relative to that part.
    corner: Vec2<i32>,
    channels: usize,
    bytes: Vec<u8>,
    /// The placement of that part in the display window.
    placement: Placement,
}

impl Canvas {
    fn new(header: &Header, layer: &Layer, window: ExrWindow, path: &Path) -> Result<Self> {
        let display = header.shared_attributes.display_window;
        let data = header.layer_size;
        check_size(path, data.0 as u64, data.1 as u64, 4)?;
        let channels = match layer.colors {
            Colors::Grey(_) => 1 + usize::from(layer.alpha.is_some()),
            Colors::Rgb(_) | Colors::LuminanceChroma(_) => 4,
        };
        let corner = header.own_attributes.layer_position - display.position;
        let (first, size) = match window {
            ExrWindow::Display => ([0; 2], display.size),
            ExrWindow::Data => intersection(corner, data, display.size).ok_or_else(|| {
                Error::with_help(
                    format!("{}: its data window lies outside its display window", path.display()),
                    "write the picture again with a data window that the display window shows",
                )
            })?,
        };
        let Vec2(width, height) = size;
        check_size(path, width as u64, height as u64, channels * 4)?;
        let bytes = width * height * channels * 4;
        check_memory(path, bytes)?;
        let corner = Vec2(corner.0 - first[0] as i32, corner.1 - first[1] as i32);
        let placement =
            Placement { corner: first, full: [display.size.0, display.size.1].map(|side| side as u32) };
        Ok(Canvas { width, height, corner, channels, bytes: vec![0; bytes], placement })
    }

    /// Fills a channel along a row of the data window, as far as the row lies in the picture.
    fn put_line(&mut self, channel: usize, position: Vec2<usize>, values: impl Iterator<Item = f32>) {
        let left = i64::from(self.corner.0) + position.0 as i64;
        let top = usize::try_from(i64::from(self.corner.1) + position.1 as i64);
        let Some(y) = top.ok().filter(|y| *y < self.height) else { return };
        let outside = usize::try_from(-left).unwrap_or(0);
        let first = usize::try_from(left).unwrap_or(0).min(self.width);
        let texel = self.channels * 4;
        let row = &mut self.bytes[(y * self.width + first) * texel..(y + 1) * self.width * texel];
        for (to, value) in row.chunks_exact_mut(texel).zip(values.skip(outside)) {
            to[channel * 4..channel * 4 + 4].copy_from_slice(&value.to_ne_bytes());
        }
    }

    fn finish(
        mut self,
        layer: &Layer,
        file: Option<Chromaticities>,
        path: &Path,
    ) -> Result<(Texels, Placement)> {
        if let Colors::LuminanceChroma(_) = layer.colors {
            exr_color::to_rgb(&mut self.bytes, exr_color::luminances(file, path)?);
        }
        let has_alpha = layer.alpha.is_some();
        // This comes last, so that a damaged header cannot make the program fill gigabytes.
        if self.channels == 4 && !has_alpha {
            self.bytes.chunks_exact_mut(16).for_each(|t| t[12..].copy_from_slice(&1f32.to_ne_bytes()));
        }
        let colors = if self.channels == 4 { 3 } else { 1 };
        let texels = Texels {
            width: self.width as u32,
            height: self.height as u32,
            format: TexelFormat::new(self.channels, Component::Float32),
            file_channels: colors + usize::from(has_alpha),
            bytes: self.bytes,
        };
        Ok((texels, self.placement))
    }
}

/// Returns corner and size of the intersection of a data window at `corner` and a display window at
/// the origin.
fn intersection(
    corner: Vec2<i32>,
    data: Vec2<usize>,
    display: Vec2<usize>,
) -> Option<([u32; 2], Vec2<usize>)> {
    let along = |corner: i32, data: usize, display: usize| {
        let first = i64::from(corner).max(0);
        let end = (i64::from(corner) + data as i64).min(display as i64);
        (end > first).then_some((first as u32, (end - first) as usize))
    };
    let (x, width) = along(corner.0, data.0, display.0)?;
    let (y, height) = along(corner.1, data.1, display.1)?;
    Some(([x, y], Vec2(width, height)))
}

fn exr_error(path: &Path, error: exr::error::Error) -> Error {
    match error {
        exr::error::Error::NotSupported(what) => Error::with_help(
            format!("{}: this kind of OpenEXR file is not supported: {what}", path.display()),
            "convert it to flat scan lines with ZIP, ZIPS, PIZ, RLE or no compression",
        ),
        other => damaged(path, "OpenEXR", &other),
    }
}
