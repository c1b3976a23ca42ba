//! Parts of a picture: rectangles of pixels, and ranges, which are rectangles times runs of samples. Work is
//! distributed by splitting ranges. A split covers each sample of each pixel exactly once; its positions depend on the
//! range alone, never on the backends that take the parts.

use std::ops;

use crate::core::error::{Error, Result};

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rect {
    /// The column of its first pixel.
    pub x: u32,
    /// The row of its first pixel.
    pub y: u32,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Rect {
    /// The whole of a picture.
    pub const fn whole([width, height]: [u32; 2]) -> Rect {
        Rect { x: 0, y: 0, width, height }
    }

    /// Refuses a crop that is empty or reaches outside a picture of this size.
    pub fn check_within(&self, [full_width, full_height]: [u32; 2]) -> Result<()> {
        let Rect { x, y, width, height } = *self;
        let fits =
            |at: u32, size: u32, full: u32| size > 0 && at.checked_add(size).is_some_and(|end| end <= full);
        if fits(x, width, full_width) && fits(y, height, full_height) {
            return Ok(());
        }
        Err(Error::new(format!(
            "--crop {x},{y},{width},{height} reaches outside the picture of {full_width}×{full_height} pixels"
        )))
    }

    /// Returns the number of pixels.
    pub const fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Returns its columns.
    pub const fn columns(&self) -> ops::Range<u32> {
        self.x..self.x + self.width
    }

    /// Returns its rows.
    pub const fn rows(&self) -> ops::Range<u32> {
        self.y..self.y + self.height
    }

    /// Returns the intersection; `None` if it is empty.
    pub fn intersection(&self, other: &Rect) -> Option<Rect> {
        let (columns, rows) =
            (overlap(&self.columns(), &other.columns())?, overlap(&self.rows(), &other.rows())?);
        Some(Rect {
            x: columns.start,
            y: rows.start,
            width: columns.end - columns.start,
            height: rows.end - rows.start,
        })
    }

    /// Splits into squares of `side` pixels, row by row; those at the right and the lower edge may be smaller.
    pub fn tiles(self, side: u32) -> impl Iterator<Item = Rect> {
        self.strips(side).flat_map(move |strip| {
            pieces(strip.columns(), side).map(move |c| Rect { x: c.start, width: c.end - c.start, ..strip })
        })
    }

    /// Splits into strips of `rows` whole rows; the last one may have fewer.
    pub fn strips(self, rows: u32) -> impl Iterator<Item = Rect> {
        pieces(self.rows(), rows).map(move |r| Rect { y: r.start, height: r.end - r.start, ..self })
    }
}

/// The samples `samples` of each pixel of a rectangle.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Range {
    /// The pixels.
    pub pixels: Rect,
    /// The samples of each pixel.
    pub samples: ops::Range<u32>,
}

impl Range {
    /// Returns the samples of each pixel.
    pub fn depth(&self) -> u32 {
        self.samples.end.saturating_sub(self.samples.start)
    }

    /// Returns the intersection; `None` if it is empty.
    pub fn intersection(&self, other: &Range) -> Option<Range> {
        let samples = overlap(&self.samples, &other.samples)?;
        Some(Range { pixels: self.pixels.intersection(&other.pixels)?, samples })
    }

    /// Splits the pixels into squares; see [`Rect::tiles`].
    pub fn tiles(&self, side: u32) -> impl Iterator<Item = Range> + use<> {
        let samples = self.samples.clone();
        self.pixels.tiles(side).map(move |pixels| Range { pixels, samples: samples.clone() })
    }

    /// Splits the pixels into strips of whole rows; see [`Rect::strips`].
    pub fn strips(&self, rows: u32) -> impl Iterator<Item = Range> + use<> {
        let samples = self.samples.clone();
        self.pixels.strips(rows).map(move |pixels| Range { pixels, samples: samples.clone() })
    }

    /// Splits the samples at multiples of `block`.
    pub fn by_samples(&self, block: u32) -> impl Iterator<Item = Range> + use<> {
        let (pixels, samples, block) = (self.pixels, self.samples.clone(), block.max(1));
        let first = samples.start / block;
        (first..samples.end.div_ceil(block)).filter_map(move |k| {
            let own = k * block..(k + 1).saturating_mul(block);
            overlap(&own, &samples).map(|samples| Range { pixels, samples })
        })
    }

    /// Splits the rows in two, or the columns of a single row; `None` for a single pixel.
    pub fn halves(&self) -> Option<[Range; 2]> {
        let Rect { x, y, width, height } = self.pixels;
        let part = |pixels| Range { pixels, samples: self.samples.clone() };
        let (upper, left) = (height / 2, width / 2);
        if upper > 0 {
            let lower = Rect { y: y + upper, height: height - upper, ..self.pixels };
            Some([part(Rect { height: upper, ..self.pixels }), part(lower)])
        } else if left > 0 {
            let right = Rect { x: x + left, width: width - left, ..self.pixels };
            Some([part(Rect { width: left, ..self.pixels }), part(right)])
        } else {
            None
        }
    }
}

fn overlap(a: &ops::Range<u32>, b: &ops::Range<u32>) -> Option<ops::Range<u32>> {
    let both = a.start.max(b.start)..a.end.min(b.end);
    (both.start < both.end).then_some(both)
}

fn pieces(of: ops::Range<u32>, length: u32) -> impl Iterator<Item = ops::Range<u32>> {
    let (end, length) = (of.end, length.max(1));
    of.step_by(length as usize).map(move |start| start..start.saturating_add(length).min(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Counts how often each sample of each pixel of a range occurs in parts of it; fails if a part is outside.
    fn cover(range: &Range, parts: &[Range]) -> Vec<u32> {
        let mut counts = vec![0; range.pixels.area() * range.depth() as usize];
        for part in parts {
            assert_eq!(range.intersection(part).as_ref(), Some(part), "{part:?} is not inside {range:?}");
            for y in part.pixels.rows() {
                for x in part.pixels.columns() {
                    for s in part.samples.clone() {
                        let pixel = (y - range.pixels.y) * range.pixels.width + x - range.pixels.x;
                        counts[(pixel * range.depth() + s - range.samples.start) as usize] += 1;
                    }
                }
            }
        }
        counts
    }

    fn random_range(rng: &mut fastrand::Rng) -> Range {
        let pixels =
            Rect { x: rng.u32(0..9), y: rng.u32(0..9), width: rng.u32(1..20), height: rng.u32(1..20) };
        let start = rng.u32(0..12);
        Range { pixels, samples: start..start + rng.u32(1..12) }
    }

    #[test]
    fn every_split_covers_each_sample_of_each_pixel_once() {
        let mut rng = fastrand::Rng::with_seed(1);
        for _ in 0..300 {
            let range = random_range(&mut rng);
            let step = rng.u32(1..8);
            let splits: [Vec<Range>; 4] = [
                range.tiles(step).collect(),
                range.strips(step).collect(),
                range.by_samples(step).collect(),
                range.halves().map_or(vec![range.clone()], Vec::from),
            ];
            for parts in splits {
                assert!(cover(&range, &parts).iter().all(|&n| n == 1), "{range:?} by {step}: {parts:?}");
            }
        }
    }

    #[test]
    fn a_split_that_loses_or_repeats_a_part_is_noticed() {
        let range = Range { pixels: Rect { x: 3, y: 1, width: 7, height: 5 }, samples: 2..6 };
        let tiles: Vec<Range> = range.tiles(3).collect();
        assert!(cover(&range, &tiles[1..]).contains(&0));
        assert!(cover(&range, &[tiles.clone(), tiles[..1].to_vec()].concat()).contains(&2));
    }

    /// Blocks of samples end at the same places wherever a range begins.
    #[test]
    fn samples_are_split_at_fixed_places() {
        let blocks = |samples: ops::Range<u32>| {
            let range = Range { pixels: Rect::whole([1, 1]), samples };
            range.by_samples(256).map(|r| r.samples).collect::<Vec<_>>()
        };
        assert_eq!(blocks(0..600), [0..256, 256..512, 512..600]);
        assert_eq!(blocks(300..600), [300..512, 512..600]);
        assert_eq!(blocks(4..4), []);
    }

    #[test]
    fn what_two_ranges_have_in_common_is_what_both_cover() {
        let mut rng = fastrand::Rng::with_seed(2);
        for _ in 0..300 {
            let [a, b] = [random_range(&mut rng), random_range(&mut rng)];
            let has = |r: &Range, x, y, s| {
                r.pixels.columns().contains(&x) && r.pixels.rows().contains(&y) && r.samples.contains(&s)
            };
            let common = a.intersection(&b);
            for (x, y, s) in (0..30).flat_map(|x| (0..30).flat_map(move |y| (0..25).map(move |s| (x, y, s))))
            {
                let both = has(&a, x, y, s) && has(&b, x, y, s);
                assert_eq!(both, common.as_ref().is_some_and(|c| has(c, x, y, s)), "{a:?} {b:?}");
            }
        }
    }
}
