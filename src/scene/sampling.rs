//! The sampling of a picture as data: algorithm, pattern, number and footprint. Part of the model.

use crate::core::named::named_enum;
pub use crate::schema::enums::{Footprint, Pattern, Quantity};

named_enum! {
    /// The rendering algorithm (`[sampling] algorithm`).
    #[derive(Default)]
    pub enum Algorithm {
        /// The same number of samples in each pixel.
        #[default]
        Samples = "samples",
        /// More samples in pixels with larger errors.
        Adaptive = "adaptive",
        /// One beam per pixel, cut by the polygons that it meets: exact areas, exact integrals.
        Beam = "beam",
        /// The algorithm that meets the goal of `--budget` or `--target-error` soonest.
        Auto = "auto",
        /// One cone per pixel and no sample (Amanatides 1984).
        Cone = "cone",
    }
}

impl Pattern {
    /// Returns true for a sequence, whose positions do not depend on the number of samples, so that any
    /// number of them from the first on is a set of the same kind.
    pub const fn is_progressive(self) -> bool {
        matches!(self, Pattern::Center | Pattern::Random | Pattern::Halton | Pattern::SobolOwen)
    }

    /// Returns true if each pixel may stop at a different number of samples.
    pub fn stops_anywhere(self) -> bool {
        self.is_progressive() && self != Pattern::Center
    }

    /// Returns the strata along each side of a pixel, for `multi-jittered` the columns; 1 if the pattern has
    /// none.
    pub const fn strata_side(self, samples: u32) -> u32 {
        match self {
            Pattern::Grid | Pattern::Stratified | Pattern::MultiJittered => samples.isqrt(),
            _ => 1,
        }
    }

    /// Returns true if all pixels may share one set of displacements.
    pub const fn can_be_shared(self) -> bool {
        use Pattern::{Halton, MultiJittered, NRooks, SobolOwen, Stratified};
        matches!(self, Stratified | MultiJittered | Halton | SobolOwen | NRooks)
    }
}

named_enum! {
    /// The precision of intersections and texture coordinates (`[sampling] precision`).
    #[derive(Default)]
    pub enum Precision {
        /// f64 if f32 would displace a texel or an outline.
        #[default]
        Auto = "auto",
        Single = "single",
        Double = "double",
    }
}

impl Quantity {
    /// Returns true for one that needs the footprint of a whole pixel, whatever footprint look-ups have.
    pub const fn is_of_footprints(self) -> bool {
        !matches!(self, Quantity::Radiance | Quantity::Albedo)
    }
}

impl Algorithm {
    /// Returns true if pixels may have different numbers of samples.
    pub fn is_adaptive(self) -> bool {
        matches!(self, Algorithm::Adaptive | Algorithm::Auto)
    }

    /// Returns the algorithm that reads textures in the same way: all that take samples read them alike, beams and cones
    /// each in a way of their own.
    pub const fn reads_textures_as(self) -> Algorithm {
        match self {
            Algorithm::Adaptive | Algorithm::Auto | Algorithm::Samples => Algorithm::Samples,
            own @ (Algorithm::Beam | Algorithm::Cone) => own,
        }
    }
}

/// The sampling of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// The rendering algorithm.
    pub algorithm: Algorithm,
    /// The sample pattern within a pixel.
    pub pattern: Pattern,
    /// Samples per pixel, at least 1; a square for `grid` and `stratified`, a power of two for `blue-noise`.
    pub spp: u32,
    /// True: one set of displacement vectors for all pixels (the lecture's variant).
    pub shared: bool,
    /// Selects one of 2³² sets of samples.
    pub seed: u32,
    /// Most mirror bounces after the camera ray; further ones are black.
    pub max_depth: u32,
    /// The footprint over which look-ups are averaged.
    pub footprint: Footprint,
    /// The precision of geometry.
    pub precision: Precision,
    /// What the samples measure, of algorithm `samples`: radiance, or a layer.
    pub quantity: Quantity,
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
            quantity: Quantity::Radiance,
        }
    }
}

impl Sampling {
    /// Returns the samples that are actually taken: those of `center` coincide, so one is enough, and a cone
    /// is one.
    pub fn samples(&self) -> u32 {
        let one = self.pattern == Pattern::Center || self.algorithm == Algorithm::Cone;
        if one { 1 } else { self.spp }
    }

    /// Returns the strata along each side of a pixel; 1 if the pattern has none.
    pub fn strata_side(&self) -> u32 {
        self.pattern.strata_side(self.spp)
    }
}
