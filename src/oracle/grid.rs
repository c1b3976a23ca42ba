//! Prefix sums along the rows of a texture's levels, or of a checker: maps cells to texel codes and to the
//! sums of all codes before them, across repetitions and edges. Twin of `glsl/shared/grid.glsl`.

use glam::DVec2;

use super::address::addressed_texel;
use super::filter::kinds::is_continuous;
use super::texture::addresses;
use crate::schema::layout::{Sampler, Texture};
use crate::texture::sampler_spec::{Address, TexelCenter};

/// A grid of cells: a level of a texture, or a checker of unit squares.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    sums: &'a [u32],
    pub checker: bool,
    /// True if all cells have the mean colour, because the grid is seen from far away.
    pub even: bool,
    /// True for coarser levels of a texture that does not repeat, which are no prefilter beyond its edges.
    pub unknown: bool,
    size: [i64; 2],
    channels: i64,
    first_word: i64,
    /// First word of the texture's sums.
    head: i64,
    address: [Address; 2],
    /// True if colours are interpolated between texels, false if they are constant per texel.
    pub linear: bool,
    /// Cells per unit of the coordinate along each axis, and the coordinate of cell 0.
    pub scale: DVec2,
    pub shift: f64,
    /// value = least + step · code
    pub least: f64,
    pub step: f64,
}

/// Words before the sums of a 2D texture: channels, levels, least value, step, first word of each level.
const HEADER_WORDS: i64 = 4;

/// Returns the grid of level 0.
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
        // Linear cells are bounded by texel centres; the integer rule shifts all of them by half a texel.
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

/// Returns the grid of a coarser level; all coarser levels of a checker are uniform.
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

/// Returns the sum of codes from column 0 to before column i, in the row that begins at word `first`, modulo
/// 2³².
fn stored_sum(grid: &Grid, first: i64, i: i64) -> Sums {
    let at = (first + i * grid.channels) as usize;
    std::array::from_fn(|c| grid.sums[at + if grid.channels == 1 { 0 } else { c }])
}

pub type Sums = [u32; 3];

/// Returns a + times · b, modulo 2³².
pub fn plus(a: Sums, times: i64, b: Sums) -> Sums {
    std::array::from_fn(|c| a[c].wrapping_add((times as u32).wrapping_mul(b[c])))
}

/// Returns the first word of the texture row that row j addresses; for a checker, the parity of the row.
pub fn addressed_row(grid: &Grid, j: i64) -> i64 {
    if grid.checker {
        return j & 1;
    }
    // Beams do not support textures with a border.
    let row = addressed_texel(grid.address[1], j, grid.size[1]).unwrap_or(0);
    grid.first_word + row * (grid.size[0] + 1) * grid.channels
}

/// Column i: the texel that it addresses, and the number of whole rows before it.
struct Column {
    texel: i64,
    rows: i64,
    /// True if mirrored: it counts from the row's end.
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

/// The codes of a column's texel, and the sums of all columns from column 0 to before it, negative left of
/// column 0.
pub struct Codes {
    pub own: Sums,
    pub before: Sums,
}

pub fn codes_at(grid: &Grid, row: i64, i: i64) -> Codes {
    if grid.checker {
        // Odd cells are the checker's figure: half of the cells before this one.
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
