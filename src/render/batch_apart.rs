//! Batches whose sums do not go to the film, such as those of audits. They are divided into short parts, each of which has an
//! entry of its own on the device. Input: batches. Output: the sums of each.

use super::Report;
use super::batch_lists::{Batches, halves};
use super::batches::{BatchSampler, film_of, weighed};
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::gpu::BufferUse;
use crate::schema::constants::GOAL_PART_SAMPLES;
use crate::schema::layout::PixelBatch;

/// Samples that one invocation takes of a batch that does not go to the film.
const PART_SAMPLES: u32 = GOAL_PART_SAMPLES;
/// Number of such batches whose sums one buffer holds.
const MAX_PARTS: usize = 1 << 20;

/// A part of a batch that does not go to the film: the batch's index, and samples for one invocation.
type Part = (usize, PixelBatch);

/// Sums of each entry: of radiance, and if samples have signs also of negative samples, and the counts.
type Planes = Vec<Vec<[f32; 4]>>;

/// Adds one entry of the planes.
fn add(sums: &mut [[f64; 4]; 3], planes: &Planes, entry: usize) {
    for (sum, plane) in sums.iter_mut().zip(planes) {
        (0..4).for_each(|c| sum[c] += f64::from(plane[entry][c]));
    }
}

impl BatchSampler<'_> {
    /// Sums each batch separately, without adding it to the film.
    pub fn sample_apart(
        &mut self,
        batches: &[PixelBatch],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<Vec<[f32; 4]>> {
        // Each part that an invocation takes has a slot of its own. Parts are short, so that neighbouring invocations
        // work on one pixel and follow the same paths.
        let most = self.block.min(PART_SAMPLES);
        let mut parts: Vec<Part> = Vec::new();
        for (i, batch) in batches.iter().enumerate() {
            let firsts = (0..batch.count).step_by(most as usize);
            parts.extend(firsts.map(|first| {
                (i, PixelBatch { first: batch.first + first, count: most.min(batch.count - first), ..*batch })
            }));
        }
        let mut sums = vec![[[0f64; 4]; 3]; batches.len()];
        let mut pass = 0;
        while !parts.is_empty() {
            let mut left: Vec<Part> = Vec::new();
            for parts in parts.chunks(MAX_PARTS) {
                let (planes, unfinished) = self.parts_apart(pass, parts, report, progress)?;
                let mut is_left = vec![false; parts.len()];
                unfinished.iter().for_each(|&at| is_left[at as usize] = true);
                for (at, &(i, batch)) in parts.iter().enumerate() {
                    if !is_left[at] {
                        add(&mut sums[i], &planes, at);
                    } else {
                        left.push((i, batch));
                    }
                }
            }
            if pass == self.passes.last() && !left.is_empty() {
                left = match halves(left.iter().map(|(_, batch)| batch)) {
                    Some(pairs) => {
                        let of =
                            left.iter().zip(pairs).flat_map(|(&(i, _), pair)| pair.map(|half| (i, half)));
                        of.filter(|(_, half)| half.count > 0).collect()
                    }
                    None => {
                        self.parts_alone(&left, &mut sums, report, progress)?;
                        Vec::new()
                    }
                };
            }
            parts = left;
            pass = self.passes.last().min(pass + 1);
        }
        let finish = |sums: [[f64; 4]; 3]| match self.mean_sign {
            Some(mean) => weighed(sums, mean),
            None => sums[0].map(|v| v as f32),
        };
        Ok(sums.into_iter().map(finish).collect())
    }

    /// Takes parts by one pass. Returns their sums, and which ones are left.
    fn parts_apart(
        &mut self,
        pass: usize,
        parts: &[Part],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<(Planes, Vec<u32>)> {
        let list: Vec<PixelBatch> = parts.iter().map(|(_, batch)| *batch).collect();
        let planes = if self.mean_sign.is_some() { 3 } else { 1 };
        let plane = (list.len() * size_of::<[f32; 4]>()) as u64;
        let buffer = self.gpu.buffer("audit", planes * plane, BufferUse::Storage)?;
        // Positions are those of the whole picture.
        let film = film_of(Rect::whole(self.size), buffer);
        let left = self.passes.indices_left(pass, &film, &Batches::List(&list), report, progress)?;
        let read = |kind: u64| {
            let mut sums = vec![[0f32; 4]; list.len()];
            self.gpu.read_buffer(&film.buffer, kind * plane, bytemuck::cast_slice_mut(&mut sums))?;
            Ok(sums)
        };
        Ok(((0..planes).map(read).collect::<Result<_>>()?, left))
    }

    /// Adds parts of one sample to the sums of their batches, each part in a workgroup of its own.
    fn parts_alone(
        &mut self,
        parts: &[Part],
        sums: &mut [[[f64; 4]; 3]],
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for part in parts {
            let apart = self.passes.apart(&[part.1]);
            let list: Vec<Part> = apart.into_iter().map(|batch| (part.0, batch)).collect();
            let (planes, left) = self.parts_apart(self.passes.last(), &list, report, progress)?;
            if !left.is_empty() {
                let film = film_of(Rect::whole(self.size), self.pages[0].film.buffer.clone());
                return Err(self.passes.too_long(&film, &part.1));
            }
            add(&mut sums[part.0], &planes, 0);
        }
        Ok(())
    }
}
