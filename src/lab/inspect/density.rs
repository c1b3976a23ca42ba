//! How densely a texture is seen: texels for each pixel, as a histogram by octaves and as quantiles. Input: the longer axis
//! of each pixel's footprint, in texels. Output: counts, and the size that the texture would need.

/// Lowest and highest octave of a histogram; values beyond are counted in these.
const OCTAVES: [i32; 2] = [-10, 12];
/// The share of pixels that may see a texture more closely than the size that it is said to need.
const CLOSEST: f64 = 0.01;

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

    /// Returns the factor, a power of two, by which each side of the texture could be shorter, if above 1, or would have
    /// to be longer, if below, so that the closest pixels cover from one to two texels.
    pub fn spare_factor(&self) -> f64 {
        let closest = self.quantile(CLOSEST).unwrap_or(1.0);
        if (1.0..2.0).contains(&closest) { 1.0 } else { closest.max(1e-30).log2().floor().exp2() }
    }
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

    #[test]
    fn a_texture_that_is_seen_four_texels_a_pixel_could_be_a_quarter() {
        let factor = |length| Density::new(vec![length; 100]).spare_factor();
        assert_eq!([4.5, 1.5, 0.3].map(factor), [4.0, 1.0, 0.25]);
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
