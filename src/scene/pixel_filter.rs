//! The pixel filter as data: its kind and its radius, which weight the light around a pixel. Part of the model.

pub use crate::schema::enums::PixelFilterKind;

impl PixelFilterKind {
    /// Returns the default radius in pixels: half a pixel's width; the next pixel's centre; 3 σ of half a pixel (Pharr,
    /// Jakob & Humphreys 2023); the two pixels of the cubic; 1.5 as in Cycles.
    pub const fn default_radius(self) -> f64 {
        match self {
            PixelFilterKind::Box => 0.5,
            PixelFilterKind::Tent => 1.0,
            PixelFilterKind::Gaussian | PixelFilterKind::BlackmanHarris => 1.5,
            PixelFilterKind::Mitchell => 2.0,
        }
    }
}

/// The filter that weights the samples around a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFilter {
    /// Its kind.
    pub kind: PixelFilterKind,
    /// Half the filter's width, in pixels, to which it is scaled.
    pub radius: f64,
}

impl PixelFilter {
    /// Returns a filter with this radius, or with the default radius of its kind.
    pub fn new(kind: PixelFilterKind, radius: Option<f64>) -> PixelFilter {
        PixelFilter { kind, radius: radius.unwrap_or(kind.default_radius()) }
    }
}

impl Default for PixelFilter {
    fn default() -> Self {
        PixelFilter::new(PixelFilterKind::Box, None)
    }
}
