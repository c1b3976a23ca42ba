//! The way from scene-linear colours to those of a screen: exposure, white balance, tone map, primaries. In: pixels of
//! a film. Out: linear pixels of the picture, which a file format clips and encodes. The default changes nothing.

use std::borrow::Cow;
use std::ops::RangeInclusive;

use glam::{DMat3, DVec3};

use super::adaptation::{KELVINS, white_balance};
use super::gamut::Gamut;
use super::quantise::srgb8;
use super::tone_map::ToneMap;
use crate::core::error::{Error, Result};
use crate::core::film::Film;

/// The exposures, in stops, that a picture takes.
pub const STOPS: RangeInclusive<f64> = -64.0..=64.0;

/// Returns the exposure that a text states, or what was expected.
pub fn parse_stops(text: &str) -> std::result::Result<f64, String> {
    let value = text.parse().ok().filter(|value| STOPS.contains(value));
    value.ok_or_else(|| format!("expected a number of stops from {} to {}", STOPS.start(), STOPS.end()))
}

/// What becomes of a film's colours in formats for screens: PNG, JPEG and TIFF.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayTransform {
    /// Stops by which all radiance is multiplied, before anything else.
    pub exposure: f64,
    /// The colour temperature, in kelvin, of the light that becomes white.
    pub white_balance: Option<f64>,
    /// How values without a bound become those of a screen.
    pub tone_map: ToneMap,
    /// The primaries of the picture.
    pub gamut: Gamut,
}

impl Default for DisplayTransform {
    fn default() -> Self {
        DisplayTransform { exposure: 0.0, white_balance: None, tone_map: ToneMap::None, gamut: Gamut::Srgb }
    }
}

impl DisplayTransform {
    /// Returns an error that names the first value out of its range.
    pub fn check(&self) -> Result<()> {
        if !STOPS.contains(&self.exposure) {
            let what = format!(
                "exposure: found {}, allowed are {} to {} stops",
                self.exposure,
                STOPS.start(),
                STOPS.end()
            );
            return Err(Error::new(what));
        }
        match self.white_balance {
            Some(kelvin) if !KELVINS.contains(&kelvin) => Err(Error::new(format!(
                "white balance: found {kelvin}, allowed are {} to {} kelvin",
                KELVINS.start(),
                KELVINS.end()
            ))),
            _ => Ok(()),
        }
    }

    /// Returns the numbers that a picture of 8 bits a channel has for a pixel of a film.
    pub fn codes(&self, pixel: [f32; 3]) -> [u8; 3] {
        let prepared = self.prepare();
        if prepared.is_identity { pixel } else { prepared.color(pixel) }.map(srgb8)
    }

    /// Returns the light of a screen of any primaries, in linear colours of sRGB and without a bound: what is written with
    /// the gamut alone becomes the picture.
    pub fn developed(&self, film: &Film) -> Film {
        let prepared = DisplayTransform { gamut: Gamut::Srgb, ..*self }.prepare();
        Film { pixels: prepared.colors(&film.pixels).into_owned(), ..*film }
    }

    /// Returns the transform with its matrices.
    pub(super) fn prepare(&self) -> Prepared {
        let balance = self.white_balance.map_or(DMat3::IDENTITY, white_balance);
        Prepared {
            is_identity: *self == DisplayTransform::default(),
            before: balance * self.exposure.exp2(),
            tone_map: self.tone_map,
            after: (self.gamut != Gamut::Srgb).then(|| self.gamut.from_srgb()),
        }
    }
}

/// Returns the pixels that a screen shows, 8 bits a channel, as PNG and TIFF files have them.
pub fn screen_pixels(film: &Film, display: &DisplayTransform) -> Result<Vec<[u8; 3]>> {
    display.check()?;
    let colors = display.prepare().colors(&film.pixels).into_owned();
    Ok(colors.into_iter().map(|color| color.map(srgb8)).collect())
}

/// A transform ready for pixels.
pub(super) struct Prepared {
    is_identity: bool,
    /// Exposure and white balance.
    before: DMat3,
    tone_map: ToneMap,
    /// To other primaries than those of sRGB.
    after: Option<DMat3>,
}

impl Prepared {
    /// Returns the colours of a screen: the same ones where nothing is to be done.
    pub(super) fn colors<'a>(&self, pixels: &'a [[f32; 3]]) -> Cow<'a, [[f32; 3]]> {
        if self.is_identity {
            return Cow::Borrowed(pixels);
        }
        Cow::Owned(pixels.iter().map(|pixel| self.color(*pixel)).collect())
    }

    /// Returns the colour of a screen. As in a picture without a transform, NaN and negative infinity are black and
    /// infinity is the largest value.
    fn color(&self, pixel: [f32; 3]) -> [f32; 3] {
        let bounded = |v: f32| if v > f32::NEG_INFINITY { f64::from(v.min(f32::MAX)) } else { 0.0 };
        let color = self.tone_map.apply(self.before * DVec3::from(pixel.map(bounded)));
        self.after.map_or(color, |matrix| matrix * color).as_vec3().to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_copied_where_nothing_is_to_be_done() {
        let pixels = [[0.5, f32::NAN, -1.0]];
        assert!(matches!(DisplayTransform::default().prepare().colors(&pixels), Cow::Borrowed(_)));
        let brighter = DisplayTransform { exposure: 1.0, ..DisplayTransform::default() };
        assert_eq!(brighter.prepare().colors(&pixels)[0], [1.0, 0.0, -2.0]);
    }

    #[test]
    fn extreme_pixels_become_defined_colors_with_every_tone_map() {
        let extremes =
            [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, -1.0, 0.0, 1e-45, 1.0];
        for &tone_map in ToneMap::ALL {
            for &gamut in Gamut::ALL {
                for exposure in [*STOPS.start(), 0.0, *STOPS.end()] {
                    for white_balance in [None, Some(*KELVINS.start()), Some(*KELVINS.end())] {
                        let display = DisplayTransform { exposure, white_balance, tone_map, gamut };
                        display.check().unwrap();
                        for r in extremes {
                            for g in extremes {
                                let told = display.prepare().color([r, g, 0.25]);
                                let defined = told.iter().all(|v| !v.is_nan());
                                let bounded = told.iter().all(|v| (-1e-6..=1.0 + 1e-6).contains(v));
                                let clips = tone_map == ToneMap::None;
                                assert!(defined && (clips || bounded), "{display:?}: {r} {g}: {told:?}");
                            }
                        }
                    }
                }
            }
        }
    }
}
