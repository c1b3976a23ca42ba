//! How much of a picture one submission renders: enough that submitting costs nothing, little
//! enough that progress moves, Ctrl-C is heard and no watchdog fires. Tiles and chunks of samples
//! go in; how many tiles to dispatch next comes out, learnt from how long the last ones took.

use crate::schema::layout::TILE;

/// What a slice aims at. Costs differ over a picture, so the aim is well below the bound of 0.5 s.
const TARGET_SECONDS: f64 = 0.15;
/// Samples in the first slice, before anything is known.
pub(super) const FIRST_SAMPLES: f64 = (1u32 << 20) as f64;
/// A slice is at most this many times longer than the one before it.
const GROWTH: f64 = 16.0;
/// `maxComputeWorkGroupCount` is at least this on every device.
pub(super) const MAX_TILES: u32 = 65_535;

pub struct Plan {
    samples: u32,
    chunk: u32,
    /// Tile-samples of the whole picture and how many are done.
    total: f64,
    done: f64,
    /// Tile-samples of the next slice.
    next: f64,
}

impl Plan {
    pub fn new(samples: u32, chunk: u32, tiles: u64) -> Plan {
        Plan::starting_with(FIRST_SAMPLES / f64::from(TILE * TILE), samples, chunk, tiles)
    }

    /// With so many tile-samples in the first slice.
    pub fn starting_with(next: f64, samples: u32, chunk: u32, tiles: u64) -> Plan {
        Plan { samples, chunk, total: tiles as f64 * f64::from(samples), done: 0.0, next }
    }

    /// (first sample, number) of each chunk, in the order in which the film adds them.
    pub fn chunks(&self) -> impl Iterator<Item = (u32, u32)> + use<> {
        let (samples, chunk) = (self.samples, self.chunk);
        (0..samples).step_by(chunk as usize).map(move |first| (first, chunk.min(samples - first)))
    }

    /// How many of the `left` tiles the next slice takes.
    pub fn tiles(&self, left: u32, sample_count: u32) -> u32 {
        let tiles = (self.next / f64::from(sample_count)).clamp(1.0, f64::from(MAX_TILES)) as u32;
        // Rather one slice a little longer than a tiny one at the end.
        if left <= tiles + tiles / 4 && left <= MAX_TILES { left } else { tiles.min(left) }
    }

    pub fn learn(&mut self, tiles: u32, sample_count: u32, seconds: f64) {
        let work = f64::from(tiles) * f64::from(sample_count);
        self.done += work;
        self.next = next_work(work, seconds);
    }

    pub fn done(&self) -> f64 {
        self.done / self.total
    }
}

/// The work of the next slice, after one that took so long.
pub fn next_work(work: f64, seconds: f64) -> f64 {
    (work * TARGET_SECONDS / seconds.max(1e-6)).min(work * GROWTH)
}

/// A step through `tiles` tiles that visits each once and neighbours far apart: the number nearest
/// to the golden section that shares no factor with `tiles`.
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

    #[test]
    fn chunks_cover_all_samples_in_order() {
        for (samples, chunk) in [1, 255, 256, 257, 1000, 65_536].into_iter().zip([256, 256, 7, 256, 1, 256]) {
            let plan = Plan::new(samples, chunk, 1);
            let mut next = 0;
            for (first, count) in plan.chunks() {
                assert_eq!(first, next);
                assert!((1..=chunk).contains(&count));
                next += count;
            }
            assert_eq!(next, samples);
        }
    }

    #[test]
    fn a_slow_slice_makes_the_next_one_short() {
        let mut plan = Plan::new(64, 256, 10_000);
        plan.learn(100, 64, 1.5);
        assert_eq!(plan.tiles(9_000, 64), 10);
    }

    #[test]
    fn growth_is_bounded_even_when_the_clock_says_nothing() {
        let mut plan = Plan::new(64, 256, 10_000);
        plan.learn(4, 64, 0.0);
        assert_eq!(plan.tiles(9_000, 64), 64);
    }
}
