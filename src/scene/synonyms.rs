//! Terms of other programs and textbooks for words of the vocabulary. Input: an unknown word and the valid names.
//! Output: the name with the same meaning, and a setting that is also required.

/// A foreign term, its name here, and the setting (key, value) that it implies.
type Synonym = (&'static str, &'static str, Option<(&'static str, &'static str)>);

const MIPPED: Option<(&str, &str)> = Some(("mip", "linear"));

/// Several lines may have one term: they are tried in order.
const SYNONYMS: &[Synonym] = &[
    // Patterns.
    ("jitter", "stratified", None),
    ("jittered", "stratified", None),
    ("independent", "random", None),
    ("uniform", "random", None),
    ("white-noise", "random", None),
    ("regular", "grid", None),
    ("cmj", "multi-jittered", None),
    ("multijitter", "multi-jittered", None),
    ("sobol", "sobol-owen", None),
    ("owen", "sobol-owen", None),
    ("latin-hypercube", "n-rooks", None),
    ("lhs", "n-rooks", None),
    // Algorithms and footprints.
    ("path", "samples", None),
    ("supersampling", "samples", None),
    ("ray-differentials", "differentials", None),
    // Texture filters.
    ("point", "nearest", None),
    ("bilinear", "linear", None),
    ("trilinear", "linear", MIPPED),
    ("bicubic", "cubic", None),
    ("sat", "summed-area", None),
    // Pixel filters.
    ("triangle", "tent", None),
    ("bartlett", "tent", None),
    ("mitchell-netravali", "mitchell", None),
    // Address modes.
    ("wrap", "repeat", None),
    ("tile", "repeat", None),
    ("mirror", "mirrored-repeat", None),
    ("mirrored", "mirrored-repeat", None),
    ("clamp", "clamp-to-edge", None),
    ("edge", "clamp-to-edge", None),
    ("border", "clamp-to-border", None),
    ("mirror-once", "mirror-clamp-to-edge", None),
    // Colour spaces.
    ("gamma", "srgb", None),
    ("raw", "linear", None),
    ("non-color", "linear", None),
    // Material models.
    ("diffuse", "lambert", None),
    ("lambertian", "lambert", None),
    ("matte", "lambert", None),
    ("metal", "mirror", None),
    ("conductor", "mirror", None),
    ("specular", "mirror", None),
    ("glass", "dielectric", None),
    ("plastic", "phong", None),
    ("blinn-phong", "phong", None),
    ("emissive", "unlit", None),
    ("constant", "unlit", None),
    // Mappings and layouts.
    ("uv", "surface", None),
    ("box", "cube", None),
    ("3d", "solid", None),
    ("latlong", "equirectangular", None),
    ("lat-long", "equirectangular", None),
    ("spherical", "equirectangular", None),
    ("cubemap", "cube", None),
    // Lights.
    ("sun", "directional", None),
    ("distant", "directional", None),
    ("area", "rectangle", None),
    ("quad", "rectangle", None),
    ("omni", "point", None),
    // Keys.
    ("position", "center", None),
    ("colour", "color", None),
    ("albedo", "color", None),
    ("base_color", "color", None),
    ("reflectance", "color", None),
    ("diffuse", "color", None),
    ("fov", "vertical_fov", None),
    ("from", "eye", None),
    ("origin", "eye", None),
    ("target", "look_at", None),
    ("to", "look_at", None),
    ("shininess", "exponent", None),
    ("power", "intensity", None),
    ("emission", "intensity", None),
    ("wrap", "address", None),
    ("wrap_mode", "address", None),
    ("address_mode", "address", None),
    ("samples", "spp", None),
    ("samples_per_pixel", "spp", None),
    ("filename", "file", None),
    ("path", "file", None),
    ("image", "file", None),
];

/// Returns the one of `names` that `word` means elsewhere, and the setting that it implies.
pub fn meant<'n>(
    word: &str,
    names: impl IntoIterator<Item = &'n str> + Clone,
) -> Option<(&'n str, Option<(&'static str, &'static str)>)> {
    let word = word.to_lowercase();
    let known = |name: &str| names.clone().into_iter().find(|n| *n == name);
    let same = SYNONYMS.iter().filter(|(other, ..)| *other == word);
    same.filter_map(|(_, name, also)| known(name).map(|name| (name, *also))).next()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::model::Pattern;
    use crate::texture::sampler_spec::{Address, Filter};

    #[test]
    fn a_word_means_what_the_vocabulary_that_it_stands_in_has() {
        assert_eq!(meant("Jittered", Pattern::NAMES.iter().copied()), Some(("stratified", None)));
        assert_eq!(meant("wrap", Address::NAMES.iter().copied()), Some(("repeat", None)));
        assert_eq!(meant("wrap", ["file", "address"]), Some(("address", None)));
        assert_eq!(meant("trilinear", Filter::NAMES.iter().copied()), Some(("linear", MIPPED)));
        assert_eq!(meant("wrap", Pattern::NAMES.iter().copied()), None);
        assert_eq!(meant("stratified", Pattern::NAMES.iter().copied()), None);
    }
}
