//! The pixels of a picture that is sampled to a goal, kept by the host. Input: any backend, whose sums are read after each
//! pass. Output: batches of samples for it, and what `Pixels` tells the loop of passes.

use std::collections::BTreeMap;

use super::allocate::Allocation;
use super::audit;
use super::draws::Masses;
use super::estimate::Estimate;
use super::explore::Explorer;
use super::resolved::{ResolvedPixels, shares};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::core::range::{Range, Rect};
use crate::sampling::{
    AuditPlan, Audited, Backend, Block, Count, Drawn, Estimated, FilmSums, HalfSums, PilotRun, Pixels, Plan,
    Planned, Raises,
};
use crate::schema::layout::PixelBatch;

/// Rows of the film that are made at once.
const FILM_ROWS: u32 = 64;

pub struct HostPixels<'b> {
    backend: &'b mut dyn Backend,
    size: [u32; 2],
    sums: HalfSums,
    /// Samples in each half of each pixel: now, and after the planned pass.
    counts: Vec<u32>,
    next: Vec<u32>,
    estimate: Estimate,
    /// Seconds of the last samples.
    sampling: f64,
    explorer: Explorer,
    resolved: ResolvedPixels,
}

impl<'b> HostPixels<'b> {
    pub fn new(backend: &'b mut dyn Backend, size: [u32; 2]) -> HostPixels<'b> {
        let counts = vec![0u32; size[0] as usize * size[1] as usize];
        HostPixels {
            backend,
            size,
            sums: HalfSums::new(size),
            next: counts.clone(),
            counts,
            estimate: Estimate::default(),
            sampling: 0.0,
            explorer: Explorer::default(),
            resolved: ResolvedPixels::default(),
        }
    }

    fn width(&self) -> usize {
        self.size[0] as usize
    }
}

impl Pixels for HostPixels<'_> {
    fn backend(&mut self) -> &mut dyn Backend {
        self.backend
    }

    fn plan_first(&mut self, most: u32) -> Result<()> {
        self.next = self.backend.first_samples(most, self.counts.len())?;
        Ok(())
    }

    fn plan_all(&mut self, count: u32) -> Result<()> {
        self.next = vec![count; self.counts.len()];
        Ok(())
    }

    fn plan(&mut self, plan: &Plan) -> Result<Planned> {
        let allocation = Allocation::new(&self.estimate.variances, &self.counts, plan.exponent);
        self.next = allocation.counts(plan.aim, &self.counts, plan.growth, plan.most);
        // If no pixel that matters may have more samples, exploring does not help either.
        if self.next != self.counts || plan.explores {
            self.explorer.visit(&mut self.next, &self.counts, &self.estimate.spreads);
        }
        Ok(Planned { gains: self.next != self.counts, cost: allocation.cost(plan.aim) })
    }

    fn sample(&mut self, progress: &dyn Progress) -> Result<()> {
        let begun = self.backend.seconds();
        match (equal(&self.counts), equal(&self.next)) {
            (Some(now), Some(next)) => self.backend.sample_all(self.size, now, next - now, progress)?,
            _ => self.backend.sample(&batches(&self.counts, &self.next, self.size[0]), progress)?,
        }
        self.sampling = self.backend.seconds() - begun;
        self.counts.clone_from(&self.next);
        Ok(())
    }

    fn estimate(&mut self, bright: bool) -> Result<Estimated> {
        self.backend.read(&mut self.sums)?;
        self.resolved.replace(&mut self.sums, &self.counts);
        self.estimate = Estimate::new(&self.sums, &self.counts, bright);
        self.resolved.clear_variances(&mut self.estimate.variances);
        let estimated = Estimated {
            taken: total(&self.counts),
            sampling: self.sampling,
            mse: self.estimate.mse,
            deviation: self.estimate.deviation,
            variance: self.estimate.mean_variance(),
            resolved: self.resolved.count() as u64,
            least: self.counts.iter().copied().min().unwrap_or(0),
            most: self.counts.iter().copied().max().unwrap_or(0),
        };
        let width = self.width();
        self.explorer.spread(&mut self.estimate, &self.counts, width);
        Ok(estimated)
    }

    fn audit(&mut self, plan: &AuditPlan, progress: &dyn Progress) -> Result<Vec<Audited>> {
        let of = (self.counts.as_slice(), self.estimate.variances.as_slice());
        let masses = Masses::new(of, self.width(), plan.budget)?;
        let drawn = |pixel: usize| Drawn {
            pixel: pixel as u32,
            count: self.counts[pixel],
            halves: [0, 1].map(|half| self.sums.halves[half][pixel]),
            draws: masses.draws_of(pixel),
            resolved: self.resolved.has(pixel),
        };
        let drawn: Vec<Drawn> = masses.draw(plan.start).into_iter().map(drawn).collect();
        audit::sample_drawn(self.backend, self.size[0], &drawn, plan, progress)
    }

    fn raise(&mut self, raises: &Raises) -> Result<()> {
        let width = self.width();
        let raised = audit::raise_all(raises, &mut self.estimate.variances, &self.counts, width);
        self.explorer.look_at(&raised, &self.estimate.spreads);
        Ok(())
    }

    fn shares(&mut self, pilot: &PilotRun, exponent: f64) -> Result<[f64; 2]> {
        Ok(shares(pilot, &self.counts, &self.estimate.variances, exponent))
    }

    fn resolve(&mut self, resolved: Vec<[f32; 4]>) -> Result<()> {
        self.resolved = ResolvedPixels::new(resolved);
        self.next.clone_from(&self.counts);
        Ok(())
    }

    /// The samples of the second half follow those of the first.
    fn write_to(&mut self, film: &mut Film) -> Result<()> {
        let most = self.counts.iter().copied().max().unwrap_or(0);
        for pixels in Rect::whole(self.size).strips(FILM_ROWS) {
            let first = pixels.y as usize * self.width();
            let places = first..first + pixels.area();
            let half = |half: u32| {
                let own = &self.sums.halves[half as usize][places.clone()];
                let mut block = Block::new(Range { pixels, samples: half * most..(half + 1) * most });
                block.sums = own.iter().map(|&[r, g, b, _]| [r, g, b].map(f64::from)).collect();
                block.squares = own.iter().map(|&[.., squares]| f64::from(squares)).collect();
                block.count = Count::Each(self.counts[places.clone()].to_vec());
                FilmSums::from(block)
            };
            let mut both = half(0);
            both.merge(half(1))?;
            both.write_to(film);
        }
        Ok(())
    }

    fn counts_and_variances(&mut self) -> Result<(Vec<u32>, Vec<f32>)> {
        let samples = self.counts.iter().map(|count| 2 * count).collect();
        Ok((samples, self.estimate.variances.clone()))
    }
}

/// Returns the count of all pixels if it is the same for all.
fn equal(counts: &[u32]) -> Option<u32> {
    counts.first().copied().filter(|first| counts.iter().all(|n| n == first))
}

/// Returns the samples of both halves.
fn total(counts: &[u32]) -> f64 {
    2.0 * counts.iter().map(|&n| f64::from(n)).sum::<f64>()
}

/// Returns the batches that take each half of each pixel from `counts` to `next` samples, longest first, so that
/// neighbouring threads have equal amounts of work.
fn batches(counts: &[u32], next: &[u32], width: u32) -> Vec<PixelBatch> {
    // There are few different lengths, so pixels are put into buckets instead of sorted.
    let mut lengths: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (i, (&now, &next)) in (0..).zip(counts.iter().zip(next)) {
        if next > now {
            lengths.entry(next - now).or_default().push(i);
        }
    }
    let batch = |i: u32, half, count| PixelBatch {
        place: PixelBatch::place_of(i, width),
        part: PixelBatch::part_of(half),
        first: counts[i as usize],
        count,
    };
    let both = |(count, pixels): (u32, Vec<u32>)| {
        let pair = |i: u32| [batch(i, 0, count), batch(i, 1, count)];
        pixels.into_iter().flat_map(pair).collect::<Vec<_>>()
    };
    lengths.into_iter().rev().flat_map(both).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_count_differs_from_several() {
        assert_eq!([equal(&[3, 3, 3]), equal(&[3, 4, 3]), equal(&[])], [Some(3), None, None]);
    }
}
