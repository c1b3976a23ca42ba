//! How a picture is sampled, as data: algorithm, pattern, number and what each sample is averaged over. Part of
//! the model.

use crate::core::named::named_enum;
pub use crate::schema::enums::{Footprint, Pattern};

named_enum! {
    /// How many rays a pixel sends and what becomes of them (`[sampling] algorithm`).
    #[derive(Default)]
    pub enum Algorithm {
        /// As many as asked for, the same number in each pixel.
        #[default]
        Samples = "samples",
        /// More where the picture errs more.
        Adaptive = "adaptive",
        /// One beam a pixel, cut by the polygons that it meets: exact areas, exact integrals.
        Beam = "beam",
        /// What meets the goal of `--budget` or `--target-error` soonest.
        Auto = "auto",
        /// One cone a pixel and no sample (Amanatides 1984).
        Cone = "cone",
    }
}

impl Pattern {
    /// A sequence: positions do not depend on how many samples there are, so that any number of them, from
    /// the first on, is a set of the same kind.
    pub const fn is_progressive(self) -> bool {
        matches!(self, Pattern::Center | Pattern::Random | Pattern::Halton | Pattern::SobolOwen)
    }

    /// Whether each pixel may stop at another number of samples.
    pub fn stops_anywhere(self) -> bool {
        self.is_progressive() && self != Pattern::Center
    }

    /// Strata along each side of a pixel, of `multi-jittered` columns; 1 where the pattern has none.
    pub const fn strata_side(self, samples: u32) -> u32 {
        match self {
            Pattern::Grid | Pattern::Stratified | Pattern::MultiJittered => samples.isqrt(),
            _ => 1,
        }
    }

    /// Whether all pixels may have one set of displacements.
    pub const fn can_be_shared(self) -> bool {
        use Pattern::{Halton, MultiJittered, NRooks, SobolOwen, Stratified};
        matches!(self, Stratified | MultiJittered | Halton | SobolOwen | NRooks)
    }
}

named_enum! {
    /// In which numbers rays meet shapes and texture coordinates are formed (`[sampling] precision`).
    #[derive(Default)]
    pub enum Precision {
        /// f64 where f32 would misplace a texel or an outline.
        #[default]
        Auto = "auto",
        Single = "single",
        Double = "double",
    }
}

impl Algorithm {
    /// Whether pixels may get different numbers of samples.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Algorithm::Adaptive | Algorithm::Auto)
    }
}

/// How a picture is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// What becomes of a pixel.
    pub algorithm: Algorithm,
    /// Where in the pixel the samples lie.
    pub pattern: Pattern,
    /// Samples per pixel, at least 1; a square for `grid` and `stratified`, a power of two for
    /// `blue-noise`.
    pub spp: u32,
    /// True: one set of displacement vectors for all pixels (the lecture's variant).
    pub shared: bool,
    /// Chooses one of 2³² sets of samples.
    pub seed: u32,
    /// Mirror bounces after the camera ray; exhausted means black.
    pub max_depth: u32,
    /// Over what look-ups are averaged.
    pub footprint: Footprint,
    /// In which numbers geometry is computed.
    pub precision: Precision,
}

impl Default for Sampling {
    fn default() -> Self {
        Sampling {
            algorithm: Algorithm::Samples,
            pattern: Pattern::Stratified,
            spp: 16,
            shared: false,
            seed: 1,
            max_depth: 5,
            footprint: Footprint::None,
            precision: Precision::Auto,
        }
    }
}

impl Sampling {
    /// Samples that are really taken: all of `center` lie at one place, so one is enough, and a cone is one.
    pub fn samples(&self) -> u32 {
        let one = self.pattern == Pattern::Center || self.algorithm == Algorithm::Cone;
        if one { 1 } else { self.spp }
    }

    /// Returns the strata along each side of a pixel; 1 where the pattern has none.
    pub fn strata_side(&self) -> u32 {
        self.pattern.strata_side(self.spp)
    }
}
