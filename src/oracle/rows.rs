//! The integral of a texture over a polygon of texture space, by Green's theorem: ∬ c dX dY = ∮ C dY, where C
//! is the integral of c along its row, from a table of sums. Every edge is walked cell by cell, and in
//! each cell C is a polynomial; so the integral is exact for the reconstruction between texels (Heckbert
//! 1986, "Filtering by repeated integration", has it for boxes). Twin of `glsl/shared/rows.glsl`.

use glam::{DVec2, DVec3};

use super::forms::Quotient;
use super::polygon::{MAX_CORNERS, Polygon, at, middle};
use crate::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Address, Filter, TexelCenter};

/// What is walked: a level of a texture, or a checker.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    /// None: a checker of unit squares.
    sums: Option<&'a [u32]>,
    /// Seen from so far that all has the colour of the mean.
    even: Option<DVec3>,
    /// Of a texture that does not repeat, coarser levels are no prefilter beyond its edges.
    unknown: bool,
    size: [i64; 2],
    channels: usize,
    first_word: usize,
    address: [u32; 2],
    /// Between texels colour changes linearly, not in steps.
    linear: bool,
    /// Cells an axis a unit of the coordinate, and where cell 0 begins.
    scale: DVec2,
    shift: f64,
    /// value = least + step · code
    least: f64,
    step: f64,
}

/// Of a flat texture's sums: channels, levels, least value, step, first word of each level.
const HEADER_WORDS: usize = 4;

pub fn texture_grid<'a>(
    sums: &'a [u32],
    index: u32,
    texture: &Texture,
    sampler: &Sampler,
    level: u32,
) -> Grid<'a> {
    let head = &sums[sums[index as usize] as usize..];
    let coarsest = head[1] - 1;
    let (far, asked) = (level > coarsest, level);
    let level = level.min(coarsest);
    let [_, width, height, _] = texture.place;
    let size = [width, height].map(|n| i64::from((n >> level).max(1)));
    let linear = sampler.modes[2] == Filter::Linear as u32;
    let centered = sampler.modes[3] == TexelCenter::Half as u32;
    // Linear cells lie between texel centres, of which the integer rule moves all by half a texel.
    let shift = match (linear, centered) {
        (true, true) => -0.5,
        (true, false) | (false, true) => 0.0,
        (false, false) => 0.5,
    };
    let address = [sampler.modes[0], sampler.modes[1]];
    let mut grid = Grid {
        sums: Some(sums),
        even: None,
        unknown: asked > 0 && address.contains(&(Address::ClampToEdge as u32)),
        size,
        channels: head[0] as usize,
        first_word: head[HEADER_WORDS + level as usize] as usize,
        address,
        linear,
        scale: DVec2::new(size[0] as f64, size[1] as f64),
        shift,
        least: f64::from(f32::from_bits(head[2])),
        step: f64::from(f32::from_bits(head[3])),
    };
    if far {
        grid.even = Some(texel(&grid, 0, 0));
    }
    grid
}

pub fn checker_grid(level: u32) -> Grid<'static> {
    Grid {
        sums: None,
        even: (level > 0).then_some(DVec3::splat(0.5)),
        unknown: false,
        size: [1, 1],
        channels: 1,
        first_word: 0,
        address: [0, 0],
        linear: false,
        scale: DVec2::splat(0.5f64.powi(level as i32)),
        shift: 0.0,
        least: 0.0,
        step: 1.0,
    }
}

/// ⌊a / b⌋ for b > 0.
fn floor_div(a: i64, b: i64) -> i64 {
    if a < 0 { -1 - (-1 - a) / b } else { a / b }
}

/// Codes of `row` summed from column 0 to before column `i`, modulo 2³².
fn stored_sum(grid: &Grid, sums: &[u32], row: i64, i: i64) -> [u32; 3] {
    let at = grid.first_word + ((row * (grid.size[0] + 1) + i) as usize) * grid.channels;
    std::array::from_fn(|c| sums[at + if grid.channels == 3 { c } else { 0 }])
}

/// The texture's row that an addressed one shows.
fn addressed_row(grid: &Grid, j: i64) -> i64 {
    let size = grid.size[1];
    if grid.address[1] == Address::Repeat as u32 {
        j - size * floor_div(j, size)
    } else if grid.address[1] == Address::MirroredRepeat as u32 {
        let left = j - 2 * size * floor_div(j, 2 * size);
        if left < size { left } else { 2 * size - 1 - left }
    } else {
        j.clamp(0, size - 1)
    }
}

/// The same for any column, over repeats and edges: from column 0 to before column i, negative before it.
fn row_sum(grid: &Grid, j: i64, i: i64) -> [u32; 3] {
    let Some(sums) = grid.sums else {
        // Cells whose numbers sum to an odd one; a level's are all alike.
        let odd = floor_div(i + (j & 1), 2);
        return [odd as u32; 3];
    };
    let row = addressed_row(grid, j);
    let size = grid.size[0];
    let sum = |i: i64| stored_sum(grid, sums, row, i);
    let plus = |a: [u32; 3], times: i64, b: [u32; 3]| -> [u32; 3] {
        std::array::from_fn(|c| a[c].wrapping_add((times as u32).wrapping_mul(b[c])))
    };
    if grid.address[0] == Address::Repeat as u32 {
        let tile = floor_div(i, size);
        plus(sum(i - size * tile), tile, sum(size))
    } else if grid.address[0] == Address::MirroredRepeat as u32 {
        let tile = floor_div(i, 2 * size);
        let left = i - 2 * size * tile;
        let all = sum(size);
        if left <= size {
            plus(sum(left), 2 * tile, all)
        } else {
            let back = sum(2 * size - left);
            plus(plus([0; 3], -1, back), 2 * tile + 2, all)
        }
    } else if i < 0 {
        plus([0; 3], i, sum(1))
    } else if i > size {
        let last = plus(sum(size), -1, sum(size - 1));
        plus(sum(size), i - size, last)
    } else {
        sum(i)
    }
}

/// b - a as a signed number.
fn difference(a: [u32; 3], b: [u32; 3]) -> DVec3 {
    let d: [f64; 3] = std::array::from_fn(|c| f64::from(b[c].wrapping_sub(a[c]) as i32));
    DVec3::from_array(d)
}

fn texel(grid: &Grid, i: i64, j: i64) -> DVec3 {
    difference(row_sum(grid, j, i), row_sum(grid, j, i + 1))
}

/// The integral of a row's colour from a whole column to place s in cell i.
fn along_row(grid: &Grid, j: i64, from: i64, i: i64, s: f64) -> DVec3 {
    let (start, here, next) = (row_sum(grid, j, from), row_sum(grid, j, i), row_sum(grid, j, i + 1));
    let own = difference(here, next);
    let whole = difference(start, here);
    if !grid.linear {
        return whole + s * own;
    }
    let right = difference(next, row_sum(grid, j, i + 2));
    let left = difference(start, row_sum(grid, j, from + 1));
    whole + 0.5 * (own - left) + s * own + (0.5 * s * s) * (right - own)
}

/// C in a cell, from column `base`; cells count from `base`.
fn primitive(grid: &Grid, base: [i64; 2], cell: [i64; 2], s: f64, t: f64) -> DVec3 {
    let (i, j) = (base[0] + cell[0], base[1] + cell[1]);
    let low = along_row(grid, j, base[0], i, s);
    if grid.linear { low.lerp(along_row(grid, j + 1, base[0], i, s), t) } else { low }
}

/// ∫ C dY from a to b; places count from cell `base`.
fn edge_integral(grid: &Grid, base: [i64; 2], a: DVec2, b: DVec2) -> DVec3 {
    let way = b - a;
    if way.y == 0.0 {
        return DVec3::ZERO;
    }
    let mut cell = [a.x.floor() as i64, a.y.floor() as i64];
    let last = [b.x.floor() as i64, b.y.floor() as i64];
    let forward = [way.x > 0.0, way.y > 0.0];
    // Where on the edge the next line of the grid is met.
    let next = |axis: usize, cell: [i64; 2]| {
        let line = (cell[axis] + i64::from(forward[axis])) as f64;
        if way[axis] == 0.0 { 1.0 } else { ((line - a[axis]) / way[axis]).clamp(0.0, 1.0) }
    };
    let mut sum = DVec3::ZERO;
    let mut done = 0.0;
    for _ in 0..=cells_between(a, b) {
        let ends = [next(0, cell), next(1, cell)];
        let axis = usize::from(cell[0] == last[0] || (cell[1] != last[1] && ends[1] < ends[0]));
        let end = if cell == last { 1.0 } else { ends[axis].max(done) };
        let half = 0.5 * (end - done);
        // Gauss's two points: exact for what is cubic along the edge.
        for sign in [-1.0, 1.0] {
            let place = a + way * (done + half + sign * half * GAUSS);
            let s = (place.x - cell[0] as f64).clamp(0.0, 1.0);
            let t = (place.y - cell[1] as f64).clamp(0.0, 1.0);
            sum += half * primitive(grid, base, cell, s, t);
        }
        done = end;
        cell[axis] += if forward[axis] { 1 } else { -1 };
    }
    sum * way.y
}

/// 1 / √3
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Lines of the grid that an edge crosses.
fn cells_between(a: DVec2, b: DVec2) -> u32 {
    let cells = (b.floor() - a.floor()).abs();
    (cells.x + cells.y) as u32
}

/// The colour at a place of a cell.
fn value_in(grid: &Grid, cell: [i64; 2], s: f64, t: f64) -> DVec3 {
    let [i, j] = cell;
    if !grid.linear {
        return texel(grid, i, j);
    }
    let row = |j| texel(grid, i, j).lerp(texel(grid, i + 1, j), s);
    row(j).lerp(row(j + 1), t)
}

/// Places of a polygon's corners in the grid.
fn places(grid: &Grid, polygon: &Polygon, quotient: &Quotient, base: [i64; 2]) -> [DVec2; MAX_CORNERS] {
    let start = DVec2::splat(grid.shift) - DVec2::new(base[0] as f64, base[1] as f64);
    // Counted from the base before the division, so that near places differ exactly.
    let u = grid.scale.x * quotient.u + start.x * quotient.below;
    let v = grid.scale.y * quotient.v + start.y * quotient.below;
    let mut out = [DVec2::ZERO; MAX_CORNERS];
    for k in 0..polygon.count {
        let corner = polygon.corners[k];
        let below = at(quotient.below, corner);
        // Towards the horizon a place goes to infinity.
        out[k] = (DVec2::new(at(u, corner), at(v, corner)) / below).clamp(-FARTHEST, FARTHEST);
    }
    out
}

/// In cells.
const FARTHEST: DVec2 = DVec2::splat(1e8);
/// A polygon so small has the colour of its middle.
const SMALLEST: f64 = 1.0 / 256.0;

/// Mean colour over the texture space that a polygon shows; `most` cells for each of its edges. `make` gives
/// the levels of the texture. Cells that were crossed are counted. None where only samples can tell.
pub fn mean_over<'a>(
    make: impl Fn(u32) -> Grid<'a>,
    polygon: &Polygon,
    quotient: &Quotient,
    most: f64,
    crossed: &mut u32,
) -> Option<DVec3> {
    let mut grid = make(0);
    let corners = places(&grid, polygon, quotient, [0, 0]);
    let edges = || (0..polygon.count).map(|k| (k, (k + 1) % polygon.count));
    let reach = edges().map(|(k, n)| (corners[n] - corners[k]).abs().element_sum()).fold(0.0, f64::max);
    if reach > most {
        grid = make((reach / most).log2().ceil() as u32);
    }
    if grid.unknown {
        return None;
    }
    if let Some(mean) = grid.even {
        return Some(DVec3::splat(grid.least) + grid.step * mean);
    }
    let center = middle(polygon);
    let below = at(quotient.below, center);
    let place = DVec2::new(at(quotient.u, center), at(quotient.v, center)) / below * grid.scale + grid.shift;
    let place = place.clamp(-FARTHEST, FARTHEST);
    let base = [place.x.floor() as i64, place.y.floor() as i64];
    let within = place - place.floor();
    let mut mean = value_in(&grid, base, within.x, within.y);
    if reach >= SMALLEST {
        let corners = places(&grid, polygon, quotient, base);
        let mut integral = DVec3::ZERO;
        let mut area = 0.0;
        for (k, n) in edges() {
            let (a, b) = (corners[k], corners[n]);
            integral += edge_integral(&grid, base, a, b);
            area += 0.5 * (a.x + b.x) * (b.y - a.y);
            *crossed += 1 + cells_between(a, b);
        }
        // What has no area shows the colour of its middle.
        mean = if area == 0.0 { mean } else { integral / area };
    }
    Some(DVec3::splat(grid.least) + grid.step * mean)
}
