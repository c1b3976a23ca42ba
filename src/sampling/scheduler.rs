//! Several backends as one: strips of rows are assigned to them round-robin, and their sums are merged. The assignment
//! depends on the strip's position and the number of backends, never on time: backends of one kind render the picture
//! that a single one renders, backends of different kinds the same picture every time. A single one may keep the pixels of a
//! picture that is sampled to a goal itself, whose samples then differ by rounding of the estimates.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use super::backend::batches_of_all;
use super::{Backend, Candidate, FilmSums, HalfSums, Made, PilotRun, Pixels};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::{Progress, SubProgress};
use crate::core::range::{Range, Rect};
use crate::schema::layout::{PixelBatch, TILE};

pub struct Scheduler<'a> {
    members: Vec<&'a mut dyn Backend>,
}

impl<'a> Scheduler<'a> {
    pub fn new(members: Vec<&'a mut dyn Backend>) -> Result<Scheduler<'a>> {
        if members.is_empty() {
            return Err(Error::new("no device is given to render on"));
        }
        Ok(Scheduler { members })
    }

    /// Returns the index of the backend that renders a row of pixels.
    pub fn owner(&self, row: u32) -> usize {
        (row / TILE) as usize % self.members.len()
    }

    /// Runs a task on all backends concurrently. If one fails, the others stop.
    fn on_each<T: Send>(
        &mut self,
        progress: &dyn Progress,
        task: impl Fn(usize, &mut dyn Backend, &dyn Progress) -> Result<T> + Sync,
    ) -> Result<Vec<T>> {
        if let [member] = self.members.as_mut_slice() {
            return Ok(vec![task(0, &mut **member, progress)?]);
        }
        let shared = Shared {
            whole: progress,
            done: self.members.iter().map(|_| AtomicU64::new(0)).collect(),
            failed: AtomicBool::new(false),
        };
        let results: Vec<Result<T>> = std::thread::scope(|scope| {
            let threads: Vec<_> = self
                .members
                .iter_mut()
                .enumerate()
                .map(|(index, member)| {
                    let (shared, task) = (&shared, &task);
                    scope.spawn(move || {
                        let result = task(index, &mut **member, &Share { of: shared, index });
                        shared.failed.fetch_or(result.is_err(), Ordering::Relaxed);
                        result
                    })
                })
                .collect();
            let join = |thread: std::thread::ScopedJoinHandle<'_, Result<T>>| {
                thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            };
            threads.into_iter().map(join).collect()
        });
        // A backend that stopped because another one failed has no error of its own.
        let failed = |r: &Result<T>| matches!(r, Err(error) if !matches!(error, Error::Interrupted));
        match results.iter().position(failed) {
            Some(index) => results.into_iter().nth(index).into_iter().collect(),
            None => results.into_iter().collect(),
        }
    }

    /// Returns the strips of a rectangle that are assigned to a backend, in order.
    fn strips(pixels: Rect, index: usize, members: usize) -> Vec<Rect> {
        // Strips end at the borders of the picture's tiles.
        let above = pixels.y % TILE;
        let raised = Rect { y: pixels.y - above, height: pixels.height + above, ..pixels };
        let own = raised.strips(TILE).filter(|strip| (strip.y / TILE) as usize % members == index);
        own.filter_map(|strip| strip.intersection(&pixels)).collect()
    }

    /// Returns for each backend the indices of the batches whose rows are assigned to it.
    fn shares(&self, batches: &[PixelBatch]) -> Vec<Vec<usize>> {
        let mut shares = vec![Vec::new(); self.members.len()];
        for (at, batch) in batches.iter().enumerate() {
            shares[self.owner(batch.column_and_row()[1])].push(at);
        }
        shares
    }
}

impl Backend for Scheduler<'_> {
    fn name(&self) -> String {
        self.members.iter().map(|member| member.name()).collect::<Vec<_>>().join(" + ")
    }

    fn prefilters(&self) -> bool {
        self.members[0].prefilters()
    }

    fn seconds(&self) -> f64 {
        self.members[0].seconds()
    }

    fn bright_share(&self) -> f64 {
        self.members[0].bright_share()
    }

    fn sum(&mut self, range: &Range, progress: &dyn Progress) -> Result<FilmSums> {
        let members = self.members.len();
        if members == 1 {
            return self.members[0].sum(range, progress);
        }
        let parts = self.on_each(progress, |index, member, progress| {
            let mut sums = FilmSums::default();
            let strips = Self::strips(range.pixels, index, members);
            for (k, &pixels) in strips.iter().enumerate() {
                let part = share_of(progress, k, strips.len());
                sums.merge(member.sum(&Range { pixels, samples: range.samples.clone() }, &part)?)?;
            }
            Ok(sums)
        })?;
        let mut sums = FilmSums::default();
        parts.into_iter().try_for_each(|part| sums.merge(part))?;
        Ok(sums)
    }

    fn means(&mut self, range: &Range, film: &mut Film, progress: &dyn Progress) -> Result<f64> {
        if let [member] = self.members.as_mut_slice() {
            return member.means(range, film, progress);
        }
        let sums = self.sum(range, progress)?;
        sums.write_to(film);
        Ok(sums.dropped())
    }

    fn resolve(&mut self, pixels: Rect, progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let members = self.members.len();
        if members == 1 {
            return self.members[0].resolve(pixels, progress);
        }
        let parts = self.on_each(progress, |index, member, progress| {
            let strips = Self::strips(pixels, index, members);
            let mut resolved = Vec::with_capacity(strips.len());
            for (k, strip) in strips.iter().enumerate() {
                resolved.push((strip.y, member.resolve(*strip, &share_of(progress, k, strips.len()))?));
            }
            Ok(resolved)
        })?;
        let mut strips: Vec<_> = parts.into_iter().flatten().collect();
        strips.sort_by_key(|(y, _)| *y);
        Ok(strips.into_iter().flat_map(|(_, pixels)| pixels).collect())
    }

    fn pilot(&mut self, progress: &dyn Progress) -> Result<Option<PilotRun>> {
        let members = self.members.len() as f64;
        let runs = self.on_each(progress, |_, member, progress| member.pilot(progress))?;
        // Each backend resolves its own strips, so all must support it.
        let runs: Option<Vec<PilotRun>> = runs.into_iter().collect();
        let Some(runs) = runs else { return Ok(None) };
        let seconds = runs.iter().map(|run| run.seconds).fold(0.0, f64::max) / members;
        Ok(runs.into_iter().next().map(|run| PilotRun { seconds, ..run }))
    }

    fn cost(&mut self, candidate: Candidate, samples: u32, progress: &dyn Progress) -> Result<Option<f64>> {
        match self.members.as_mut_slice() {
            [member] => member.cost(candidate, samples, progress),
            // Strips of several are not rendered at once by a candidate.
            _ => Ok(None),
        }
    }

    fn prefiltered_apart(
        &mut self,
        batches: &[PixelBatch],
        progress: &dyn Progress,
    ) -> Result<Option<Vec<[f32; 4]>>> {
        self.members[0].prefiltered_apart(batches, progress)
    }

    fn render_by(
        &mut self,
        candidate: Candidate,
        samples: u32,
        seconds: f64,
        film: &mut Film,
        progress: &dyn Progress,
    ) -> Result<Made> {
        self.members[0].render_by(candidate, samples, seconds, film, progress)
    }

    fn sample(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<()> {
        if let [member] = self.members.as_mut_slice() {
            return member.sample(batches, progress);
        }
        let shares = self.shares(batches);
        self.on_each(progress, |index, member, progress| {
            let own: Vec<PixelBatch> = shares[index].iter().map(|&at| batches[at]).collect();
            member.sample(&own, progress)
        })?;
        Ok(())
    }

    fn sample_all(&mut self, size: [u32; 2], first: u32, count: u32, progress: &dyn Progress) -> Result<()> {
        if let [member] = self.members.as_mut_slice() {
            return member.sample_all(size, first, count, progress);
        }
        self.sample(&batches_of_all(size, first, count), progress)
    }

    fn sample_apart(&mut self, batches: &[PixelBatch], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        if let [member] = self.members.as_mut_slice() {
            return member.sample_apart(batches, progress);
        }
        let shares = self.shares(batches);
        let parts = self.on_each(progress, |index, member, progress| {
            let own: Vec<PixelBatch> = shares[index].iter().map(|&at| batches[at]).collect();
            member.sample_apart(&own, progress)
        })?;
        let mut sums = vec![[0.0; 4]; batches.len()];
        for (&at, sum) in shares.iter().flatten().zip(parts.iter().flatten()) {
            sums[at] = *sum;
        }
        Ok(sums)
    }

    fn read(&mut self, sums: &mut HalfSums) -> Result<()> {
        let members = self.members.len();
        let (width, pixels) = (sums.width as usize, Rect::whole([sums.width, sums.height]));
        self.members[0].read(sums)?;
        for index in 1..members {
            let mut own = HalfSums::new([sums.width, sums.height]);
            self.members[index].read(&mut own)?;
            for strip in Self::strips(pixels, index, members) {
                let places = strip.y as usize * width..(strip.y + strip.height) as usize * width;
                for (sums, own) in sums.halves.iter_mut().zip(&own.halves) {
                    sums[places.clone()].copy_from_slice(&own[places.clone()]);
                }
            }
        }
        Ok(())
    }

    fn keeps_pixels(&self) -> bool {
        matches!(self.members.as_slice(), [member] if member.keeps_pixels())
    }

    fn kept_pixels(&mut self) -> Result<Option<Box<dyn Pixels + '_>>> {
        match self.members.as_mut_slice() {
            [member] => member.kept_pixels(),
            _ => Ok(None),
        }
    }

    fn first_samples(&self, most: u32, pixels: usize) -> Result<Vec<u32>> {
        self.members[0].first_samples(most, pixels)
    }
}

/// Returns the progress of part `index` of `count` equal parts.
fn share_of(whole: &dyn Progress, index: usize, count: usize) -> SubProgress<'_> {
    let at = |k: usize| k as f64 / count as f64;
    SubProgress { whole, from: at(index), to: at(index + 1) }
}

/// The progress of all backends, and a flag that is set when one fails.
struct Shared<'a> {
    whole: &'a dyn Progress,
    /// Progress of each backend, in thousandths.
    done: Vec<AtomicU64>,
    failed: AtomicBool,
}

struct Share<'a> {
    of: &'a Shared<'a>,
    index: usize,
}

impl Progress for Share<'_> {
    fn advance(&self, done: f64) {
        let shares = &self.of.done;
        shares[self.index].store((1000.0 * done) as u64, Ordering::Relaxed);
        let sum: u64 = shares.iter().map(|share| share.load(Ordering::Relaxed)).sum();
        self.of.whole.advance(sum as f64 / (1000 * shares.len()) as f64);
    }

    fn cancelled(&self) -> bool {
        self.of.failed.load(Ordering::Relaxed) || self.of.whole.cancelled()
    }
}
