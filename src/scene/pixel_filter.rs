//! By which weights the light around a pixel becomes its colour, as data: a filter and how far it reaches. Part of the
//! model.

pub use crate::schema::enums::PixelFilterKind;

impl PixelFilterKind {
    /// In pixels: a pixel's own square; the next pixel's centre; 3 σ of half a pixel (Pharr, Jakob & Humphreys
    /// 2023); the cubic's two pixels; 1.5 as in Cycles.
    pub const fn default_radius(self) -> f64 {
        match self {
            PixelFilterKind::Box => 0.5,
            PixelFilterKind::Tent => 1.0,
            PixelFilterKind::Gaussian | PixelFilterKind::BlackmanHarris => 1.5,
            PixelFilterKind::Mitchell => 2.0,
        }
    }
}

/// By which weights the samples around a pixel become its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFilter {
    /// Its shape.
    pub kind: PixelFilterKind,
    /// Half the filter's width, in pixels. Its shape is stretched with it.
    pub radius: f64,
}

impl PixelFilter {
    /// As wide as the kind is by default, if no radius is given.
    pub fn new(kind: PixelFilterKind, radius: Option<f64>) -> PixelFilter {
        PixelFilter { kind, radius: radius.unwrap_or(kind.default_radius()) }
    }
}

impl Default for PixelFilter {
    fn default() -> Self {
        PixelFilter::new(PixelFilterKind::Box, None)
    }
}
