//! The kernels: their values, that the sampling distribution is the kernel's integral, that the
//! prefilter's part has its variance, and that the response to a thin line is the kernel.

use moire::internal::oracle::pixel_filter::{filter_width, filtered_place};
use moire::internal::pack::{PackedScene, kernel};
use moire::internal::scene::model::{PixelFilter, PixelFilterKind};

use super::{filters, integral, squares, with};
use crate::stage::{render, render_on_oracle, small};

/// By hand from the formulas as they were published, in pixels at the default radius.
#[test]
fn kernels_have_their_published_values() {
    use PixelFilterKind::{BlackmanHarris, Box, Gaussian, Mitchell, Tent};
    let gauss = |x: f64| (-2.0 * x * x).exp() - (-4.5f64).exp();
    for (kind, x, value) in [
        (Box, 0.3, 1.0),
        (Tent, 0.25, 0.75),
        (Gaussian, 0.0, gauss(0.0)),
        (Gaussian, 0.7, gauss(0.7)),
        (Gaussian, 1.5, 0.0),
        // B-splines and Catmull-Rom, (B, C) = (1/3, 1/3): 8/9 in the middle, 1/18 at the next pixel.
        (Mitchell, 0.0, 8.0 / 9.0),
        (Mitchell, 1.0, 1.0 / 18.0),
        (Mitchell, 8.0 / 7.0, 0.0),
        (Mitchell, 1.5, -5.0 / 144.0),
        (Mitchell, 2.0, 0.0),
        (BlackmanHarris, 0.0, 1.0),
        (BlackmanHarris, 1.5, 6e-5),
    ] {
        let found = kernel(kind, x / kind.default_radius());
        assert!((found - value).abs() < 1e-12, "{kind} at {x}: {found}, not {value}");
        assert_eq!(kernel(kind, -x / kind.default_radius()), found);
    }
    assert!(PixelFilterKind::ALL.iter().all(|&kind| kernel(kind, 1.000_001) == 0.0));
}

fn packed(filter: PixelFilter) -> PackedScene {
    squares([4, 4], filter, 16, &[])
}

/// Of a number of samples placed evenly, those below each place, with their signs.
#[test]
fn samples_are_distributed_as_the_kernel_is() {
    const SAMPLES: u32 = 1 << 14;
    for filter in filters() {
        let scene = packed(filter);
        let places: Vec<(f64, f64)> = (0..SAMPLES)
            .map(|i| {
                // Beside a centre that is positive: the sign is that of x.
                let place = filtered_place(&scene, [i << 10 | 1 << 9, 1 << 23]);
                (place.inside.x - 0.5, place.sign)
            })
            .collect();
        let whole: f64 = places.iter().map(|p| p.1).sum();
        assert!(places.windows(2).all(|w| w[0].0 < w[1].0), "{filter:?} is not monotonic");
        let (mut sum, mut worst) = (0.0, 0f64);
        for (i, (x, sign)) in places.iter().enumerate() {
            sum += sign;
            if i % 512 == 0 {
                worst = worst.max(((sum - 0.5 * sign) / whole - integral(filter, -filter.radius, *x)).abs());
            }
        }
        // Half a step of the sum, and of a table with a zero in a cell 1.3e-4.
        let table = if filter.kind == PixelFilterKind::Mitchell { 1.3e-4 } else { 1e-6 };
        assert!(worst <= table + 0.6 / f64::from(SAMPLES), "{filter:?}: {worst:e}");
    }
}

#[test]
fn a_prefilter_covers_as_much_as_the_kernel_spreads() {
    for filter in filters() {
        let scene = packed(filter);
        let step = filter.radius / 5000.0;
        let middles = (-5000..5000).map(|i| (f64::from(i) + 0.5) * step);
        let moments = middles.fold((0.0, 0.0), |(one, two), x| {
            let f = kernel(filter.kind, x / filter.radius);
            (one + f, two + f * x * x)
        });
        let width = (12.0 * moments.1 / moments.0).sqrt();
        assert!((filter_width(&scene.header) / width - 1.0).abs() < 1e-5, "{filter:?}");
        let filtered = crate::stage::packed(with(small("filters", 8, 16), filter), None);
        let side = f64::from(filtered.samples).sqrt();
        assert!((filtered.header.sample_side * side / width - 1.0).abs() < 1e-5, "{filter:?}");
    }
    assert_eq!(filter_width(&packed(PixelFilter::default()).header), 1.0);
}

/// Pixels along a line's normal.
const PIXELS: usize = 20;
const SAMPLES: u32 = 1024;
/// Lines of 1/8 of a pixel, at 8 places in it, are all places.
const LINE: f64 = 0.125;

/// Samples of a (0, 2)-sequence: of 1024 one in each 1 / 1024 of the pixel, so that a line's fraction is off by two at
/// most, for signed ones by as many more where the sign changes (4 positions, and twice by the other axis).
fn bound(filter: PixelFilter) -> f64 {
    let counted = if filter.kind == PixelFilterKind::Mitchell { 12.0 } else { 2.0 };
    let table = if filter.kind == PixelFilterKind::Mitchell { 2.6e-4 } else { 2e-6 };
    counted / f64::from(SAMPLES) + table + 1e-6
}

/// A line at right angles to x or to y, `middle` pixels right of the picture's middle or above it; seen by
/// the pixels from left to right, or from below.
fn line(filter: PixelFilter, across: bool, middle: f64, oracle: bool) -> Vec<f64> {
    let (at, half) =
        if across { ([middle, 0.0], [0.5 * LINE, 99.0]) } else { ([0.0, middle], [99.0, 0.5 * LINE]) };
    let size = if across { [PIXELS as u32, 1] } else { [1, PIXELS as u32] };
    let scene = squares(size, filter, SAMPLES, &[(at, half)]);
    let film = if oracle { render_on_oracle(&scene) } else { render(&scene) };
    let mut seen: Vec<f64> = film.pixels.iter().map(|p| f64::from(p[0])).collect();
    if !across {
        seen.reverse();
    }
    seen
}

#[test]
fn lines_show_the_kernel_and_nothing_beyond_its_radius() {
    for filter in filters() {
        for (across, oracle) in [(true, false), (false, false), (true, true)] {
            let mut whole = 0.0;
            for phase in 0..8 {
                let middle = (f64::from(phase) + 0.5) * LINE;
                for (i, value) in line(filter, across, middle, oracle).into_iter().enumerate() {
                    let offset = middle - (i as f64 + 0.5 - 0.5 * PIXELS as f64);
                    let exact = integral(filter, offset - 0.5 * LINE, offset + 0.5 * LINE);
                    if offset.abs() > filter.radius + LINE {
                        assert_eq!(value, 0.0, "{filter:?} reaches {offset} pixels");
                    }
                    assert!(
                        (value - exact).abs() <= bound(filter),
                        "{filter:?} at {offset}: {value}, exactly {exact}, bound {:e}",
                        bound(filter)
                    );
                    whole += value;
                }
            }
            // All lines together are the plane.
            assert!((whole - 1.0).abs() < 6e-3, "{filter:?}: integral {whole}");
        }
    }
}

/// A square at the corner of four pixels, seen by all of them alike, and as the product of both axes.
#[test]
fn a_square_shows_the_product_of_both_axes() {
    for filter in filters() {
        let scene = squares([12, 12], filter, SAMPLES, &[([0.0, 0.0], [0.4, 0.4])]);
        let film = render(&scene);
        for (i, pixel) in film.pixels.iter().enumerate() {
            let off = [i % 12, i / 12].map(|p| p as f64 + 0.5 - 6.0);
            let exact: f64 = off.iter().map(|x| integral(filter, x - 0.4, x + 0.4)).product();
            // The square's rim is a tenth of all elementary intervals.
            assert!(
                (f64::from(pixel[0]) - exact).abs() < 6e-3,
                "{filter:?} at {off:?}: {} {exact}",
                pixel[0]
            );
        }
    }
}
