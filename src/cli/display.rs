//! Options of pictures for screens: exposure, white balance, tone map, primaries; of files bits and quality, too. In: the
//! options. Out: how PNG, JPEG and TIFF files are written, and which options change nothing.

use clap::Args;
use serde_json::{Value, json};

use super::outputs::Outputs;
use super::{DISPLAY, named_parser};
use crate::core::counted::verb;
use crate::output::{DisplayTransform, Format, Gamut, ToneMap, WriteOptions, parse_kelvin, parse_stops};

/// What becomes of a film's colours in pictures for screens.
#[derive(Args, Clone, Debug, Default)]
pub struct DisplayArgs {
    /// Exposure in stops [default: 0]
    ///
    /// Before the tone map.
    #[arg(long, value_name = "EV", value_parser = parse_stops, allow_negative_numbers = true, help_heading = DISPLAY)]
    exposure: Option<f64>,
    /// Temperature of the light that shall look white
    ///
    /// In kelvin: lamps have about 2700, daylight 6500.
    #[arg(long, value_name = "KELVIN", value_parser = parse_kelvin, allow_negative_numbers = true, help_heading = DISPLAY)]
    white_balance: Option<f64>,
    /// Tone map [default: none]
    ///
    /// How radiance becomes the light of a screen; none clips it.
    #[arg(long, value_name = "MAP", value_parser = named_parser(ToneMap::NAMES, ToneMap::from_name), help_heading = DISPLAY)]
    tone_map: Option<ToneMap>,
    /// Primaries and their tag [default: srgb]
    #[arg(long, value_name = "SPACE", value_parser = named_parser(Gamut::NAMES, Gamut::from_name), help_heading = DISPLAY)]
    gamut: Option<Gamut>,
}

/// How picture files are written.
#[derive(Args, Debug)]
pub struct FileArgs {
    #[command(flatten)]
    display: DisplayArgs,
    /// Bits of PNG files [default: 8]
    ///
    /// Per channel.
    #[arg(long, value_name = "BITS", value_parser = ["8", "16"], help_heading = DISPLAY)]
    png_bits: Option<String>,
    /// Quality of JPEG files [default: 95]
    ///
    /// From 1 (smallest) to 100.
    #[arg(long, value_name = "Q", value_parser = clap::value_parser!(u8).range(1..=100), allow_negative_numbers = true, help_heading = DISPLAY)]
    jpeg_quality: Option<u8>,
}

impl DisplayArgs {
    /// The names of these options.
    pub const NAMES: [&str; 4] = ["exposure", "white-balance", "tone-map", "gamut"];

    /// Returns what becomes of colours.
    pub fn transform(&self) -> DisplayTransform {
        let default = DisplayTransform::default();
        DisplayTransform {
            exposure: self.exposure.unwrap_or(default.exposure),
            white_balance: self.white_balance,
            tone_map: self.tone_map.unwrap_or(default.tone_map),
            gamut: self.gamut.unwrap_or(default.gamut),
        }
    }

    /// Returns the options that were given, with their values as words.
    pub fn given(&self) -> Vec<(&'static str, String)> {
        let values = [
            self.exposure.map(|stops| stops.to_string()),
            self.white_balance.map(|kelvin| kelvin.to_string()),
            self.tone_map.map(|map| map.name().to_owned()),
            self.gamut.map(|gamut| gamut.name().to_owned()),
        ];
        Self::NAMES.into_iter().zip(values).filter_map(|(name, value)| Some((name, value?))).collect()
    }

    /// Returns these options, and those of `base` that they do not state.
    pub fn over(self, base: &DisplayArgs) -> DisplayArgs {
        DisplayArgs {
            exposure: self.exposure.or(base.exposure),
            white_balance: self.white_balance.or(base.white_balance),
            tone_map: self.tone_map.or(base.tone_map),
            gamut: self.gamut.or(base.gamut),
        }
    }
}

impl FileArgs {
    /// Returns how pictures are written.
    pub fn write_options(&self) -> WriteOptions<'static> {
        let written = WriteOptions::default();
        let png_bits = self.png_bits.as_deref().map(|bits| if bits == "16" { 16 } else { 8 });
        WriteOptions {
            png_bits: png_bits.unwrap_or(written.png_bits),
            jpeg_quality: self.jpeg_quality.unwrap_or(written.jpeg_quality),
            display: self.display.transform(),
            ..written
        }
    }

    /// Adds the settings that are in force to those of a report.
    pub fn report(&self, settings: &mut Value) {
        let WriteOptions { png_bits, jpeg_quality, display, .. } = self.write_options();
        settings["exposure"] = json!(display.exposure);
        settings["white_balance"] = json!(display.white_balance);
        settings["tone_map"] = json!(display.tone_map.name());
        settings["gamut"] = json!(display.gamut.name());
        settings["png_bits"] = json!(png_bits);
        settings["jpeg_quality"] = json!(jpeg_quality);
    }

    /// Returns warnings for options that concern no output.
    pub fn without_effect(&self, outputs: &Outputs, has_beauty: bool) -> Vec<String> {
        let shown: Vec<String> = self.display.given().iter().map(|(name, _)| format!("--{name}")).collect();
        let shows = |format: Format| !matches!(format, Format::Exr | Format::Hdr);
        let has = |wanted: Format| outputs.formats().any(|format| format == wanted);
        let given = |name: &str, is_given: bool| if is_given { vec![name.to_owned()] } else { Vec::new() };
        let why = if has_beauty {
            "OpenEXR and Radiance HDR keep linear light; PNG, JPEG and TIFF show it"
        } else {
            "false colours stand for numbers"
        };
        let groups = [
            (shown, has_beauty && outputs.formats().any(shows), why),
            (given("--png-bits", self.png_bits.is_some()), has(Format::Png), "no output is a PNG file"),
            (
                given("--jpeg-quality", self.jpeg_quality.is_some()),
                has(Format::Jpeg),
                "no output is a JPEG file",
            ),
        ];
        let idle = groups.into_iter().filter(|(options, concerned, _)| !concerned && !options.is_empty());
        idle.map(|(options, _, why)| {
            format!("{} {} no effect: {why}", options.join(", "), verb(options.len(), "has", "have"))
        })
        .collect()
    }
}
