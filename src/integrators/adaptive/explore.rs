//! Gives some samples to pixels drawn at random in every pass: a pixel whose samples are all equal may have missed rare
//! light. If such a pixel turns out to vary, its neighbours are assumed to vary too until their own samples show
//! otherwise, so that a discovery spreads from pass to pass.

use super::MAX_COUNT;
use super::audit::raise;
use super::estimate::Estimate;
use crate::schema::constants::{GOAL_DISCOVERY, GOAL_FEW_SAMPLES, GOAL_RADIUS, GOAL_RUN, GOAL_VISIT_GROWTH};

/// Length of a run of pixels of which one is visited.
const RUN: usize = GOAL_RUN as usize;
/// Factor by which the count of a visited pixel grows if it has fewer than `FEW` samples in each half; a larger count
/// grows by half of its leading power of two.
const GROWTH: u32 = GOAL_VISIT_GROWTH;
const FEW: u32 = GOAL_FEW_SAMPLES;
/// A visited pixel has made a discovery if its samples vary this many times more than before.
const FOUND: f32 = GOAL_DISCOVERY as f32;
/// Radius, in pixels, of the neighbourhood that is assumed to be like it.
const RADIUS: usize = GOAL_RADIUS as usize;

#[derive(Default)]
pub struct Explorer {
    /// The number of rounds of visits so far.
    rounds: u32,
    /// Visited pixels, and the variance of their samples before.
    visited: Vec<(u32, f32)>,
}

impl Explorer {
    /// Raises the variances around visited pixels that have made a discovery, and visits those too.
    pub fn spread(&mut self, estimate: &mut Estimate, counts: &[u32], width: usize) {
        let mut raised = Vec::new();
        for (pixel, before) in std::mem::take(&mut self.visited) {
            let now = estimate.spreads[pixel as usize];
            if now > FOUND * before {
                raise(&mut estimate.variances, counts, width, pixel as usize, now, RADIUS, &mut raised);
            }
        }
        self.look_at(&raised, &estimate.spreads);
    }

    /// Visits pixels that were given a variance that their samples do not show.
    pub fn look_at(&mut self, pixels: &[u32], spreads: &[f32]) {
        self.visited.extend(pixels.iter().map(|&i| (i, spreads[i as usize])));
    }

    /// Gives some samples to one pixel of each run, drawn at random.
    pub fn visit(&mut self, next: &mut [u32], now: &[u32], spreads: &[f32]) {
        for (run, first) in (0..next.len()).step_by(RUN).enumerate() {
            let length = RUN.min(next.len() - first);
            let pixel = first + drawn_of(run as u32, self.rounds, length as u32) as usize;
            next[pixel] = next[pixel].max(grown(now[pixel]).min(MAX_COUNT));
            self.visited.push((pixel as u32, spreads[pixel]));
        }
        self.rounds += 1;
    }
}

/// Returns a number below `length`, at random by run and round: two rounds of pcg (Jarzynski & Olano 2020).
fn drawn_of(run: u32, round: u32, length: u32) -> u32 {
    pcg(pcg(run).wrapping_add(round)) % length
}

pub(super) fn pcg(v: u32) -> u32 {
    let state = v.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn grown(now: u32) -> u32 {
    if now < FEW { GROWTH * now } else { now + (1 << now.ilog2()) / 2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(pixels: usize) -> Estimate {
        let mut estimate = Estimate::default();
        (estimate.variances, estimate.spreads) = (vec![0.0; pixels], vec![0.0; pixels]);
        estimate
    }

    #[test]
    fn every_run_of_pixels_is_visited_and_no_pixel_is_left_out_for_ever() {
        let (now, estimate) = (vec![8; 1000], flat(1000));
        let mut ever = vec![false; 1000];
        let mut explorer = Explorer::default();
        for _ in 0..2000 {
            let mut next = now.clone();
            explorer.visit(&mut next, &now, &estimate.spreads);
            for (run, counts) in next.chunks(RUN).enumerate() {
                assert_eq!(counts.iter().filter(|n| **n == 32).count(), 1, "run {run}");
            }
            next.iter().zip(&mut ever).for_each(|(n, ever)| *ever |= *n > 8);
        }
        // A pixel is missed 2000 times with a probability of (127/128)^2000 = 1.5e-7.
        assert!(ever.iter().all(|e| *e));
    }

    #[test]
    fn visited_pixels_keep_counts_of_two_bits_and_grow_less_where_they_have_many() {
        assert_eq!([1, 8, 48, 64, 96, 1024].map(grown), [4, 32, 192, 96, 128, 1536]);
    }

    /// A texture of rare bright texels that no first pass has met: a pixel that finds one raises its neighbours, these
    /// raise theirs.
    #[test]
    fn what_one_pixel_finds_spreads_until_pixels_see_that_there_is_nothing() {
        const WIDTH: usize = 64;
        let counts = vec![8; WIDTH * 8];
        let mut explorer = Explorer::default();
        let mut estimate = flat(WIDTH * 8);
        let found = 4 * WIDTH + 20;
        explorer.look_at(&[found as u32], &estimate.spreads);
        estimate.spreads[found] = 1.0;
        explorer.spread(&mut estimate, &counts, WIDTH);
        let raised = |estimate: &Estimate| estimate.variances.iter().filter(|v| **v > 0.0).count();
        assert_eq!(raised(&estimate), 49);
        assert_eq!(estimate.variances[found], 1.0 / 16.0);
        assert_eq!(estimate.variances[found + 3], 0.25 / 16.0);
        // One neighbour finds another texel: its surroundings are raised in turn; the others have seen nothing.
        estimate.variances.fill(0.0);
        estimate.spreads[found + 3] = 1.0;
        explorer.spread(&mut estimate, &counts, WIDTH);
        assert!(estimate.variances[found + 6] > 0.0);
        assert_eq!(raised(&estimate), 49);
        // If no pixel finds any, the search ends.
        estimate.variances.fill(0.0);
        explorer.spread(&mut estimate, &counts, WIDTH);
        assert_eq!(raised(&estimate), 0);
    }
}
