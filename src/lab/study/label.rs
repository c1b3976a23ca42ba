//! Settings as a person calls them. Input: a pattern, filter, footprint or algorithm, or an option with its value. Output:
//! a few words, of which [`Method::label`](super::method::Method::label) makes the names of methods.

use crate::core::counted::counted;
use crate::scene::model::{Algorithm, Footprint, Pattern};
use crate::texture::sampler_spec::Filter;

/// Returns the words for an option of `moire render` with a value, or for a key of the scene.
pub fn setting(name: &str, value: &str) -> String {
    match (name, value.parse::<u32>()) {
        ("spp", Ok(count)) => counted(count, "sample"),
        ("seed" | "camera" | "exposure", _) => format!("{name} {value}"),
        ("white-balance", _) => format!("white balance: {value} K"),
        ("gamut", _) => value.to_owned(),
        ("size", _) => value.replace('x', "×"),
        ("set", _) => value.replacen('=', ": ", 1),
        _ if name.contains('.') => format!("{name}: {value}"),
        _ => format!("{}: {value}", name.replace('-', " ")),
    }
}

pub fn pattern(pattern: Pattern) -> &'static str {
    match pattern {
        Pattern::Center => "pixel centres",
        Pattern::Grid => "regular grid",
        Pattern::Halton => "Halton",
        Pattern::SobolOwen => "Sobol-Owen",
        Pattern::BlueNoise => "blue noise",
        other => other.name(),
    }
}

/// Returns the name of an algorithm that is not the plain one.
pub fn algorithm(algorithm: Algorithm) -> Option<&'static str> {
    match algorithm {
        Algorithm::Samples => None,
        Algorithm::Adaptive => Some("adaptive"),
        Algorithm::Beam => Some("beams"),
        Algorithm::Cone => Some("cones"),
        Algorithm::Auto => Some("auto"),
    }
}

/// Returns the name of a filter over levels that are read linearly.
pub fn filter(filter: Filter) -> &'static str {
    match filter {
        Filter::Nearest => "nearest, two levels",
        Filter::Linear => "trilinear",
        Filter::Ewa => "EWA",
        Filter::SummedArea => "summed-area table",
        Filter::Lanczos2 => "Lanczos 2",
        Filter::Lanczos3 => "Lanczos 3",
        other => other.name(),
    }
}

pub fn footprint(footprint: Footprint) -> &'static str {
    match footprint {
        Footprint::Cone => "cone footprint",
        Footprint::Differentials => "ray differentials",
        Footprint::None => "no footprint",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_named_by_option_and_value() {
        assert_eq!(setting("spp", "1"), "1 sample");
        assert_eq!(setting("filter", "ewa"), "filter: ewa");
        assert_eq!(setting("pixel-filter", "tent"), "pixel filter: tent");
        assert_eq!(setting("size", "64x48"), "64×48");
        assert_eq!(setting("sampler.ground.address", "repeat"), "sampler.ground.address: repeat");
    }
}
