//! Encodes a film as the bytes of one file format. EXR and HDR keep linear light; PNG, JPEG and
//! TIFF get values clipped to [0, 1] and sRGB-encoded, with neither dithering nor a tone map.

use std::io::{Seek, Write};

use super::exr::{exr, exr_layers};
use super::quantise::{srgb8, srgb16};
use super::{WriteOptions, hdr, jpeg, tiff};
use crate::core::film::Film;
use crate::core::named::named_enum;

named_enum! {
    /// A file format; several extensions may name the same one.
    pub enum Format {
        Exr = "OpenEXR",
        Hdr = "Radiance HDR",
        Png = "PNG",
        Jpeg = "JPEG",
        Tiff = "TIFF",
    }
}

/// Where encoded bytes go: one type for files and memory, so that each encoder is compiled once.
pub trait Sink: Write + Seek {}

impl<T: Write + Seek> Sink for T {}

/// Encodes a film. The error states only the cause; the caller knows the file's name.
pub fn encode(film: &Film, format: Format, options: &WriteOptions, to: &mut dyn Sink) -> Result<(), String> {
    match format {
        Format::Exr if !options.layers.is_empty() => exr_layers(film, options, to),
        Format::Exr => exr(film, options.placement, to),
        Format::Hdr => hdr::write(film, to).map_err(|e| e.to_string()),
        Format::Png => {
            let (bits, rows) = match options.png_bits {
                16 => (png::BitDepth::Sixteen, srgb16_rows(film)),
                _ => (png::BitDepth::Eight, srgb8_rows(film)),
            };
            png(film, bits, &rows, to).map_err(|e| e.to_string())
        }
        Format::Jpeg => jpeg::write(film.width, film.height, &srgb8_rows(film), to),
        Format::Tiff => tiff::write(film.width, film.height, &srgb8_rows(film), to),
    }
}

fn srgb8_rows(film: &Film) -> Vec<u8> {
    film.pixels.iter().flat_map(|p| p.map(srgb8)).collect()
}

/// Returns big-endian rows, as PNG stores them.
fn srgb16_rows(film: &Film) -> Vec<u8> {
    film.pixels.iter().flat_map(|p| p.map(|v| srgb16(v).to_be_bytes())).flatten().collect()
}

fn png(film: &Film, bits: png::BitDepth, rows: &[u8], to: &mut dyn Sink) -> Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(to, film.width, film.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(bits);
    // Fast deflate takes half the time of the default level at 512² for a few per cent of size.
    encoder.set_compression(png::Compression::Fast);
    encoder.set_filter(png::Filter::Adaptive);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(rows)?;
    writer.finish()
}
