//! Writes a film as a JPEG file (JFIF, Y′CbCr 4:4:4 at the quality given), sRGB-encoded.

use std::io::Write;

use jpeg_encoder::{Encoder, ImageBuffer, JpegColorType, SamplingFactor, rgb_to_ycbcr};

use super::display::Prepared;
use super::quantise::srgb8;
use super::record::jpeg::{Insert, segments};
use super::{WriteOptions, icc};
use crate::core::film::Film;

/// The first bytes that the encoder writes: the start of the image, and the segment of JFIF.
const HEADER_BYTES: usize = 20;

/// A film, the one kind of picture for which the encoder is compiled.
struct Rgb<'a> {
    width: u16,
    height: u16,
    pixels: &'a [[f32; 3]],
    display: Prepared,
}

impl ImageBuffer for Rgb<'_> {
    fn get_jpeg_color_type(&self) -> JpegColorType {
        JpegColorType::Ycbcr
    }

    fn width(&self) -> u16 {
        self.width
    }

    fn height(&self) -> u16 {
        self.height
    }

    fn fill_buffers(&self, y: u16, buffers: &mut [Vec<u8>; 4]) {
        let [lumas, blues, reds, _] = buffers;
        let width = usize::from(self.width);
        for pixel in &*self.display.colors(&self.pixels[usize::from(y) * width..][..width]) {
            let [r, g, b] = pixel.map(srgb8);
            let (luma, blue, red) = rgb_to_ycbcr(r, g, b);
            lumas.push(luma);
            blues.push(blue);
            reds.push(red);
        }
    }
}

pub(super) fn write(film: &Film, options: &WriteOptions, to: &mut dyn Write) -> Result<(), String> {
    let (Ok(width), Ok(height)) = (u16::try_from(film.width), u16::try_from(film.height)) else {
        return Err(format!("JPEG has at most {} pixels a side", u16::MAX));
    };
    let comments = options.record.map_or(Vec::new(), segments);
    let mut encoder = Encoder::new(Insert::new(to, HEADER_BYTES, comments), options.jpeg_quality);
    // Below a quality of 90, the encoder would halve the resolution of colours.
    encoder.set_sampling_factor(SamplingFactor::F_1_1);
    encoder
        .add_icc_profile(&icc::profile(options.display.gamut))
        .and_then(|()| {
            let display = options.display.prepare();
            encoder.encode_image(Rgb { width, height, pixels: &film.pixels, display })
        })
        .map_err(|e| e.to_string())
}
