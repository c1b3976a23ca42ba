//! Negative lobes: pictures from samples with signed weights. Pixels beside an edge overshoot, a
//! constant colour is preserved, and no sum of few weights makes a pixel diverge.

use moire::internal::core::film::Film;
use moire::internal::output::{WriteOptions, write};
use moire::internal::pack::filtered_mean;
use moire::internal::scene::check_spp;
use moire::internal::scene::model::{Algorithm, Pattern, PixelFilter, PixelFilterKind};

use super::{filters, squares};
use crate::stage::{packed, render, render_on_oracle, small};

const MITCHELL: PixelFilter = PixelFilter { kind: PixelFilterKind::Mitchell, radius: 2.0 };

/// One colour, whatever the filter, the pattern and the number of samples, on device and oracle: with few samples, half
/// or all may be in negative lobes.
#[test]
fn one_colour_stays_one_colour() {
    const COLOR: [f32; 3] = [0.7, 0.5, 3.0];
    for filter in filters() {
        for &pattern in Pattern::ALL {
            for count in [1, 2, 3, 4, 16, 64, 256] {
                let mut scene = super::with(small("quad", 24, 1), filter);
                scene.shapes.planes.clear();
                scene.background.color = glam::Vec3::from_array(COLOR).as_dvec3();
                (scene.sampling.pattern, scene.sampling.spp) = (pattern, count);
                if check_spp(pattern, count).is_err() {
                    continue;
                }
                let name = format!("{filter:?}, {pattern}, {count} samples");
                let scene_of = |algorithm| {
                    let mut scene = scene.clone();
                    scene.sampling.algorithm = algorithm;
                    packed(scene, None)
                };
                let samples = scene_of(Algorithm::Samples);
                assert_one_color(&render(&samples), COLOR, &name);
                assert_one_color(&render_on_oracle(&samples), COLOR, &name);
                if pattern.stops_anywhere() && count >= 16 {
                    assert_one_color(
                        &render(&scene_of(Algorithm::Adaptive)),
                        COLOR,
                        &format!("adaptive {name}"),
                    );
                }
            }
        }
    }
}

/// An f32 sum of 64 equal terms errs by 1e-6 of itself at worst (`render_main.glsl`), and so does the mean.
fn assert_one_color(film: &Film, color: [f32; 3], name: &str) {
    for (value, wanted) in film.pixels.iter().flat_map(|p| p.iter().zip(color)) {
        assert!((value - wanted).abs() <= 1e-6 * wanted, "{name}: {value} for {wanted}"); // the sum's roundings
    }
}

/// The filters whose sums of the lobes from 3/2 pixels on are -1/128.
#[test]
fn an_edge_overshoots_on_both_sides_and_files_clip_it() {
    // Everything right of the middle is white.
    let scene = squares([16, 4], MITCHELL, 1024, &[([50.0, 0.0], [50.0, 90.0])]);
    for film in [render(&scene), render_on_oracle(&scene)] {
        let row: Vec<f32> = film.pixels[32..48].iter().map(|p| p[0]).collect();
        let exact = super::integral(MITCHELL, 1.5, 2.0);
        assert!((exact + 1.0 / 128.0).abs() < 1e-6, "{exact}");
        assert!((f64::from(row[6]) - exact).abs() < 4e-3, "{row:?}");
        assert!((f64::from(row[9]) - (1.0 - exact)).abs() < 4e-3, "{row:?}");
        let folder = tempfile::tempdir().unwrap();
        for (ending, least) in [("png", 0.0), ("jpg", 0.0), ("hdr", 0.0), ("exr", exact as f32 - 4e-3)] {
            let path = folder.path().join(format!("edge.{ending}"));
            write(&film, &path, &WriteOptions::default()).unwrap();
            let read: Film = moire::internal::lab::metrics::read_picture(&path).unwrap();
            let darkest = read.pixels.iter().flatten().copied().fold(f32::INFINITY, f32::min);
            assert!(darkest >= least, "{ending}: {darkest}");
            assert_eq!(ending == "exr", darkest < 0.0, "{ending}: {darkest}");
        }
    }
}

/// Samples of 1, 1, 1 and 5, by hand.
#[test]
fn signs_that_cancel_leave_what_they_are_on_average() {
    let mean = 0.5;
    // All positive: the plain mean 2, and the excess of the signs over their average.
    assert_eq!(filtered_mean(8.0, 0.0, 4.0, 4.0, mean), 2.0);
    // The sample of 5 is negative: -2 with signs of 2, 2 plain, 2 + (-2 - 2 * 2) / (4 * 0.5).
    assert_eq!(filtered_mean(-2.0, 5.0, 2.0, 4.0, mean), -1.0);
    // Two of 1 are negative: 4 with signs of 0.
    assert_eq!(filtered_mean(4.0, 2.0, 0.0, 4.0, mean), 4.0);
    // One colour, whatever the signs.
    for signs in [-4.0, -2.0, 0.0, 2.0, 4.0] {
        assert_eq!(filtered_mean(3.0 * signs, 3.0 * (4.0 - signs) / 2.0, signs, 4.0, mean), 3.0);
    }
}

/// No pixel exceeds the picture's colours, 0 to 1, by more than twice the negative part of |f|.
#[test]
fn few_samples_explode_in_no_pixel() {
    let mut scene = super::with(small("quad", 96, 1), MITCHELL);
    scene.sampling.pattern = Pattern::Random;
    for count in [2, 3, 4, 8] {
        scene.sampling.spp = count;
        let scene = packed(scene.clone(), None);
        let mean = scene.mean_sign.unwrap();
        let film = render(&scene);
        let outside = film.pixels.iter().flatten().map(|v| (v - 0.5).abs() - 0.5).fold(0.0, f32::max);
        // plain + (sum - plain * signs) / (samples * mean): |sum - plain * signs| <= samples.
        assert!(f64::from(outside) <= 1.0 / mean, "{count} samples: {outside} outside");
    }
}
