//! How densely a texture is seen: texels for each pixel, as a histogram by octaves and as quantiles. Input: the longer axis
//! of each pixel's footprint, in texels. Output: counts, and the size that the texture would need.

/// Lowest and highest octave of a histogram; values beyond are counted in these.
const OCTAVES: [i32; 2] = [-10, 12];
/// The share of pixels in which a texture of the size that it is said to need may be magnified.
pub const CLOSEST: f64 = 0.05;
/// Texels that half of the pixels cover at most where a texture is said to be too small: a larger one would serve few.
pub const MOST_TEXELS: f64 = 8.0;
/// Texels along a side of a texture that is said to be too small, at most: what devices take.
pub const MOST_SIDE: u32 = 16384;

/// The number of pixels whose footprint is from 2^`octave` to twice as many texels long.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bin {
    pub octave: i32,
    pub pixels: u64,
}

/// Texels for each pixel that sees a texture.
#[derive(Clone, Debug, Default)]
pub struct Density {
    /// In ascending order.
    lengths: Vec<f64>,
}

impl Density {
    pub fn new(mut lengths: Vec<f64>) -> Density {
        lengths.sort_by(f64::total_cmp);
        Density { lengths }
    }

    /// Returns the number of pixels.
    pub fn pixels(&self) -> u64 {
        self.lengths.len() as u64
    }

    /// Returns the histogram from the first octave with pixels to the last one.
    pub fn histogram(&self) -> Vec<Bin> {
        let octave = |length: &f64| (length.max(1e-30).log2().floor() as i32).clamp(OCTAVES[0], OCTAVES[1]);
        let (Some(first), Some(last)) = (self.lengths.first(), self.lengths.last()) else {
            return Vec::new();
        };
        let mut bins: Vec<Bin> =
            (octave(first)..=octave(last)).map(|octave| Bin { octave, pixels: 0 }).collect();
        let start = octave(first);
        self.lengths.iter().for_each(|length| bins[(octave(length) - start) as usize].pixels += 1);
        bins
    }

    /// Returns the length below which this share of the pixels lies.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        let last = self.lengths.len().checked_sub(1)?;
        Some(self.lengths[(share * last as f64).round() as usize])
    }

    /// Returns the share of pixels whose length is above `length`.
    pub fn above(&self, length: f64) -> f64 {
        let below = self.lengths.partition_point(|own| *own <= length);
        (self.lengths.len() - below) as f64 / self.lengths.len().max(1) as f64
    }

    /// Returns the share of pixels whose length is below `length`.
    pub fn below(&self, length: f64) -> f64 {
        let below = self.lengths.partition_point(|own| *own < length);
        below as f64 / self.lengths.len().max(1) as f64
    }

    /// Returns the size that suits these pixels, for a texture of that one.
    pub fn wanted(&self, size: [u32; 2]) -> Wanted {
        let closest = self.quantile(CLOSEST).unwrap_or(1.0);
        let free = closest.max(1e-30).log2().floor() as i32;
        let longest = size[0].max(size[1]).max(1);
        if free >= 0 {
            // To a texel and no further.
            return Wanted { octaves: -free.min(longest.ilog2() as i32), is_capped: false };
        }
        let middle = self.quantile(0.5).unwrap_or(1.0);
        let useful = (MOST_TEXELS / middle.max(1e-30)).log2().floor().max(0.0) as i32;
        let possible = (f64::from(MOST_SIDE) / f64::from(longest)).log2().floor().max(0.0) as i32;
        let octaves = (-free).min(useful).min(possible);
        Wanted { octaves, is_capped: octaves < -free }
    }
}

/// The size that suits a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// Each side should be 2 to this power as long: the most of which all but few pixels cover a texel or more.
    pub octaves: i32,
    /// It should be longer still, but for the sake of few pixels, or beyond what devices take.
    pub is_capped: bool,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_is_in_one_bin() {
        let density = Density::new(vec![0.3, 1.0, 1.99, 2.0, 1e9]);
        let bins = density.histogram();
        assert_eq!(bins.iter().map(|bin| bin.pixels).sum::<u64>(), density.pixels());
        assert_eq!(bins[0], Bin { octave: -2, pixels: 1 });
        assert_eq!(bins[2], Bin { octave: 0, pixels: 2 });
        assert_eq!(bins.last(), Some(&Bin { octave: 12, pixels: 1 }));
        assert!(Density::default().histogram().is_empty());
    }

    fn wanted(lengths: Vec<f64>) -> (i32, bool) {
        let Wanted { octaves, is_capped } = Density::new(lengths).wanted([1024, 512]);
        (octaves, is_capped)
    }

    #[test]
    fn a_texture_that_is_seen_four_texels_a_pixel_could_be_a_quarter() {
        let octaves = |length| wanted(vec![length; 100]);
        assert_eq!([4.5, 1.5, 0.3].map(octaves), [(-2, false), (0, false), (2, false)]);
        assert_eq!(wanted(vec![1e9; 100]), (-10, false), "one texel is the least");
    }

    #[test]
    fn few_close_pixels_do_not_decide() {
        let share = |close: usize, middle| [vec![1.0 / 32.0; close], vec![middle; 100 - close]].concat();
        assert_eq!(wanted(share(4, 1.0)), (0, false), "less than a twentieth");
        assert_eq!(wanted([vec![0.125; 20], vec![0.5; 80]].concat()), (3, false));
        // Half of the pixels cover 3 texels: of a texture twice as large 6.
        assert_eq!(wanted(share(20, 3.0)), (1, true));
        assert_eq!(wanted(share(20, 100.0)), (0, true));
        assert_eq!(wanted(vec![1e-6; 100]), (4, true), "larger than devices take");
    }

    #[test]
    fn what_covers_a_texel_is_neither_above_nor_below() {
        let density = Density::new(vec![0.5, 1.0, 2.0, 2.0]);
        assert_eq!([density.below(1.0), density.above(1.0)], [0.25, 0.5]);
    }

    #[test]
    fn quantiles_and_shares_are_of_pixels() {
        let density = Density::new(vec![4.0, 1.0, 2.0]);
        assert_eq!(
            [density.quantile(0.0), density.quantile(0.5), density.quantile(1.0)],
            [Some(1.0), Some(2.0), Some(4.0)]
        );
        assert_eq!(density.above(1.0), 2.0 / 3.0);
        assert_eq!(Density::default().quantile(0.5), None);
    }
}
