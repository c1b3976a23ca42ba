//! How a film is written to a file. In: nothing, or settings one after the other. Out: the options of the writers.

use crate::output::{DisplayTransform, Gamut, ToneMap, WriteOptions};

/// The settings with which [`Film::save_with`](crate::Film::save_with) writes a picture. Exposure, white balance, tone map
/// and gamut concern formats for screens: PNG, JPEG and TIFF; OpenEXR and Radiance HDR keep linear light.
///
/// ```
/// use moire::{Film, Gamut, SaveOptions, ToneMap};
///
/// # fn main() -> moire::Result<()> {
/// # let folder = tempfile::tempdir().unwrap();
/// # let path = folder.path().join("a.png");
/// let film = Film::new(4, 4, 1);
/// let options = SaveOptions::new().exposure(0.5).tone_map(ToneMap::Agx).gamut(Gamut::DisplayP3).png_bits(16);
/// film.save_with(&path, &options)?;
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaveOptions {
    display: DisplayTransform,
    png_bits: u8,
    jpeg_quality: u8,
}

impl Default for SaveOptions {
    fn default() -> Self {
        SaveOptions::new()
    }
}

impl SaveOptions {
    /// Returns the settings of [`Film::save`](crate::Film::save).
    pub fn new() -> SaveOptions {
        let WriteOptions { display, png_bits, jpeg_quality, .. } = WriteOptions::default();
        SaveOptions { display, png_bits, jpeg_quality }
    }

    /// Sets the exposure in stops, −64 to 64, by which radiance is multiplied before the tone map.
    pub fn exposure(mut self, stops: f64) -> Self {
        self.display.exposure = stops;
        self
    }

    /// Sets the colour temperature of the light that shall look white, 1500 to 25000 kelvin.
    pub fn white_balance(mut self, kelvin: f64) -> Self {
        self.display.white_balance = Some(kelvin);
        self
    }

    /// Sets how radiance becomes the light of a screen.
    pub fn tone_map(mut self, tone_map: ToneMap) -> Self {
        self.display.tone_map = tone_map;
        self
    }

    /// Sets the primaries of the picture, with which the file is tagged.
    pub fn gamut(mut self, gamut: Gamut) -> Self {
        self.display.gamut = gamut;
        self
    }

    /// Sets the bits of a channel of PNG files: 8 or 16.
    pub fn png_bits(mut self, bits: u8) -> Self {
        self.png_bits = bits;
        self
    }

    /// Sets the quality of JPEG files: 1, the smallest files, to 100.
    pub fn jpeg_quality(mut self, quality: u8) -> Self {
        self.jpeg_quality = quality;
        self
    }

    pub(super) fn write_options(&self) -> WriteOptions<'static> {
        let SaveOptions { display, png_bits, jpeg_quality } = *self;
        WriteOptions { display, png_bits, jpeg_quality, ..WriteOptions::default() }
    }
}
