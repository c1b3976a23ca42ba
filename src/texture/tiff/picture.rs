//! Assembles strips and tiles into a picture. Bands of strips or tiles are decoded in parallel.
//! CMYK becomes RGB by (1 − C)(1 − K); premultiplied colours (associated alpha) stay premultiplied.

use rayon::prelude::*;

use super::super::data::{Component, TexelFormat};
use super::super::read_file::Texels;
use super::super::scalar::Scalar;
use super::Fault;
use super::color::Color;
use super::decompress::{decompress, greatest_ratio};
use super::layout::Layout;
use super::predictor;
use super::samples::Samples;

pub(super) fn format(layout: &Layout) -> TexelFormat {
    let channels = match layout.color {
        Color::Grey { .. } => 1 + usize::from(layout.alpha.is_some()),
        _ => 4,
    };
    let component = match &layout.color {
        Color::Palette(map) => MapDepth::of(map).component().max(layout.alpha_component()),
        _ => layout.scalar.component(),
    };
    TexelFormat::new(channels, component)
}

impl Layout {
    /// Returns the component of alpha, which beside a palette is a number of its own.
    fn alpha_component(&self) -> Component {
        self.alpha.map_or(Component::Unorm8, |_| self.scalar.component())
    }
}

/// The scale of a colour map's values: 16 bits by the standard, but 8-bit values are written in
/// three ways.
#[derive(Clone, Copy, PartialEq)]
enum MapDepth {
    /// 8-bit values times 257 or times 256: the high byte is the value.
    High8,
    /// Unscaled 8-bit values.
    Low8,
    Full16,
}

impl MapDepth {
    fn of(map: &[[u16; 3]]) -> MapDepth {
        let all = |test: fn(u16) -> bool| map.as_flattened().iter().all(|v| test(*v));
        if all(|v| v < 256) {
            MapDepth::Low8
        } else if all(|v| v % 257 == 0) || all(|v| v % 256 == 0) {
            MapDepth::High8
        } else {
            MapDepth::Full16
        }
    }

    fn component(self) -> Component {
        if self == MapDepth::Full16 { Component::Unorm16 } else { Component::Unorm8 }
    }

    fn fraction(self, value: u16) -> f64 {
        match self {
            MapDepth::High8 => f64::from(value >> 8) / 255.0,
            MapDepth::Low8 => f64::from(value) / 255.0,
            MapDepth::Full16 => f64::from(value) / 65_535.0,
        }
    }
}

/// Checks before any allocation that a file of this length can contain the strips or tiles.
pub(super) fn check_bytes(layout: &Layout, file_bytes: usize) -> Result<(), Fault> {
    let planes = if layout.planar { layout.samples } else { 1 };
    let count = (layout.across() * layout.down()).saturating_mul(planes);
    let found = layout.chunks.offsets.len();
    if found < count {
        return Err(Fault::damaged(format!("it says of {found} of {count} strips or tiles where they are")));
    }
    let rows = match layout.chunks.tiled {
        true => layout.down() as u64 * u64::from(layout.chunks.height),
        false => u64::from(layout.height),
    };
    let plain =
        rows.saturating_mul(layout.across() as u64 * planes as u64).saturating_mul(layout.row_bytes());
    let most = (file_bytes as u64).saturating_mul(greatest_ratio(layout.compression));
    if plain > most {
        let (width, height) = (layout.width, layout.height);
        return Err(Fault::damaged(format!("{file_bytes} bytes cannot hold {width}×{height} texels")));
    }
    Ok(())
}

pub(super) fn decode(file: &[u8], layout: &Layout, jpeg_tables: Option<&[u8]>) -> Result<Texels, Fault> {
    let format = format(layout);
    let size = format.bytes_per_texel();
    let row_bytes = layout.width as usize * size;
    let writer = Writer::new(layout, format);
    let mut bytes = vec![0; row_bytes * layout.height as usize];
    let bands = bytes.par_chunks_mut(row_bytes * layout.chunks.height.min(layout.height) as usize);
    bands.enumerate().try_for_each(|(down, band)| {
        for across in 0..layout.across() {
            let planes = planes(file, layout, jpeg_tables, [across, down])?;
            let first = across * layout.chunks.width as usize;
            let count = (layout.width as usize - first).min(layout.chunks.width as usize);
            band.par_chunks_mut(row_bytes).enumerate().for_each(|(y, row)| {
                let samples = Samples::of_row(layout, &planes, y);
                writer.write(&samples, &mut row[first * size..(first + count) * size]);
            });
        }
        Ok(())
    })?;
    let color_channels = if matches!(layout.color, Color::Grey { .. }) { 1 } else { 3 };
    Ok(Texels {
        width: layout.width,
        height: layout.height,
        format,
        file_channels: color_channels + usize::from(layout.alpha.is_some()),
        bytes,
    })
}

/// Returns the bytes of the chunks at one position: one chunk, or one per sample. A plane that no
/// texel needs stays empty.
fn planes(
    file: &[u8],
    layout: &Layout,
    jpeg_tables: Option<&[u8]>,
    [across, down]: [usize; 2],
) -> Result<Vec<Vec<u8>>, Fault> {
    let place = down * layout.across() + across;
    let of_plane = layout.across() * layout.down();
    let rows = layout.rows(down);
    let wanted = layout.row_bytes() as usize * rows as usize;
    let is_needed = |plane: usize| {
        !layout.planar || plane < layout.color.samples() || layout.alpha.is_some_and(|a| a.sample == plane)
    };
    let decoded = |plane: usize| {
        if !is_needed(plane) {
            return Ok(Vec::new());
        }
        let stored = stored(file, layout, plane * of_plane + place, wanted)?;
        let mut plain = decompress(stored, layout, jpeg_tables, rows, wanted)?;
        let row_bytes = layout.row_bytes() as usize;
        plain
            .par_chunks_mut(row_bytes)
            .for_each(|row| predictor::undo(layout, row, layout.samples_in_chunk()));
        Ok(plain)
    };
    (0..if layout.planar { layout.samples } else { 1 }).map(decoded).collect()
}

/// Returns a chunk as stored. If its length is not stated, it may extend to the end of the file.
fn stored<'a>(file: &'a [u8], layout: &Layout, index: usize, wanted: usize) -> Result<&'a [u8], Fault> {
    let number = index + 1;
    let offset = layout.chunks.offsets[index];
    let from = usize::try_from(offset).ok().and_then(|offset| file.get(offset..));
    let from = from.ok_or_else(|| Fault::damaged(format!("strip or tile {number} lies outside the file")))?;
    let length = match layout.chunks.lengths.get(index) {
        Some(0) => {
            return Err(Fault::unsupported(format!("strip or tile {number} left out (a sparse file)")));
        }
        Some(length) => usize::try_from(*length).unwrap_or(usize::MAX),
        None => from.len(),
    };
    let plain = layout.compression == super::layout::Compression::None;
    if length > from.len() || plain && length < wanted {
        let found = length.min(from.len());
        return Err(Fault::damaged(format!("strip or tile {number} ends after {found} bytes")));
    }
    Ok(&from[..length])
}

/// The conversion of samples to texels of the picture's format.
struct Writer<'a> {
    layout: &'a Layout,
    format: TexelFormat,
    map: Vec<[f64; 3]>,
    copied: Option<Vec<Option<usize>>>,
}

impl<'a> Writer<'a> {
    fn new(layout: &'a Layout, format: TexelFormat) -> Writer<'a> {
        let map = match &layout.color {
            Color::Palette(map) => {
                let depth = MapDepth::of(map);
                map.iter().map(|color| color.map(|v| depth.fraction(v))).collect()
            }
            _ => Vec::new(),
        };
        Writer { layout, format, map, copied: copied(layout, format) }
    }

    fn write(&self, samples: &Samples<'_>, row: &mut [u8]) {
        let (channels, component) = (self.format.channels(), self.format.component());
        if let Some(channels) = &self.copied {
            return match component {
                Component::Unorm8 => copy::<1>(samples, channels, component, row),
                Component::Unorm16 => copy::<2>(samples, channels, component, row),
                Component::Float32 => copy::<4>(samples, channels, component, row),
            };
        }
        for (x, texel) in row.chunks_exact_mut(self.format.bytes_per_texel()).enumerate() {
            let values = self.values(|sample| samples.number(x, sample));
            let kept = if channels == 2 { [values[0], values[3], 0.0, 0.0] } else { values };
            for (value, to) in kept.into_iter().zip(texel.chunks_exact_mut(component.bytes())) {
                component.store(value, to);
            }
        }
    }

    /// Returns red, green, blue and alpha; grey is replicated.
    fn values(&self, number: impl Fn(usize) -> f64) -> [f64; 4] {
        let fraction = |sample| self.layout.scalar.fraction(number(sample));
        let [r, g, b] = match &self.layout.color {
            Color::Grey { inverted: false } => [fraction(0); 3],
            Color::Grey { inverted: true } => [1.0 - fraction(0); 3],
            Color::Rgb | Color::YCbCr => [0, 1, 2].map(fraction),
            Color::Palette(_) => self.map[number(0) as usize],
            Color::Cmyk => [0, 1, 2].map(|ink| (1.0 - fraction(ink)) * (1.0 - fraction(3))),
        };
        [r, g, b, self.layout.alpha.map_or(1.0, |alpha| fraction(alpha.sample))]
    }
}

/// Returns the sample index of each channel for samples that are stored unchanged, with `None` for
/// an alpha of 1.
fn copied(layout: &Layout, format: TexelFormat) -> Option<Vec<Option<usize>>> {
    let colors = match layout.color {
        Color::Grey { inverted: false } => 1,
        Color::Rgb | Color::YCbCr => 3,
        _ => return None,
    };
    let is_same = layout.scalar == Scalar::of(format.component()) && cfg!(target_endian = "little");
    if !is_same {
        return None;
    }
    let alpha = std::iter::once(layout.alpha.map(|alpha| alpha.sample));
    Some((0..colors).map(Some).chain(alpha).take(format.channels()).collect())
}

fn copy<const SIZE: usize>(
    samples: &Samples<'_>,
    channels: &[Option<usize>],
    component: Component,
    row: &mut [u8],
) {
    let mut opaque = [0; SIZE];
    opaque.copy_from_slice(&component.one()[..SIZE]);
    for (x, texel) in row.chunks_exact_mut(channels.len() * SIZE).enumerate() {
        for (place, channel) in texel.as_chunks_mut().0.iter_mut().zip(channels) {
            *place = channel.map_or(opaque, |sample| *samples.bytes(x, sample));
        }
    }
}
