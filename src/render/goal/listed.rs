//! The samples of a list that the device has made. Input: the number of pixels in each class of lengths. Output: sums in the
//! film; those of long batches in parts first, which several threads take at once.

use super::{Ahead, DevicePixels};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::render::batch_lists::Listed;
use crate::sampling::Backend;
use crate::schema::blocks::GoalStep;
use crate::schema::constants::{GOAL_LONG_CLASS, GOAL_PART_COUNT, GOAL_PART_SAMPLES};
use crate::schema::enums::GoalStepKind as Kind;

/// Returns the most samples of a batch of a class.
fn most_of_class(kind: u32) -> u32 {
    let octave = 1 << (kind / 2);
    if kind % 2 == 0 { octave + octave / 2 - u32::from(octave > 1) } else { 2 * octave - 1 }
}

impl DevicePixels<'_, '_> {
    /// Takes the same number of samples of all pixels, at once with the next steps if possible.
    pub(super) fn sample_all(&mut self, now: u32, next: u32, progress: &dyn Progress) -> Result<()> {
        match self.backend.batches()?.0.all_at_once(now, next - now) {
            Some(at_once) => self.ahead.push(Ahead::Samples(at_once)),
            None => self.backend.sample_all(self.steps.size, now, next - now, progress)?,
        }
        Ok(())
    }

    /// Takes the samples of a list with these numbers of pixels in each class, those of long batches in parts.
    pub(super) fn sample_classes(&mut self, classes: &[u32], progress: &dyn Progress) -> Result<()> {
        let (short, long) = classes.split_at(GOAL_LONG_CLASS as usize);
        let lengths: Vec<(u32, u32)> = (0..GOAL_LONG_CLASS)
            .zip(short)
            .rev()
            .map(|(kind, &pixels)| (2 * pixels, most_of_class(kind)))
            .collect();
        if short.iter().any(|&pixels| pixels > 0) {
            let listed = Listed { batches: &self.steps.batches, lengths: &lengths };
            let (sampler, report) = self.backend.batches()?;
            match sampler.listed_at_once(&listed) {
                Some(at_once) => self.ahead.push(Ahead::Samples(at_once)),
                None => sampler.sample_listed(&listed, report, progress)?,
            }
        }
        let most = |(kind, &pixels): (u32, &u32)| {
            2 * u64::from(pixels) * u64::from(most_of_class(kind).div_ceil(GOAL_PART_SAMPLES))
        };
        let most: u64 = (GOAL_LONG_CLASS..).zip(long).map(most).sum();
        if most == 0 {
            return Ok(());
        }
        let most = u32::try_from(most).map_err(|_| Error::new("a pass has too many parts of batches"))?;
        self.make_room(most)?;
        self.sample_parts(most, progress)
    }

    /// Takes at most that number of parts.
    fn sample_parts(&mut self, most: u32, progress: &dyn Progress) -> Result<()> {
        let listed = |count| [(count, GOAL_PART_SAMPLES)];
        let bound = Listed { batches: &self.parts.list, lengths: &listed(most) };
        if let Some(at_once) = self.backend.batches()?.0.listed_at_once(&bound) {
            let push = GoalStep { count: most, ..self.push };
            self.ahead.extend([Kind::ListParts, Kind::EndParts].map(|kind| Ahead::Step(kind, push)));
            self.ahead.push(Ahead::Parts(at_once));
        } else {
            let [count] = self.run(&[(Kind::ListParts, self.push)], GOAL_PART_COUNT)?;
            let listed = Listed { batches: &self.parts.list, lengths: &listed(count) };
            let (sampler, report) = self.backend.batches()?;
            sampler.sample_listed_apart(&listed, &self.parts.sums, report, progress)?;
        }
        self.ahead.push(Ahead::Step(Kind::AddParts, self.push));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::most_of_class;

    #[test]
    fn classes_end_where_the_next_ones_begin() {
        let ends: Vec<u32> = (0..10).map(most_of_class).collect();
        // The second class has no length.
        assert_eq!(ends, [1, 1, 2, 3, 5, 7, 11, 15, 23, 31]);
        assert_eq!(most_of_class(crate::schema::constants::GOAL_LONG_CLASS - 1), 95);
    }
}
