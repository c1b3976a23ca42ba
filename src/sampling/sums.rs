//! Sums of samples over parts of a picture, and the film made from them. Input: for each range of samples one block of
//! sums in f64. Output: means. Blocks stay separate until the film is made and are then added in the order of their
//! first samples, so merging is a union of sets: the film depends neither on the backend that took a range nor on the
//! order in which ranges arrive.

use rayon::iter::{IndexedParallelIterator, ParallelIterator};
use rayon::slice::ParallelSliceMut;

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::range::{Range, Rect};
use crate::pack::filtered_mean;

/// The sums of one range, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    pub range: Range,
    /// Sums of red, green and blue; each sample has the sign of the pixel filter at its position.
    pub sums: Vec<[f64; 3]>,
    /// Present if the pixel filter has negative lobes.
    pub signed: Option<Signed>,
    /// The weight that cones dropped, summed over all pixels.
    pub dropped: f64,
}

/// The terms that turn sums of signed samples into means: see [`filtered_mean`].
#[derive(Clone, Debug, PartialEq)]
pub struct Signed {
    /// The mean of the samples' signs over the whole filter.
    pub mean_sign: f64,
    /// Sums of the absolute values of samples with negative sign.
    pub negative: Vec<[f64; 3]>,
    /// Sums of the signs, which are the weights of the samples.
    pub weights: Vec<f64>,
}

/// The sums of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct PixelSums {
    /// Sums of red, green and blue.
    pub sum: [f64; 3],
    /// The other two are those of [`Signed`], if there are any.
    pub negative: [f64; 3],
    pub weight: f64,
    /// The number of samples.
    pub samples: f64,
}

impl PixelSums {
    fn add(&mut self, next: PixelSums) {
        for c in 0..3 {
            self.sum[c] += next.sum[c];
            self.negative[c] += next.negative[c];
        }
        self.weight += next.weight;
        self.samples += next.samples;
    }

    /// Returns the means of the samples, whose signs have that mean if they have any.
    #[inline(always)]
    pub fn mean(&self, mean_sign: Option<f64>) -> [f32; 3] {
        let PixelSums { sum: [r, g, b], negative, weight, samples } = *self;
        let Some(mean) = mean_sign else {
            return [(r / samples) as f32, (g / samples) as f32, (b / samples) as f32];
        };
        [0, 1, 2].map(|c| filtered_mean(self.sum[c], negative[c], weight, samples, mean) as f32)
    }
}

impl Block {
    /// Returns sums of no samples, with capacity for all pixels, which are pushed in order.
    pub fn new(range: Range) -> Block {
        let sums = Vec::with_capacity(range.pixels.area());
        Block { range, sums, signed: None, dropped: 0.0 }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSums {
        let Rect { x: left, y: top, width, .. } = self.range.pixels;
        let i = ((y - top) * width + (x - left)) as usize;
        let signed = self.signed.as_ref();
        PixelSums {
            sum: self.sums[i],
            negative: signed.map_or([0.0; 3], |s| s.negative[i]),
            weight: signed.map_or(0.0, |s| s.weights[i]),
            samples: f64::from(self.range.depth()),
        }
    }

    /// Writes the means of its pixels into a row of the picture.
    fn write_row(&self, y: u32, mean_sign: Option<f64>, pixels: &mut [[f32; 3]]) {
        let columns = self.range.pixels.columns();
        for (x, pixel) in columns.clone().zip(&mut pixels[columns.start as usize..]) {
            *pixel = self.pixel(x, y).mean(mean_sign);
        }
    }

    /// Returns the sort key: blocks of a pixel are ordered by their first samples.
    fn key(&self) -> (u32, u32, u32) {
        (self.range.samples.start, self.range.pixels.y, self.range.pixels.x)
    }
}

/// Sums of any number of disjoint ranges of one picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilmSums {
    /// Sorted by [`Block::key`].
    blocks: Vec<Block>,
}

impl From<Block> for FilmSums {
    fn from(block: Block) -> FilmSums {
        FilmSums { blocks: vec![block] }
    }
}

impl FilmSums {
    /// Merges the sums of other ranges. Fails, without any effect, if a sample of a pixel would count twice.
    pub fn merge(&mut self, other: FilmSums) -> Result<()> {
        let own = || self.blocks.iter();
        let both = other.blocks.iter().flat_map(|b| own().map(|a| a.range.intersection(&b.range)));
        if let Some(Range { pixels, samples }) = both.flatten().next() {
            return Err(Error::new(format!(
                "samples {} to {} of pixel ({}, {}) are there already: they would count twice",
                samples.start,
                samples.end - 1,
                pixels.x,
                pixels.y
            )));
        }
        self.blocks.extend(other.blocks);
        self.blocks.sort_by_key(Block::key);
        Ok(())
    }

    pub fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Returns the weight that cones dropped, summed over all pixels.
    pub fn dropped(&self) -> f64 {
        self.blocks.iter().map(|block| block.dropped).sum()
    }

    /// Writes the means of all pixels that have sums into a film of the whole picture.
    pub fn write_to(&self, film: &mut Film) {
        let [width, height] = [film.width, film.height];
        let rows = self.blocks.iter().map(|b| b.range.pixels.rows());
        let [top, bottom] = rows.fold([height, 0], |[top, bottom], r| [top.min(r.start), bottom.max(r.end)]);
        let mean_sign = self.blocks.iter().find_map(|b| b.signed.as_ref()).map(|s| s.mean_sign);
        let bottom = bottom.clamp(top, height);
        let rows = top as usize * width as usize..bottom as usize * width as usize;
        film.pixels[rows].par_chunks_mut(width as usize).zip(top..bottom).for_each(|(pixels, y)| {
            let mut blocks = self.blocks.iter().filter(|b| b.range.pixels.rows().contains(&y));
            match (blocks.next(), blocks.next()) {
                (Some(block), None) => block.write_row(y, mean_sign, pixels),
                (Some(_), Some(_)) => self.write_row(y, mean_sign, pixels),
                (None, _) => {}
            }
        });
    }

    /// Writes the means of a row that several blocks cover.
    fn write_row(&self, y: u32, mean_sign: Option<f64>, pixels: &mut [[f32; 3]]) {
        let mut row: Vec<Option<PixelSums>> = vec![None; pixels.len()];
        for block in self.blocks.iter().filter(|b| b.range.pixels.rows().contains(&y)) {
            for x in block.range.pixels.columns() {
                let next = block.pixel(x, y);
                match &mut row[x as usize] {
                    Some(sums) => sums.add(next),
                    empty => *empty = Some(next),
                }
            }
        }
        for (pixel, sums) in pixels.iter_mut().zip(&row) {
            if let Some(sums) = sums {
                *pixel = sums.mean(mean_sign);
            }
        }
    }

    /// Returns the film of a picture of that size. Fails if a pixel does not have `samples` samples.
    pub fn to_film(&self, [width, height]: [u32; 2], samples: u32) -> Result<Film> {
        let whole = Rect::whole([width, height]);
        let wanted = whole.area() as u64 * u64::from(samples);
        let inside = |b: &&Block| b.range.pixels.intersection(&whole) == Some(b.range.pixels);
        let count = |b: &Block| b.range.pixels.area() as u64 * u64::from(b.range.depth());
        // No sample counts twice, so the total shows whether any is missing.
        let there: u64 = self.blocks.iter().filter(inside).map(count).sum();
        let beyond = self.blocks.iter().any(|b| !inside(&b) || b.range.samples.end > samples);
        if there != wanted || beyond {
            return Err(Error::new(format!(
                "{there} of {wanted} samples of a picture of {width}×{height} pixels were taken"
            )));
        }
        let mut film = Film::new(width, height, samples);
        self.write_to(&mut film);
        Ok(film)
    }
}

#[cfg(test)]
mod tests;
