//! Procedural patterns over a box of texture space as exact areas, cell by cell; and means of many samples
//! as exact counts.

use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::procedural::figure_share;
use moire::internal::oracle::render::pixel;
use moire::internal::pack;
use moire::internal::texture::procedural::{Procedural, ProceduralKind};
use num_traits::{Signed, Zero};

use super::numbers::{Q, approx, frac, q};
use super::scenes::{AHEAD, packed_as};
use super::{U, Worst};

/// Returns the mean over [x − w/2, x + w/2] of a function that is 1 `inside` a cell from 0 to 1, by the length of each
/// part.
fn mean(x: f64, w: f64, pieces: impl Fn(i64) -> Vec<(Q, Q, i64)>) -> Q {
    let half = q(w) / frac(2, 1);
    let [low, high] = [q(x) - &half, q(x) + &half];
    let first = i64::try_from(low.floor().to_integer()).unwrap();
    let last = i64::try_from(high.floor().to_integer()).unwrap();
    let mut sum = Q::zero();
    for cell in first - 1..=last + 1 {
        for (from, to, value) in pieces(cell) {
            let from = (frac(cell, 1) + from).max(low.clone());
            let to = (frac(cell, 1) + to).min(high.clone());
            if w == 0.0 {
                // A point belongs to the part that begins there.
                continue;
            }
            sum += (to - from).max(Q::zero()) * frac(value, 1);
        }
    }
    if w == 0.0 { point(x, pieces) } else { sum / q(w) }
}

fn point(x: f64, pieces: impl Fn(i64) -> Vec<(Q, Q, i64)>) -> Q {
    let cell = i64::try_from(q(x).floor().to_integer()).unwrap();
    let within = |n: i64| {
        let place = q(x) - frac(n, 1);
        pieces(n)
            .into_iter()
            .filter(move |(from, to, _)| *from <= place && place < *to)
            .map(|p| p.2)
            .sum::<i64>()
    };
    frac((cell - 1..=cell + 1).map(within).sum(), 1)
}

/// +1 in even cells, −1 in odd ones.
fn parity(cell: i64) -> Vec<(Q, Q, i64)> {
    vec![(frac(0, 1), frac(1, 1), 1 - 2 * cell.rem_euclid(2))]
}

/// The figure's share: of a checker where the cells' numbers add up to odd, of stripes where the fraction of x
/// is below the width, of a grid on lines around whole numbers.
fn exact(what: &Procedural, at: DVec3, w: DVec3) -> Q {
    let width = q(what.width.into());
    let one = frac(1, 1);
    match what.kind {
        ProceduralKind::Checker => {
            let wave: Q = (0..3).map(|i| mean(at[i], w[i], parity)).product();
            (one - wave) / frac(2, 1)
        }
        ProceduralKind::Stripes => mean(at.x, w.x, |_| vec![(frac(0, 1), width.clone(), 1)]),
        _ => {
            let line = |i: usize| {
                let half = &width / frac(2, 1);
                mean(at[i], w[i], |_| vec![(-half.clone(), half.clone(), 1)])
            };
            let between = (0..what.dimensions as usize).map(|i| frac(1, 1) - line(i)).product::<Q>();
            one - between
        }
    }
}

fn compare(share: impl Fn(&moire::internal::schema::layout::Procedural, DVec3, DVec3) -> f64) -> Worst {
    let mut rng = Rng::new(121);
    let mut worst = Worst::default();
    for kind in [ProceduralKind::Checker, ProceduralKind::Stripes, ProceduralKind::Grid] {
        for width in [0.1f32, 0.5, 0.9] {
            let what = Procedural { width, ..Procedural::new(kind) };
            let record = pack::procedural(&what);
            for i in 0..60 {
                let reach = [2.0, 1e3, 1e9][i % 3];
                let at = super::numbers::vector(&mut rng, reach);
                // A footprint in the plane z = const, from none to 40 cells.
                let wide =
                    |rng: &mut Rng| [0.0, 1e-6, 0.03, 0.5, 2.0, 13.7, 40.0][(rng.unit() * 7.0) as usize];
                let w = DVec3::new(wide(&mut rng), wide(&mut rng), 0.0) * rng.between(0.5, 1.0);
                // A point is rounded to U of itself when whole cells are subtracted, and a box as wide as its error is
                // meaningless.
                let narrow = |w: f64| if w > 0.0 { 16.0 * U / w } else { 0.0 };
                let bound = 16.0 * U + narrow(w.x) + narrow(w.y);
                worst.add(share(&record, at, w), &exact(&what, at, w), bound);
            }
        }
    }
    worst
}

fn of_box(what: &moire::internal::schema::layout::Procedural, at: DVec3, w: DVec3) -> f64 {
    figure_share(what, at, DVec3::X * w.x, DVec3::Y * w.y)
}

#[test]
fn checkers_stripes_and_grids_have_their_exact_share_of_a_box() {
    compare(of_box).holds("areas");
}

#[test]
fn planted_errors_of_areas_are_told() {
    compare(|what, at, w| 1.0 - of_box(what, at, w)).fails("figure and ground");
    compare(|what, at, w| of_box(what, at + 0.5 / 256.0, w)).fails("half a texel of 256");
    compare(|what, at, w| of_box(what, at, 1.01 * w)).fails("a footprint a hundredth wider");
    compare(|what, at, w| of_box(what, at, DVec3::new(w.y, w.x, 0.0))).fails("swapped axes");
}

const CORNERS: [[f64; 2]; 3] = [[-0.71, -0.63], [0.917, -0.211], [0.1003, 0.8117]];

/// A triangle ahead, in a picture of one pixel.
fn triangle(side: u32) -> f64 {
    let corners = CORNERS.map(|[x, y]| format!("[{x:?}, {y:?}, -1]"));
    let text = format!(
        "{AHEAD}[[material]]\nname = 'm'\nmodel = 'unlit'\ncolor = [0.1, 1, 1]\n[[triangle]]\nvertices = [{}]\nmaterial = 'm'\n",
        corners.join(", ")
    );
    let rest = format!(
        "[image]\nwidth = 1\nheight = 1\n[sampling]\npattern = 'grid'\nspp = {}\nprecision = 'double'\n",
        side * side
    );
    pixel(&packed_as(&text, &rest).1, 0, 0).x
}

/// How many of the grid's cells have their middle in the triangle.
fn inside(side: i64) -> i64 {
    let corners = CORNERS.map(|c| c.map(q));
    let holds = |x: &Q, y: &Q| {
        let turn = |i: usize| {
            let ([ax, ay], [bx, by]) = (&corners[i], &corners[(i + 1) % 3]);
            (bx - ax) * (y - ay) - (by - ay) * (x - ax)
        };
        (0..3).all(|i| turn(i).is_positive())
    };
    let middle = |i: i64| frac(2 * i + 1, side) - frac(1, 1);
    (0..side * side).filter(|i| holds(&middle(i % side), &-middle(i / side))).count() as i64
}

#[test]
fn a_mean_over_a_grid_of_samples_is_the_exact_count_inside_the_outline() {
    let color = q(0.1f32.into());
    for side in [1, 2, 16, 64] {
        let mut worst = Worst::default();
        let share = frac(inside(side.into()), i64::from(side * side));
        // A sum of as many terms.
        worst.add(triangle(side), &(share * &color), f64::from(side * side) * U * approx(&color));
        worst.holds("a mean of samples");
    }
    let mut worst = Worst::default();
    let one_more = frac(inside(64) + 1, 4096);
    worst.add(triangle(64), &(one_more * color), 4096.0 * U);
    worst.fails("one sample more");
}

#[test]
fn the_mean_of_65536_equal_samples_is_the_sample() {
    let rest = "[image]\nwidth = 1\nheight = 1\n[background]\ncolor = [0.1, 0.3, 0.7]\n[sampling]\npattern = 'random'\nspp = 65536\nprecision = 'double'\n";
    let (_, scene) = packed_as(AHEAD, rest);
    let seen = pixel(&scene, 0, 0);
    for (k, color) in [0.1f32, 0.3, 0.7].into_iter().enumerate() {
        let mut worst = Worst::default();
        worst.add(seen[k], &q(color.into()), 65536.0 * U * f64::from(color));
        worst.holds("65536 samples");
    }
}
