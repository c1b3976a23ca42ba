//! Mip chains against levels computed by hand, and invariants of every texture: the size rule,
//! preserved means, preserved constants.

use moire::internal::core::color::{linear_to_srgb, srgb_to_linear};
use moire::internal::texture::data::{ColorSpace, Component, Dimension, MipKernel, TexelFormat, TextureData};
use moire::internal::texture::mips::{level_count, level_size, mip_chain};
use proptest::prelude::*;

fn texture(dimension: Dimension, size: [u32; 3], format: TexelFormat, texels: Vec<u8>) -> TextureData {
    let [width, height, depth] = size;
    assert_eq!(texels.len(), (width * height * depth) as usize * format.bytes_per_texel());
    TextureData {
        name: "by hand".into(),
        dimension,
        width,
        height,
        depth,
        format,
        color_space: ColorSpace::Linear,
        file_channels: format.channels(),
        texels,
        stored_levels: Vec::new(),
    }
}

fn floats(dimension: Dimension, size: [u32; 3], values: &[f32]) -> TextureData {
    let bytes = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    texture(dimension, size, TexelFormat::GreyFloat, bytes)
}

/// The values of each level.
fn boxes(dimension: Dimension, size: [u32; 3], values: &[f32]) -> Vec<Vec<f32>> {
    let levels = mip_chain(&floats(dimension, size, values), MipKernel::Box);
    let values =
        |t: &TextureData| t.texels.as_chunks::<4>().0.iter().map(|b| f32::from_ne_bytes(*b)).collect();
    levels.iter().map(values).collect()
}

fn assert_near(found: &[Vec<f32>], expected: &[&[f32]]) {
    assert_eq!(
        found.iter().map(Vec::len).collect::<Vec<_>>(),
        expected.iter().map(|l| l.len()).collect::<Vec<_>>()
    );
    for (f, e) in found.iter().flatten().zip(expected.iter().copied().flatten()) {
        // One rounding to f32.
        assert!((f - e).abs() <= f32::EPSILON * e.abs(), "{found:?}, not {expected:?}");
    }
}

const TWO: Dimension = Dimension::Two;

#[test]
fn odd_lengths_share_the_texels_between() {
    assert_near(&boxes(TWO, [3, 1, 1], &[1.0, 2.0, 6.0]), &[&[3.0]]);
    // 5 → 2: each covers two and a half.
    let halves = [(1.0 + 2.0 + 0.5 * 4.0) / 2.5, (0.5 * 4.0 + 8.0 + 16.0) / 2.5];
    assert_near(&boxes(TWO, [5, 1, 1], &[1.0, 2.0, 4.0, 8.0, 16.0]), &[&halves, &[6.2]]);
    assert_near(&boxes(TWO, [2, 1, 1], &[1.0, 4.0]), &[&[2.5]]);
    // 7 → 3 → 1, upright: 7/3 = 2 1/3 texels each; the last level is the mean of all.
    let third = 1.0 / 3.0;
    let column = [3.0, 6.0, 9.0, 12.0, 15.0, 18.0, 21.0];
    let thirds = [
        (3.0 + 6.0 + 9.0 * third) * 3.0 / 7.0,
        (9.0 * 2.0 * third + 12.0 + 15.0 * 2.0 * third) * 3.0 / 7.0,
        (15.0 * third + 18.0 + 21.0) * 3.0 / 7.0,
    ];
    assert_near(&boxes(TWO, [1, 7, 1], &column), &[&thirds, &[12.0]]);
    assert_near(&boxes(Dimension::One, [3, 1, 1], &[1.0, 2.0, 6.0]), &[&[3.0]]);
}

/// 6 → 3 → 1: the first step halves, the second does not; 4 rows halve twice.
#[test]
fn even_and_odd_lengths_mix() {
    let values: Vec<f32> = (0..24).map(|i| i as f32).collect();
    let one = [3.5, 5.5, 7.5, 15.5, 17.5, 19.5];
    assert_near(&boxes(TWO, [6, 4, 1], &values), &[&one, &[11.5]]);
}

#[test]
fn volumes_halve_in_depth_and_cubes_keep_their_faces() {
    let values: Vec<f32> = (0..16).map(|i| i as f32).collect();
    assert_near(&boxes(Dimension::Three, [2, 2, 4], &values), &[&[3.5, 11.5], &[7.5]]);
    assert_near(&boxes(Dimension::Three, [1, 1, 3], &[1.0, 2.0, 6.0]), &[&[3.0]]);
    let faces: Vec<f32> = (0..24).map(|i| i as f32).collect();
    assert_near(&boxes(Dimension::Cube, [2, 2, 6], &faces), &[&[1.5, 5.5, 9.5, 13.5, 17.5, 21.5]]);
    let odd: Vec<f32> = (0..54).map(|i| (i / 9) as f32).collect();
    assert_near(&boxes(Dimension::Cube, [3, 3, 6], &odd), &[&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]]);
}

#[test]
fn a_texture_of_one_texel_has_no_more_levels() {
    assert!(boxes(TWO, [1, 1, 1], &[3.0]).is_empty());
    assert!(boxes(Dimension::Cube, [1, 1, 6], &[0.0; 6]).is_empty());
}

fn level1(format: TexelFormat, color_space: ColorSpace, texels: &[u8]) -> Vec<u8> {
    let width = (texels.len() / format.bytes_per_texel()) as u32;
    let t = TextureData { color_space, ..texture(TWO, [width, 1, 1], format, texels.to_vec()) };
    mip_chain(&t, MipKernel::Box)[0].texels.clone()
}

#[test]
fn srgb_is_averaged_as_light() {
    use TexelFormat::{Grey8, Grey16, Rgba8};
    assert_eq!(level1(Grey8, ColorSpace::Srgb, &[0, 255]), [188]);
    assert_eq!(level1(Grey8, ColorSpace::Linear, &[0, 255]), [128]);
    assert_eq!(level1(Rgba8, ColorSpace::Srgb, &[0, 255, 10, 255, 255, 255, 10, 255]), [188, 255, 10, 255]);
    let exact = linear_to_srgb((srgb_to_linear(1000.0 / 65535.0) + srgb_to_linear(30000.0 / 65535.0)) / 2.0);
    let pair: Vec<u8> = [1000u16, 30000].into_iter().flat_map(u16::to_ne_bytes).collect();
    let code = (exact * 65535.0).round() as u16;
    assert_eq!(level1(Grey16, ColorSpace::Srgb, &pair), code.to_ne_bytes());
    assert_eq!(level1(Grey16, ColorSpace::Linear, &pair), 15500u16.to_ne_bytes());
}

/// No material interprets alpha as coverage: a colour counts whatever its alpha, and alpha is averaged separately.
#[test]
fn alpha_is_a_channel_like_the_others() {
    use TexelFormat::{GreyAlpha8, Rgba8, RgbaFloat};
    let linear = |format, texels: &[u8]| level1(format, ColorSpace::Linear, texels);
    assert_eq!(linear(Rgba8, &[200, 100, 0, 255, 0, 255, 0, 0]), [100, 178, 0, 128]);
    assert_eq!(linear(GreyAlpha8, &[200, 51, 100, 204]), [150, 128]);
    assert_eq!(linear(Rgba8, &[200, 100, 0, 0, 100, 50, 7, 0]), [150, 75, 4, 0]);
    // Alpha is never encoded.
    assert_eq!(level1(GreyAlpha8, ColorSpace::Srgb, &[0, 0, 255, 255]), [188, 128]);
    let bytes = |values: &[f32]| values.iter().flat_map(|v| v.to_ne_bytes()).collect::<Vec<u8>>();
    let pair = bytes(&[8.0, -4.0, 0.0, 0.25, 4.0, 4.0, 1.0, 0.75]);
    assert_eq!(linear(RgbaFloat, &pair), bytes(&[6.0, 0.0, 0.5, 0.5]));
}

/// Rounded at every level, 0 0 0 1 would become 0 1, and then 1.
#[test]
fn levels_are_rounded_once() {
    let t = texture(TWO, [4, 1, 1], TexelFormat::Grey8, vec![0, 0, 0, 1]);
    let levels = mip_chain(&t, MipKernel::Box);
    assert_eq!((&levels[0].texels[..], &levels[1].texels[..]), (&[0, 1][..], &[0][..]));
}

/// The new rate holds waves of 4 texels and longer. Of one of 7.7 the box leaves cos(π/7.7) = 0.918 and the
/// Kaiser kernel 0.998; of one of 2.9, which can only alias, |cos(π/2.9)| = 0.468 and 0.025.
#[test]
fn the_kaiser_kernel_is_sharper_and_aliases_less_than_the_box() {
    let height = |period: f64, kernel| {
        let wave = |i: u32| (std::f64::consts::TAU * f64::from(i) / period).sin() as f32;
        let t = floats(TWO, [256, 1, 1], &(0..256).map(wave).collect::<Vec<_>>());
        let level = mip_chain(&t, kernel).swap_remove(0);
        // Away from the border, whose texels are repeated.
        (16..112).map(|x| level.value(x, 0, 0).abs()).fold(0.0, f64::max)
    };
    for (period, kernel, gain) in [
        (7.7, MipKernel::Kaiser, 0.998),
        (7.7, MipKernel::Box, 0.918),
        (2.9, MipKernel::Kaiser, 0.025),
        (2.9, MipKernel::Box, 0.468),
    ] {
        let found = height(period, kernel);
        // Of 96 texels one lies within 1/96 of a period of a peak: cos(2π/96) = 0.998; gains to 3 digits.
        assert!((found - gain).abs() <= 0.0025, "{kernel}, period {period}: {found}");
    }
}

#[test]
fn kaiser_levels_stay_in_the_range_of_the_texture() {
    let edge: Vec<f32> = (0..64).map(|i| if i < 32 { 2.0 } else { 5.0 }).collect();
    for level in mip_chain(&floats(TWO, [64, 1, 1], &edge), MipKernel::Kaiser) {
        let range = (0..level.width).map(|x| level.value(x, 0, 0));
        assert!(range.clone().all(|v| (2.0..=5.0).contains(&v)), "{:?}", range.collect::<Vec<_>>());
    }
}

fn mean(t: &TextureData, channel: usize) -> f64 {
    let rows = t.height * t.depth;
    let sum: f64 = (0..rows)
        .flat_map(|y| (0..t.width).map(move |x| (x, y)))
        .map(|(x, y)| t.linear_value(x, y, channel))
        .sum();
    sum / f64::from(t.width * rows)
}

fn any_texture() -> impl Strategy<Value = TextureData> {
    let format = prop::sample::select(TexelFormat::ALL);
    let dimension = prop::sample::select(Dimension::ALL);
    (format, dimension, 1..40u32, 1..40u32, 1..9u32, any::<bool>(), any::<u32>()).prop_map(
        |(format, dimension, w, h, d, srgb, seed)| {
            let size = match dimension {
                Dimension::One => [w, 1, 1],
                Dimension::Two => [w, h, 1],
                Dimension::Three => [w, h, d],
                Dimension::Cube => [w, w, 6],
            };
            let count = size.iter().product::<u32>() * format.channels() as u32;
            let code =
                |i: u32| (i ^ seed).wrapping_mul(0x9E37_79B9).rotate_left(15).wrapping_mul(0x85EB_CA6B);
            let texels: Vec<u8> = match format.component() {
                Component::Unorm8 => (0..count).map(|i| (code(i) >> 24) as u8).collect(),
                Component::Unorm16 => {
                    (0..count).flat_map(|i| ((code(i) >> 16) as u16).to_ne_bytes()).collect()
                }
                Component::Float32 => {
                    (0..count).flat_map(|i| ((code(i) >> 8) as f32).to_ne_bytes()).collect()
                }
            };
            let float = format.component() == Component::Float32;
            let color_space = if srgb && !float { ColorSpace::Srgb } else { ColorSpace::Linear };
            TextureData { color_space, ..texture(dimension, size, format, texels) }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, ..ProptestConfig::default() })]

    #[test]
    fn sizes_follow_vulkans_rule(t in any_texture()) {
        let levels = mip_chain(&t, MipKernel::Box);
        let depth = if t.dimension == Dimension::Three { t.depth } else { 1 };
        let longest = t.width.max(t.height).max(depth);
        prop_assert_eq!(levels.len() as u32, longest.ilog2());
        prop_assert_eq!(level_count(&t), 1 + longest.ilog2());
        for (l, level) in (1..).zip(&levels) {
            let size = [level.width, level.height, level.depth];
            prop_assert_eq!(size, level_size(&t, l));
            let depth = if t.dimension == Dimension::Three { (t.depth >> l).max(1) } else { t.depth };
            prop_assert_eq!(size, [(t.width >> l).max(1), (t.height >> l).max(1), depth]);
            let texels = size.iter().product::<u32>() as usize;
            prop_assert_eq!(level.texels.len(), texels * t.format.bytes_per_texel());
            prop_assert_eq!((level.format, level.color_space, level.dimension), (t.format, t.color_space, t.dimension));
        }
    }

    #[test]
    fn box_levels_keep_the_mean_of_every_channel(t in any_texture()) {
        for (l, level) in mip_chain(&t, MipKernel::Box).iter().enumerate() {
            for channel in 0..t.format.channels() {
                let (before, after) = (mean(&t, channel), mean(level, channel));
                // Stored levels are rounded to half a step; sRGB steps are at most 2.3 times as wide in
                // light. Floats: f32 sums of two.
                let step = match t.format.component() {
                    Component::Unorm8 => 1.0 / 255.0,
                    Component::Unorm16 => 1.0 / 65535.0,
                    Component::Float32 => 1e-6 * before.abs().max(1.0),
                };
                prop_assert!((before - after).abs() <= 1.15 * step, "level {}: {} became {}", l + 1, before, after);
            }
        }
    }

    #[test]
    fn constants_stay(t in any_texture()) {
        let texel = t.texels[..t.format.bytes_per_texel()].to_vec();
        let constant = TextureData { texels: texel.repeat(t.texels.len() / texel.len()), ..t };
        for kernel in [MipKernel::Box, MipKernel::Kaiser] {
            for level in mip_chain(&constant, kernel) {
                for channel in 0..constant.format.channels() {
                    let (exact, found) = (constant.value(0, 0, channel), level.value(0, 0, channel));
                    // A rounding to f32 at each of up to six Kaiser levels.
                    let float = constant.format.component() == Component::Float32;
                    let tolerance = if float { 4.0 * f64::from(f32::EPSILON) * exact.abs() } else { 0.0 };
                    prop_assert!((exact - found).abs() <= tolerance, "{}: {} became {}", kernel, exact, found);
                }
                let first = &level.texels[..texel.len()];
                prop_assert!(level.texels.chunks(texel.len()).all(|texel| texel == first));
            }
        }
    }
}
