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
    /// Bits per channel of PNG files [default: 8]
    #[arg(long, value_name = "BITS", value_parser = ["8", "16"], help_heading = DISPLAY)]
    png_bits: Option<String>,
    /// Quality of JPEG files: 1 (smallest) to 100 [default: 95]
    #[arg(long, value_name = "Q", value_parser = clap::value_parser!(u8).range(1..=100), allow_negative_numbers = true, help_heading = DISPLAY)]
    jpeg_quality: Option<u8>,
}

impl DisplayArgs {
    /// Returns how pictures are written.
    pub fn write_options(&self) -> WriteOptions<'static> {
        let (written, default) = (WriteOptions::default(), DisplayTransform::default());
        let png_bits = self.png_bits.as_deref().map(|bits| if bits == "16" { 16 } else { 8 });
        WriteOptions {
            png_bits: png_bits.unwrap_or(written.png_bits),
            jpeg_quality: self.jpeg_quality.unwrap_or(written.jpeg_quality),
            display: DisplayTransform {
                exposure: self.exposure.unwrap_or(default.exposure),
                white_balance: self.white_balance,
                tone_map: self.tone_map.unwrap_or(default.tone_map),
                gamut: self.gamut.unwrap_or(default.gamut),
            },
            ..written
        }
    }

    /// Returns warnings for options that concern no output.
    pub fn without_effect(&self, outputs: &Outputs, has_beauty: bool) -> Vec<String> {
        let shown = [
            ("--exposure", self.exposure.is_some()),
            ("--white-balance", self.white_balance.is_some()),
            ("--tone-map", self.tone_map.is_some()),
            ("--gamut", self.gamut.is_some()),
        ];
        let shows = |format: Format| !matches!(format, Format::Exr | Format::Hdr);
        let why = if has_beauty {
            "OpenEXR and Radiance HDR keep linear light; PNG, JPEG and TIFF show it"
        } else {
            "false colours stand for numbers"
        };
        let bits = [("--png-bits", self.png_bits.is_some())];
        let quality = [("--jpeg-quality", self.jpeg_quality.is_some())];
        let groups = [
            (&shown[..], has_beauty && outputs.formats().any(shows), why),
            (&bits[..], outputs.formats().any(|format| format == Format::Png), "no output is a PNG file"),
            (
                &quality[..],
                outputs.formats().any(|format| format == Format::Jpeg),
                "no output is a JPEG file",
            ),
        ];
        let without = groups.into_iter().filter(|(_, concerned, _)| !concerned);
        without.filter_map(|(options, _, why)| warning(options, why)).collect()
    }
}

/// Returns that the given ones of some options have no effect.
fn warning(options: &[(&str, bool)], why: &str) -> Option<String> {
    let given: Vec<&str> = options.iter().filter(|(_, given)| *given).map(|(name, _)| *name).collect();
    let verb = verb(given.len(), "has", "have");
    (!given.is_empty()).then(|| format!("{} {verb} no effect: {why}", given.join(", ")))
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
