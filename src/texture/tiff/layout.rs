//! The layout of a TIFF picture: checks the tags before anything is decoded and returns a
//! [`Layout`]. An unsupported structure is refused by name.

use super::super::scalar::{NumberKind, Scalar};
use super::Fault;
use super::color::{self, Alpha, Color};
use super::directory::{Directory, tag};

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Compression {
    None,
    Group4,
    Lzw,
    Jpeg,
    Deflate,
    PackBits,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Predictor {
    None,
    Horizontal,
    FloatingPoint,
}

/// The tiling. Strips are tiles as wide as the picture, of which the last ends with it.
pub(super) struct Chunks {
    pub tiled: bool,
    pub width: u32,
    pub height: u32,
    pub offsets: Vec<u64>,
    pub lengths: Vec<u64>,
}

pub(super) struct Layout {
    pub width: u32,
    pub height: u32,
    pub scalar: Scalar,
    pub little_endian: bool,
    /// The samples of each texel, colours first.
    pub samples: usize,
    /// True if samples of different channels are stored in different chunks.
    pub planar: bool,
    pub color: Color,
    pub alpha: Option<Alpha>,
    pub compression: Compression,
    pub predictor: Predictor,
    /// True if the first sample of a byte is in its lowest bits.
    pub bits_reversed: bool,
    pub chunks: Chunks,
}

impl Layout {
    pub fn of(tags: &Directory<'_>) -> Result<Layout, Fault> {
        let side = |tag, name| {
            let value = tags.number(tag)?.ok_or_else(|| Fault::damaged(format!("it has no {name}")))?;
            u32::try_from(value).map_err(|_| Fault::damaged(format!("its {name} is {value}")))
        };
        let (width, height) = (side(tag::WIDTH, "width")?, side(tag::HEIGHT, "height")?);
        if tags.number_or(tag::IMAGE_DEPTH, 1)? > 1 {
            return Err(Fault::unsupported("a volume (ImageDepth)"));
        }
        let compression = compression(tags)?;
        let scalar = scalar(tags)?;
        let samples = usize::from(u16::try_from(tags.number_or(tag::SAMPLES_PER_PIXEL, 1)?).unwrap_or(0));
        let color = color::of(tags, scalar, compression)?;
        if samples < color.samples() {
            let (found, needed) = (samples, color.samples());
            return Err(Fault::damaged(format!("{found} samples a texel, where the colour needs {needed}")));
        }
        let planar = match tags.number_or(tag::PLANAR_CONFIGURATION, 1)? {
            1 => false,
            // With one sample both configurations are the same.
            2 => samples > 1,
            other => return Err(Fault::unsupported(format!("PlanarConfiguration {other}"))),
        };
        let layout = Layout {
            width,
            height,
            scalar,
            little_endian: tags.little_endian(),
            samples,
            planar,
            alpha: color::alpha(tags, &color, samples)?,
            color,
            compression,
            predictor: predictor(tags, scalar)?,
            bits_reversed: match tags.number_or(tag::FILL_ORDER, 1)? {
                1 => false,
                2 => true,
                other => return Err(Fault::unsupported(format!("FillOrder {other}"))),
            },
            chunks: chunks(tags, width, height)?,
        };
        layout.check_codec()?;
        Ok(layout)
    }

    /// Returns the number of chunks side by side in each plane.
    pub fn across(&self) -> usize {
        self.width.div_ceil(self.chunks.width) as usize
    }

    pub fn down(&self) -> usize {
        self.height.div_ceil(self.chunks.height) as usize
    }

    pub fn samples_in_chunk(&self) -> usize {
        if self.planar { 1 } else { self.samples }
    }

    /// Returns the bytes of a row, which begins at a byte boundary.
    pub fn row_bytes(&self) -> u64 {
        let bits =
            u64::from(self.chunks.width) * self.samples_in_chunk() as u64 * u64::from(self.scalar.bits);
        bits.div_ceil(8)
    }

    /// Returns the rows of the chunk in this row of chunks.
    pub fn rows(&self, down: usize) -> u32 {
        match self.chunks.tiled {
            true => self.chunks.height,
            false => self.chunks.height.min(self.height - down as u32 * self.chunks.height),
        }
    }

    /// Checks the restrictions that single codecs impose.
    fn check_codec(&self) -> Result<(), Fault> {
        match self.compression {
            Compression::Jpeg if self.scalar.bits != 8 => {
                Err(Fault::unsupported(format!("JPEG compression with {} bits a sample", self.scalar.bits)))
            }
            Compression::Jpeg if ![1, 3].contains(&self.samples) => {
                Err(Fault::unsupported(format!("JPEG compression with {} samples a texel", self.samples)))
            }
            Compression::Jpeg if self.planar && matches!(self.color, Color::YCbCr) => {
                Err(Fault::unsupported("JPEG compression of YCbCr in separate planes"))
            }
            Compression::Group4 if self.scalar.bits != 1 || self.samples_in_chunk() != 1 => {
                Err(Fault::damaged("CCITT compression of samples that are not 1 bit"))
            }
            _ => Ok(()),
        }
    }
}

fn compression(tags: &Directory<'_>) -> Result<Compression, Fault> {
    let name = match tags.number_or(tag::COMPRESSION, 1)? {
        1 => return Ok(Compression::None),
        4 => return Ok(Compression::Group4),
        5 => return Ok(Compression::Lzw),
        7 => return Ok(Compression::Jpeg),
        8 | 32_946 => return Ok(Compression::Deflate),
        32_773 => return Ok(Compression::PackBits),
        2 => "CCITT modified Huffman (2)",
        3 => "CCITT group 3 (3)",
        6 => "old JPEG (6)",
        9 | 10 | 34_661 => "JBIG",
        32_766 => "NeXT (32766)",
        32_771 => "CCITT modified Huffman by words (32771)",
        32_809 => "ThunderScan (32809)",
        33_003 | 33_004 | 33_005 | 34_712 => "JPEG 2000",
        34_676 | 34_677 => "SGI LogLuv",
        34_887 => "LERC (34887)",
        34_892 => "lossy JPEG of raw data (34892)",
        34_925 => "LZMA (34925)",
        34_934 | 22_610 => "JPEG XR",
        50_000 | 34_926 => "Zstandard (50000)",
        50_001 | 34_927 => "WebP (50001)",
        50_002 | 52_546 => "JPEG XL",
        other => return Err(Fault::unsupported(format!("compression {other}, which is not known"))),
    };
    Err(Fault::unsupported(format!("compression {name}")))
}

fn scalar(tags: &Directory<'_>) -> Result<Scalar, Fault> {
    let bits = tags.numbers(tag::BITS_PER_SAMPLE)?.unwrap_or_else(|| vec![1]);
    let formats = tags.numbers(tag::SAMPLE_FORMAT)?.unwrap_or_else(|| vec![1]);
    let all_equal = |values: &[u64]| values.iter().all(|v| *v == values[0]);
    if bits.is_empty() || formats.is_empty() {
        return Err(Fault::damaged("the bits or the format of its samples are missing"));
    }
    if !all_equal(&bits) {
        return Err(Fault::unsupported(format!("samples of different lengths ({bits:?} bits)")));
    }
    if !all_equal(&formats) {
        return Err(Fault::unsupported(format!("samples of different formats ({formats:?})")));
    }
    let kind = match formats[0] {
        // 4 is "undefined", which readers treat as integers.
        1 | 4 => NumberKind::Unsigned,
        2 => NumberKind::Signed,
        3 => NumberKind::Float,
        5 | 6 => return Err(Fault::unsupported("complex numbers")),
        other => return Err(Fault::unsupported(format!("SampleFormat {other}"))),
    };
    let scalar = Scalar { bits: u32::try_from(bits[0]).unwrap_or(u32::MAX), kind };
    let word = match kind {
        NumberKind::Unsigned => "unsigned integers",
        NumberKind::Signed => "signed integers",
        NumberKind::Float => "floats",
    };
    match scalar.is_known() {
        true => Ok(scalar),
        false => Err(Fault::unsupported(format!("{word} of {} bits", bits[0]))),
    }
}

fn predictor(tags: &Directory<'_>, scalar: Scalar) -> Result<Predictor, Fault> {
    match tags.number_or(tag::PREDICTOR, 1)? {
        1 => Ok(Predictor::None),
        2 if [8, 16, 32, 64].contains(&scalar.bits) => Ok(Predictor::Horizontal),
        2 => Err(Fault::unsupported(format!("predictor 2 with {} bits a sample", scalar.bits))),
        3 if scalar.kind == NumberKind::Float => Ok(Predictor::FloatingPoint),
        3 => Err(Fault::unsupported("predictor 3 (of floats) with integers")),
        other => Err(Fault::unsupported(format!("predictor {other}"))),
    }
}

fn chunks(tags: &Directory<'_>, width: u32, height: u32) -> Result<Chunks, Fault> {
    let tiled = tags.has(tag::TILE_WIDTH) || tags.has(tag::TILE_OFFSETS);
    let side = |tag, default| Ok(u32::try_from(tags.number_or(tag, default)?).unwrap_or(u32::MAX));
    let (chunk, offsets, lengths) = if tiled {
        let sides = [side(tag::TILE_WIDTH, 0)?, side(tag::TILE_LENGTH, 0)?];
        // Some writers store tiles under the tags of strips.
        let offsets = tags.numbers(tag::TILE_OFFSETS)?.or(tags.numbers(tag::STRIP_OFFSETS)?);
        (sides, offsets, tags.numbers(tag::TILE_BYTE_COUNTS)?.or(tags.numbers(tag::STRIP_BYTE_COUNTS)?))
    } else {
        let rows = side(tag::ROWS_PER_STRIP, u64::from(height))?.min(height);
        ([width, rows], tags.numbers(tag::STRIP_OFFSETS)?, tags.numbers(tag::STRIP_BYTE_COUNTS)?)
    };
    // A picture of zero size gets its own message.
    if chunk.contains(&0) && width > 0 && height > 0 {
        return Err(Fault::damaged(format!("its strips or tiles are {}×{} texels", chunk[0], chunk[1])));
    }
    let offsets = offsets.ok_or_else(|| Fault::damaged("it does not say where its strips or tiles are"))?;
    let lengths = lengths.unwrap_or_default();
    Ok(Chunks { tiled, width: chunk[0], height: chunk[1], offsets, lengths })
}
