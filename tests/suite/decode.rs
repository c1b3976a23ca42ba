//! Reading texture files: exact texels of every format and bit depth, and their numerical meaning.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use image::codecs::jpeg::JpegEncoder;
use image::{DynamicImage, ImageBuffer, Luma, LumaA, Rgb, Rgba};
use moire::internal::core::color::{linear_to_srgb, srgb_table, srgb_to_linear};
use moire::internal::core::film::Film;
use moire::internal::output::{self, WriteOptions};
use moire::internal::texture::data::{ColorSpace, TexelFormat, TextureData};
use moire::internal::texture::decode::decode;
use tempfile::{TempDir, tempdir};

const W: u32 = 5;
const H: u32 = 3;

fn load(path: &Path) -> moire::internal::core::error::Result<TextureData> {
    decode(path, "t", ColorSpace::Linear, false)
}

fn saved(folder: &TempDir, name: &str, picture: impl Into<DynamicImage>) -> PathBuf {
    let path = folder.path().join(name);
    picture.into().save(&path).unwrap();
    path
}

fn u8s(channels: u32) -> Vec<u8> {
    (0..W * H * channels).map(|i| (i * 37 % 251) as u8).collect()
}

fn u16s(channels: u32) -> Vec<u16> {
    (0..W * H * channels).map(|i| (i * 2749 % 65_521) as u16).collect()
}

fn f32s(channels: u32) -> Vec<f32> {
    (0..W * H * channels).map(|i| i as f32 * 0.37 - 2.0).collect()
}

/// Three values a texel and an opaque fourth.
fn opaque<T: Copy>(rgb: &[T], alpha: T) -> Vec<T> {
    rgb.chunks(3).flat_map(|t| [t[0], t[1], t[2], alpha]).collect()
}

fn check(path: &Path, format: TexelFormat, file_channels: usize, texels: &[u8]) {
    let t = load(path).unwrap();
    assert_eq!((t.width, t.height, t.format, t.file_channels), (W, H, format, file_channels), "{path:?}");
    assert_eq!(t.texels, texels, "{path:?}");
}

#[test]
fn eight_bit_png_and_tiff_texels_are_exact_for_1_to_4_channels() {
    let folder = tempdir().unwrap();
    for ending in ["png", "tiff"] {
        let name = |n| format!("{n}.{ending}");
        let rgb = ImageBuffer::<Rgb<u8>, _>::from_raw(W, H, u8s(3)).unwrap();
        check(&saved(&folder, &name(3), rgb), TexelFormat::Rgba8, 3, &opaque(&u8s(3), 255));
        let rgba = ImageBuffer::<Rgba<u8>, _>::from_raw(W, H, u8s(4)).unwrap();
        check(&saved(&folder, &name(4), rgba), TexelFormat::Rgba8, 4, &u8s(4));
        let grey = ImageBuffer::<Luma<u8>, _>::from_raw(W, H, u8s(1)).unwrap();
        check(&saved(&folder, &name(1), grey), TexelFormat::Grey8, 1, &u8s(1));
    }
    let grey_alpha = ImageBuffer::<LumaA<u8>, _>::from_raw(W, H, u8s(2)).unwrap();
    check(&saved(&folder, "2.png", grey_alpha), TexelFormat::GreyAlpha8, 2, &u8s(2));
}

#[test]
fn sixteen_bit_png_and_tiff_texels_are_exact_for_1_to_4_channels() {
    let folder = tempdir().unwrap();
    let bytes = |v: &[u16]| v.iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<u8>>();
    for ending in ["png", "tiff"] {
        let name = |n| format!("{n}.{ending}");
        let rgb = ImageBuffer::<Rgb<u16>, _>::from_raw(W, H, u16s(3)).unwrap();
        check(&saved(&folder, &name(3), rgb), TexelFormat::Rgba16, 3, &bytes(&opaque(&u16s(3), 65_535)));
        let rgba = ImageBuffer::<Rgba<u16>, _>::from_raw(W, H, u16s(4)).unwrap();
        check(&saved(&folder, &name(4), rgba), TexelFormat::Rgba16, 4, &bytes(&u16s(4)));
        let grey = ImageBuffer::<Luma<u16>, _>::from_raw(W, H, u16s(1)).unwrap();
        check(&saved(&folder, &name(1), grey), TexelFormat::Grey16, 1, &bytes(&u16s(1)));
    }
    let grey_alpha = ImageBuffer::<LumaA<u16>, _>::from_raw(W, H, u16s(2)).unwrap();
    check(&saved(&folder, "2.png", grey_alpha), TexelFormat::GreyAlpha16, 2, &bytes(&u16s(2)));
}

#[test]
fn float_exr_and_tiff_texels_are_exact_with_and_without_alpha() {
    let folder = tempdir().unwrap();
    let bytes = |v: &[f32]| v.iter().flat_map(|x| x.to_ne_bytes()).collect::<Vec<u8>>();
    for ending in ["exr", "tiff"] {
        let rgb = ImageBuffer::<Rgb<f32>, _>::from_raw(W, H, f32s(3)).unwrap();
        let path = saved(&folder, &format!("3.{ending}"), rgb);
        check(&path, TexelFormat::RgbaFloat, 3, &bytes(&opaque(&f32s(3), 1.0)));
        let rgba = ImageBuffer::<Rgba<f32>, _>::from_raw(W, H, f32s(4)).unwrap();
        let path = saved(&folder, &format!("4.{ending}"), rgba);
        check(&path, TexelFormat::RgbaFloat, 4, &bytes(&f32s(4)));
    }
}

#[test]
fn grey_exr_with_half_floats_stays_one_channel() {
    use exr::prelude::*;
    let folder = tempdir().unwrap();
    let path = folder.path().join("y.exr");
    let channel = SpecificChannels::build()
        .with_channel("Y")
        .with_pixel_fn(|at: Vec2<usize>| (f16::from_f32(at.0 as f32 + 10.0 * at.1 as f32),));
    Image::from_channels((W as usize, H as usize), channel).write().to_file(&path).unwrap();
    let t = load(&path).unwrap();
    assert_eq!((t.format, t.file_channels), (TexelFormat::GreyFloat, 1));
    assert_eq!(t.value(3, 2, 0), 23.0);
}

#[test]
fn exr_data_window_is_placed_in_the_display_window() {
    use exr::prelude::*;
    let folder = tempdir().unwrap();
    let path = folder.path().join("window.exr");
    let pixel = |at: Vec2<usize>| (at.0 as f32 + 1.0, at.1 as f32 + 1.0, 7f32);
    let attributes = LayerAttributes::default().with_position(Vec2(1, -1));
    let layer = Layer::new((4, 3), attributes, Encoding::FAST_LOSSLESS, SpecificChannels::rgb(pixel));
    let display = IntegerBounds::new(Vec2(0, 0), Vec2(3, 4));
    Image::empty(ImageAttributes::new(display)).with_layer(layer).write().to_file(&path).unwrap();
    let t = load(&path).unwrap();
    assert_eq!((t.width, t.height), (3, 4));
    let rgba = |x, y| t.linear_rgba(x, y);
    assert_eq!(rgba(0, 0), [0.0, 0.0, 0.0, 1.0], "left of the data window");
    assert_eq!(rgba(1, 0), [1.0, 2.0, 7.0, 1.0], "its first row is above the picture");
    assert_eq!(rgba(2, 1), [2.0, 3.0, 7.0, 1.0]);
    assert_eq!(rgba(2, 3), [0.0, 0.0, 0.0, 1.0], "below the data window");
}

#[test]
fn radiance_hdr_texels_are_exact_where_rgbe_can_hold_them() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.hdr");
    let mut film = Film::new(9, 2, 1);
    film.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = [i as f32 * 0.25, 1.0, 16.0]);
    output::write(&film, &path, &WriteOptions::default()).unwrap();
    let t = load(&path).unwrap();
    assert_eq!((t.format, t.file_channels), (TexelFormat::RgbaFloat, 3));
    assert_eq!(t.linear_rgba(4, 1), [13.0 * 0.25, 1.0, 16.0, 1.0]);
}

#[test]
fn jpeg_texels_are_the_decoders_own() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    let grey = ImageBuffer::<Luma<u8>, _>::from_pixel(16, 8, Luma([77]));
    JpegEncoder::new_with_quality(File::create(&path).unwrap(), 100).encode_image(&grey).unwrap();
    let t = load(&path).unwrap();
    assert_eq!((t.format, t.width, t.height), (TexelFormat::Grey8, 16, 8));
    assert!(t.texels.iter().all(|&v| v == 77));
}

#[test]
fn flip_v_reverses_the_rows_of_odd_and_even_heights() {
    let folder = tempdir().unwrap();
    for height in [1, 2, 3, 4] {
        let values: Vec<u8> = (0..W * height * 3).map(|i| i as u8).collect();
        let rgb = ImageBuffer::<Rgb<u8>, _>::from_raw(W, height, values).unwrap();
        let path = saved(&folder, &format!("{height}.png"), rgb);
        let upright = decode(&path, "t", ColorSpace::Srgb, false).unwrap();
        let flipped = decode(&path, "t", ColorSpace::Srgb, true).unwrap();
        for y in 0..height {
            for x in 0..W {
                assert_eq!(flipped.linear_rgba(x, y), upright.linear_rgba(x, height - 1 - y));
            }
        }
    }
}

#[test]
fn one_by_one_picture_is_a_texture() {
    let folder = tempdir().unwrap();
    let path = saved(&folder, "1.png", ImageBuffer::<Rgb<u8>, _>::from_pixel(1, 1, Rgb([1, 2, 3])));
    assert_eq!(load(&path).unwrap().texels, [1, 2, 3, 255]);
}

#[test]
fn linear_value_decodes_srgb_color_but_never_alpha() {
    let folder = tempdir().unwrap();
    let path = saved(&folder, "a.png", ImageBuffer::<Rgba<u8>, _>::from_pixel(1, 1, Rgba([188, 10, 0, 128])));
    let t = decode(&path, "t", ColorSpace::Srgb, false).unwrap();
    // IEC 61966-2-1 by hand: ((188/255 + 0.055)/1.055)^2.4 and 10/255/12.92.
    assert!((t.linear_value(0, 0, 0) - 0.502_886_458_033_3).abs() < 1e-12);
    assert!((t.linear_value(0, 0, 1) - 0.003_035_269_835_488_375).abs() < 1e-15);
    assert_eq!(t.linear_value(0, 0, 3), 128.0 / 255.0);
    assert_eq!(t.value(0, 0, 0), 188.0 / 255.0);
}

#[test]
fn srgb_functions_are_inverse_and_agree_with_the_table() {
    for i in 0..=255usize {
        let v = i as f64 / 255.0;
        // The standard's rounded constants leave a gap of 1e-8 between the two pieces.
        assert!((linear_to_srgb(srgb_to_linear(v)) - v).abs() < 1e-7);
        assert_eq!(srgb_table(256)[i], srgb_to_linear(v) as f32);
    }
}

#[test]
fn mislabelled_picture_is_read_by_its_content() {
    let folder = tempdir().unwrap();
    let png = saved(&folder, "a.png", ImageBuffer::<Luma<u8>, _>::from_raw(W, H, u8s(1)).unwrap());
    for name in ["a.jpg", "a.exr", "a.txt", "a"] {
        let path = folder.path().join(name);
        fs::copy(&png, &path).unwrap();
        assert_eq!(load(&path).unwrap().texels, u8s(1), "{name}");
    }
}
