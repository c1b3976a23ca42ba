//! Regression tests for extreme footprints and coordinates, one each: boxes wider than the texture, footprints that are
//! NaN or infinite, textures far longer than wide, directions of any length.

use glam::DVec3;
use moire::internal::lab::probe::LookupQuery;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::texture::data::{Dimension, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use super::bench::{answers, coordinate, expected, narrow, pairs_of, solid};
use crate::lookup::bench::{Rng, Vectors, query};

fn grey(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> TextureData {
    solid(Dimension::Two, [width, height, 1], TexelFormat::GreyFloat).with_floats(1, |x, y, _| value(x, y))
}

fn minified(texture: TextureData, spec: SamplerSpec) -> PackedScene {
    pairs_of(Footprint::Differentials, vec![texture], &[spec], &[(0, 0)])
}

fn summed(address: Address) -> SamplerSpec {
    SamplerSpec { address: [address; 2], min: Filter::SummedArea, ..Default::default() }
}

fn over(scene: &PackedScene, uv: [f32; 2], wide: f32, high: f32) -> LookupQuery {
    let (dx, dy) = ([wide, 0.0, 0.0, 0.0], [0.0, high, 0.0, 0.0]);
    LookupQuery { dx, dy, ..query(scene, 0, uv) }
}

/// Returns the texel of an endless row.
fn of_row(address: Address, i: i64, size: i64) -> i64 {
    let mirrored = i.rem_euclid(2 * size);
    match address {
        Address::Repeat => i.rem_euclid(size),
        Address::MirroredRepeat => mirrored.min(2 * size - 1 - mirrored),
        _ => i.clamp(0, size - 1),
    }
}

#[test]
fn sums_over_areas_count_what_a_box_covers_beside_whole_periods() {
    let size = 5i64;
    let row = |x: u32| [1.0, 7.0, 2.0, 3.0, -4.0][x as usize];
    for address in [Address::Repeat, Address::MirroredRepeat, Address::ClampToEdge] {
        let scene = minified(grey(5, 3, |x, _| row(x)), summed(address));
        let mut rng = Rng::new(61);
        let boxes: Vec<[i64; 2]> =
            (0..400).map(|_| [rng.between(0.0, 5.0) as i64, rng.between(1.0, 40.0) as i64]).collect();
        let query = |[first, count]: &[i64; 2]| {
            let middle = (*first as f32 + 0.5 * *count as f32) / size as f32;
            over(&scene, [middle, 0.5], *count as f32 / size as f32, 0.1)
        };
        // Clamped modes cut coordinates at 3.
        let inside = |[first, count]: &&[i64; 2]| 2 * first + count <= 25;
        let boxes: Vec<[i64; 2]> = boxes.iter().filter(inside).copied().collect();
        assert!(boxes.iter().filter(|b| b[1] > 2 * size).count() > 20, "wide boxes");
        let queries: Vec<LookupQuery> = boxes.iter().map(query).collect();
        for ([first, count], answer) in boxes.iter().zip(answers(&scene, &queries)) {
            let texels = (*first..first + count).map(|i| f64::from(row(of_row(address, i, size) as u32)));
            let mean = texels.sum::<f64>() / *count as f64;
            // The range is 11; ends of the box round to 2^-24 of 25 texels.
            let off = (f64::from(answer[0]) - mean).abs();
            assert!(off < 11.0 * 4e-6, "{address} {first}+{count}: {} for {mean}", answer[0]);
        }
    }
}

/// If f32 has lost the position of a box's end, its texels are still those of the table.
#[test]
fn the_widest_boxes_read_no_further_than_their_table() {
    for address in
        [Address::Repeat, Address::MirroredRepeat, Address::ClampToEdge, Address::MirrorClampToEdge]
    {
        for (width, height) in [(1000, 3), (37, 61), (1, 1)] {
            let scene = minified(grey(width, height, |x, y| ((x * 7 + y * 3) % 11) as f32), summed(address));
            let mut rng = Rng::new(62);
            let wide = |rng: &mut Rng| 10f64.powf(rng.between(-2.0, 9.0)) as f32;
            let queries: Vec<LookupQuery> = (0..2000)
                .map(|_| {
                    let uv = [rng.between(-3.0, 4.0) as f32, rng.between(-3.0, 4.0) as f32];
                    over(&scene, uv, wide(&mut rng), wide(&mut rng))
                })
                .collect();
            for (i, (query, answer)) in queries.iter().zip(answers(&scene, &queries)).enumerate() {
                assert!((0.0..=10.0).contains(&(f64::from(answer[0]))), "{address}: {answer:?} at {query:?}");
                let right = expected(&scene, query, i, &coordinate(query))[0];
                // Of the range of 10: ends round to 2^-24 of up to 4000 texels, of a box of at least one.
                let off = (right - f64::from(answer[0])).abs();
                assert!(off < 10.0 * 5e-4, "{address} {width}x{height}: {answer:?} for {right} at {query:?}");
            }
        }
    }
}

#[test]
fn bright_texels_times_large_areas_do_not_overflow() {
    let scene = minified(grey(8, 8, |x, _| x as f32 * 1e29), summed(Address::ClampToEdge));
    let queries: Vec<LookupQuery> = [1.0, 1e3, 1e9].iter().map(|&w| over(&scene, [0.5; 2], w, w)).collect();
    for (query, answer) in queries.iter().zip(answers(&scene, &queries)) {
        // By symmetry: as much of the first column's edge as of the last one's.
        assert!((answer[0] / 3.5e29 - 1.0).abs() < 1e-5, "{answer:?} at {query:?}"); // 2^-24 of the box, twice
    }
}

#[test]
fn an_ellipse_over_a_footprint_that_is_no_number_is_the_mean_and_not_black() {
    let spec = SamplerSpec { min: Filter::Ewa, ..Default::default() };
    let scene = minified(grey(8, 8, |x, y| (x + y) as f32), spec);
    for (a, b) in [(f32::NAN, 0.1), (f32::INFINITY, f32::NAN), (1e38, -1e38), (-f32::INFINITY, 0.0)] {
        let one = over(&scene, [0.3, 0.8], a, b);
        let answer = answers(&scene, &[one])[0][0];
        assert!((answer - 7.0).abs() < 1e-5, "{answer} at {a} and {b}"); // a few roundings of 7
    }
}

/// Levels of such a texture shrink along one side alone, so that an ellipse has many of the other's rows.
#[test]
fn an_ellipse_on_a_long_texture_ends_with_its_last_row() {
    let spec = SamplerSpec { min: Filter::Ewa, max_anisotropy: 64, ..Default::default() };
    // Left to right from 0 to 1, over and over: a mean of whole ellipses is symmetric about its middle.
    let scene = minified(grey(4096, 1, |x, _| x as f32 / 4095.0), spec);
    let queries: Vec<LookupQuery> = (0..200)
        .map(|i| {
            let wide = 0.01 * (1.0 + i as f32 % 17.0);
            LookupQuery {
                dx: [wide, 8.0 * wide, 0.0, 0.0],
                dy: [0.5 * wide, 2000.0 * wide, 0.0, 0.0],
                ..over(&scene, [0.5, 0.5], 0.0, 0.0)
            }
        })
        .collect();
    for (query, answer) in queries.iter().zip(answers(&scene, &queries)) {
        // Weights of an ellipse cancel by the square of its length, 64²: see the tests of all filters.
        assert!((answer[0] - 0.5).abs() < 5e-3, "{answer:?} at {query:?}");
    }
}

#[test]
fn a_tie_of_cube_faces_is_read_on_the_face_that_it_goes_to() {
    let spec = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let faces =
        solid(Dimension::Cube, [4, 4, 6], TexelFormat::GreyFloat).with_floats(1, |_, y, _| (y / 4) as f32);
    let scene = pairs_of(Footprint::None, vec![faces], &[spec], &[(0, 0)]);
    let signs = [-1.0, 1.0];
    for (x, y, z) in
        signs.iter().flat_map(|&x| signs.map(|y| (x, y))).flat_map(|(x, y)| signs.map(|z| (x, y, z)))
    {
        let side = |sign: f64| f32::from(u8::from(sign < 0.0));
        // Ties go to z, then y.
        for (direction, face) in [
            (DVec3::new(x, y, z), 4.0 + side(z)),
            (DVec3::new(0.3 * x, y, z), 4.0 + side(z)),
            (DVec3::new(x, 0.3 * y, z), 4.0 + side(z)),
            (DVec3::new(x, y, 0.3 * z), 2.0 + side(y)),
        ] {
            let one = LookupQuery { uv: narrow(direction), ..query(&scene, 0, [0.0; 2]) };
            assert_eq!(answers(&scene, &[one])[0][0], face, "{direction}");
        }
    }
}

#[test]
fn levels_of_a_cube_do_not_depend_on_the_length_of_the_direction() {
    let spec = SamplerSpec { mip: MipMode::Linear, ..Default::default() };
    let scene = pairs_of(
        Footprint::Differentials,
        vec![solid(Dimension::Cube, [16, 16, 6], TexelFormat::GreyFloat)],
        &[spec],
        &[(0, 0)],
    );
    let mut rng = Rng::new(63);
    for _ in 0..20 {
        let (way, dx, dy) = (rng.direction(), 0.5 * rng.direction(), 0.4 * rng.direction());
        // Powers of two change no digit.
        let long = |exponent: i32| {
            let by = 2f64.powi(exponent);
            LookupQuery {
                uv: narrow(way * by),
                dx: narrow(dx * by),
                dy: narrow(dy * by),
                ..query(&scene, 0, [0.0; 2])
            }
        };
        let read = answers(&scene, &[0, -80, -30, 30, 80].map(long));
        for (answer, exponent) in read.iter().zip([0, -80, -30, 30, 80]) {
            assert!((answer[0] - read[0][0]).abs() < 1e-5, "2^{exponent}: {answer:?}, not {:?}", read[0]); // quotients round
        }
    }
}
