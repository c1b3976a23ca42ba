//! The integral of a texture over a polygon in texture space, by Green's theorem: ∬ c dX dY = ∮ C dY, where C
//! is the integral of c along its row, from a table of prefix sums. Every edge is traversed cell by cell, and
//! in each cell C is a polynomial, so the integral is exact for the reconstruction between texels (Heckbert
//! 1986, "Filtering by repeated integration", for boxes). Twin of `glsl/shared/prefix_sums.glsl`.

use glam::{DVec2, DVec3};

use super::grid::{Codes, Grid, Sums, addressed_row, codes_at, plus};
use super::polygon::{Polygon, at, middle};
use super::projective::RationalMap;

/// The start of the integrals along a row.
struct Row {
    first: i64,
    start: Codes,
}

fn load_row(grid: &Grid, base: [i64; 2], j: i64) -> Row {
    let first = addressed_row(grid, base[1] + j);
    Row { first, start: codes_at(grid, first, base[0]) }
}

/// Converts to signed numbers.
fn signed(codes: Sums) -> DVec3 {
    DVec3::from_array(codes.map(|code| f64::from(code as i32)))
}

/// A cell of a row: its texel and the next one, and the integral from the centre of the base's texel to that
/// of its own, or from edge to edge if colours are constant per texel.
struct Stretch {
    own: DVec3,
    right: DVec3,
    whole: DVec3,
}

fn stretch(grid: &Grid, row: &Row, i: i64) -> Stretch {
    let here = codes_at(grid, row.first, i);
    let own = signed(here.own);
    let whole = signed(plus(here.before, -1, row.start.before));
    if !grid.linear {
        return Stretch { own, right: own, whole };
    }
    let right = signed(codes_at(grid, row.first, i + 1).own);
    Stretch { own, right, whole: whole + 0.5 * (own - signed(row.start.own)) }
}

/// Returns the integral of a row's colour up to position s in the cell.
fn along_row(grid: &Grid, row: &Stretch, s: f64) -> DVec3 {
    let sum = row.whole + s * row.own;
    if grid.linear { sum + (0.5 * s * s) * (row.right - row.own) } else { sum }
}

/// Returns the number of grid lines that an edge crosses.
fn cells_between(a: DVec2, b: DVec2) -> u32 {
    let cells = (b.floor() - a.floor()).abs();
    (cells.x + cells.y) as u32
}

/// 1 / √3
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Returns ∫ C dY from a to b; positions count from cell `base`.
fn edge_integral(grid: &Grid, base: [i64; 2], a: DVec2, b: DVec2) -> DVec3 {
    let way = b - a;
    let mut cell = [a.x.floor() as i64, a.y.floor() as i64];
    let last = [b.x.floor() as i64, b.y.floor() as i64];
    let forward = [way.x > 0.0, way.y > 0.0];
    // The parameter at which the edge meets the next grid line.
    let next = |axis: usize, cell: [i64; 2]| {
        let line = (cell[axis] + i64::from(forward[axis])) as f64;
        if way[axis] == 0.0 { 1.0 } else { ((line - a[axis]) / way[axis]).clamp(0.0, 1.0) }
    };
    let rows = if grid.linear { 2 } else { 1 };
    let mut sum = DVec3::ZERO;
    let mut done = 0.0;
    for _ in 0..=cells_between(a, b) {
        let ends = [next(0, cell), next(1, cell)];
        let axis = usize::from(cell[0] == last[0] || (cell[1] != last[1] && ends[1] < ends[0]));
        let end = if cell == last { 1.0 } else { ends[axis].max(done) };
        let half = 0.5 * (end - done);
        // Gauss-Legendre quadrature with two points: exact for cubics along the edge.
        let corner = DVec2::new(cell[0] as f64, cell[1] as f64);
        let place = |sign: f64| {
            (a + way * (done + half * (1.0 + sign * GAUSS)) - corner).clamp(DVec2::ZERO, DVec2::ONE)
        };
        for r in 0..rows {
            let row = load_row(grid, base, cell[1] + r);
            let s = stretch(grid, &row, base[0] + cell[0]);
            for place in [place(-1.0), place(1.0)] {
                let weight = match (grid.linear, r) {
                    (false, _) => 1.0,
                    (true, 0) => 1.0 - place.y,
                    (true, _) => place.y,
                };
                sum += half * weight * along_row(grid, &s, place.x);
            }
        }
        done = end;
        cell[axis] += if forward[axis] { 1 } else { -1 };
    }
    sum * way.y
}

/// Returns the colour at a position in a cell.
fn value_in(grid: &Grid, cell: [i64; 2], within: DVec2) -> DVec3 {
    let row = |j: i64| stretch(grid, &load_row(grid, cell, j), cell[0]);
    let value = |s: &Stretch| s.own.lerp(s.right, within.x);
    if grid.linear { value(&row(0)).lerp(value(&row(1)), within.y) } else { row(0).own }
}

/// In cells.
const FARTHEST: DVec2 = DVec2::splat(1e8);
/// A smaller polygon has the colour at its centre.
pub const SMALLEST: f64 = 1.0 / 256.0;

/// Returns the map from the picture to the grid, relative to a base that is subtracted before the division,
/// so that differences of near positions are exact.
pub fn in_grid(grid: &Grid, quotient: &RationalMap, base: [i64; 2]) -> RationalMap {
    let start = DVec2::splat(grid.shift) - DVec2::new(base[0] as f64, base[1] as f64);
    RationalMap {
        u: grid.scale.x * quotient.u + start.x * quotient.below,
        v: grid.scale.y * quotient.v + start.y * quotient.below,
        below: quotient.below,
    }
}

/// Maps a position; towards the horizon it would go to infinity.
fn place_in(quotient: &RationalMap, place: DVec2) -> DVec2 {
    let at_place = DVec2::new(at(quotient.u, place), at(quotient.v, place)) / at(quotient.below, place);
    at_place.clamp(-FARTHEST, FARTHEST)
}

fn places<'a>(polygon: &'a Polygon, quotient: &'a RationalMap) -> impl Iterator<Item = [DVec2; 2]> + 'a {
    let place = |k: usize| place_in(quotient, polygon.corners[k % polygon.count]);
    (0..polygon.count).map(move |k| [place(k), place(k + 1)])
}

/// Returns the length of the longest edge of a polygon, in cells.
pub fn longest_edge(polygon: &Polygon, quotient: &RationalMap) -> f64 {
    places(polygon, quotient).map(|[a, b]| (b - a).abs().element_sum()).fold(0.0, f64::max)
}

/// An edge counts as horizontal if it rises by less than this fraction of the polygon's height: its integral
/// is smaller than the rounding error.
const LEVEL: f64 = 3e-5;

fn rows_covered(polygon: &Polygon, quotient: &RationalMap) -> f64 {
    let rows = || places(polygon, quotient).map(|[a, _]| a.y);
    rows().fold(-FARTHEST.y, f64::max) - rows().fold(FARTHEST.y, f64::min)
}

/// Returns the mean colour, in codes, over the polygon's image in texture space, and counts the cells crossed.
pub fn mean_over(
    grid: &Grid,
    polygon: &Polygon,
    quotient: &RationalMap,
    small: bool,
    crossed: &mut u32,
) -> DVec3 {
    if grid.even && grid.checker {
        return DVec3::splat(0.5);
    }
    let place = place_in(&in_grid(grid, quotient, [0, 0]), middle(polygon));
    let cell = place.floor();
    let base = [cell.x as i64, cell.y as i64];
    if !small && !grid.even {
        let near = in_grid(grid, quotient, base);
        let height = rows_covered(polygon, &near);
        let mut integral = DVec3::ZERO;
        let mut covered = 0.0;
        for [a, b] in places(polygon, &near) {
            if (b.y - a.y).abs() > LEVEL * height {
                integral += edge_integral(grid, base, a, b);
                covered += 0.5 * (a.x + b.x) * (b.y - a.y);
                *crossed += 1 + cells_between(a, b);
            }
        }
        if covered != 0.0 {
            return integral / covered;
        }
    }
    // A polygon without area has the colour at its centre; the coarsest level is uniform.
    value_in(grid, base, place - cell)
}
