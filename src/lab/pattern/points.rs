//! The points of one pixel as the renderer generates them, in the unit square, for a pattern,
//! count, seed and pair of dimensions. Realisation r is the pixel at (0, 0) with the seed increased
//! by r.

use crate::oracle::patterns::{pair_points, pixel_points, sample_pair};
use crate::oracle::rng::pixel_key;
use crate::oracle::strata::UNIT;
use crate::scene::model::Pattern;
use crate::schema::layout::Header;

#[derive(Clone, Copy, Debug)]
pub struct Set {
    pub pattern: Pattern,
    pub samples: u32,
    pub seed: u32,
    pub pair: u32,
}

impl Set {
    pub fn realisation(&self, number: u32) -> Vec<[f64; 2]> {
        let seed = self.seed.wrapping_add(number);
        let side = self.pattern.strata_side(self.samples);
        let Set { pattern, samples, .. } = *self;
        let header = Header { pattern, strata_side: side, samples, seed, ..Default::default() };
        let first = pixel_points(&header, [0, 0], pixel_key([0, 0], seed, false));
        let points = pair_points(&first, self.pair);
        (0..self.samples).map(|s| sample_pair(&points, s).map(|x| f64::from(x) * UNIT)).collect()
    }

    pub fn with_pair(self, pair: u32) -> Set {
        Set { pair, ..self }
    }

    /// Returns the columns and rows of the pattern's own strata in the pixel.
    pub fn strata(&self) -> Option<[u32; 2]> {
        let side = self.pattern.strata_side(self.samples);
        match self.pattern {
            Pattern::Grid | Pattern::Stratified | Pattern::MultiJittered => {
                Some([side, self.samples.div_ceil(side)])
            }
            Pattern::NRooks => Some([self.samples; 2]),
            _ => None,
        }
    }
}
