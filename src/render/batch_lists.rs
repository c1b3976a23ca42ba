//! Batches as one submission takes them: listed by the host, listed by the device, or as many samples of all pixels; and the
//! film to which they go. Output: push constants, and the samples of each tile, by which submissions are divided.

use std::sync::Arc;

use crate::gpu::{BindGroup, Buffer, Dispatch, Pipeline};
use crate::schema::layout::{PixelBatch, Slice, TILE};

/// Batches of a tile.
pub const BATCHES_PER_TILE: usize = (TILE * TILE) as usize;

/// The batches of one call.
pub enum Batches<'b> {
    List(&'b [PixelBatch]),
    /// `count` samples from `first` on in both halves of `pixels` pixels.
    Equal {
        pixels: u32,
        first: u32,
        count: u32,
    },
}

/// Batches that the device has listed, longest first.
pub struct Listed<'b> {
    pub batches: &'b Buffer,
    /// (batches, most samples of each), longest first.
    pub lengths: &'b [(u32, u32)],
}

impl Listed<'_> {
    /// Returns the number of batches.
    pub fn count(&self) -> u32 {
        self.lengths.iter().map(|length| length.0).sum()
    }

    /// Returns the push constants of all, where those of the film are `film`.
    pub fn slice(&self, film: Slice) -> Slice {
        Slice { tiles: self.count(), listed: 1, ..film }
    }

    /// Returns the samples of each tile of batches, or somewhat more.
    pub fn costs(&self) -> Vec<f64> {
        let mut costs = vec![0.0; (self.count() as usize).div_ceil(BATCHES_PER_TILE)];
        let mut at = 0;
        for &(count, most) in self.lengths {
            let end = at + count as usize;
            while at < end {
                let tile = at / BATCHES_PER_TILE;
                let until = end.min((tile + 1) * BATCHES_PER_TILE);
                costs[tile] += (until - at) as f64 * f64::from(most);
                at = until;
            }
        }
        costs
    }
}

impl Batches<'_> {
    /// Returns the samples of each tile of batches.
    pub fn costs(&self) -> Vec<f64> {
        match *self {
            Batches::List(list) => list
                .chunks(BATCHES_PER_TILE)
                .map(|tile| tile.iter().map(|j| f64::from(j.count)).sum())
                .collect(),
            Batches::Equal { pixels, count, .. } => {
                let cost = (BATCHES_PER_TILE * count as usize) as f64;
                vec![cost; (2 * pixels as usize).div_ceil(BATCHES_PER_TILE)]
            }
        }
    }

    /// Returns one of them; a film is `width` pixels wide.
    pub fn batch(&self, index: u32, width: u32) -> PixelBatch {
        match *self {
            Batches::List(list) => list[index as usize],
            Batches::Equal { first, count, .. } => {
                let place = PixelBatch::place_of(index / 2, width);
                PixelBatch { place, part: PixelBatch::part_of(index % 2), first, count }
            }
        }
    }

    /// Returns the push constants of all, where those of the film are `film`.
    pub fn slice(&self, film: Slice) -> Slice {
        match *self {
            Batches::List(list) => Slice { tiles: list.len() as u32, listed: 1, ..film },
            Batches::Equal { pixels, first, count } => {
                Slice { tiles: 2 * pixels, first_sample: first, sample_count: count, ..film }
            }
        }
    }
}

/// Returns the halves of batches, of which the second one is empty if there is a single sample: threads beside it may have had
/// more. If none has more, returns `None`: each has to be alone in its workgroup.
pub fn halves<'b>(batches: impl Iterator<Item = &'b PixelBatch> + Clone) -> Option<Vec<[PixelBatch; 2]>> {
    if batches.clone().all(|batch| batch.count == 1) {
        return None;
    }
    let of = |batch: &PixelBatch| {
        let half = batch.count.div_ceil(2);
        let second = PixelBatch { first: batch.first + half, count: batch.count - half, ..*batch };
        [PixelBatch { count: half, ..*batch }, second]
    };
    Some(batches.map(of).collect())
}

/// Batches that one dispatch takes, together with other work.
pub struct AtOnce {
    pub pipeline: Arc<Pipeline>,
    pub slice: Slice,
    pub groups: [u32; 3],
    pub samples: f64,
}

impl AtOnce {
    pub fn dispatch<'a>(&'a self, group: &'a BindGroup) -> Dispatch<'a> {
        Dispatch {
            pipeline: &self.pipeline,
            group,
            push: bytemuck::bytes_of(&self.slice),
            groups: self.groups,
        }
    }
}

/// A film of batches, with the push constants of its submissions.
#[derive(Clone)]
pub struct BatchFilm {
    pub buffer: Buffer,
    pub slice: Slice,
}
