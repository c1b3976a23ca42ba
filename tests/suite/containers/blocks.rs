//! Blocks of BC1 to BC7 whose texels follow from the format's definition (Khronos Data Format Specification, chapters 18
//! to 20), through DDS and KTX2; textures whose sizes are no multiples of four.

use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};

use super::write::{Dds, Ktx2};
use super::{load, numbers};

/// Red and blue; the first row has the indices 0, 1, 2, 3.
const RED_BLUE: [u8; 8] = [0x00, 0xf8, 0x1f, 0x00, 0xe4, 0, 0, 0];
/// 255 and 0; the first row has the indices 0, 1, 2, 3.
const FALLING: [u8; 8] = [255, 0, 0x88, 0x06, 0, 0, 0, 0];

/// The numbers of the first row of a block, the same from DDS and from KTX2.
fn first_row(dxgi: u32, vulkan: u32, block: &[u8], format: TexelFormat) -> Vec<f64> {
    let dds = load(&Dds::flat(dxgi, [4, 4], block).bytes(), Dimension::Two).unwrap();
    let ktx = load(&Ktx2::flat(vulkan, [4, 4], &[block.to_vec()]).bytes(), Dimension::Two).unwrap();
    assert_eq!((dds.format, ktx.format, dds.width, dds.height), (format, format, 4, 4));
    assert_eq!(dds.texels, ktx.texels);
    numbers(&dds)[..4 * format.channels()].to_vec()
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    let near = found.iter().zip(expected).all(|(f, e)| (f - e).abs() <= tolerance);
    assert!(near, "{found:?}, not {expected:?}");
}

#[test]
fn bc1_has_two_colours_and_two_between() {
    let row = first_row(71, 133, &RED_BLUE, TexelFormat::Rgba8);
    let expected = [[255, 0, 0, 255], [0, 0, 255, 255], [170, 0, 85, 255], [85, 0, 170, 255]].concat();
    assert_near(&row, &expected.iter().map(|&c| f64::from(c)).collect::<Vec<_>>(), 0.0);
}

#[test]
fn bc1_in_the_other_order_has_one_between_and_a_hole() {
    let block = [0x1f, 0x00, 0x00, 0xf8, 0xe4, 0, 0, 0];
    let row = first_row(71, 133, &block, TexelFormat::Rgba8);
    assert_near(&row[8..], &[128.0, 0.0, 128.0, 255.0, 0.0, 0.0, 0.0, 0.0], 0.0);
    // As a format without alpha, the hole is black.
    let opaque = load(&Ktx2::flat(131, [4, 4], &[block.to_vec()]).bytes(), Dimension::Two).unwrap();
    assert_eq!((opaque.file_channels, numbers(&opaque)[15]), (3, 255.0));
}

#[test]
fn bc2_has_alpha_of_four_bits() {
    let block = [&[0x10, 0x32, 0, 0, 0, 0, 0, 0], &RED_BLUE[..]].concat();
    let row = first_row(74, 135, &block, TexelFormat::Rgba8);
    assert_near(&[row[3], row[7], row[11], row[15]], &[0.0, 17.0, 34.0, 51.0], 0.0);
    assert_near(&row[..3], &[255.0, 0.0, 0.0], 0.0);
}

#[test]
fn bc3_has_alpha_between_two_numbers() {
    let row = first_row(77, 137, &[FALLING, RED_BLUE].concat(), TexelFormat::Rgba8);
    assert_near(&[row[3], row[7], row[11], row[15]], &[255.0, 0.0, 1530.0 / 7.0, 1275.0 / 7.0], 0.6);
}

#[test]
fn bc4_keeps_what_lies_between_codes() {
    let row = first_row(80, 139, &FALLING, TexelFormat::Grey16);
    assert_near(&row, &[65_535.0, 0.0, 65_535.0 * 6.0 / 7.0, 65_535.0 * 5.0 / 7.0], 0.51);
    let signed = first_row(81, 140, &[127, 0x81, 0x88, 0x06, 0, 0, 0, 0], TexelFormat::GreyFloat);
    assert_near(&signed, &[1.0, -1.0, 5.0 / 7.0, 3.0 / 7.0], 1e-6);
}

#[test]
fn bc5_is_a_normal_whose_z_is_made() {
    let half = [128, 128, 0, 0, 0, 0, 0, 0];
    let row = first_row(83, 141, &[FALLING, half].concat(), TexelFormat::Rgba16);
    let y: f64 = 2.0 * 128.0 / 255.0 - 1.0;
    let x: f64 = 2.0 * 5.0 / 7.0 - 1.0;
    let z = (1.0 - x * x - y * y).sqrt();
    let expected = [5.0 / 7.0, 128.0 / 255.0, 0.5 + 0.5 * z, 1.0].map(|v| v * 65_535.0);
    assert_near(&row[12..], &expected, 0.51);
    // Signed numbers are moved into the range of unsigned ones, as normal maps have it.
    let signed = first_row(84, 142, &[[0; 8], [0; 8]].concat(), TexelFormat::Rgba16);
    assert_near(&signed[..4], &[32_768.0, 32_768.0, 65_535.0, 65_535.0], 0.0);
}

/// Writes bits, the lowest first.
fn pack(fields: &[(u128, u32)]) -> Vec<u8> {
    let mut at = 0;
    let word = fields.iter().fold(0u128, |word, &(value, bits)| {
        let word = word | value << at;
        at += bits;
        word
    });
    word.to_le_bytes().to_vec()
}

#[test]
fn bc6h_holds_halves() {
    // Mode 11: one region, two endpoints of 10 bits a channel, here equal.
    let block = pack(&[(3, 5), (1023, 10), (0, 10), (496, 10), (1023, 10), (0, 10), (496, 10)]);
    let row = first_row(95, 143, &block, TexelFormat::RgbaFloat);
    // ((496 · 2¹⁶ + 2¹⁵) / 2¹⁰) · 31 / 64 = 3C1F.
    assert_near(&row[..4], &[65_504.0, 0.0, 1.0 + 31.0 / 1024.0, 1.0], 1e-6);
    let signed = first_row(96, 144, &pack(&[(3, 5)]), TexelFormat::RgbaFloat);
    assert_near(&signed[..4], &[0.0, 0.0, 0.0, 1.0], 0.0);
}

#[test]
fn bc7_of_mode_6_has_two_colours_of_seven_bits_and_a_shared_one() {
    let block = pack(&[
        (1 << 6, 7),
        (100, 7),
        (0, 7),
        (50, 7),
        (127, 7),
        (25, 7),
        (0, 7),
        (127, 7),
        (127, 7),
        (1, 1),
        (0, 1),
        (0, 3),
        (15, 4),
    ]);
    let row = first_row(98, 145, &block, TexelFormat::Rgba8);
    assert_near(&row[..8], &[201.0, 101.0, 51.0, 255.0, 0.0, 254.0, 0.0, 254.0], 0.0);
    // A block of no mode is transparent black.
    assert_near(&first_row(98, 145, &[0; 16], TexelFormat::Rgba8), &[0.0; 16], 0.0);
}

#[test]
fn blocks_beyond_the_edges_are_cut() {
    let green = [0xe0, 0x07, 0xe0, 0x07, 0, 0, 0, 0];
    let blocks = [RED_BLUE, green, green, RED_BLUE].concat();
    let texture = load(&Dds::flat(72, [5, 6], &blocks).bytes(), Dimension::Two).unwrap();
    assert_eq!((texture.width, texture.height, texture.color_space), (5, 6, ColorSpace::Srgb));
    let texels = texture.texels.as_chunks::<4>().0;
    assert_eq!(texels.len(), 30);
    let (red, green) = ([255, 0, 0, 255], [0, 255, 0, 255]);
    let at = |x: usize, y: usize| texels[y * 5 + x];
    assert_eq!(
        [at(0, 0), at(4, 0), at(4, 3), at(0, 4), at(4, 4), at(4, 5)],
        [red, green, green, green, red, red]
    );
}
