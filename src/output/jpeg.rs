//! Writes sRGB bytes as a JPEG file (JFIF, Y′CbCr 4:4:4 at the quality given).

use std::io::Write;

use jpeg_encoder::{Encoder, ImageBuffer, JpegColorType, rgb_to_ycbcr};

const QUALITY: u8 = 95;

/// Tightly packed rows of R, G, B; the one kind of picture for which the encoder is compiled.
struct Rgb<'a> {
    width: u16,
    height: u16,
    bytes: &'a [u8],
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
        let row = usize::from(self.width) * 3;
        for pixel in self.bytes[usize::from(y) * row..][..row].chunks_exact(3) {
            let (luma, blue, red) = rgb_to_ycbcr(pixel[0], pixel[1], pixel[2]);
            lumas.push(luma);
            blues.push(blue);
            reds.push(red);
        }
    }
}

/// Writes the file; `rgb` has tightly packed rows.
pub(super) fn write(width: u32, height: u32, rgb: &[u8], to: impl Write) -> Result<(), String> {
    let (Ok(width), Ok(height)) = (u16::try_from(width), u16::try_from(height)) else {
        return Err(format!("JPEG has at most {} pixels a side", u16::MAX));
    };
    Encoder::new(to, QUALITY).encode_image(Rgb { width, height, bytes: rgb }).map_err(|e| e.to_string())
}
