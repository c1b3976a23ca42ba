//! Reads `[[texture]]` with `procedural = "KIND"`: a pattern and its parameters. Input: the section's table.
//! Output: a [`Procedural`]. One table lists the parameters of each kind; a parameter of another kind is an
//! error.

use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::limits::DIMENSIONS;
use crate::texture::procedural::ProceduralKind::{
    self, Brick, Cellular, Fbm, Grid, Marble, Noise, Stripes, Turbulence, Wood,
};
use crate::texture::procedural::{MAX_OCTAVES, Procedural};

/// Parameters that only some kinds have, with those kinds.
const PARAMETERS: &[(&str, &[ProceduralKind])] = &[
    ("seed", &[Noise, Fbm, Turbulence, Marble, Wood, Cellular]),
    ("octaves", &[Fbm, Turbulence, Marble, Wood]),
    ("lacunarity", &[Fbm, Turbulence, Marble, Wood]),
    ("gain", &[Fbm, Turbulence, Marble, Wood]),
    ("width", &[Stripes, Grid, Brick]),
    ("distortion", &[Marble, Wood]),
    ("aspect", &[Brick]),
    ("offset", &[Brick]),
    ("jitter", &[Cellular]),
    ("dimensions", &[Grid]),
];

/// All keys of a procedural texture except its name.
pub(super) const PROCEDURAL: &[&str] = &[
    "procedural",
    "colors",
    "seed",
    "octaves",
    "lacunarity",
    "gain",
    "width",
    "distortion",
    "aspect",
    "offset",
    "jitter",
    "dimensions",
];

pub(super) fn procedural(table: &Table<'_>) -> Result<Procedural> {
    let kind = table.required("procedural")?.choice(ProceduralKind::NAMES, ProceduralKind::ALL)?;
    for (key, kinds) in PARAMETERS.iter().filter(|(_, kinds)| !kinds.contains(&kind)) {
        if let Some(field) = table.get(key) {
            let names: Vec<&str> = kinds.iter().map(|k| k.name()).collect();
            let verb = if names.len() == 1 { "has" } else { "have" };
            let what = format!("procedural \"{kind}\" has no {key}; {} {verb} it", names.join(", "));
            return Err(field.error(&what, format!("not with \"{kind}\"")));
        }
    }
    let mut pattern = Procedural::new(kind);
    if let Some(field) = table.get("colors") {
        let color = |f: Field<'_>| f.numbers::<3>().map(|c| c.map(|x| x as f32));
        pattern.colors = field.array("2 colours, background and figure", pattern.colors, color)?;
    }
    if let Some(field) = table.get("seed") {
        pattern.seed = field.integer(&(0..=u32::MAX))?;
    }
    if let Some(field) = table.get("octaves") {
        pattern.octaves = field.integer(&(1..=MAX_OCTAVES))?;
    }
    if let Some(field) = table.get("dimensions") {
        pattern.dimensions = field.integer(&DIMENSIONS)?;
    }
    let numbers = [
        ("lacunarity", &mut pattern.lacunarity),
        ("gain", &mut pattern.gain),
        ("width", &mut pattern.width),
        ("distortion", &mut pattern.distortion),
        ("aspect", &mut pattern.aspect),
        ("offset", &mut pattern.offset),
        ("jitter", &mut pattern.jitter),
    ];
    for (key, number) in numbers {
        if let Some(field) = table.get(key) {
            *number = field.number()? as f32;
        }
    }
    Ok(pattern)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_parameter_is_a_key() {
        let parameters = PARAMETERS.iter().map(|p| p.0);
        let keys: Vec<&str> = ["procedural", "colors"].into_iter().chain(parameters).collect();
        assert_eq!(keys, PROCEDURAL);
    }
}
