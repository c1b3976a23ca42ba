//! The pixels of an audit, drawn by the device. Input: sums over all pixels by the last estimate. Output: for each draw a
//! pixel's sums, its expected number of draws, and two new means.

use super::{Ahead, DevicePixels};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::integrators::adaptive::{DrawRates, first_draw, sample_drawn};
use crate::render::batch_lists::Listed;
use crate::sampling::{AuditPlan, Audited, Drawn};
use crate::schema::blocks::GoalStep;
use crate::schema::constants::{
    DRAW_UNIT, GOAL_DRAW_WORDS, GOAL_DRAWN, GOAL_DRAWS, GOAL_PART_SAMPLES, MAX_GOAL_DRAWS,
};
use crate::schema::enums::GoalStepKind as Kind;

/// Sums over all pixels of their variance times a factor, or 1 where that is less, for factors of which each is four times
/// the one before.
struct Capped {
    first: f64,
    sums: [f64; 8],
}

impl Capped {
    /// Returns the sum for a factor by linear interpolation of logarithms.
    fn at(&self, factor: f64) -> f64 {
        let place = ((factor / self.first).log2() / 2.0).clamp(0.0, 6.999);
        let [low, high] = [0, 1].map(|k| self.sums[place as usize + k].max(f64::MIN_POSITIVE));
        low * (high / low).powf(place.fract())
    }
}

/// Returns the words of each draw.
fn draws_of(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let (head, draws) = words.split_at((GOAL_DRAWS - GOAL_DRAWN) as usize);
    draws.chunks_exact(GOAL_DRAW_WORDS as usize).take(head[0] as usize)
}

fn sums(words: &[u32], first: usize) -> [f32; 4] {
    std::array::from_fn(|c| f32::from_bits(words[first + c]))
}

fn drawn(words: &[u32]) -> Drawn {
    Drawn {
        pixel: words[0],
        count: words[1],
        halves: [sums(words, 4), sums(words, 8)],
        draws: f64::from(words[2]) / f64::from(DRAW_UNIT),
        resolved: words[3] > 0,
    }
}

fn audited(words: &[u32]) -> Audited {
    Audited { drawn: drawn(words), samples: words[12], sums: [sums(words, 16), sums(words, 20)] }
}

impl DevicePixels<'_, '_> {
    /// Draws the pixels of an audit and samples them anew, all in one submission if it can hold the samples.
    pub(super) fn audit_pixels(&mut self, plan: &AuditPlan, progress: &dyn Progress) -> Result<Vec<Audited>> {
        let mut capped: Option<Capped> = None;
        let sums = self.draw_sums;
        let rates = DrawRates::new(&sums, plan.budget, |factor| {
            if capped.is_none() {
                capped = Some(self.capped(factor)?);
            }
            Ok(capped.as_ref().map_or(0.0, |capped| capped.at(factor)))
        })?;
        let of_variance = capped.map_or(0.0, |capped| capped.at(f64::from(rates.of_variance)));
        let expected = f64::from(rates.even) * sums.inverse_cost + of_variance;
        let most = ((1.25 * expected) as u32 + 256).min(MAX_GOAL_DRAWS).min(self.steps.count());
        let parts = plan.budget as u32 / GOAL_PART_SAMPLES + 2 * MAX_GOAL_DRAWS;
        let push = GoalStep {
            even: rates.even.to_bits(),
            of_variance: rates.of_variance.to_bits(),
            start: first_draw(plan.start) as u32,
            budget: (plan.budget as f32).to_bits(),
            batch_part: plan.part,
            count: parts,
            part_samples: GOAL_PART_SAMPLES,
            ..self.push
        };
        let draw = [Kind::WeighCells, Kind::SumMasses, Kind::DrawPixels].map(|kind| (kind, push));
        let mut words = vec![0; (GOAL_DRAWS - GOAL_DRAWN + most * GOAL_DRAW_WORDS) as usize];
        let listed = Listed { batches: &self.steps.long.list, lengths: &[(parts, GOAL_PART_SAMPLES)] };
        let fits = parts <= self.steps.long.room;
        if let Some(at_once) = self.backend.sampler()?.0.listed_at_once(&listed).filter(|_| fits) {
            let list = draw.into_iter().chain([Kind::DrawParts, Kind::EndParts].map(|kind| (kind, push)));
            self.ahead.extend(list.map(|(kind, push)| Ahead::Step(kind, push)));
            self.ahead.push(Ahead::Parts(at_once));
            self.run_into(&[(Kind::SumDraws, push)], GOAL_DRAWN, &mut words)?;
            return Ok(draws_of(&words).map(audited).collect());
        }
        self.run_into(&draw, GOAL_DRAWN, &mut words)?;
        let drawn: Vec<Drawn> = draws_of(&words).map(drawn).collect();
        sample_drawn(self.backend, self.steps.size[0], &drawn, plan, progress)
    }

    fn capped(&mut self, first: f64) -> Result<Capped> {
        let push = GoalStep { of_variance: (first as f32).to_bits(), count: 8, ..self.push };
        let words: [u32; 8] = self.run(&[(Kind::SumCapped, push), (Kind::SumPartials, push)], 0)?;
        Ok(Capped { first, sums: words.map(|bits| f64::from(f32::from_bits(bits))) })
    }
}
