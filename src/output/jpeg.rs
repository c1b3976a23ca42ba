//! Writes a film as a JPEG file (JFIF, Y′CbCr 4:4:4 at the quality given), sRGB-encoded.

use std::io::Write;

use jpeg_encoder::{Encoder, ImageBuffer, JpegColorType, rgb_to_ycbcr};

use super::quantise::srgb8;
use crate::core::film::Film;

const QUALITY: u8 = 95;

/// A film, the one kind of picture for which the encoder is compiled.
struct Rgb<'a> {
    width: u16,
    height: u16,
    pixels: &'a [[f32; 3]],
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
        for pixel in &self.pixels[usize::from(y) * width..][..width] {
            let [r, g, b] = pixel.map(srgb8);
            let (luma, blue, red) = rgb_to_ycbcr(r, g, b);
            lumas.push(luma);
            blues.push(blue);
            reds.push(red);
        }
    }
}

pub(super) fn write(film: &Film, to: &mut dyn Write) -> Result<(), String> {
    let (Ok(width), Ok(height)) = (u16::try_from(film.width), u16::try_from(film.height)) else {
        return Err(format!("JPEG has at most {} pixels a side", u16::MAX));
    };
    Encoder::new(to, QUALITY)
        .encode_image(Rgb { width, height, pixels: &film.pixels })
        .map_err(|e| e.to_string())
}
