//! Options of pictures for screens: exposure, white balance, tone map, primaries, bits and quality. In: the options. Out:
//! how PNG, JPEG and TIFF files are written, and which options change nothing.

use clap::Args;

use super::outputs::Outputs;
use super::{DISPLAY, named_parser};
use crate::core::counted::verb;
use crate::output::{DisplayTransform, Format, Gamut, KELVINS, STOPS, ToneMap, WriteOptions};

#[derive(Args, Debug)]
pub struct DisplayArgs {
    /// Exposure in stops, before the tone map [default: 0]
    #[arg(long, value_name = "EV", value_parser = stops, allow_negative_numbers = true, help_heading = DISPLAY)]
    exposure: Option<f64>,
    /// Colour temperature, in kelvin, of the light that shall look white
    #[arg(long, value_name = "KELVIN", value_parser = kelvin, allow_negative_numbers = true, help_heading = DISPLAY)]
    white_balance: Option<f64>,
    /// How radiance becomes the light of a screen; none clips it [default: none]
    #[arg(long, value_name = "MAP", value_parser = named_parser(ToneMap::NAMES, ToneMap::from_name), help_heading = DISPLAY)]
    tone_map: Option<ToneMap>,
    /// Primaries of the picture, with which it is tagged [default: srgb]
    #[arg(long, value_name = "SPACE", value_parser = named_parser(Gamut::NAMES, Gamut::from_name), help_heading = DISPLAY)]
    gamut: Option<Gamut>,
    /// Bits per channel of PNG files
    #[arg(long, value_name = "BITS", default_value = "8", value_parser = ["8", "16"], help_heading = DISPLAY)]
    png_bits: String,
    /// Quality of JPEG files: 1 (smallest) to 100
    #[arg(long, value_name = "Q", default_value_t = 95, value_parser = clap::value_parser!(u8).range(1..=100), allow_negative_numbers = true, help_heading = DISPLAY)]
    jpeg_quality: u8,
}

impl DisplayArgs {
    /// Returns how pictures are written.
    pub fn write_options(&self) -> WriteOptions<'static> {
        let default = DisplayTransform::default();
        WriteOptions {
            png_bits: if self.png_bits == "16" { 16 } else { 8 },
            jpeg_quality: self.jpeg_quality,
            display: DisplayTransform {
                exposure: self.exposure.unwrap_or(default.exposure),
                white_balance: self.white_balance,
                tone_map: self.tone_map.unwrap_or(default.tone_map),
                gamut: self.gamut.unwrap_or(default.gamut),
            },
            ..WriteOptions::default()
        }
    }

    /// Returns a warning if an option concerns no output, as all of them hold linear light.
    pub fn without_effect(&self, outputs: &Outputs) -> Option<String> {
        let options = [
            ("--exposure", self.exposure.is_some()),
            ("--white-balance", self.white_balance.is_some()),
            ("--tone-map", self.tone_map.is_some()),
            ("--gamut", self.gamut.is_some()),
        ];
        let given: Vec<&str> = options.iter().filter(|(_, given)| *given).map(|(name, _)| *name).collect();
        let is_linear = |format: Format| matches!(format, Format::Exr | Format::Hdr);
        if given.is_empty() || !outputs.formats().all(is_linear) {
            return None;
        }
        Some(format!(
            "{} {} no effect: OpenEXR and Radiance HDR keep linear light; PNG, JPEG and TIFF show it",
            given.join(", "),
            verb(given.len(), "has", "have")
        ))
    }
}

fn stops(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| STOPS.contains(value));
    value.ok_or_else(|| format!("expected a number of stops from {} to {}", STOPS.start(), STOPS.end()))
}

fn kelvin(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| KELVINS.contains(value));
    value.ok_or_else(|| {
        format!(
            "expected kelvin from {} to {}: lamps have about 2700, daylight 6500",
            KELVINS.start(),
            KELVINS.end()
        )
    })
}
