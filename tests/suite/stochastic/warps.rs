//! Mappings of the unit square to discs and caps: the device against the oracle, and area
//! preservation.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3, DVec4};
use moire::internal::lab::probe::{self, WarpAnswer, WarpQuery};
use moire::internal::oracle::bsdf::facets::{smith_g2_over_g1, visible_normal};
use moire::internal::oracle::bsdf::mirror::mirrored;
use moire::internal::oracle::disk_sampling::{concentric_disc, on_cap};
use moire::internal::oracle::footprint::around;
use moire::internal::scene::model::Pattern;

use crate::lookup::bench::Rng;
use crate::stage::device;

const HEIGHTS: [f32; 5] = [1e-7, 0.01, 0.5, 1.0, 2.0];
const ALPHAS: [f32; 4] = [0.01, 0.1, 0.5, 1.0];

fn queries() -> Vec<WarpQuery> {
    let mut rng = Rng::new(70);
    let square =
        |rng: &mut Rng| [0, 1].map(|_| (rng.between(0.0, 16_777_216.0).floor() / 16_777_216.0) as f32);
    let mut places: Vec<[f32; 2]> = (0..2000).map(|_| square(&mut rng)).collect();
    for x in [0.0, 0.25, 0.5, 1.0 - f32::EPSILON / 2.0] {
        places.extend([0.0, 0.25, 0.5, 1.0 - f32::EPSILON / 2.0].map(|y| [x, y]));
    }
    let mut direction = || {
        let v = DVec3::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0), rng.between(0.05, 1.0));
        v.normalize()
    };
    let query = |(i, square): (usize, [f32; 2])| {
        let normal = direction();
        let against = -around(normal, direction());
        let [direction, normal] = [against, normal].map(|v| v.as_vec3().extend(0.0).to_array());
        WarpQuery {
            square,
            height: HEIGHTS[i % 5],
            alpha: ALPHAS[i % 4],
            direction,
            normal,
            ..Default::default()
        }
    };
    places.into_iter().enumerate().map(query).collect()
}

#[test]
fn device_and_oracle_agree_to_a_few_ulp() {
    let queries = queries();
    let mut scene = super::packed(&super::parsed(super::lens::VIEW));
    scene.header.pattern = Pattern::Center;
    let answers = probe::warps(&device(), &scene, &queries).unwrap();
    let mut beyond = 0;
    for (query, answer) in queries.iter().zip(&answers) {
        beyond += u32::from(!facet_agrees(query, answer));
        let disc = concentric_disc(DVec2::from_array(query.square.map(f64::from)));
        let got = DVec2::new(answer.disc[0].into(), answer.disc[1].into());
        // Four roundings of numbers up to 1, and the polynomial.
        assert!((got - disc).abs().max_element() <= 3e-7, "{query:?}: disc {got}, oracle {disc}");
        let height = f64::from(query.height);
        let cap = on_cap(disc, height);
        let [x, y, z, _] = answer.cap.map(f64::from);
        // The disc's error, stretched; where the cap ends in its own antipode the root takes it further.
        let lateral = cap.truncate().length();
        let stretch = (height * (2.0 - height * disc.length_squared())).max(0.0).sqrt();
        let allowed = 1e-6 * stretch + 1e-6 * height * height / stretch.max(1e-3);
        let off = (DVec2::new(x, y) - cap.truncate()).length();
        assert!(off <= allowed, "{query:?}: cap off by {off:e} of {lateral}, {allowed:e} allowed");
        assert!((z - cap.z).abs() <= 2e-6 * height + 6e-8, "{query:?}: z {z}, oracle {}", cap.z);
    }
    // Where the cap's point is all but opposite to the view, their sum has few digits.
    assert!(beyond * 200 < queries.len() as u32, "{beyond} of {} facets", queries.len());
}

/// A sum of numbers up to 2 that is turned by it, and by 1 / alpha where the facet leans.
fn facet_agrees(query: &WarpQuery, answer: &WarpAnswer) -> bool {
    let [d, n] = [query.direction, query.normal].map(|v| DVec4::from_array(v.map(f64::from)).truncate());
    let (alpha, square) = (f64::from(query.alpha), DVec2::from_array(query.square.map(f64::from)));
    let facet = visible_normal(d, n, alpha, square);
    let off = (DVec4::from_array(answer.facet.map(f64::from)).truncate() - facet).length();
    let sine = facet.cross(n).length();
    let leaving = mirrored(d, facet).dot(n);
    let share = smith_g2_over_g1(-d.dot(n), leaving, alpha);
    let slips = (f64::from(answer.facet[3]) - share).abs() <= 2e-5 * (1.0 + 1.0 / leaving.abs());
    off <= 2e-6 + 2e-6 * sine / alpha && (slips || leaving < 0.01)
}

/// Chi-square of `count` points in equal cells, in standard deviations above its mean.
fn excess(cells: &[u32]) -> f64 {
    let count: u32 = cells.iter().sum();
    let expected = f64::from(count) / cells.len() as f64;
    let chi: f64 = cells.iter().map(|&n| (f64::from(n) - expected).powi(2) / expected).sum();
    let freedom = cells.len() as f64 - 1.0;
    (chi - freedom) / (2.0 * freedom).sqrt()
}

/// Sixteen sectors times eight rings of equal area.
fn cells(points: impl Iterator<Item = (f64, f64)>) -> Vec<u32> {
    let mut cells = vec![0; 128];
    for (angle, ring) in points {
        let sector = ((angle / TAU).rem_euclid(1.0) * 16.0) as usize % 16;
        cells[sector * 8 + ((ring * 8.0) as usize).min(7)] += 1;
    }
    cells
}

fn discs(warp: impl Fn(DVec2) -> DVec2) -> Vec<DVec2> {
    let mut rng = Rng::new(71);
    (0..100_000).map(|_| warp(DVec2::new(rng.between(0.0, 1.0), rng.between(0.0, 1.0)))).collect()
}

#[test]
fn discs_and_caps_are_filled_evenly() {
    let discs = discs(concentric_disc);
    assert!(discs.iter().all(|p| p.length() <= 1.0 + 1e-12));
    let found = excess(&cells(discs.iter().map(|p| (p.y.atan2(p.x), p.length_squared()))));
    assert!(found.abs() < 5.0, "disc: {found}");
    for height in HEIGHTS.map(f64::from) {
        let points: Vec<DVec3> = discs.iter().map(|&p| on_cap(p, height)).collect();
        assert!(points.iter().all(|p| (p.length() - 1.0).abs() < 1e-12), "off the sphere");
        // On a sphere zones of equal height have equal areas.
        let found = excess(&cells(points.iter().map(|p| (p.y.atan2(p.x), (1.0 - p.z) / height))));
        assert!(found.abs() < 5.0, "cap of height {height}: {found}");
    }
}

#[test]
fn an_uneven_disc_is_seen() {
    let polar = |p: DVec2| DVec2::from_angle(TAU * p.x) * p.y;
    let found = excess(&cells(discs(polar).iter().map(|p| (p.y.atan2(p.x), p.length_squared()))));
    assert!(found > 100.0, "{found}");
}

/// Neighbours in the square are neighbours on the disc: strata stay compact.
#[test]
fn neighbours_stay_neighbours() {
    let mut rng = Rng::new(72);
    for _ in 0..2000 {
        let p = DVec2::new(rng.between(0.0, 1.0), rng.between(0.0, 1.0));
        let q = p + DVec2::new(rng.between(-1e-3, 1e-3), rng.between(-1e-3, 1e-3));
        let (a, b) = (concentric_disc(p), concentric_disc(q));
        assert!(a.distance(b) <= 3.0 * p.distance(q), "{p} {q}");
    }
}
