//! Tests of the comparisons themselves: exact answers pass, and each planted error is detected.

use super::areas::box_mean;
use super::case::Point;
use super::filters::{RANGE, SIDE, cases, footprints};
use super::probing::{ROUNDING, noise, oracle, over, scene, worst_of};
use super::procedurals::{checker_mean, query as box_at, worst_checker};
use super::seams::worst_step;
use crate::lab::probe::LookupQuery;
use crate::pack::PackedScene;
use crate::texture::sampler_spec::{Filter, MipMode, SamplerSpec};

fn filtered(min: Filter) -> PackedScene {
    scene(noise(SIDE, SIDE), &[SamplerSpec { min, mip: MipMode::Linear, ..Default::default() }]).unwrap()
}

/// Returns the error of answers to lookups that were altered by `plant`.
fn planted(scene: &PackedScene, wide: f64, plant: impl Fn(&mut LookupQuery)) -> Point {
    let queries = footprints(scene, wide);
    let answer = |(i, query): (usize, &LookupQuery)| {
        let mut planted = *query;
        plant(&mut planted);
        [oracle(scene, i, &planted) as f32; 4]
    };
    let answers: Vec<[f32; 4]> = queries.iter().enumerate().map(answer).collect();
    worst_of(scene, wide, RANGE, &queries, &answers, |i, query| oracle(scene, i, query))
}

#[test]
fn a_hundredth_of_a_texel_or_of_a_width_is_above_the_bound_of_look_ups() {
    let texel = 1.0 / SIDE as f32;
    for (min, name) in
        [(Filter::Linear, "trilinear"), (Filter::Anisotropic, "anisotropic"), (Filter::Ewa, "elliptical")]
    {
        let bound = cases().iter().find(|case| case.name == name).unwrap().bound;
        let scene = filtered(min);
        for wide in [0.1, 3.3, 21.0] {
            assert!(planted(&scene, wide, |_| {}).error < 1e-7, "{min}: no error");
            assert!(planted(&scene, wide, |q| q.uv[0] += 0.01 * texel).error > bound, "{min}: moved");
            assert!(planted(&scene, wide, |q| q.uv.swap(0, 1)).error > bound, "{min}: u and v swapped");
        }
        for wide in [3.3, 21.0] {
            let wider =
                planted(&scene, wide, |q| (q.dx, q.dy) = (q.dx.map(|d| 1.01 * d), q.dy.map(|d| 1.01 * d)));
            assert!(wider.error > bound, "{min}: wider");
            assert!(planted(&scene, wide, |q| q.dx = [0.0; 4]).error > bound, "{min}: an axis lost");
        }
    }
}

#[test]
fn an_answer_that_is_no_number_has_an_endless_error() {
    let scene = filtered(Filter::Linear);
    let queries = footprints(&scene, 1.0);
    let mut answers = vec![[1.0; 4]; queries.len()];
    answers[7][0] = f32::NAN;
    assert_eq!(worst_of(&scene, 1.0, RANGE, &queries, &answers, |_, _| 1.0).error, f64::INFINITY);
}

#[test]
fn boxes_by_their_mean_tell_a_box_of_one_period_from_one_and_a_half() {
    let scene = filtered(Filter::SummedArea);
    let texels = noise(SIDE, SIDE);
    for (wide, detected) in [(1.5, true), (1.0, false)] {
        let query = over(&scene, 0, [0.3, 0.6], [[wide, 0.0], [0.0, 0.2]]);
        let period = over(&scene, 0, [0.3, 0.6], [[1.0, 0.0], [0.0, 0.2]]);
        let error = (box_mean(&texels, &query) - box_mean(&texels, &period)).abs() / RANGE;
        assert_eq!(error > 2e-5, detected, "{wide}: {error}");
        // The summed-area table agrees.
        assert!((oracle(&scene, 0, &query) - box_mean(&texels, &query)).abs() / RANGE < 1e-6);
    }
}

#[test]
fn steps_are_told_from_slopes() {
    let pair = [LookupQuery::default(); 2];
    let step = |apart: f32| worst_step(1e-3, 0.01, &pair, &[[1.0; 4], [1.0 + apart; 4]]).error;
    assert_eq!(step(0.009), 0.0);
    assert!(step(0.0101) > 4e-6 && step(f32::NAN) == f64::INFINITY);
}

#[test]
fn a_checker_that_forgets_where_a_box_ends_is_told() {
    // Four fifths of a box lie in the odd cell beside 1000.
    let query = box_at(0, [1001.3, 0.5, 0.5], [1.0, 0.0]);
    let exact = checker_mean(&query);
    assert!((exact - 0.8).abs() < 1e-4, "{exact}"); // the place is an f32
    let error = |value: f64| worst_checker(1.0, 1.0, &[query], &[[value as f32; 4]]).error;
    assert!(error(exact) < ROUNDING && error(exact + 2e-4) > 1.5e-4 && error(f64::NAN) == f64::INFINITY);
}
