//! Device and oracle, lean and full pipelines, parts and the whole give the same picture.

use moire::internal::core::progress::NoProgress;
use moire::internal::core::range::Rect;
use moire::internal::integrators::adaptive::{self, Goal};
use moire::internal::lab::metrics::compare;
use moire::internal::oracle::backend::OracleBackend;
use moire::internal::pack::features::Features;
use moire::internal::render::{self, Tuning};
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, PixelFilter, PixelFilterKind, Scene};

use super::{filters, with};
use crate::stage::{
    assert_same_bits, cut, device, packed, render, render_on_oracle, render_with, small, with_random,
};

fn constant(features: &Features, name: &str) -> u32 {
    features.values.iter().find(|(n, _)| n.name() == name).unwrap().1
}

#[test]
fn a_box_of_one_pixel_is_left_out_and_changes_no_bit() {
    for name in ["s1a", "lecture", "filters"] {
        let plain = small(name, 70, 4);
        let named = with(plain.clone(), PixelFilter::new(PixelFilterKind::Box, Some(0.5)));
        let (plain, named) = (packed(plain, None), packed(named, None));
        assert_eq!(constant(&Features::new(&named, false, false), "WARPED"), 0);
        assert_same_bits(&render(&plain), &render(&named), name);
        let (full, _) = render_with(&named, true, &Tuning::default());
        assert_same_bits(&full, &render(&named), name);
    }
}

#[test]
fn other_filters_are_not_left_out() {
    for filter in filters() {
        let features = Features::new(&packed(with(small("s1a", 8, 4), filter), None), false, false);
        assert_eq!(constant(&features, "WARPED"), 1, "{filter:?}");
        assert_eq!(constant(&features, "PIXEL_FILTERS"), 1 << filter.kind as u32);
    }
}

#[test]
fn device_and_oracle_filter_alike() {
    for name in ["lecture", "s2", "zone_plate"] {
        for filter in filters() {
            let scene = packed(with(small(name, 64, 16), filter), None);
            let (device, oracle) = (render(&scene), render_on_oracle(&scene));
            let found = compare(&device, &oracle).unwrap();
            // One of 16 samples on the other side of an edge, in one pixel of thousands.
            assert!(found.rmse < 1e-3 && found.over_1_255 < 0.002, "{name}, {filter:?}: {:e}", found.rmse);
        }
    }
}

/// All code is compiled once for each, so a few represent all.
#[test]
fn what_is_left_out_changes_no_bit_of_a_filtered_picture() {
    let footprints = |mut scene: Scene| {
        scene.sampling.footprint = Footprint::Differentials;
        scene
    };
    for (scene, filter) in [
        (small("lecture", 70, 4), PixelFilter::new(PixelFilterKind::Tent, None)),
        (footprints(small("filters", 70, 4)), PixelFilter::new(PixelFilterKind::Mitchell, None)),
        // More samples than one block holds.
        (with_random(small("lights", 24, 1), 600), PixelFilter::new(PixelFilterKind::Mitchell, None)),
        (small("s2", 40, 4), PixelFilter::new(PixelFilterKind::BlackmanHarris, None)),
        (small("s2", 40, 4), PixelFilter::new(PixelFilterKind::Box, Some(2.0))),
    ] {
        let scene = packed(with(scene, filter), None);
        let (lean, _) = render_with(&scene, false, &Tuning::default());
        let (full, _) = render_with(&scene, true, &Tuning::default());
        assert_same_bits(&lean, &full, &format!("{filter:?}"));
    }
}

/// Filters reach over the edges of crops, and of the picture, where nothing else ends.
#[test]
fn a_crop_of_a_filtered_picture_has_its_pixels() {
    for filter in filters() {
        let scene = with(small("lecture", 80, 4), filter);
        let full = render(&packed(scene.clone(), None));
        for crop in [Rect { x: 0, y: 0, width: 3, height: 2 }, Rect { x: 17, y: 30, width: 30, height: 21 }] {
            let part = render(&packed(scene.clone(), Some(crop)));
            assert_same_bits(&part, &cut(&full, crop), &format!("{filter:?}, {crop:?}"));
        }
    }
}

/// On a CPU device a film this wide takes several bands, of both kinds.
#[test]
fn bands_and_pages_change_no_bit_of_a_filtered_picture() {
    for algorithm in [Algorithm::Samples, Algorithm::Adaptive] {
        let mut scene = with(small("quad", 96, 1), PixelFilter::new(PixelFilterKind::Mitchell, None));
        (scene.width, scene.height) = (16_384, 300);
        (scene.sampling.pattern, scene.sampling.spp) = (Pattern::SobolOwen, 2);
        scene.sampling.algorithm = algorithm;
        let full = render(&packed(scene.clone(), None));
        let crop = Rect { x: 8000, y: 250, width: 100, height: 30 };
        let part = render(&packed(scene, Some(crop)));
        assert_same_bits(&part, &cut(&full, crop), &format!("{algorithm}"));
    }
}

fn adaptively(filter: PixelFilter, footprint: Footprint) -> Scene {
    // Without a footprint, pixels near a horizon differ by rounding.
    let name = if footprint == Footprint::None { "s2" } else { "filters" };
    let mut scene = with(small(name, 64, 4), filter);
    scene.sampling.algorithm = Algorithm::Adaptive;
    (scene.sampling.pattern, scene.sampling.spp) = (Pattern::SobolOwen, 2);
    scene.sampling.footprint = footprint;
    scene
}

#[test]
fn adaptive_samples_are_filtered_alike_by_device_and_oracle() {
    for filter in filters() {
        for footprint in [Footprint::None, Footprint::Cone] {
            let scene = packed(adaptively(filter, footprint), None);
            let (width, height) = (scene.header.film_size.x, scene.header.film_size.y);
            let mut backend = OracleBackend::new(&scene).unwrap();
            let oracle = adaptive::run(
                &mut backend,
                moire::internal::core::film::Film::new(width, height, 0),
                Goal::Samples(2),
                false,
                None,
                &NoProgress,
            )
            .unwrap()
            .film;
            let rendered = render::render_to_goal(
                &device(),
                scene,
                false,
                &Tuning::default(),
                Some(Goal::Samples(2)),
                &NoProgress,
            );
            let found = compare(&rendered.unwrap().0, &oracle).unwrap();
            assert!(found.rmse < 2e-3, "{filter:?}, {footprint}: {:e}", found.rmse);
        }
    }
}

#[test]
fn adaptive_pictures_converge_to_the_filtered_one() {
    for filter in filters() {
        let mut scene = with(small("s2", 64, 4), filter);
        (scene.sampling.pattern, scene.sampling.spp) = (Pattern::SobolOwen, 4096);
        let reference = render(&packed(scene.clone(), None));
        scene.sampling.algorithm = Algorithm::Adaptive;
        let scene = packed(scene, None);
        let goal = Goal::Error(4e-3);
        let rendered =
            render::render_to_goal(&device(), scene, false, &Tuning::default(), Some(goal), &NoProgress);
        let (film, report) = rendered.unwrap();
        let error = compare(&film, &reference).unwrap().rmse;
        // The estimate has a sigma of 5 % at this size.
        assert!(error < 4.6e-3, "{filter:?}: {error:e}, {:?}", report.outcome);
    }
}
