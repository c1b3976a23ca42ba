//! Stratification of each pattern: the number of points in each part of the pixel.

use moire::internal::oracle::patterns::sample_line;
use moire::internal::oracle::permute::permute;
use moire::internal::oracle::rng::sample_bits;
use moire::internal::oracle::sobol::{second_dimension, shuffled_quarter};
use moire::internal::scene::model::Pattern;

use super::{header, points, set};

/// The largest number of points in any of `columns` × `rows` equal cells, and how many hold one.
fn cells(positions: &[[u32; 2]], columns: u32, rows: u32) -> (u32, u32) {
    let mut held = vec![0u32; columns as usize * rows as usize];
    // The last cell c of n that begins, at floor(c · 2²⁴ / n), at the position or before it.
    let cell = |x: u32, n: u32| ((u64::from(x + 1) * u64::from(n)).div_ceil(1 << 24) - 1) as usize;
    for p in positions {
        held[cell(p[1], rows) * columns as usize + cell(p[0], columns)] += 1;
    }
    (held.iter().copied().max().unwrap_or(0), held.iter().filter(|h| **h > 0).count() as u32)
}

fn assert_one_each(what: &str, positions: &[[u32; 2]], columns: u32, rows: u32) {
    let (most, held) = cells(positions, columns, rows);
    let wanted = (1, columns * rows);
    assert_eq!((most, held), wanted, "{what}: most and cells with points of {columns} × {rows}");
}

/// (seed, pixel, pair)
const PLACES: [(u32, [u32; 2], u32); 5] =
    [(1, [0, 0], 0), (9, [17, 5], 0), (1, [3, 4], 1), (u32::MAX, [100, 7], 2), (5, [0, 1], 5)];

#[test]
fn stratified_and_grid_fill_every_stratum_in_every_pair() {
    for pattern in [Pattern::Stratified, Pattern::Grid] {
        for (seed, pixel, pair) in PLACES {
            for side in [1, 2, 3, 7, 16] {
                let positions = set(pattern, side * side, seed, pixel, pair);
                assert_one_each(&format!("{pattern}, pair {pair}"), &positions, side, side);
            }
        }
    }
}

/// If one number is used, N points are in N strata of the line.
#[test]
fn lines_have_one_point_in_each_stratum() {
    use Pattern::{BlueNoise, Grid, MultiJittered, NRooks, SobolOwen, Stratified};
    for pattern in [Grid, Stratified, MultiJittered, NRooks, SobolOwen, BlueNoise] {
        for (seed, pixel, pair) in PLACES {
            for count in [1, 4, 16, 256, 1024] {
                let points = points(&header(pattern, count, false, seed), pixel, pair);
                let line: Vec<[u32; 2]> = (0..count).map(|s| [sample_line(&points, s), 0]).collect();
                assert_one_each(&format!("{pattern}, pair {pair}"), &line, count, 1);
            }
        }
    }
}

#[test]
fn multi_jittered_fills_cells_rows_and_columns() {
    for (seed, pixel, pair) in PLACES {
        for count in (1..40).chain([64, 100, 128, 200, 256, 1000, 1023, 4096]) {
            let positions = set(Pattern::MultiJittered, count, seed, pixel, pair);
            let what = format!("N = {count}, pair {pair}");
            let columns = count.isqrt();
            let rows = count.div_ceil(columns);
            assert_one_each(&what, &positions, 1, count);
            // With fewer points than cells, some cells are empty.
            assert_eq!(cells(&positions, columns * rows, 1).0, 1, "{what}: two points in a column");
            if columns * rows == count {
                assert_one_each(&what, &positions, columns, rows);
                assert_one_each(&what, &positions, count, 1);
            }
        }
    }
}

#[test]
fn n_rooks_fill_rows_and_columns() {
    for (seed, pixel, pair) in PLACES {
        for count in [1, 2, 3, 5, 16, 31, 64, 100, 1000, 4096, 5000] {
            let positions = set(Pattern::NRooks, count, seed, pixel, pair);
            assert_one_each(&format!("pair {pair}"), &positions, count, 1);
            assert_one_each(&format!("pair {pair}"), &positions, 1, count);
        }
    }
}

/// A (0,2)-sequence: each block of 2^k samples that begins at a multiple of it has one in each
/// elementary interval (Niederreiter 1992, definition 4.2), and so has each pixel of blue noise.
#[test]
fn sobol_and_blue_noise_fill_every_elementary_interval() {
    let check = |what: &str, block: &[[u32; 2]]| {
        let bits = block.len().ilog2();
        for i in 0..=bits {
            assert_one_each(what, block, 1 << i, 1 << (bits - i));
        }
    };
    for (seed, pixel, pair) in PLACES {
        let positions = set(Pattern::SobolOwen, 1 << 12, seed, pixel, pair);
        for bits in 0..=12 {
            for (i, block) in positions.chunks(1 << bits).take(20).enumerate() {
                check(&format!("sobol-owen, pair {pair}, block {i} of 2^{bits}"), block);
            }
        }
        for bits in [0, 1, 2, 3, 6, 7, 10] {
            let positions = set(Pattern::BlueNoise, 1 << bits, seed, pixel, pair);
            check(&format!("blue-noise, pair {pair}, 2^{bits}"), &positions);
        }
    }
}

/// The pixels of an aligned square share a longer block of the sequence.
#[test]
fn squares_of_blue_noise_pixels_fill_elementary_intervals_together() {
    for pair in [0, 1] {
        for side in [2u32, 4, 8] {
            let pixels = (0..side * side).map(|i| [3 * side + i % side, 5 * side + i / side]);
            let together: Vec<[u32; 2]> =
                pixels.flat_map(|pixel| set(Pattern::BlueNoise, 4, 3, pixel, pair)).collect();
            for i in 0..=together.len().ilog2() {
                let columns = 1 << i;
                assert_one_each("square", &together, columns, together.len() as u32 / columns);
            }
        }
    }
}

/// Steps of 2⁻²⁴ that a boundary between two of n cells divides count for either.
fn may_lie_in(x: u32, n: u32) -> impl Iterator<Item = u32> {
    let first = (u64::from(x) * u64::from(n)) >> 24;
    let last = (u64::from(x + 1) * u64::from(n)).div_ceil(1 << 24) - 1;
    (first..=last).map(|c| c as u32)
}

/// Expects one point in each of `columns` × `rows` cells, where those on a boundary fill cells left empty.
fn fill_cells(positions: &[[u32; 2]], columns: u32, rows: u32) -> bool {
    let candidates = |p: &[u32; 2]| -> Vec<u32> {
        let [x, y] = *p;
        may_lie_in(y, rows).flat_map(|row| may_lie_in(x, columns).map(move |c| row * columns + c)).collect()
    };
    let mut all: Vec<Vec<u32>> = positions.iter().map(candidates).collect();
    all.sort_by_key(Vec::len);
    let mut held = vec![false; columns as usize * rows as usize];
    let place = |cells: Vec<u32>| {
        let free = cells.into_iter().find(|&c| !held[c as usize]);
        free.map(|c| held[c as usize] = true).is_some()
    };
    all.into_iter().all(place)
}

#[test]
fn halton_fills_intervals_of_its_bases() {
    let bases = [[2u32, 3], [5, 7], [11, 13], [17, 19], [23, 29], [31, 37]];
    for (seed, pixel, pair) in PLACES {
        let [a, b] = bases[pair as usize];
        for (i, j) in [(0, 1), (1, 0), (1, 1), (2, 1), (1, 2), (3, 2), (5, 3), (0, 7), (11, 0), (4, 5)] {
            let Some(count) = a.checked_pow(i).and_then(|x| Some((x, b.checked_pow(j)?))) else { continue };
            let Some(total) = count.0.checked_mul(count.1).filter(|t| *t <= 20_000) else { continue };
            let positions = set(Pattern::Halton, 3 * total, seed, pixel, pair);
            for block in positions.chunks(total as usize) {
                let filled = fill_cells(block, count.0, count.1);
                assert!(filled, "pair {pair}: {} × {} of bases {a} {b}", count.0, count.1);
            }
        }
    }
}

/// Sequences have the same first samples whatever the count; the other patterns need not.
#[test]
fn sequences_can_be_stopped_and_continued() {
    for &pattern in Pattern::ALL.iter().filter(|p| p.is_progressive() && **p != Pattern::Center) {
        let long = set(pattern, 1000, 1, [2, 3], 1);
        for count in [1, 7, 64, 999] {
            assert_eq!(long[..count as usize], set(pattern, count, 1, [2, 3], 1), "{pattern}, {count}");
        }
    }
    for pattern in [Pattern::MultiJittered, Pattern::NRooks] {
        assert!(!pattern.is_progressive());
        assert_ne!(set(pattern, 1000, 1, [2, 3], 0)[..64], set(pattern, 64, 1, [2, 3], 0), "{pattern}");
    }
}

#[test]
fn permutations_hold_every_number_once() {
    for length in (1..70).chain([100, 255, 256, 257, 1000, 4096]) {
        // Seeds near 2³² among them: an offset added to the index would wrap there.
        for p in
            (0..40).chain((0..40).map(|i| u32::MAX - i)).chain((0..40).map(|i| sample_bits([1, 2], i)[0]))
        {
            let mut seen = vec![false; length as usize];
            for i in 0..length {
                let place = permute(i, length, p) as usize;
                assert!(
                    !std::mem::replace(&mut seen[place], true),
                    "length {length}, p = {p}: {place} twice"
                );
            }
        }
    }
}

#[test]
fn all_24_orders_of_quarters_come_up() {
    let mut orders: Vec<[u32; 4]> =
        (0..600).map(|i| [0, 1, 2, 3].map(|q| shuffled_quarter(q, sample_bits([3, 4], i)[0]))).collect();
    orders.sort_unstable();
    orders.dedup();
    assert_eq!(orders.len(), 24);
    assert!(orders.iter().all(|o| o.iter().fold(0, |m, q| m | 1 << q) == 0b1111));
}

/// The direction numbers of Sobol's second dimension: m = 1, 3, 5, 15, 17, 51, 85, 255 (Joe & Kuo 2008).
#[test]
fn second_dimension_has_its_direction_numbers() {
    for (bit, m) in [1u32, 3, 5, 15, 17, 51, 85, 255].into_iter().enumerate() {
        let direction = second_dimension(1 << bit).reverse_bits();
        assert_eq!(direction, m << (31 - bit), "bit {bit}");
    }
}

#[test]
fn the_checker_of_cells_finds_what_it_looks_for() {
    let good = set(Pattern::SobolOwen, 64, 1, [0, 0], 0);
    assert_eq!(cells(&good, 8, 8), (1, 64));
    assert_ne!(cells(&set(Pattern::Random, 64, 1, [0, 0], 0), 8, 8), (1, 64));
    let mut moved = good.clone();
    moved[5][0] ^= 1 << 23;
    assert_ne!(cells(&moved, 8, 8), (1, 64));
    // Swapped axes leave Sobol's and n-rooks' laws as they are, but not those of bases 2 and 3.
    let halton = set(Pattern::Halton, 72, 1, [0, 0], 0);
    let swapped: Vec<[u32; 2]> = halton.iter().map(|p| [p[1], p[0]]).collect();
    assert!(fill_cells(&halton, 8, 9));
    assert!(!fill_cells(&swapped, 8, 9));
    assert!(!fill_cells(&set(Pattern::Random, 72, 1, [0, 0], 0), 8, 9));
}
