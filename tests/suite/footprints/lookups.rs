//! Every filter, mip mode, kind of texture and address mode over footprints of any shape: the
//! device's answer equals the oracle's for some coordinate and footprint within f32 rounding of the
//! given ones. At a discontinuity in between (a texel's edge, another level, one more probe) any
//! value between both sides is correct; such lookups are few.

use glam::DVec3;
use moire::internal::lab::probe::LookupQuery;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use super::bench::{angle, answers, axes, coordinate, expected, narrow, pairs_of, solid};
use crate::lookup::bench::{Rng, Vectors, query};

const BORDER: [f32; 4] = [3.0, -1.0, 0.5, 0.25];
/// The tolerance of a coordinate and a footprint: a few roundings of f32, relative to their own lengths.
const DOUBT: f64 = 6.0 / 16_777_216.0;

/// All filters that a kind of texture has, with all mip modes and address modes.
fn specs(flat: bool) -> Vec<SamplerSpec> {
    use Filter::{Anisotropic, Cubic, Ewa, Lanczos2, Lanczos3, Linear, Nearest, Stochastic};
    let filters: &[(Filter, Filter)] = if flat {
        &[
            (Nearest, Nearest),
            (Nearest, Linear),
            (Linear, Nearest),
            (Linear, Linear),
            (Cubic, Cubic),
            (Lanczos2, Lanczos2),
            (Lanczos3, Lanczos3),
            (Cubic, Linear),
            (Stochastic, Stochastic),
            (Linear, Anisotropic),
            (Linear, Ewa),
        ]
    } else {
        &[(Nearest, Nearest), (Linear, Linear), (Stochastic, Stochastic), (Linear, Anisotropic)]
    };
    let mut all = Vec::new();
    for (i, &(mag, min)) in filters.iter().enumerate() {
        for (j, &mip) in MipMode::ALL.iter().enumerate() {
            for (k, &u) in Address::ALL.iter().enumerate() {
                let other = |n: usize| Address::ALL[(i + j + n * k) % Address::ALL.len()];
                all.push(SamplerSpec {
                    address: [u, other(1)],
                    address_w: other(2),
                    mag,
                    min,
                    mip,
                    border_color: BORDER,
                    ..Default::default()
                });
            }
        }
    }
    all
}

/// Footprints in texels: round, long up to 100 to 1, flat to a line, of no extent.
fn footprint(rng: &mut Rng, kind: u32) -> [DVec3; 2] {
    let wide = rng.between(-2.0, 4.0).exp2();
    let (turn, roll) = (angle(rng), angle(rng));
    let [x, y] = match kind % 5 {
        0 => axes(wide, wide, turn, roll),
        1 => axes(wide, wide / rng.between(1.0, 100.0), turn, roll),
        2 => axes(wide, wide / rng.between(1.0, 4.0), turn, roll),
        3 => axes(wide, 0.0, turn, roll),
        _ => axes(0.0, 0.0, turn, roll),
    };
    [x.extend(0.0), y.extend(0.0)]
}

/// A scene of one kind of texture, and queries in and around it through every sampler.
fn bench(dimension: Dimension, size: [u32; 3], each: u32, seed: u64) -> (PackedScene, Vec<LookupQuery>) {
    let specs = specs(matches!(dimension, Dimension::One | Dimension::Two));
    let texture = solid(dimension, size, TexelFormat::RgbaFloat);
    let mip = specs.iter().position(|s| s.mip == MipMode::Linear).unwrap();
    let scene = pairs_of(Footprint::Differentials, vec![texture], &specs, &[(0, mip)]);
    let mut rng = Rng::new(seed);
    let mut queries = Vec::new();
    for sampler in 0..specs.len() as u32 {
        for i in 0..each {
            let [x, y] = footprint(&mut rng, i);
            let (uv, [dx, dy]) = if dimension == Dimension::Cube {
                // Across a direction of any length; two units are the side of a face.
                let way = rng.direction();
                let side = way.cross(rng.direction()).normalize();
                let long = rng.between(0.5, 4.0);
                let across =
                    |d: DVec3| (side * d.x + way.cross(side) * d.y) * (2.0 * long / f64::from(size[0]));
                (way * long, [x, y].map(across))
            } else {
                // A volume's footprint lies in any plane.
                let turn = rng.direction();
                let [w, h, d] = size.map(f64::from);
                let depth = if dimension == Dimension::Three { turn } else { DVec3::Z };
                let turned =
                    |v: DVec3| glam::DQuat::from_rotation_arc(DVec3::Z, depth) * v / DVec3::new(w, h, d);
                (rng.vector(2.5), [x, y].map(turned))
            };
            let (uv, dx, dy) = (narrow(uv), narrow(dx), narrow(dy));
            queries.push(LookupQuery { sampler, seed: i, uv, dx, dy, ..query(&scene, 0, [0.0; 2]) });
        }
    }
    (scene, queries)
}

/// Least and greatest answer of the oracle around a query.
fn around(scene: &PackedScene, query: &LookupQuery, index: usize, rng: &mut Rng) -> [[f64; 4]; 2] {
    let exact = coordinate(query);
    let [mut low, mut high] = [expected(scene, query, index, &exact); 2];
    for corner in 0..10 {
        let sign = |bit: u32| if corner >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let signs = DVec3::new(sign(0), sign(1), sign(2));
        let at = exact.at + signs * DOUBT * exact.at.abs().max_element().max(1.0);
        let change = exact.change.map(|d| d + rng.direction() * d.length() * 2.0 * DOUBT);
        // The last two: the footprint as a whole a little narrower and wider.
        let change = change.map(|d| if corner < 8 { d } else { d * (1.0 + sign(0) * 8.0 * DOUBT) });
        let value = expected(scene, query, index, &Coordinate { at, change });
        for c in 0..4 {
            low[c] = low[c].min(value[c]);
            high[c] = high[c].max(value[c]);
        }
    }
    [low, high]
}

fn check(dimension: Dimension, size: [u32; 3], each: u32, seed: u64) {
    let (scene, queries) = bench(dimension, size, each, seed);
    let read = answers(&scene, &queries);
    let mut rng = Rng::new(seed + 1);
    let mut wrong = Vec::new();
    let mut undecided = 0;
    for (i, (query, answer)) in queries.iter().zip(&read).enumerate() {
        let [low, high] = around(&scene, query, i, &mut rng);
        let spec = &scene.sampler_specs[query.sampler as usize];
        // Of a range of 8. Weights of up to 64 texels: 64 roundings of 2^-24. In an ellipse r² cancels by
        // the square of the greatest anisotropy, 16²: 8 roundings of 2^-24 times 256 times the slope 1.2.
        let slack = if spec.min == Filter::Ewa { 8.0 * 1.5e-4 } else { 8.0 * 4e-6 };
        let off = (0..4).map(|c| (low[c] - f64::from(answer[c])).max(f64::from(answer[c]) - high[c]));
        let off = off.fold(0.0, f64::max);
        undecided += usize::from((0..4).any(|c| high[c] - low[c] > 0.05));
        if off > slack || answer.iter().any(|a| !a.is_finite()) {
            wrong
                .push(format!("{} off by {off}: {answer:?}, {low:?} to {high:?} at {query:?}", spec.label()));
        }
    }
    let first = wrong.iter().take(4).cloned().collect::<Vec<_>>().join("\n");
    assert!(wrong.is_empty(), "{dimension}: {} of {} are wrong:\n{first}", wrong.len(), queries.len());
    // Steps are thin: far less than one in a hundred, but for places on the edges of 1D textures' one row.
    assert!(undecided * 50 < queries.len(), "{dimension}: {undecided} of {} undecided", queries.len());
}

#[test]
fn flat_textures_whose_sides_are_powers_of_two() {
    check(Dimension::Two, [32, 16, 1], 20, 31);
}

#[test]
fn flat_textures_of_any_size() {
    check(Dimension::Two, [23, 7, 1], 20, 32);
}

#[test]
fn textures_of_one_dimension() {
    check(Dimension::One, [37, 1, 1], 15, 33);
}

#[test]
fn volumes() {
    check(Dimension::Three, [9, 16, 6], 20, 34);
}

#[test]
fn cubes() {
    check(Dimension::Cube, [13, 13, 6], 20, 35);
}

/// Nothing but the last level, which is one texel, or the border, whatever the coordinate.
#[test]
fn endless_footprints_and_those_that_are_no_numbers_read_the_last_level() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 1e25, -1e30];
    for (dimension, size) in
        [(Dimension::Two, [16, 8, 1]), (Dimension::Three, [4, 8, 4]), (Dimension::Cube, [8, 8, 6])]
    {
        let (scene, queries) = bench(dimension, size, 1, 41);
        let mut list = Vec::new();
        for (i, query) in queries.iter().enumerate() {
            for (j, &a) in odd.iter().enumerate() {
                let b = odd[(i + j) % odd.len()];
                list.push(LookupQuery { dx: [a, 0.0, 0.1, 0.0], dy: [0.0, b, 0.0, 0.0], ..*query });
                list.push(LookupQuery { uv: [a, b, a, 0.0], ..*query });
                list.push(LookupQuery { uv: [a, 0.3, b, 0.0], dx: [b; 4], dy: [a; 4], ..*query });
            }
        }
        for (query, answer) in list.iter().zip(answers(&scene, &list)) {
            // Random texels lie in [-2, 6]; Catmull-Rom overshoots by at most (5/4)² of the range.
            let inside = answer.iter().all(|v| (-8.0..=12.0).contains(v));
            let spec = &scene.sampler_specs[query.sampler as usize];
            assert!(inside, "{dimension} {}: {answer:?} at {query:?}", spec.label());
            let whole = query.dx[0].is_finite() && query.uv.iter().all(|x| x.abs() < 10.0);
            let chooses = matches!(spec.min, Filter::Anisotropic | Filter::Ewa | Filter::Stochastic);
            if whole && query.dx[0].abs() > 1e20 && !chooses && spec.mip == MipMode::Nearest {
                let right = expected(&scene, query, 0, &coordinate(query));
                let off = (0..4).map(|c| (right[c] - f64::from(answer[c])).abs()).fold(0.0, f64::max);
                assert!(
                    off < 1e-4,
                    "{dimension} {}: {answer:?}, oracle {right:?} at {query:?}",
                    spec.label()
                );
            }
        }
    }
}
