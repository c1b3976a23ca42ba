//! `[image] pixel_filter` and `pixel_filter_radius`: by which weights the light around a pixel becomes its
//! colour. In: those keys, each with a default of its own. Out: a filter and how far it reaches.

use super::reader::Limits;
use super::table::Table;
use crate::core::error::Result;
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

/// Pixels that a filter may reach to each side.
pub const MAX_RADIUS: f64 = 8.0;
const RADIUS: Limits =
    Limits { words: "above 0 and at most 8 (pixels)", allow: |x| (1e-30..=MAX_RADIUS).contains(&x) };

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelFilter {
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

pub(super) fn pixel_filter(image: &Table<'_>) -> Result<PixelFilter> {
    let kind = match image.get("pixel_filter") {
        Some(field) => field.choice(PixelFilterKind::NAMES, PixelFilterKind::ALL)?,
        None => PixelFilterKind::default(),
    };
    let radius = image.get("pixel_filter_radius").map(|field| field.number(&RADIUS)).transpose()?;
    Ok(PixelFilter::new(kind, radius))
}
