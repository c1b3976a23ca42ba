//! The options of the page, in one table: those of `moire render` whose values are words, from their vocabularies, those
//! that are typed, keys of all samplers, and what becomes of light on a screen. Input: an option and its value as text.
//! Output: a change of the scene or of the display, or what is wrong with the value.

use serde_json::{Value, json};

use super::own_value::{MAG, own_value};
use crate::output::{DisplayTransform, Gamut, ToneMap, parse_kelvin, parse_stops};
use crate::scene::changes::Changes;
use crate::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Precision, Scene};
use crate::scene::{MAX_RADIUS, MAX_SIZE, MAX_SPP};
use crate::texture::sampler_spec::{Address, CUBICS, Filter, LevelUse, Method, TexelCenter};

/// An option of the page.
pub struct Choice {
    /// The option of `moire render` without its dashes, or the key of `--set`.
    pub name: &'static str,
    /// Its values; none for what is typed.
    pub names: &'static [&'static str],
    /// What it is.
    pub help: &'static str,
    pub kind: Kind,
}

/// How an option takes effect.
pub enum Kind {
    /// As an option of the command line: changes the scene, or returns what was expected.
    Option(fn(&mut Changes, &str) -> Result<(), String>),
    /// As `--set`.
    Set,
    /// As an option of the display: the film stays, and is shown differently.
    Display(fn(&mut DisplayTransform, &str) -> Result<(), String>),
}

const BOOL: &[&str] = &["true", "false"];
const CUBIC: &[&str] = &[CUBICS[0].0, CUBICS[1].0, CUBICS[2].0];

macro_rules! word {
    ($field:ident, $kind:ident) => {
        Kind::Option(|changes, value| {
            changes.$field = Some($kind::from_name(value).ok_or_else(|| expected($kind::NAMES))?);
            Ok(())
        })
    };
}

macro_rules! number {
    ($field:ident, $most:expr) => {
        Kind::Option(|changes, value| {
            let number = value.parse().ok().filter(|number| (0..=$most).contains(number));
            changes.$field = Some(number.ok_or_else(|| format!("expected an integer up to {}", $most))?);
            Ok(())
        })
    };
}

/// All options, in the order of the page and of commands.
pub const CHOICES: &[Choice] = &[
    Choice {
        name: "algorithm",
        names: Algorithm::NAMES,
        help: "how a picture is made of samples",
        kind: word!(algorithm, Algorithm),
    },
    Choice {
        name: "pattern",
        names: Pattern::NAMES,
        help: "where samples lie in their pixel",
        kind: word!(pattern, Pattern),
    },
    Choice {
        name: "spp",
        names: &[],
        help: "samples a pixel up to which it refines",
        kind: number!(spp, MAX_SPP),
    },
    Choice {
        name: "seed",
        names: &[],
        help: "another set of random positions",
        kind: number!(seed, u32::MAX),
    },
    Choice {
        name: "shared",
        names: BOOL,
        help: "whether all pixels share their displacements",
        kind: Kind::Option(|changes, value| {
            changes.shared = Some(value.parse().map_err(|_| expected(BOOL))?);
            Ok(())
        }),
    },
    Choice {
        name: "pixel-filter",
        names: PixelFilterKind::NAMES,
        help: "what weighs the samples of a pixel",
        kind: word!(pixel_filter, PixelFilterKind),
    },
    Choice {
        name: "pixel-filter-radius",
        names: &[],
        help: "pixels that it reaches to each side",
        kind: Kind::Option(|changes, value| {
            let radius = value.parse().ok().filter(|radius| (1e-30..=MAX_RADIUS).contains(radius));
            let what = || format!("expected a number above 0 and at most {MAX_RADIUS} (pixels)");
            changes.pixel_filter_radius = Some(radius.ok_or_else(what)?);
            Ok(())
        }),
    },
    Choice {
        name: "footprint",
        names: Footprint::NAMES,
        help: "over what each look-up averages",
        kind: word!(footprint, Footprint),
    },
    Choice { name: "filter", names: Filter::NAMES, help: "of all samplers", kind: word!(filter, Filter) },
    Choice { name: MAG, names: Filter::NAMES, help: "where a texel is wider than a pixel", kind: Kind::Set },
    Choice {
        name: "sampler.*.filter.min",
        names: Filter::NAMES,
        help: "where a pixel is wider than a texel",
        kind: Kind::Set,
    },
    Choice {
        name: "sampler.*.max_anisotropy",
        names: &[],
        help: "the longest footprint, in widths, that anisotropic and ewa follow: 1 to 64",
        kind: Kind::Set,
    },
    Choice { name: "sampler.*.cubic", names: CUBIC, help: "which one the filter cubic is", kind: Kind::Set },
    Choice {
        name: "mip",
        names: LevelUse::NAMES,
        help: "levels that all samplers read",
        kind: word!(mip, LevelUse),
    },
    Choice {
        name: "method",
        names: Method::NAMES,
        help: "the shader's own look-up, or the texture unit",
        kind: word!(method, Method),
    },
    Choice {
        name: "sampler.*.address",
        names: Address::NAMES,
        help: "beyond the edge of a texture",
        kind: Kind::Set,
    },
    Choice {
        name: "sampler.*.texel_center",
        names: TexelCenter::NAMES,
        help: "where the middle of a texel lies",
        kind: Kind::Set,
    },
    Choice {
        name: "precision",
        names: Precision::NAMES,
        help: "of geometry",
        kind: word!(precision, Precision),
    },
    Choice {
        name: "size",
        names: &[],
        help: "width and height, such as 320x240",
        kind: Kind::Option(|changes, value| {
            let sides = value.split_once(['x', '×']);
            let sides = sides.and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
            let fits = |size: &[u32; 2]| size.iter().all(|side| (1..=MAX_SIZE).contains(side));
            let what = || format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIZE}, such as 512x512");
            changes.size = Some(sides.filter(fits).ok_or_else(what)?);
            Ok(())
        }),
    },
    Choice {
        name: "exposure",
        names: &[],
        help: "stops, each a factor of two, before the tone map",
        kind: Kind::Display(|display, value| {
            display.exposure = parse_stops(value)?;
            Ok(())
        }),
    },
    Choice {
        name: "white-balance",
        names: &[],
        help: "the colour temperature, in kelvin, of the light that looks white",
        kind: Kind::Display(|display, value| {
            display.white_balance = Some(parse_kelvin(value)?);
            Ok(())
        }),
    },
    Choice {
        name: "tone-map",
        names: ToneMap::NAMES,
        help: "how light without a bound becomes that of a screen",
        kind: Kind::Display(|display, value| {
            display.tone_map = ToneMap::from_name(value).ok_or_else(|| expected(ToneMap::NAMES))?;
            Ok(())
        }),
    },
    Choice {
        name: "gamut",
        names: Gamut::NAMES,
        help: "the primaries of the picture, with which it is tagged",
        kind: Kind::Display(|display, value| {
            display.gamut = Gamut::from_name(value).ok_or_else(|| expected(Gamut::NAMES))?;
            Ok(())
        }),
    },
];

fn expected(names: &[&str]) -> String {
    format!("expected one of {}", names.join(", "))
}

/// Returns the option with this name.
pub fn choice(name: &str) -> Option<&'static Choice> {
    CHOICES.iter().find(|choice| choice.name == name)
}

/// Returns the table for the page; `own` are the values of the scene itself.
pub fn described(own: &Scene) -> Value {
    let of = |choice: &Choice| {
        json!({
            "name": choice.name,
            "values": values(choice),
            "help": choice.help,
            "own": own_value(own, choice.name),
            "slider": slider(choice.name),
            "is_display": matches!(choice.kind, Kind::Display(_)),
        })
    };
    CHOICES.iter().map(of).collect()
}

/// Returns the values of an option that no scene refuses by themselves.
fn values(choice: &Choice) -> Vec<&'static str> {
    let only_minifies = |name: &str| Filter::from_name(name).is_some_and(Filter::only_minifies);
    choice.names.iter().copied().filter(|name| choice.name != MAG || !only_minifies(name)).collect()
}

/// Returns the ends, the step and the neutral place of an option's slider; a field takes values beyond the ends, too.
fn slider(name: &str) -> Option<[f64; 4]> {
    match name {
        "exposure" => Some([-8.0, 8.0, 0.1, 0.0]),
        "white-balance" => Some([2000.0, 12_000.0, 100.0, 6500.0]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_of_every_vocabulary_is_a_value() {
        for choice in CHOICES {
            let set = |value: &str| match &choice.kind {
                Kind::Option(set) => set(&mut Changes::default(), value),
                Kind::Display(set) => set(&mut DisplayTransform::default(), value),
                Kind::Set => Err("expected by the scene".into()),
            };
            for name in choice.names.iter().filter(|_| !matches!(choice.kind, Kind::Set)) {
                assert_eq!(set(name), Ok(()), "{}={name}", choice.name);
            }
            let said = set("no such word").expect_err(choice.name);
            assert!(said.starts_with("expected"), "{said}");
        }
    }

    #[test]
    fn sizes_and_numbers_keep_their_limits() {
        let set = |name: &str, value: &str| match &choice(name).unwrap().kind {
            Kind::Option(set) => set(&mut Changes::default(), value).is_ok(),
            Kind::Display(set) => set(&mut DisplayTransform::default(), value).is_ok(),
            Kind::Set => unreachable!(),
        };
        assert!(
            set("size", "640x480") && !set("size", "0x4") && !set("size", "99999x1") && !set("size", "4")
        );
        assert!(set("spp", "16777216") && !set("spp", "16777217") && !set("spp", "-1"));
        assert!(set("pixel-filter-radius", "1.5") && !set("pixel-filter-radius", "nan"));
        assert!(set("exposure", "-0.5") && !set("exposure", "65") && !set("exposure", "nan"));
        assert!(set("white-balance", "2700") && !set("white-balance", "0") && !set("white-balance", "off"));
    }
}
