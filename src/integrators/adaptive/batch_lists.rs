//! Counts now and after a pass → the batches of both halves of each pixel, longest first, so that neighbouring threads have
//! equal amounts of work; those of one length in the order of the pixels.

use std::collections::BTreeMap;

use rayon::prelude::*;

use crate::schema::layout::PixelBatch;

/// Pixels that one thread lists at once.
const PIXELS_PER_TASK: usize = 1 << 14;

/// A list whose memory is kept from pass to pass.
#[derive(Default)]
pub struct BatchLists {
    batches: Vec<PixelBatch>,
}

impl BatchLists {
    /// Returns the batches that take each half of each pixel of a picture of that width from `counts` to `next` samples.
    pub fn list(&mut self, counts: &[u32], next: &[u32], width: u32) -> &[PixelBatch] {
        let chunks = || counts.par_chunks(PIXELS_PER_TASK).zip(next.par_chunks(PIXELS_PER_TASK));
        // There are few different lengths, so pixels are put into buckets instead of sorted.
        let numbers: Vec<Lengths> = chunks().map(|(now, next)| Lengths::of(now, next)).collect();
        let mut lengths: BTreeMap<u32, usize> = BTreeMap::new();
        for &(length, pixels) in numbers.iter().flat_map(|lengths| &lengths.0) {
            *lengths.entry(length).or_default() += pixels;
        }
        self.batches.resize(2 * lengths.values().sum::<usize>(), PixelBatch::default());
        // The batches of each length in each chunk.
        let mut rest = self.batches.as_mut_slice();
        let mut rooms: Vec<Vec<(u32, &mut [PixelBatch])>> = numbers.iter().map(|_| Vec::new()).collect();
        for &length in lengths.keys().rev() {
            for (own, rooms) in numbers.iter().zip(&mut rooms) {
                if let Some(&(_, pixels)) = own.0.iter().find(|(other, _)| *other == length) {
                    let (room, behind) = std::mem::take(&mut rest).split_at_mut(2 * pixels);
                    rooms.push((length, room));
                    rest = behind;
                }
            }
        }
        chunks().zip(rooms).enumerate().for_each(|(chunk, ((now, next), mut rooms))| {
            let mut last = 0;
            for (i, (&now, &next)) in ((chunk * PIXELS_PER_TASK) as u32..).zip(now.iter().zip(next)) {
                if next <= now {
                    continue;
                }
                if rooms[last].0 != next - now {
                    last = rooms.iter().position(|(length, _)| *length == next - now).unwrap_or(last);
                }
                let room = std::mem::take(&mut rooms[last].1);
                let (pair, behind) = room.split_at_mut(2);
                for (half, batch) in (0..).zip(pair) {
                    let place = PixelBatch::place_of(i, width);
                    *batch =
                        PixelBatch { place, part: PixelBatch::part_of(half), first: now, count: next - now };
                }
                rooms[last].1 = behind;
            }
        });
        &self.batches
    }
}

/// (length, pixels) of the batches of some pixels.
struct Lengths(Vec<(u32, usize)>);

impl Lengths {
    fn of(now: &[u32], next: &[u32]) -> Lengths {
        let mut lengths: Vec<(u32, usize)> = Vec::new();
        let mut last = 0;
        for (now, next) in now.iter().zip(next).filter(|(now, next)| next > now) {
            let length = next - now;
            if lengths.get(last).is_none_or(|(other, _)| *other != length) {
                last = lengths.iter().position(|(other, _)| *other == length).unwrap_or_else(|| {
                    lengths.push((length, 0));
                    lengths.len() - 1
                });
            }
            lengths[last].1 += 1;
        }
        Lengths(lengths)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_of_a_pixel_that_gains_samples_has_one_batch_and_the_longest_come_first() {
        const WIDTH: u32 = 300;
        let now: Vec<u32> = (0..WIDTH * 200).map(|i| 1 + i % 3).collect();
        let next: Vec<u32> =
            now.iter().zip(0..).map(|(&now, i)| now + [0, 4, 4, 96, 12][i as usize % 5]).collect();
        let mut lists = BatchLists::default();
        for _ in 0..2 {
            let list = lists.list(&now, &next, WIDTH);
            assert!(list.is_sorted_by_key(|batch| std::cmp::Reverse(batch.count)));
            let mut taken = vec![[0; 2]; now.len()];
            for pair in list.chunks(2) {
                for (half, batch) in (0..).zip(pair) {
                    let [x, y] = batch.column_and_row();
                    let i = (y * WIDTH + x) as usize;
                    assert_eq!((batch.first, batch.part), (now[i], PixelBatch::part_of(half)));
                    taken[i][half as usize] += batch.count;
                }
            }
            assert!(
                taken.iter().zip(now.iter().zip(&next)).all(|(taken, (now, next))| *taken == [next - now; 2])
            );
        }
        assert!(lists.list(&now, &now, WIDTH).is_empty());
    }
}
