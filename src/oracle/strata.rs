//! Positions in strata, as integers in [0, 2^24) on each axis. With n strata per side, L = ceil(log2 n) and B
//! = 24 - L bits of jitter j, the position in stratum c is floor(((c << B) + j) · 2^24 / (n << B)). Here by
//! that formula in 64-bit integers; the shader uses 32 bits. Twin of `glsl/shared/strata.glsl`.

/// The unit of positions, as a fraction of a pixel.
pub const UNIT: f64 = 1.0 / 16_777_216.0;

pub fn stratum_position(cell: u32, jitter: u32, side: u32, side_log2: u32) -> u32 {
    let bits = 24 - side_log2;
    let place = (u64::from(cell) << bits) + u64::from(jitter);
    ((place << 24) / (u64::from(side) << bits)) as u32
}

/// As above for up to 2^24 strata per side and a jitter of 24 bits, of which the upper B are used.
pub fn fine_position(cell: u32, jitter: u32, cells: u32) -> u32 {
    let cells_log2 = cells.next_power_of_two().trailing_zeros();
    stratum_position(cell, jitter >> cells_log2, cells, cells_log2)
}
