//! Negative lobes: what samples with signs come to. Pixels beside an edge overshoot, one colour stays that
//! colour, and no sum of few signs makes a pixel explode.

use moire::film::Film;
use moire::output::{WriteOptions, write};
use moire::pack::divisor;
use moire::scene::model::{Algorithm, Pattern, PixelFilter, PixelFilterKind};

use super::{filters, squares};
use crate::stage::{packed, render, render_on_oracle, small};

const MITCHELL: PixelFilter = PixelFilter { kind: PixelFilterKind::Mitchell, radius: 2.0 };

/// With samples enough that signs cannot cancel: one colour, exactly, whatever the pattern.
#[test]
fn one_colour_stays_one_colour() {
    for filter in filters() {
        for &pattern in Pattern::ALL {
            for algorithm in [Algorithm::Samples, Algorithm::Adaptive] {
                if algorithm.is_adaptive() && !pattern.stops_anywhere() {
                    continue;
                }
                let mut scene = super::with(small("quad", 12, 1), filter);
                scene.planes.clear();
                scene.background.color = glam::DVec3::new(0.25, 0.5, 3.0);
                (scene.sampling.pattern, scene.sampling.spp) = (pattern, 64);
                scene.sampling.algorithm = algorithm;
                let scene = packed(scene, None);
                let film = render(&scene);
                for (value, wanted) in film.pixels.iter().flat_map(|p| p.iter().zip([0.25f32, 0.5, 3.0])) {
                    assert!((value - wanted).abs() <= 1e-6 * wanted, "{filter:?}, {pattern}: {value}");
                }
            }
        }
    }
}

/// Whose sums of the lobes from 3/2 pixels on are -1/128.
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
            let read: Film = moire::metrics::read_picture(&path).unwrap();
            let darkest = read.pixels.iter().flatten().copied().fold(f32::INFINITY, f32::min);
            assert!(darkest >= least, "{ending}: {darkest}");
            assert_eq!(ending == "exr", darkest < 0.0, "{ending}: {darkest}");
        }
    }
}

#[test]
fn few_signs_divide_by_what_they_are_on_average() {
    let mean = 0.87;
    assert_eq!(divisor(14.0, 16.0, mean), 14.0);
    assert_eq!(divisor(8.0, 16.0, mean), 8.0);
    assert_eq!(divisor(6.0, 16.0, mean), 16.0 * mean);
    assert_eq!(divisor(0.0, 2.0, mean), 2.0 * mean);
    assert_eq!(divisor(-1.0, 1.0, mean), -1.0);
    let mut scene = super::with(small("quad", 96, 1), MITCHELL);
    (scene.sampling.pattern, scene.sampling.spp) = (Pattern::Random, 2);
    let film = render(&packed(scene, None));
    assert!(film.pixels.iter().flatten().all(|v| v.is_finite() && v.abs() < 3.0));
}
