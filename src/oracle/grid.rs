//! Sums along the rows of a texture's levels, or of a checker: cells to codes of texels and of all before them,
//! over repeats and edges. Twin of `glsl/shared/grid.glsl`.

use glam::DVec2;

use super::address::addressed_texel;
use super::filter::kinds::is_continuous;
use super::texture::addresses;
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Address, TexelCenter};

/// What is walked: a level of a texture, or a checker of unit squares.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    sums: &'a [u32],
    pub checker: bool,
    /// MapInput from so far that all has the colour of the mean.
    pub even: bool,
    /// Of a texture that does not repeat, coarser levels are no prefilter beyond its edges.
    pub unknown: bool,
    size: [i64; 2],
    channels: i64,
    first_word: i64,
    /// Of the texture's sums.
    head: i64,
    address: [Address; 2],
    /// Between texels colour changes linearly, not in steps.
    pub linear: bool,
    /// Cells an axis a unit of the coordinate, and where cell 0 begins.
    pub scale: DVec2,
    pub shift: f64,
    /// value = least + step · code
    pub least: f64,
    pub step: f64,
}

/// Of a flat texture's sums: channels, levels, least value, step, first word of each level.
const HEADER_WORDS: i64 = 4;

/// Level 0.
pub fn texture_grid<'a>(sums: &'a [u32], index: u32, texture: &Texture, sampler: &Sampler) -> Grid<'a> {
    let head = i64::from(sums[index as usize]);
    let word = |i: i64| sums[(head + i) as usize];
    let [width, height, _] = texture.size.to_array();
    let linear = is_continuous(sampler);
    let [u, v, _] = addresses(sampler);
    let integer = sampler.texel_center == TexelCenter::Integer;
    Grid {
        sums,
        checker: false,
        even: false,
        unknown: false,
        size: [width.into(), height.into()],
        channels: word(0).into(),
        first_word: word(HEADER_WORDS).into(),
        head,
        address: [u, v],
        linear,
        scale: DVec2::new(width.into(), height.into()),
        // Linear cells lie between texel centres, of which the integer rule moves all by half a texel.
        shift: if linear { -0.5 } else { 0.0 } + if integer { 0.5 } else { 0.0 },
        least: f64::from(f32::from_bits(word(2))),
        step: f64::from(f32::from_bits(word(3))),
    }
}

pub fn checker_grid() -> Grid<'static> {
    Grid {
        sums: &[],
        checker: true,
        even: false,
        unknown: false,
        size: [1, 1],
        channels: 1,
        first_word: 0,
        head: 0,
        address: [Address::Repeat; 2],
        linear: false,
        scale: DVec2::ONE,
        shift: 0.0,
        least: 0.0,
        step: 1.0,
    }
}

/// A coarser level of a grid; of a checker all of them are even.
pub fn coarser<'a>(grid: Grid<'a>, level: i64) -> Grid<'a> {
    if grid.checker {
        return Grid { even: true, ..grid };
    }
    let word = |i: i64| i64::from(grid.sums[(grid.head + i) as usize]);
    let coarsest = word(1) - 1;
    let held = level.min(coarsest);
    let size = grid.size.map(|n| (n >> held).max(1));
    Grid {
        even: level > coarsest,
        unknown: grid.address.contains(&Address::ClampToEdge),
        size,
        first_word: word(HEADER_WORDS + held),
        scale: DVec2::new(size[0] as f64, size[1] as f64),
        ..grid
    }
}

/// Codes of a row, which begins at word `first`, summed from column 0 to before column i, modulo 2³².
fn stored_sum(grid: &Grid, first: i64, i: i64) -> Sums {
    let at = (first + i * grid.channels) as usize;
    std::array::from_fn(|c| grid.sums[at + if grid.channels == 1 { 0 } else { c }])
}

pub type Sums = [u32; 3];

/// a + times · b, modulo 2³².
pub fn plus(a: Sums, times: i64, b: Sums) -> Sums {
    std::array::from_fn(|c| a[c].wrapping_add((times as u32).wrapping_mul(b[c])))
}

/// The first word of the texture's row that an addressed one shows; of a checker whether cells are odd.
pub fn addressed_row(grid: &Grid, j: i64) -> i64 {
    if grid.checker {
        return j & 1;
    }
    // Beams read no texture that has a border.
    let row = addressed_texel(grid.address[1], j, grid.size[1]).unwrap_or(0);
    grid.first_word + row * (grid.size[0] + 1) * grid.channels
}

/// Column i: the texel that it shows, and how often whole rows lie before it.
struct Column {
    texel: i64,
    rows: i64,
    /// Mirrored: it runs from the row's end.
    back: bool,
}

fn addressed_column(grid: &Grid, i: i64) -> Column {
    let mode = grid.address[0];
    let texel = addressed_texel(mode, i, grid.size[0]).unwrap_or(0);
    let mirrors = mode == Address::MirroredRepeat;
    if !mirrors && mode != Address::Repeat {
        return Column { texel, rows: 0, back: false };
    }
    let rows = i.div_euclid(grid.size[0]);
    let back = mirrors && rows & 1 != 0;
    Column { texel, rows: rows + i64::from(back), back }
}

/// Codes of a column's texel, and summed up to it from column 0, negative before that.
pub struct Codes {
    pub own: Sums,
    pub before: Sums,
}

pub fn codes_at(grid: &Grid, row: i64, i: i64) -> Codes {
    if grid.checker {
        // Cells of odd number are its figure: half of those before.
        return Codes { own: [((i + row) & 1) as u32; 3], before: [((i + row) >> 1) as u32; 3] };
    }
    let column = addressed_column(grid, i);
    let low = stored_sum(grid, row, column.texel);
    let high = stored_sum(grid, row, column.texel + 1);
    let own = plus(high, -1, low);
    let mut before = if column.back { plus([0; 3], -1, high) } else { low };
    if column.rows != 0 {
        before = plus(before, column.rows, stored_sum(grid, row, grid.size[0]));
    }
    if grid.address[0] == Address::ClampToEdge {
        before = plus(before, i - column.texel, own);
    }
    Codes { own, before }
}
