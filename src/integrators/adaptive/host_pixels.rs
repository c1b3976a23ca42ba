//! The pixels of a picture that is sampled to a goal, kept by the host. Input: any backend, whose sums are read after each
//! pass. Output: batches of samples for it, and what `Pixels` tells the loop of passes.

use super::allocate::Allocation;
use rayon::prelude::*;

use super::audit;
use super::batch_lists::BatchLists;
use super::draws::Masses;
use super::estimate::Estimate;
use super::explore::Explorer;
use super::resolved::{ResolvedPixels, shares};
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::sampling::{
    AuditPlan, Audited, Backend, Drawn, Estimated, HalfSums, PilotRun, Pixels, Plan, Planned, Raises,
};

pub struct HostPixels<'b> {
    backend: &'b mut dyn Backend,
    size: [u32; 2],
    sums: HalfSums,
    /// Samples in each half of each pixel: now, and after the planned pass.
    counts: Vec<u32>,
    next: Vec<u32>,
    estimate: Estimate,
    allocation: Allocation,
    lists: BatchLists,
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
            allocation: Allocation::default(),
            lists: BatchLists::default(),
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
        self.allocation.update(&self.estimate.variances, &self.counts, plan.exponent);
        self.allocation.choose(plan.aim, &self.counts, plan.growth, plan.most, &mut self.next);
        // If no pixel that matters may have more samples, exploring does not help either.
        if self.next != self.counts || plan.explores {
            self.explorer.visit(&mut self.next, &self.counts, &self.estimate.spreads);
        }
        Ok(Planned { gains: self.next != self.counts, cost: self.allocation.cost(plan.aim) })
    }

    fn sample(&mut self, progress: &dyn Progress) -> Result<()> {
        let begun = self.backend.seconds();
        match (equal(&self.counts), equal(&self.next)) {
            (Some(now), Some(next)) => self.backend.sample_all(self.size, now, next - now, progress)?,
            _ => self.backend.sample(self.lists.list(&self.counts, &self.next, self.size[0]), progress)?,
        }
        self.sampling = self.backend.seconds() - begun;
        self.counts.clone_from(&self.next);
        Ok(())
    }

    fn estimate(&mut self, bright: bool) -> Result<Estimated> {
        self.backend.read(&mut self.sums)?;
        self.resolved.replace(&mut self.sums, &self.counts);
        self.estimate.update(&self.sums, &self.counts, bright);
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

    fn write_to(&mut self, film: &mut Film) -> Result<()> {
        let [first, second] = &self.sums.halves;
        film.pixels.par_iter_mut().enumerate().for_each(|(i, pixel)| {
            let samples = 2.0 * f64::from(self.counts[i]);
            let mean = |c: usize| (f64::from(first[i][c]) + f64::from(second[i][c])) / samples;
            *pixel = std::array::from_fn(|c| mean(c) as f32);
        });
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_count_differs_from_several() {
        assert_eq!([equal(&[3, 3, 3]), equal(&[3, 4, 3]), equal(&[])], [Some(3), None, None]);
    }
}
