//! Textures whose texels follow a known rule: the checker of the measurements, four colours for the
//! address modes, and one small picture for each number of channels and component type, whose sizes
//! are no powers of two and whose values identify texel and channel.

use image::{DynamicImage, ImageBuffer, Pixel, Rgb, RgbImage};

use super::Asset;

/// Returns 1024² texels of 8 × 8 black and white cells of 128 texels, texel (0, 0) black.
pub(super) fn checker() -> RgbImage {
    RgbImage::from_fn(1024, 1024, |i, j| Rgb([if (i / 128 + j / 128) % 2 == 0 { 0 } else { 255 }; 3]))
}

/// Returns the ordinal of a texel, shifted by five for each channel: 1 to width · height, each once
/// in each channel.
fn code(width: u32, height: u32, i: u32, j: u32, channel: u32) -> u32 {
    (i + width * j + 5 * channel) % (width * height) + 1
}

pub(super) fn small() -> Vec<Asset> {
    let coded8 = |w: u32, h: u32, channels: u32| -> Vec<u8> {
        codes(w, h, channels).map(|c| (c * 255 / (w * h)) as u8).collect()
    };
    let coded16 = |w: u32, h: u32, channels: u32| -> Vec<u16> {
        codes(w, h, channels).map(|c| (c * 65535 / (w * h)) as u16).collect()
    };
    // Values are below 0 and above 1, and the positive ones are exact in half and shared-exponent
    // formats alike.
    let coded_float = |w: u32, h: u32, channels: u32, from: f32| -> Vec<f32> {
        codes(w, h, channels).map(|c| c as f32 * 0.25 + from).collect()
    };
    let quad = [[230, 40, 50], [45, 180, 60], [40, 70, 220], [245, 205, 40]].concat();
    let asset = |path, image: DynamicImage| Asset { path, image };
    vec![
        asset("quad2x2.png", DynamicImage::ImageRgb8(buffer(2, 2, quad))),
        asset("grey8.png", DynamicImage::ImageLuma8(buffer(5, 3, coded8(5, 3, 1)))),
        asset("grey-alpha8.png", DynamicImage::ImageLumaA8(buffer(7, 4, coded8(7, 4, 2)))),
        asset("rgba8.png", DynamicImage::ImageRgba8(buffer(5, 3, coded8(5, 3, 4)))),
        asset("grey16.png", DynamicImage::ImageLuma16(buffer(7, 4, coded16(7, 4, 1)))),
        asset("grey-alpha16.png", DynamicImage::ImageLumaA16(buffer(5, 3, coded16(5, 3, 2)))),
        asset("rgb16.png", DynamicImage::ImageRgb16(buffer(7, 4, coded16(7, 4, 3)))),
        asset("rgba16.png", DynamicImage::ImageRgba16(buffer(5, 3, coded16(5, 3, 4)))),
        asset("ramp.exr", DynamicImage::ImageRgb32F(buffer(7, 4, coded_float(7, 4, 3, -1.0)))),
        asset("ramp.hdr", DynamicImage::ImageRgb32F(buffer(5, 3, coded_float(5, 3, 3, 0.0)))),
    ]
}

fn codes(width: u32, height: u32, channels: u32) -> impl Iterator<Item = u32> {
    (0..height).flat_map(move |j| {
        (0..width).flat_map(move |i| (0..channels).map(move |c| code(width, height, i, j, c)))
    })
}

fn buffer<P: Pixel>(width: u32, height: u32, values: Vec<P::Subpixel>) -> ImageBuffer<P, Vec<P::Subpixel>> {
    ImageBuffer::from_raw(width, height, values).expect("one value for each texel and channel")
}
