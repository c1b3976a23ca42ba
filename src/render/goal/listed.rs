//! The samples of a list that the device has made. Input: the number of pixels in each class of lengths. Output: sums in the
//! film; those of long batches in parts first, which several threads take at once.

use super::{Ahead, DevicePixels};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::render::batch_lists::Listed;
use crate::schema::blocks::GoalStep;
use crate::schema::constants::{GOAL_LONG_CLASS, GOAL_PART_COUNT, GOAL_PART_SAMPLES};
use crate::schema::enums::GoalStepKind as Kind;
use crate::schema::layout::MAX_SAMPLES_AT_ONCE;

/// Returns the most samples of a batch of a class.
fn most_of_class(kind: u32) -> u32 {
    let octave = 1 << (kind / 2);
    if kind.is_multiple_of(2) { octave + octave / 2 - u32::from(octave > 1) } else { 2 * octave - 1 }
}

impl DevicePixels<'_, '_> {
    /// Takes the same number of samples of all pixels, at once with the next steps if possible.
    pub(super) fn sample_all(&mut self, now: u32, next: u32, progress: &dyn Progress) -> Result<()> {
        match self.backend.sampler()?.0.all_at_once(now, next - now) {
            Some(at_once) => self.ahead.push(Ahead::Samples(at_once)),
            None => self.backend.sample_all(self.steps.size, now, next - now, progress)?,
        }
        Ok(())
    }

    /// Takes the samples of a list with these numbers of pixels in each class, those of long batches in parts.
    pub(super) fn sample_classes(&mut self, classes: &[u32], progress: &dyn Progress) -> Result<()> {
        // Longest first.
        let mut lengths: Vec<(u32, u32)> =
            (0..).zip(classes).map(|(kind, &pixels)| (2 * pixels, most_of_class(kind))).collect();
        lengths.reverse();
        let (long, short) = lengths.split_at(classes.len() - GOAL_LONG_CLASS as usize);
        if short.iter().any(|(batches, _)| *batches > 0) {
            let listed = Listed { batches: &self.steps.batches, lengths: short };
            let (sampler, report) = self.backend.sampler()?;
            match sampler.listed_at_once(&listed) {
                Some(at_once) => self.ahead.push(Ahead::Samples(at_once)),
                None => sampler.sample_listed(&listed, report, progress)?,
            }
        }
        let long: Vec<(u32, u32)> = long.iter().copied().filter(|(batches, _)| *batches > 0).collect();
        self.sample_long(&long, progress)
    }

    /// Takes long batches, given by their numbers and most samples, in as few rounds as there is room for their parts.
    fn sample_long(&mut self, long: &[(u32, u32)], progress: &dyn Progress) -> Result<()> {
        let room = u64::from(self.steps.long.room);
        let most = long.iter().map(|length| length.1).max().unwrap_or(0);
        let few = parts_of(long, 0, most, GOAL_PART_SAMPLES) <= room;
        let part_samples = if few { GOAL_PART_SAMPLES } else { MAX_SAMPLES_AT_ONCE };
        let mut from = 0;
        while from < most {
            let mut samples = (most - from).next_multiple_of(part_samples);
            while samples > part_samples && parts_of(long, from, from + samples, part_samples) > room {
                samples = (samples / 2).next_multiple_of(part_samples);
            }
            let until = from + samples;
            let parts = parts_of(long, from, until, part_samples);
            let parts = u32::try_from(parts).ok().filter(|parts| *parts <= self.steps.long.room);
            let parts = parts.ok_or_else(|| Error::new("a pass has too many parts of batches"))?;
            let push = GoalStep { part_samples, from, until, count: parts, ..self.push };
            self.sample_parts(&push, progress)?;
            from = until;
        }
        Ok(())
    }

    /// Takes at most `push.count` parts.
    fn sample_parts(&mut self, push: &GoalStep, progress: &dyn Progress) -> Result<()> {
        // One submission takes no more than one round.
        if self.ahead.iter().any(|work| matches!(work, Ahead::Parts(_))) {
            self.submit(&[])?;
        }
        let bound = [(push.count, push.part_samples)];
        let bound = Listed { batches: &self.steps.long.list, lengths: &bound };
        if let Some(at_once) = self.backend.sampler()?.0.listed_at_once(&bound) {
            self.ahead.extend([Kind::ListParts, Kind::EndParts].map(|kind| Ahead::Step(kind, *push)));
            self.ahead.push(Ahead::Parts(at_once));
        } else {
            let [count] = self.run(&[(Kind::ListParts, *push)], GOAL_PART_COUNT)?;
            let lengths = [(count, push.part_samples)];
            let listed = Listed { batches: &self.steps.long.list, lengths: &lengths };
            let (sampler, report) = self.backend.sampler()?;
            sampler.sample_listed_apart(&listed, &self.steps.long.sums, report, progress)?;
        }
        self.ahead.push(Ahead::Step(Kind::AddParts, *push));
        Ok(())
    }
}

/// Returns the parts of those of the batches' samples from one on and before another.
fn parts_of(batches: &[(u32, u32)], from: u32, until: u32, part_samples: u32) -> u64 {
    let parts = |&(number, most): &(u32, u32)| {
        u64::from(number) * u64::from((most.min(until) - most.min(from)).div_ceil(part_samples))
    };
    batches.iter().map(parts).sum()
}

#[cfg(test)]
mod tests {
    use super::{most_of_class, parts_of};

    #[test]
    fn classes_end_where_the_next_ones_begin() {
        let ends: Vec<u32> = (0..10).map(most_of_class).collect();
        // The second class has no length.
        assert_eq!(ends, [1, 1, 2, 3, 5, 7, 11, 15, 23, 31]);
        assert_eq!(most_of_class(crate::schema::constants::GOAL_LONG_CLASS - 1), 95);
    }

    #[test]
    fn all_samples_have_a_part() {
        let batches = [(10, 1000), (3, 100)];
        assert_eq!(parts_of(&batches, 0, 1000, 64), 10 * 16 + 3 * 2);
        assert_eq!(parts_of(&batches, 64, 128, 64), 10 + 3);
        assert_eq!(parts_of(&batches, 128, 1024, 256), 10 * 4);
    }
}
