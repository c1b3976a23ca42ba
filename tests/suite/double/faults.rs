//! Regression tests of past faults, one each: the cases of the stability report that exposed them,
//! over part of their sweep.

use moire::internal::core::progress::NoProgress;
use moire::internal::lab::stability::all;
use moire::internal::lab::stability::case::{Bench, Point};

use crate::stage::device;

/// The worst point over the bound.
fn worst(group: &str, name: &str, rounded: bool) -> (f64, Vec<Point>) {
    let case = all().into_iter().find(|c| (c.group, c.name) == (group, name)).unwrap();
    let device = device();
    let points = (case.run)(&Bench { rounded, ..Bench::new(&device, &NoProgress) }).unwrap();
    assert!(!points.is_empty());
    (points.iter().map(|p| p.error - case.bound).fold(f64::NEG_INFINITY, f64::max), points)
}

/// Every point of the case is within its bound.
fn within(group: &str, name: &str) {
    let (beyond, points) = worst(group, name, false);
    assert!(beyond <= 0.0, "{group}/{name}: {points:?}");
}

#[test]
fn a_texture_that_repeats_a_billion_times_a_unit_is_read_where_it_should_be() {
    within("coordinates", "scale");
}

#[test]
fn axes_a_hundred_millionth_of_a_radian_apart_still_span_their_plane() {
    within("coordinates", "collinear-axes");
}

#[test]
fn rays_nearly_parallel_to_a_plane_meet_it_where_they_should() {
    within("horizon", "grazing");
}

#[test]
fn a_ball_ten_billion_radii_away_keeps_its_outline_and_its_texture() {
    within("spheres", "distance");
}

#[test]
fn a_planet_seen_from_its_surface_keeps_its_horizon() {
    within("spheres", "horizon");
}

#[test]
fn needles_a_million_times_as_long_as_wide_keep_their_edges() {
    within("triangles", "needles");
}

#[test]
fn a_scene_of_any_size_is_lit_and_mirrored_alike() {
    within("transforms", "scaled");
}

#[test]
fn a_lit_ball_of_any_size_has_no_acne() {
    within("origins", "lit-ball");
}

#[test]
fn a_lit_ball_far_away_has_no_acne() {
    within("origins", "lit-ball-far");
}

#[test]
fn no_light_leaks_into_a_closed_box_of_any_size() {
    within("origins", "closed-box");
}

#[test]
fn glass_of_index_1_of_any_size_is_not_there() {
    within("origins", "glass-ball");
}

/// The cases are effective: each fails by far if all geometry is f32.
#[test]
fn in_f32_the_cases_of_geometry_are_broken() {
    for (group, name, least) in [
        ("coordinates", "triangle", 100.0),
        ("horizon", "height-in-f64", 100.0),
        ("spheres", "distance", 10.0),
        ("spheres", "radius", 10.0),
        ("spheres", "horizon", 1.0),
        ("origins", "lit-ball-far", 100.0),
    ] {
        let (beyond, points) = worst(group, name, true);
        assert!(beyond > least, "{group}/{name}: {points:?}");
    }
}
