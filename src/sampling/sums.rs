//! Sums of samples over parts of a picture, and the film that they become. In: for each range of samples one block
//! of sums in f64. Out: means. Blocks are kept apart until the film is made and are then added in the order of their
//! first samples, so that merging is a union of sets: the film depends neither on who took which range, nor on the
//! order in which ranges arrive.

use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::range::{Range, Rect};
use crate::pack::filtered_mean;

/// The sums of one range, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    pub range: Range,
    /// Red, green and blue; each sample counts with the sign that the pixel filter has at its place.
    pub sums: Vec<[f64; 3]>,
    /// Of each sample the mean of its squared channels; empty where nobody asked for it.
    pub squares: Vec<f64>,
    pub count: Count,
    /// Where the pixel filter has negative lobes.
    pub signed: Option<Signed>,
    /// What cones dropped, over all pixels.
    pub dropped: f64,
}

/// How many samples stand behind each sum.
#[derive(Clone, Debug, PartialEq)]
pub enum Count {
    /// As many for all pixels.
    All(u32),
    Each(Vec<u32>),
}

/// What sums of signed samples need to become means: see [`filtered_mean`].
#[derive(Clone, Debug, PartialEq)]
pub struct Signed {
    /// Mean of the samples' signs over the whole filter.
    pub mean_sign: f64,
    /// Sums of the samples whose sign is negative, without it.
    pub negative: Vec<[f64; 3]>,
    /// Sums of the signs: the weights of the samples.
    pub weights: Vec<f64>,
}

impl Count {
    fn at(&self, index: usize) -> u32 {
        match self {
            Count::All(count) => *count,
            Count::Each(counts) => counts[index],
        }
    }
}

/// The sums of one pixel.
#[derive(Clone, Copy)]
struct PixelSums {
    sum: [f64; 3],
    negative: [f64; 3],
    weight: f64,
    samples: f64,
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

    fn mean(&self, mean_sign: Option<f64>) -> [f32; 3] {
        let PixelSums { sum, negative, weight, samples } = *self;
        let channel = |c: usize| match mean_sign {
            None => sum[c] / samples,
            Some(mean) => filtered_mean(sum[c], negative[c], weight, samples, mean),
        };
        [0, 1, 2].map(|c| channel(c) as f32)
    }
}

impl Block {
    /// Sums of no sample yet, with room for one pixel after the other.
    pub fn new(range: Range) -> Block {
        let count = Count::All(range.depth());
        let sums = Vec::with_capacity(range.pixels.area());
        Block { range, sums, squares: Vec::new(), count, signed: None, dropped: 0.0 }
    }

    fn pixel(&self, x: u32, y: u32) -> PixelSums {
        let Rect { x: left, y: top, width, .. } = self.range.pixels;
        let i = ((y - top) * width + (x - left)) as usize;
        let signed = self.signed.as_ref();
        PixelSums {
            sum: self.sums[i],
            negative: signed.map_or([0.0; 3], |s| s.negative[i]),
            weight: signed.map_or(0.0, |s| s.weights[i]),
            samples: f64::from(self.count.at(i)),
        }
    }

    /// By which blocks are ordered: a pixel's samples by their numbers.
    fn key(&self) -> (u32, u32, u32) {
        (self.range.samples.start, self.range.pixels.y, self.range.pixels.x)
    }
}

/// Sums of any number of ranges of one picture, none of which overlap.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FilmSums {
    /// In the order of [`Block::key`].
    blocks: Vec<Block>,
}

impl From<Block> for FilmSums {
    fn from(block: Block) -> FilmSums {
        FilmSums { blocks: vec![block] }
    }
}

impl FilmSums {
    /// Takes over the sums of other ranges. Fails where a sample of a pixel would count twice; then nothing is taken.
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

    /// Returns what cones dropped, over all pixels.
    pub fn dropped(&self) -> f64 {
        self.blocks.iter().map(|block| block.dropped).sum()
    }

    /// Writes the means of all pixels that have sums into a film of the whole picture.
    pub fn write_to(&self, film: &mut Film) {
        let [width, height] = [film.width, film.height];
        let rows = self.blocks.iter().map(|b| b.range.pixels.rows());
        let [top, bottom] = rows.fold([height, 0], |[top, bottom], r| [top.min(r.start), bottom.max(r.end)]);
        let mean_sign = self.blocks.iter().find_map(|b| b.signed.as_ref()).map(|s| s.mean_sign);
        let mut row: Vec<Option<PixelSums>> = vec![None; width as usize];
        for y in top..bottom.min(height) {
            row.fill(None);
            for block in self.blocks.iter().filter(|b| b.range.pixels.rows().contains(&y)) {
                for x in block.range.pixels.columns() {
                    let next = block.pixel(x, y);
                    match &mut row[x as usize] {
                        Some(sums) => sums.add(next),
                        empty => *empty = Some(next),
                    }
                }
            }
            let first = y as usize * width as usize;
            for (pixel, sums) in film.pixels[first..].iter_mut().zip(&row) {
                if let Some(sums) = sums {
                    *pixel = sums.mean(mean_sign);
                }
            }
        }
    }

    /// The film of a picture of that size. Fails where a pixel has not `samples` samples.
    pub fn to_film(&self, [width, height]: [u32; 2], samples: u32) -> Result<Film> {
        let whole = Rect::whole([width, height]);
        let wanted = whole.area() as u64 * u64::from(samples);
        let inside = |b: &&Block| b.range.pixels.intersection(&whole) == Some(b.range.pixels);
        let count = |b: &Block| b.range.pixels.area() as u64 * u64::from(b.range.depth());
        // None counts twice, so that the number tells whether all are there.
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
mod tests {
    use super::*;

    /// Samples of very different sizes, so that the order in which they are added shows.
    fn sample(x: u32, y: u32, s: u32) -> [f64; 3] {
        let mut rng = fastrand::Rng::with_seed(u64::from(x) << 40 | u64::from(y) << 20 | u64::from(s));
        std::array::from_fn(|_| (rng.f64() - 0.3) * 10f64.powi(rng.i32(-6..6)))
    }

    /// What a backend gives for a range: in the order of the samples.
    fn sums_of(range: &Range, signed: bool) -> FilmSums {
        let mut block = Block::new(range.clone());
        let mut negative = Vec::new();
        let mut weights = Vec::new();
        for (y, x) in range.pixels.rows().flat_map(|y| range.pixels.columns().map(move |x| (y, x))) {
            let (mut sum, mut below, mut weight) = ([0.0; 3], [0.0; 3], 0.0);
            for s in range.samples.clone() {
                let sign = if signed && (x + y + s) % 5 == 0 { -1.0 } else { 1.0 };
                for (c, value) in sample(x, y, s).into_iter().enumerate() {
                    sum[c] += sign * value;
                    below[c] += if sign < 0.0 { value } else { 0.0 };
                }
                weight += sign;
            }
            block.sums.push(sum);
            negative.push(below);
            weights.push(weight);
        }
        block.signed = signed.then_some(Signed { mean_sign: 0.6, negative, weights });
        block.into()
    }

    const SIZE: [u32; 2] = [13, 9];
    const SAMPLES: u32 = 29;
    /// Samples are split at multiples of this and nowhere else.
    const BLOCK: u32 = 8;

    fn whole() -> Range {
        Range { pixels: Rect::whole(SIZE), samples: 0..SAMPLES }
    }

    /// Blocks of samples, and the pixels of each split anew at random, in random order.
    fn partition(rng: &mut fastrand::Rng) -> Vec<Range> {
        let mut parts = Vec::new();
        for block in whole().by_samples(BLOCK) {
            match rng.u32(0..3) {
                0 => parts.extend(block.tiles(rng.u32(1..9))),
                1 => parts.extend(block.strips(rng.u32(1..9))),
                _ => parts.extend(block.halves().into_iter().flatten()),
            }
        }
        rng.shuffle(&mut parts);
        parts
    }

    fn bits(film: &Film) -> Vec<[u32; 3]> {
        film.pixels.iter().map(|p| p.map(f32::to_bits)).collect()
    }

    fn film_of(parts: &[FilmSums]) -> Film {
        let mut sums = FilmSums::default();
        parts.iter().for_each(|part| sums.merge(part.clone()).unwrap());
        sums.to_film(SIZE, SAMPLES).unwrap()
    }

    #[test]
    fn any_partition_handed_out_in_any_order_to_any_number_of_backends_gives_the_same_film() {
        let mut rng = fastrand::Rng::with_seed(5);
        for signed in [false, true] {
            let in_order: Vec<FilmSums> = whole().by_samples(BLOCK).map(|r| sums_of(&r, signed)).collect();
            let expected = bits(&film_of(&in_order));
            for _ in 0..40 {
                let backends = rng.usize(1..5);
                let mut each = vec![FilmSums::default(); backends];
                for range in partition(&mut rng) {
                    each[rng.usize(0..backends)].merge(sums_of(&range, signed)).unwrap();
                }
                rng.shuffle(&mut each);
                assert_eq!(bits(&film_of(&each)), expected, "{backends} backends, signed: {signed}");
            }
        }
    }

    #[test]
    fn merging_is_associative_and_commutative() {
        let mut rng = fastrand::Rng::with_seed(6);
        let merged = |a: &FilmSums, b: &FilmSums| {
            let mut sums = a.clone();
            sums.merge(b.clone()).unwrap();
            sums
        };
        for _ in 0..20 {
            let parts: Vec<FilmSums> = partition(&mut rng).iter().map(|r| sums_of(r, true)).collect();
            let [a, b, c] = &parts[..3] else { panic!("{} parts", parts.len()) };
            assert_eq!(merged(&merged(a, b), c), merged(a, &merged(b, c)));
            assert_eq!(merged(a, b), merged(b, a));
        }
    }

    /// Adds blocks as they arrive, which is what a merge must not do.
    fn merge_by_arrival(parts: &[FilmSums]) -> Film {
        let mut sums = vec![[0.0; 3]; whole().pixels.area()];
        for block in parts.iter().flat_map(FilmSums::blocks) {
            let pixels = block.range.pixels;
            let places =
                pixels.rows().flat_map(|y| pixels.columns().map(move |x| (y * SIZE[0] + x) as usize));
            for (at, own) in places.zip(&block.sums) {
                (0..3).for_each(|c| sums[at][c] += own[c]);
            }
        }
        let mut film = Film::new(SIZE[0], SIZE[1], SAMPLES);
        let means = sums.iter().map(|sum| sum.map(|v| (v / f64::from(SAMPLES)) as f32));
        film.pixels.iter_mut().zip(means).for_each(|(pixel, mean)| *pixel = mean);
        film
    }

    #[test]
    fn a_merge_in_the_order_of_arrival_is_noticed() {
        let parts: Vec<FilmSums> = whole().by_samples(1).map(|r| sums_of(&r, false)).collect();
        let backwards: Vec<FilmSums> = parts.iter().rev().cloned().collect();
        assert_eq!(bits(&merge_by_arrival(&parts)), bits(&film_of(&parts)));
        assert_ne!(bits(&merge_by_arrival(&backwards)), bits(&film_of(&backwards)));
    }

    #[test]
    fn what_would_count_twice_or_is_missing_is_refused() {
        let range = |x, samples| Range { pixels: Rect { x, y: 2, width: 3, height: 4 }, samples };
        let mut sums = sums_of(&range(0, 0..8), false);
        sums.merge(sums_of(&range(3, 0..8), false)).unwrap();
        sums.merge(sums_of(&range(0, 8..9), false)).unwrap();
        let error = sums.merge(sums_of(&range(5, 7..9), false)).unwrap_err().to_string();
        assert!(error.contains("samples 7 to 7 of pixel (5, 2)"), "{error}");
        let error = sums.to_film([13, 9], 8).unwrap_err().to_string();
        assert!(error.contains("204 of 936 samples"), "{error}");
    }

    #[test]
    fn each_pixel_is_divided_by_its_own_count() {
        let mut block = Block::new(Range { pixels: Rect::whole([2, 1]), samples: 0..4 });
        block.sums = vec![[8.0; 3]; 2];
        block.count = Count::Each(vec![4, 2]);
        let mut film = Film::new(2, 1, 3);
        FilmSums::from(block).write_to(&mut film);
        assert_eq!(film.pixels, [[2.0; 3], [4.0; 3]]);
    }
}
