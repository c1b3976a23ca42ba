//! Lookups by the lecture's two formulas, and the five address modes on a row of two texels, at
//! coordinates computed by hand.

use moire::internal::lab::probe::{self, LookupQuery};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Address, Filter, SamplerSpec, TexelCenter};

use crate::lookup::bench::{pairs, query, uv_of};
use crate::stage::device;

/// Grey floats, row by row.
fn grey(width: u32, values: &[f32]) -> TextureData {
    TextureData {
        name: "by hand".into(),
        dimension: Dimension::Two,
        width,
        height: values.len() as u32 / width,
        depth: 1,
        format: TexelFormat::GreyFloat,
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: values.iter().flat_map(|v| v.to_ne_bytes()).collect(),
        stored_levels: Vec::new(),
    }
}

/// Grey values at (u, v), by oracle and by device from both sources.
fn assert_reads(texture: TextureData, spec: SamplerSpec, cases: &[([f32; 2], f64)]) {
    let scene = pairs(vec![texture], &[spec], &[(0, 0)]);
    let queries: Vec<LookupQuery> = cases.iter().map(|c| query(&scene, 0, c.0)).collect();
    let mut answers: Vec<(&str, Vec<f64>)> = Vec::new();
    let oracle = |q: &LookupQuery| {
        sample_texture(
            &scene,
            &scene.records.textures[0],
            &scene.records.samplers[0],
            &Coordinate::flat(uv_of(q)),
            [0; 2],
        )
        .x
    };
    answers.push(("oracle", queries.iter().map(oracle).collect()));
    for (who, image_source) in [("device, buffer", false), ("device, image", true)] {
        let read = probe::lookups(&device(), &scene, image_source, false, &queries).unwrap();
        answers.push((who, read.iter().map(|a| a[0].into()).collect()));
    }
    for (who, values) in answers {
        for ((uv, by_hand), got) in cases.iter().zip(values) {
            // Values up to 100 and coordinates of 4 texels: 4 · 2⁻²² of a range of 100.
            let close = (got - by_hand).abs() <= 1e-4;
            let label = spec.label();
            assert!(close, "{who}, {label} centre {}: {got} at {uv:?}, by hand {by_hand}", spec.texel_center);
        }
    }
}

fn spec(address: Address, filter: Filter, texel_center: TexelCenter) -> SamplerSpec {
    SamplerSpec { address: [address; 2], mag: filter, min: filter, texel_center, ..Default::default() }
}

/// The lecture: a = u·W, texel (int)(a + 0.5) mod W. Row 10 20 30 40, W = 4.
#[test]
fn nearest_by_the_lectures_formula() {
    let cases = [
        (0.0, 10.0),   // a = 0, (int) 0.5 = 0
        (0.12, 10.0),  // a = 0.48, (int) 0.98 = 0
        (0.13, 20.0),  // a = 0.52, (int) 1.02 = 1
        (0.25, 20.0),  // a = 1
        (0.45, 30.0),  // a = 1.8, (int) 2.3 = 2
        (0.75, 40.0),  // a = 3
        (0.87, 40.0),  // a = 3.48, (int) 3.98 = 3
        (0.88, 10.0),  // a = 3.52, (int) 4.02 = 4 mod 4 = 0
        (1.45, 30.0),  // a = 5.8, (int) 6.3 = 6 mod 4 = 2
        (-0.25, 40.0), // a = −1, 3 by the period
    ];
    let cases = cases.map(|(u, value)| ([u, 0.0], value));
    let row = || grey(4, &[10.0, 20.0, 30.0, 40.0]);
    assert_reads(row(), spec(Address::Repeat, Filter::Nearest, TexelCenter::Integer), &cases);
    // The half rule reads the same half a texel (1/8) further on.
    let moved = cases.map(|([u, v], value)| ([u + 0.125, v], value));
    assert_reads(row(), spec(Address::Repeat, Filter::Nearest, TexelCenter::Half), &moved);
}

/// The lecture: U = (int) a, c = a − U, (1 − c)·T[U] + c·T[U + 1]. Row 10 20 40 100.
#[test]
fn bilinear_by_the_lectures_formula() {
    let cases = [
        (0.0, 10.0),    // c = 0
        (0.125, 15.0),  // a = 0.5: half of 10 and of 20
        (0.25, 20.0),   // a = 1
        (0.3125, 25.0), // a = 1.25: ¾·20 + ¼·40
        (0.6875, 85.0), // a = 2.75: ¼·40 + ¾·100
        (0.875, 55.0),  // a = 3.5: half of 100, half of T[4 mod 4] = 10
        (1.125, 15.0),  // a period on
        (-0.125, 55.0), // a period back from 0.875
    ];
    let cases = cases.map(|(u, value)| ([u, 0.0], value));
    let row = || grey(4, &[10.0, 20.0, 40.0, 100.0]);
    assert_reads(row(), spec(Address::Repeat, Filter::Linear, TexelCenter::Integer), &cases);
    let moved = cases.map(|([u, v], value)| ([u + 0.125, v], value));
    assert_reads(row(), spec(Address::Repeat, Filter::Linear, TexelCenter::Half), &moved);
}

/// 2 × 2 texels 0 40 / 80 100. At a = (0.25, 0.75): top ¾·0 + ¼·40 = 10, bottom ¾·80 + ¼·100 = 85,
/// together ¼·10 + ¾·85 = 66.25.
#[test]
fn bilinear_weights_both_axes() {
    let square = || grey(2, &[0.0, 40.0, 80.0, 100.0]);
    let cases = [
        ([0.125, 0.375], 66.25),
        ([0.25, 0.25], 55.0), // a = (½, ½): the mean of all
        ([0.5, 0.0], 40.0),   // row 0 is v = 0
        ([0.0, 0.5], 80.0),
        ([0.375, 0.125], 46.25), // a = (¾, ¼): top 30, bottom 95, ¾·30 + ¼·95
    ];
    assert_reads(square(), spec(Address::Repeat, Filter::Linear, TexelCenter::Integer), &cases);
}

/// Texels A = 10, B = 20, border 0. Nearest, a texel is half a unit wide. The row of values is at
/// u = −1.25, −0.75, −0.25, 0.25, 0.75, 1.25, 1.75, 2.25.
#[test]
fn five_address_modes_on_two_texels() {
    let table = [
        (Address::Repeat, [20.0, 10.0, 20.0, 10.0, 20.0, 10.0, 20.0, 10.0]),
        // Mirrored at every whole number: … A B | B A | A B | B A | A B …
        (Address::MirroredRepeat, [20.0, 20.0, 10.0, 10.0, 20.0, 20.0, 10.0, 10.0]),
        (Address::ClampToEdge, [10.0, 10.0, 10.0, 10.0, 20.0, 20.0, 20.0, 20.0]),
        (Address::ClampToBorder, [0.0, 0.0, 0.0, 10.0, 20.0, 0.0, 0.0, 0.0]),
        // Mirrored once at 0: at −0.75 texel 1; beyond −1 and 1 the edge, B.
        (Address::MirrorClampToEdge, [20.0, 20.0, 10.0, 10.0, 20.0, 20.0, 20.0, 20.0]),
    ];
    for (address, values) in table {
        let us = [-1.25, -0.75, -0.25, 0.25, 0.75, 1.25, 1.75, 2.25];
        let cases: Vec<([f32; 2], f64)> =
            us.iter().zip(values).map(|(&u, value)| ([u, 0.5], value)).collect();
        let across = SamplerSpec {
            address: [address, Address::ClampToEdge],
            ..spec(address, Filter::Nearest, TexelCenter::Half)
        };
        assert_reads(grey(2, &[10.0, 20.0]), across, &cases);
        let down: Vec<([f32; 2], f64)> = cases.iter().map(|&([u, v], value)| ([v, u], value)).collect();
        let downwards = SamplerSpec { address: [Address::ClampToEdge, address], ..across };
        assert_reads(grey(1, &[10.0, 20.0]), downwards, &down);
    }
}

/// The same texels, linear, at the edge u = 0 between texels −1 and 0: half of each.
#[test]
fn five_address_modes_between_two_texels() {
    let table = [
        (Address::Repeat, 15.0),            // B and A
        (Address::MirroredRepeat, 10.0),    // A and A
        (Address::ClampToEdge, 10.0),       // A and A
        (Address::ClampToBorder, 5.0),      // the border's 0 and A
        (Address::MirrorClampToEdge, 10.0), // A and A
    ];
    for (address, value) in table {
        let across = SamplerSpec {
            address: [address, Address::ClampToEdge],
            ..spec(address, Filter::Linear, TexelCenter::Half)
        };
        // In the middle, u = ½, all agree: half of A and of B.
        assert_reads(grey(2, &[10.0, 20.0]), across, &[([0.0, 0.5], value), ([0.5, 0.5], 15.0)]);
    }
}
