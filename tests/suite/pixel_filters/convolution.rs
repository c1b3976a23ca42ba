//! Pictures with a filter against the definition: a finely sampled picture, convolved with the analytic kernel
//! in float64.

use moire::internal::core::film::Film;
use moire::internal::scene::model::{Pattern, PixelFilter, PixelFilterKind, Projection, Scene};

use super::{filters, integral, with};
use crate::stage::{packed, render_on_oracle, small};

/// Fine pixels along the side of one.
const FINE: u32 = 12;
/// Margin in pixels beyond which no filter's support crosses the picture's edge.
const MARGIN: usize = 2;

fn scene(name: &str, size: u32, spp: u32, seed: u32) -> Scene {
    let mut scene = small(name, size, 1);
    (scene.width, scene.height) = (scene.width / 4 * 4, scene.height / 4 * 4);
    if let Projection::Orthographic(height) = &mut scene.camera.projection {
        // Of the zone plate, up to one period a pixel.
        *height *= 0.4;
    }
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.spp = spp;
    scene.sampling.seed = seed;
    scene
}

/// The weighted sum of fine pixels around each pixel inside the margin.
fn convolved(fine: &Film, filter: PixelFilter) -> Vec<[f64; 3]> {
    let side = FINE as usize;
    let (width, height) = (fine.width as usize / side, fine.height as usize / side);
    let reach = MARGIN * side;
    let weights: Vec<f64> = (0..2 * reach + side)
        .map(|i| {
            let from = (i as f64 - reach as f64) / side as f64 - 0.5;
            integral(filter, from, from + 1.0 / side as f64)
        })
        .collect();
    let mut out = Vec::new();
    for y in MARGIN..height - MARGIN {
        for x in MARGIN..width - MARGIN {
            let mut sum = [0.0; 3];
            for (j, wy) in weights.iter().enumerate() {
                let row = (y * side + j - reach) * fine.width as usize + x * side - reach;
                for (wx, pixel) in weights.iter().zip(&fine.pixels[row..]) {
                    (0..3).for_each(|c| sum[c] += wx * wy * f64::from(pixel[c]));
                }
            }
            out.push(sum);
        }
    }
    out
}

fn inside(film: &Film) -> Vec<[f64; 3]> {
    let (width, height) = (film.width as usize, film.height as usize);
    let at = |x: usize, y: usize| film.pixels[y * width + x].map(f64::from);
    (MARGIN..height - MARGIN).flat_map(|y| (MARGIN..width - MARGIN).map(move |x| at(x, y))).collect()
}

fn rmse(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(p, q)| (p - q).powi(2));
    (squares.sum::<f64>() / (3 * a.len()) as f64).sqrt()
}

/// The difference of two seeds has twice the variance of each, for the filtered picture and for the fine one
/// alike.
#[test]
fn filtered_pictures_are_convolutions_of_fine_ones() {
    for name in ["lecture", "zone_plate"] {
        let [fine, other] = [11, 12].map(|seed| {
            let mut scene = with(scene(name, 28, 4, seed), PixelFilter::default());
            (scene.width, scene.height) = (scene.width * FINE, scene.height * FINE);
            render_on_oracle(&packed(scene, None))
        });
        for filter in filters() {
            let [a, b] = [1, 2].map(|seed| {
                inside(&render_on_oracle(&packed(with(scene(name, 28, 256, seed), filter), None)))
            });
            let [exact, again] = [&fine, &other].map(|film| convolved(film, filter));
            let noise = (0.5 * rmse(&a, &b).powi(2) + 0.5 * rmse(&exact, &again).powi(2)).sqrt();
            let apart = rmse(&a, &exact);
            // About 1500 numbers: a sigma of either root mean square is 2 %. Beside it the error of the table
            // and, for signed samples, of a quotient of sums.
            assert!(apart <= 1.15 * noise + 3e-4, "{name}, {filter:?}: {apart:e}, noise {noise:e}");
            // Another filter, and the same filter a tenth narrower, are distinguished.
            for wrong in [
                PixelFilter { radius: 0.9 * filter.radius, ..filter },
                PixelFilter::new(PixelFilterKind::Box, None),
            ] {
                let wrong = rmse(&a, &convolved(&fine, wrong));
                assert!(wrong > 1.15 * noise + 3e-4, "{name}, {filter:?} passes for another: {wrong:e}");
            }
        }
    }
}
