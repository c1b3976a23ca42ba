//! The device against the oracle, for every kind, near and far, with and without a footprint.

use glam::DVec3;
use moire::internal::lab::probe::{self, ProceduralQuery};
use moire::internal::oracle::procedural::{box_count, principal_axes, procedural_color};
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::schema::layout::{self, Header, Records};
use moire::internal::texture::procedural::ProceduralKind::{self, *};

use super::{default_record, record};
use crate::lookup::bench::{Rng, Vectors};
use crate::stage::device;

fn scene(records: &[layout::Procedural], filtered: bool) -> PackedScene {
    let footprint = if filtered { Footprint::Differentials } else { Footprint::None };
    let header = Header { footprint, ..Default::default() };
    let records = Records { procedurals: records.to_vec(), ..Default::default() };
    PackedScene { header, records, ..Default::default() }
}

fn four(v: DVec3) -> [f32; 4] {
    let [x, y, z] = v.as_vec3().to_array();
    [x, y, z, 0.0]
}

fn wide(v: [f32; 4]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

/// Points within `reach`; footprints from 10⁻³ to 30 cells, up to 50 times as long as wide, some in the plane
/// of a 2D mapping, some zero.
fn queries(rng: &mut Rng, procedural: u32, reach: f64, filtered: bool, count: u32) -> Vec<ProceduralQuery> {
    let one = |i: u32| {
        let mut at = rng.vector(reach);
        let size = 10f64.powf(rng.between(-3.0, 1.5));
        let mut dx = size * rng.direction();
        let mut dy = size * rng.between(0.02, 1.0) * rng.direction();
        if i.is_multiple_of(3) {
            (at.z, dx.z, dy.z) = (0.0, 0.0, 0.0);
        }
        if i.is_multiple_of(5) {
            at = at.floor();
        }
        if !filtered || i.is_multiple_of(7) {
            (dx, dy) = (DVec3::ZERO, DVec3::ZERO);
        }
        ProceduralQuery { procedural, padding: [0; 3], at: four(at), dx: four(dx), dy: four(dy) }
    };
    (0..count).map(one).collect()
}

/// Returns the range of the oracle's answers within the rounding of f32: of the point to 4 ulp of its
/// coordinates and of a cell's fraction, of the footprint to 1e-5 of its lengths, which determines the number
/// of boxes.
fn range(what: &layout::Procedural, query: &ProceduralQuery) -> (DVec3, DVec3) {
    let (at, dx, dy) = (wide(query.at), wide(query.dx), wide(query.dy));
    let delta = 4.0 * f64::from(f32::EPSILON) * (0.5 * at.abs() + 0.5);
    let mut low = DVec3::splat(f64::INFINITY);
    let mut high = DVec3::splat(f64::NEG_INFINITY);
    for corner in 0..9 {
        let side = |bit: i32| if corner == 8 { 0.0 } else { f64::from(1 - 2 * (corner >> bit & 1)) };
        let p = at + delta * DVec3::new(side(0), side(1), side(2));
        for (sx, sy) in [(1.0, 1.0), (1.0 + 1e-5, 1.0 - 1e-5), (1.0 - 1e-5, 1.0 + 1e-5)] {
            let color = procedural_color(what, p, sx * dx, sy * dy);
            (low, high) = (low.min(color), high.max(color));
        }
    }
    (low, high)
}

/// 2⁻²⁴ is the rounding of an f32 relative to it. Boxes: up to 16 are summed, each with
/// its middle rounded beside the widths that divide it. Noise: about 20 roundings
/// of values up to 1, and each octave rounds the coordinate it is read at by 2 + k, where the steepest
/// of noise falls by 3 a cell; veins and rings turn a sine by 2π · distortion of that, over 2.
fn tolerance(what: &layout::Procedural, query: &ProceduralQuery) -> f64 {
    const U: f64 = 1.0 / 16_777_216.0;
    let kind = what.kind;
    let [lacunarity, gain, norm, distortion] =
        [what.lacunarity, what.gain, what.normalization, what.distortion].map(f64::from);
    let far = wide(query.at).abs().max_element();
    let octave = |k: u32| {
        let (weight, frequency) = (norm * gain.powi(k as i32), lacunarity.powi(k as i32));
        weight * (20.0 + 3.0 * f64::from(2 + k) * (1.0 + far * frequency)) * U
    };
    let octaves = (0..what.octaves).map(octave).sum::<f64>();
    match kind {
        Checker | Stripes | Grid | Brick => {
            let (major, minor) = principal_axes(wide(query.dx), wide(query.dy));
            let step = major / box_count(major, minor).ceil();
            let widths = (0..3).map(|i| step[i].hypot(minor[i])).filter(|w| *w > 0.0);
            32.0 * U + widths.map(|w| 4.0 * U / w).sum::<f64>()
        }
        Noise | Fbm | Turbulence | Cellular => octaves,
        Marble | Wood => std::f64::consts::PI * distortion * octaves + 3.0 * far * U,
    }
}

fn complaints(
    records: &[layout::Procedural],
    queries: &[ProceduralQuery],
    answers: &[[f32; 4]],
) -> Vec<String> {
    let mut found = Vec::new();
    for (query, answer) in queries.iter().zip(answers) {
        let what = &records[query.procedural as usize];
        let kind = what.kind;
        let (low, high) = range(what, query);
        let (got, most) = (wide(*answer), tolerance(what, query));
        if !(got.cmpge(low - most).all() && got.cmple(high + most).all()) {
            found.push(format!("{kind}: {got}, oracle {low} to {high}, {query:?}"));
        }
    }
    found
}

fn assert_none(complaints: &[String], of: usize) {
    let first = complaints.iter().take(4).cloned().collect::<Vec<_>>().join("\n");
    assert!(complaints.is_empty(), "{} of {of} are wrong:\n{first}", complaints.len());
}

fn variants(kind: ProceduralKind) -> Vec<layout::Procedural> {
    let other = record(kind, |t| {
        t.colors = [[0.9, 0.2, 0.0], [0.1, 0.6, 0.5]];
        (t.seed, t.octaves, t.lacunarity, t.gain) = (0xDEAD_BEEF, 7, 1.93, 0.6);
        (t.width, t.distortion, t.aspect, t.offset) = (0.23, 1.5, 2.7, 0.3);
        (t.jitter, t.dimensions) = (0.6, 3);
    });
    vec![default_record(kind), other]
}

fn agrees(kind: ProceduralKind) {
    let gpu = device();
    let records = variants(kind);
    for filtered in [false, true] {
        let scene = scene(&records, filtered);
        let mut rng = Rng::new(70 + kind as u64);
        let mut list = Vec::new();
        for (i, reach) in [(0, 8.0), (1, 8.0), (0, 1000.0), (1, 1000.0)] {
            list.extend(queries(&mut rng, i, reach, filtered, 1500));
        }
        let answers = probe::procedurals(&gpu, &scene, false, &list).unwrap();
        assert_none(&complaints(&records, &list, &answers), list.len());
    }
}

macro_rules! each_kind {
    ($($name:ident: $kind:ident,)+) => { $(#[test] fn $name() { agrees($kind); })+ };
}

each_kind! {
    checker_agrees_with_float64: Checker,
    stripes_agree_with_float64: Stripes,
    grid_agrees_with_float64: Grid,
    brick_agrees_with_float64: Brick,
    noise_agrees_with_float64: Noise,
    fbm_agrees_with_float64: Fbm,
    turbulence_agrees_with_float64: Turbulence,
    marble_agrees_with_float64: Marble,
    wood_agrees_with_float64: Wood,
    cells_agree_with_float64: Cellular,
}

fn all_kinds() -> Vec<layout::Procedural> {
    ProceduralKind::ALL.iter().flat_map(|kind| variants(*kind)).collect()
}

#[test]
fn what_is_left_out_changes_no_bit_and_neither_does_a_second_run() {
    let gpu = device();
    for records in [all_kinds(), variants(Fbm), variants(Checker), vec![default_record(Wood)]] {
        for filtered in [false, true] {
            let scene = scene(&records, filtered);
            let mut rng = Rng::new(90);
            let list: Vec<ProceduralQuery> =
                (0..records.len() as u32).flat_map(|i| queries(&mut rng, i, 20.0, filtered, 100)).collect();
            let lean = probe::procedurals(&gpu, &scene, false, &list).unwrap();
            let full = probe::procedurals(&gpu, &scene, true, &list).unwrap();
            let again = probe::procedurals(&gpu, &scene, false, &list).unwrap();
            assert_eq!(lean, again);
            assert_eq!(lean, full, "filtered {filtered}, {} textures", records.len());
        }
    }
}

#[test]
fn coordinates_that_are_not_finite_read_the_origin_and_endless_footprints_the_mean() {
    let gpu = device();
    let records = all_kinds();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38];
    let query = |procedural, x: f32, w: f32| ProceduralQuery {
        procedural,
        padding: [0; 3],
        at: [x, 0.3, 0.0, 0.0],
        dx: [w, 0.0, 0.0, 0.0],
        dy: [0.0, w, 0.0, 0.0],
    };
    let scene = scene(&records, true);
    for i in 0..records.len() as u32 {
        let list: Vec<_> = odd.iter().map(|x| query(i, *x, 0.0)).chain([query(i, 0.0, 0.0)]).collect();
        let answers = probe::procedurals(&gpu, &scene, false, &list).unwrap();
        assert!(answers.iter().all(|a| *a == answers[4]), "texture {i}: {answers:?}");
        let list: Vec<_> = odd.iter().map(|w| query(i, 0.4, *w)).chain([query(i, 0.4, 1e9)]).collect();
        let answers = probe::procedurals(&gpu, &scene, false, &list).unwrap();
        let apart = |a: &[f32; 4]| (0..4).map(|c| (a[c] - answers[4][c]).abs()).fold(0.0, f32::max);
        // The remainder of the pattern under a footprint of 10⁹ cells is below one ulp of its mean.
        assert!(answers.iter().all(|a| apart(a) < 1e-6), "texture {i}: {answers:?}");
    }
}

/// Differences of an integral taken at x = 1000 would be off by 0.1 for a box of 0.01, and by all of the
/// mean for one of 0.001.
#[test]
fn small_boxes_far_from_the_origin_keep_their_mean() {
    let gpu = device();
    let records = [default_record(Checker), default_record(Stripes), default_record(Grid)];
    let scene = scene(&records, true);
    let mut list = Vec::new();
    for (procedural, x, r) in
        (0..3).flat_map(|p| [(p, 1000.0, 0.01), (p, 1000.0025, 0.01), (p, -4096.0, 1e-3)])
    {
        let (at, dx, dy) = ([x, 0.5, 0.0, 0.0], [r, 0.0, 0.0, 0.0], [0.0, r, 0.0, 0.0]);
        list.push(ProceduralQuery { procedural, padding: [0; 3], at, dx, dy });
    }
    let answers = probe::procedurals(&gpu, &scene, false, &list).unwrap();
    for (query, answer) in list.iter().zip(&answers) {
        let what = &records[query.procedural as usize];
        let expected = procedural_color(what, wide(query.at), wide(query.dx), wide(query.dy));
        // 2⁻²⁴ for the fraction's rounding, over the box of 10⁻³.
        assert!((wide(*answer) - expected).abs().max_element() < 1e-4, "{query:?}: {answer:?}, {expected}");
    }
    assert!((answers[0][0] - 0.5).abs() < 1e-4, "half of the box lies in the odd cell: {:?}", answers[0]);
}

#[test]
fn planted_errors_of_procedurals_are_caught() {
    let gpu = device();
    let records = all_kinds();
    let scene = scene(&records, true);
    let mut rng = Rng::new(95);
    let list: Vec<ProceduralQuery> =
        (0..records.len() as u32).flat_map(|i| queries(&mut rng, i, 8.0, true, 300)).collect();
    let caught = |plant: &dyn Fn(&mut ProceduralQuery)| {
        let mut planted = list.clone();
        planted.iter_mut().for_each(plant);
        let answers = probe::procedurals(&gpu, &scene, false, &planted).unwrap();
        complaints(&records, &list, &answers).len() as f64 / list.len() as f64
    };
    assert_eq!(caught(&|_| {}), 0.0);
    // Away from edges a hard-edged pattern is constant, and bricks look alike: shares of all kinds.
    type Plant<'a> = (&'a str, f64, &'a dyn Fn(&mut ProceduralQuery));
    let plants: [Plant<'_>; 4] = [
        ("a thousandth of a cell", 0.3, &|q| q.at[0] += 1e-3),
        ("x and y swapped", 0.5, &|q| q.at.swap(0, 1)),
        ("no footprint", 0.3, &|q| (q.dx, q.dy) = ([0.0; 4], [0.0; 4])),
        ("a footprint a hundredth too wide", 0.2, &|q| q.dx = q.dx.map(|d| 1.01 * d)),
    ];
    for (what, least, plant) in plants {
        let share = caught(plant);
        assert!(share > least, "{what}: only {share} caught");
    }
}
