//! Decides how much of a range one submission renders: enough that the overhead of submitting is negligible, little
//! enough that progress advances, Ctrl-C is honoured and no watchdog fires. Input: tiles and blocks of samples. Output:
//! the number of tiles of the next dispatch, learnt from the times of the previous ones.

use std::ops::Range;

use crate::schema::layout::TILE;

/// The target time of a slice. Costs differ over a picture, so it is well below the limit of 0.5 s.
const TARGET_SECONDS: f64 = 0.15;
/// Samples in the first slice, before any timing.
pub(super) const FIRST_SAMPLES: f64 = (1u32 << 20) as f64;
/// The same on a GPU, of the slowest of which a sample takes some nanoseconds.
pub(super) const FIRST_SAMPLES_GPU: f64 = (1u32 << 23) as f64;
/// Largest ratio of a slice's work to that of the previous one.
const GROWTH: f64 = 16.0;
/// Lower bound of `maxComputeWorkGroupCount` on all devices.
pub(super) const MAX_TILES: u32 = 65_535;

/// The distribution of the tiles and samples of a range over dispatches.
pub struct DispatchPlan {
    samples: Range<u32>,
    block: u32,
    /// Tile-samples of the range, and the number of those that are done.
    total: f64,
    done: f64,
    /// Tile-samples of the next slice.
    next: f64,
}

impl DispatchPlan {
    /// Tile-samples of a first slice, before any timing.
    pub const FIRST: f64 = FIRST_SAMPLES / (TILE * TILE) as f64;

    /// Plans with `next` tile-samples in the first slice; an invocation takes at most `block` samples of a pixel at
    /// once.
    pub fn new(next: f64, samples: Range<u32>, block: u32, tiles: u64) -> DispatchPlan {
        let count = samples.end.saturating_sub(samples.start);
        DispatchPlan { samples, block, total: tiles as f64 * f64::from(count), done: 0.0, next }
    }

    /// Returns (first sample, count) of each block, in the order in which the film adds them.
    pub fn blocks(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (Range { start, end }, block) = (self.samples.clone(), self.block);
        (start..end).step_by(block as usize).map(move |first| (first, block.min(end - first)))
    }

    /// Returns how many of the `left` tiles the next slice takes.
    pub fn tiles(&self, left: u32, sample_count: u32) -> u32 {
        let tiles = (self.next / f64::from(sample_count)).clamp(1.0, f64::from(MAX_TILES)) as u32;
        // One slice that is a little longer is better than a tiny last one.
        if left <= tiles + tiles / 4 && left <= MAX_TILES { left } else { tiles.min(left) }
    }

    /// Records the time of a slice.
    pub fn learn(&mut self, tiles: u32, sample_count: u32, seconds: f64) {
        let work = f64::from(tiles) * f64::from(sample_count);
        self.done += work;
        self.next = next_work(work, seconds);
    }

    /// Returns the tile-samples of the next slice.
    pub fn next(&self) -> f64 {
        self.next
    }

    /// Returns the fraction of the range that is done.
    pub fn done(&self) -> f64 {
        self.done / self.total
    }
}

/// Returns the work of the next slice, given that of the previous one and its time.
pub fn next_work(work: f64, seconds: f64) -> f64 {
    (work * TARGET_SECONDS / seconds.max(1e-6)).min(work * GROWTH)
}

/// Returns a stride over `tiles` tiles that visits each once, with successive tiles far apart: the number nearest to
/// the golden section that is coprime to `tiles`.
pub fn tile_stride(tiles: u32) -> u32 {
    let golden = (f64::from(tiles) * 0.618_033_988_75) as u32;
    let coprime = |n: &u32| gcd(*n, tiles) == 1;
    (golden.max(1)..=tiles).find(coprime).unwrap_or(1)
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tile_is_visited_once() {
        for tiles in (1..300).chain([4095, 4096, 65_535, 65_536]) {
            let stride = tile_stride(tiles);
            let mut seen = vec![false; tiles as usize];
            for i in 0..tiles {
                let tile =
                    (i.checked_mul(stride).expect("the shader multiplies in 32 bits") % tiles) as usize;
                assert!(!std::mem::replace(&mut seen[tile], true), "{tiles} tiles, stride {stride}");
            }
        }
    }

    /// `glsl/shared/slice.glsl`, whose quotients may err by 2.5 ulp (Vulkan 1.3, "Precision of core SPIR-V Instructions").
    #[test]
    fn the_shaders_tile_is_the_remainder_and_its_row_the_quotient_however_floats_round() {
        const ERRORS: [f32; 3] = [1.0 - 3.0 * f32::EPSILON, 1.0, 1.0 + 3.0 * f32::EPSILON];
        for tiles in (1..300_u32).chain([4095, 4096, 65_535, 65_536]) {
            let (stride, across) = (tile_stride(tiles), tiles.isqrt());
            for (place, error) in (0..tiles).flat_map(|place| ERRORS.map(|error| (place, error))) {
                let times = (place as f32 * (stride as f32 / tiles as f32 * error)) as u32;
                let mut rest = place.wrapping_mul(stride).wrapping_sub(times.wrapping_mul(tiles)) as i32;
                rest += if rest < 0 { tiles as i32 } else { 0 };
                rest -= if rest >= tiles as i32 { tiles as i32 } else { 0 };
                assert_eq!(rest as u32, place * stride % tiles, "{place} of {tiles}");
                let row = ((place as f32 + 0.5) / across as f32 * error) as u32;
                assert_eq!(row, place / across, "{place} of {tiles}");
            }
        }
    }

    #[test]
    fn blocks_cover_all_samples_in_order() {
        for (samples, block) in [1, 255, 256, 257, 1000, 65_536].into_iter().zip([256, 256, 7, 256, 1, 256]) {
            for start in [0, samples / 3] {
                let plan = DispatchPlan::new(DispatchPlan::FIRST, start..samples, block, 1);
                let mut next = start;
                for (first, count) in plan.blocks() {
                    assert_eq!(first, next);
                    assert!((1..=block).contains(&count));
                    next += count;
                }
                assert_eq!(next, samples);
            }
        }
    }

    #[test]
    fn a_slow_slice_makes_the_next_one_short() {
        let mut plan = DispatchPlan::new(DispatchPlan::FIRST, 0..64, 256, 10_000);
        plan.learn(100, 64, 1.5);
        assert_eq!(plan.tiles(9_000, 64), 10);
    }

    #[test]
    fn growth_is_bounded_even_when_the_clock_says_nothing() {
        let mut plan = DispatchPlan::new(DispatchPlan::FIRST, 0..64, 256, 10_000);
        plan.learn(4, 64, 0.0);
        assert_eq!(plan.tiles(9_000, 64), 64);
    }
}
