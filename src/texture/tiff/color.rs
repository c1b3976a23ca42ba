//! Colour and alpha of TIFF samples: maps the tags to a [`Color`], or returns the name of an
//! unsupported variant (TIFF 6.0, "PhotometricInterpretation", "ColorMap", "ExtraSamples").

use super::super::scalar::{NumberKind, Scalar};
use super::Fault;
use super::directory::{Directory, tag};
use super::layout::Compression;

/// The conversion of samples to colour.
pub(super) enum Color {
    /// `inverted`: 0 is white.
    Grey {
        inverted: bool,
    },
    Rgb,
    /// Red, green and blue of each index, from 0 to 65535.
    Palette(Vec<[u16; 3]>),
    /// Subtractive inks; 0 is no ink.
    Cmyk,
    /// Only within JPEG data, which is decoded to RGB.
    YCbCr,
}

impl Color {
    pub fn samples(&self) -> usize {
        match self {
            Color::Grey { .. } | Color::Palette(_) => 1,
            Color::Rgb | Color::YCbCr => 3,
            Color::Cmyk => 4,
        }
    }
}

/// The sample that holds a texel's coverage.
#[derive(Clone, Copy)]
pub(super) struct Alpha {
    pub sample: usize,
    /// True if the colours are premultiplied by it.
    pub associated: bool,
}

pub(super) fn of(tags: &Directory<'_>, scalar: Scalar, compression: Compression) -> Result<Color, Fault> {
    // Some old greyscale files lack the tag: 0 is black, as in nearly all files.
    let photometric = tags.number_or(tag::PHOTOMETRIC, 1)?;
    let unsigned = scalar.kind == NumberKind::Unsigned;
    let name = match photometric {
        0 if !unsigned => "signed or float samples where 0 is white (PhotometricInterpretation 0)",
        0 | 1 => return Ok(Color::Grey { inverted: photometric == 0 }),
        2 => return Ok(Color::Rgb),
        3 if !unsigned || scalar.bits > 16 => "a palette with signed, float or long indices",
        3 => return palette(tags, scalar.bits),
        4 => "a transparency mask (PhotometricInterpretation 4)",
        5 if !unsigned => "CMYK of signed or float samples",
        5 if tags.number_or(tag::INK_SET, 1)? != 1 => "inks other than CMYK (InkSet)",
        5 => return Ok(Color::Cmyk),
        6 if compression == Compression::Jpeg => return Ok(Color::YCbCr),
        6 => "YCbCr without JPEG compression",
        8 => "CIE L*a*b* (PhotometricInterpretation 8)",
        9 => "ICC L*a*b* (PhotometricInterpretation 9)",
        10 => "ITU L*a*b* (PhotometricInterpretation 10)",
        32_803 => "the bare colour filter array of a camera",
        32_844 => "LogL",
        32_845 => "LogLuv",
        34_892 => "linear raw data of a camera",
        other => return Err(Fault::unsupported(format!("PhotometricInterpretation {other}"))),
    };
    Err(Fault::unsupported(name))
}

/// Returns the palette, which is stored as all reds, then all greens, then all blues.
fn palette(tags: &Directory<'_>, bits: u32) -> Result<Color, Fault> {
    let map = tags.numbers(tag::COLOR_MAP)?.ok_or_else(|| Fault::damaged("it has no colour map"))?;
    let count = 1usize << bits;
    if map.len() < 3 * count {
        return Err(Fault::damaged(format!("its colour map has {} of {} values", map.len(), 3 * count)));
    }
    let value = |at: usize| map[at].min(65_535) as u16;
    Ok(Color::Palette((0..count).map(|i| [value(i), value(count + i), value(2 * count + i)]).collect()))
}

/// Returns the first extra sample declared as alpha. A single undeclared extra sample is alpha too,
/// because many programs write RGBA that way; one declared as unspecified is not.
pub(super) fn alpha(tags: &Directory<'_>, color: &Color, samples: usize) -> Result<Option<Alpha>, Fault> {
    const ASSOCIATED: u64 = 1;
    const UNASSOCIATED: u64 = 2;
    let first = color.samples();
    let Some(kinds) = tags.numbers(tag::EXTRA_SAMPLES)? else {
        return Ok((samples == first + 1).then_some(Alpha { sample: first, associated: false }));
    };
    let found = kinds.iter().take(samples - first).position(|k| [ASSOCIATED, UNASSOCIATED].contains(k));
    Ok(found.map(|i| Alpha { sample: first + i, associated: kinds[i] == ASSOCIATED }))
}
