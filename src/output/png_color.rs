//! The colour space of PNG files (PNG 3rd edition, 11.3.2). In: the space. Out: the chunks that name it: sRGB, or cICP and
//! an ICC profile, of which readers take the first that they know in the order cICP, iCCP, sRGB; and for those that know
//! none gamma and chromaticities.

use std::io::{self, Write};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use glam::DVec2;
use png::chunk::ChunkType;
use png::{Encoder, EncodingError, ScaledFloat, SourceChromaticities, SrgbRenderingIntent, Writer};

use super::gamut::{D65, Gamut};
use super::icc;

/// 1 / 2.2, in units of 1/100000.
const GAMMA: u32 = 45_455;
/// The transfer function of sRGB in Rec. ITU-T H.273; then the components are RGB, over the full range.
const CODES_AFTER_PRIMARIES: [u8; 3] = [13, 0, 1];

/// States gamma and chromaticities, and whether both are those of sRGB.
pub(super) fn describe<W: Write>(gamut: Gamut, encoder: &mut Encoder<'_, W>) {
    let scaled = |v: f64| ScaledFloat::from_scaled((v * 100_000.0).round() as u32);
    let both = |xy: DVec2| (scaled(xy.x), scaled(xy.y));
    let [red, green, blue] = gamut.primaries().map(both);
    encoder.set_source_gamma(ScaledFloat::from_scaled(GAMMA));
    encoder.set_source_chromaticities(SourceChromaticities { white: both(D65), red, green, blue });
    if gamut == Gamut::Srgb {
        encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    }
}

/// Writes the chunks for which the encoder has no setting.
pub(super) fn write_chunks<W: Write>(gamut: Gamut, writer: &mut Writer<W>) -> Result<(), EncodingError> {
    if gamut == Gamut::Srgb {
        return Ok(());
    }
    let [transfer, matrix, range] = CODES_AFTER_PRIMARIES;
    writer.write_chunk(ChunkType(*b"cICP"), &[gamut.code_point(), transfer, matrix, range])?;
    writer.write_chunk(ChunkType(*b"iCCP"), &compressed_profile(gamut)?)
}

/// Returns the name of a profile, the method of compression, and the profile.
fn compressed_profile(gamut: Gamut) -> io::Result<Vec<u8>> {
    let mut bytes = [gamut.name().as_bytes(), &[0, 0]].concat();
    let mut deflate = ZlibEncoder::new(&mut bytes, Compression::best());
    deflate.write_all(&icc::profile(gamut))?;
    deflate.finish()?;
    Ok(bytes)
}
