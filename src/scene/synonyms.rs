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
    ("msaa", "n-rooks", None),
    ("ssaa", "grid", None),
    ("rgss", "n-rooks", None),
    ("low-discrepancy", "sobol-owen", None),
    ("poisson", "blue-noise", None),
    ("poisson-disk", "blue-noise", None),
    // Algorithms and footprints.
    ("path", "samples", None),
    ("supersampling", "samples", None),
    ("supersample", "samples", None),
    ("ssaa", "samples", None),
    ("msaa", "samples", None),
    ("path-tracing", "samples", None),
    ("monte-carlo", "samples", None),
    ("ray-differentials", "differentials", None),
    ("anisotropic", "differentials", None),
    ("ellipse", "differentials", None),
    ("isotropic", "cone", None),
    // Texture filters.
    ("point", "nearest", None),
    ("bilinear", "linear", None),
    ("trilinear", "linear", MIPPED),
    ("mipmap", "linear", MIPPED),
    ("mipmaps", "linear", MIPPED),
    ("bicubic", "cubic", None),
    ("catmull-rom", "cubic", None),
    ("b-spline", "cubic", None),
    ("bspline", "cubic", None),
    ("sat", "summed-area", None),
    ("box", "summed-area", None),
    ("gaussian", "ewa", None),
    ("elliptical", "ewa", None),
    ("tent", "linear", None),
    ("texture-unit", "hardware", None),
    ("gpu", "hardware", None),
    ("software", "shader", None),
    ("off", "none", None),
    ("on", "linear", None),
    // Pixel filters.
    ("triangle", "tent", None),
    ("bartlett", "tent", None),
    ("bilinear", "tent", None),
    ("mitchell-netravali", "mitchell", None),
    ("bicubic", "mitchell", None),
    ("catmull-rom", "mitchell", None),
    ("b-spline", "mitchell", None),
    ("bspline", "mitchell", None),
    ("lanczos", "mitchell", None),
    ("sinc", "mitchell", None),
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
    ("rec709", "srgb", None),
    ("bt709", "srgb", None),
    ("p3", "display-p3", None),
    ("dci-p3", "display-p3", None),
    // Tone maps.
    ("hable", "filmic", None),
    ("uncharted2", "filmic", None),
    ("narkowicz", "aces-narkowicz", None),
    ("aces-filmic", "aces", None),
    ("linear", "none", None),
    ("clamp", "none", None),
    ("gamma", "none", None),
    // Layers and files.
    ("z", "depth", None),
    ("diffuse", "albedo", None),
    ("base-color", "albedo", None),
    ("object-id", "instance", None),
    ("mesh-id", "instance", None),
    ("variance", "error", None),
    ("texcoord", "uv", None),
    ("lod", "level", None),
    ("half", "exr", None),
    ("float", "exr", None),
    ("webp", "png", None),
    ("bmp", "png", None),
    ("tga", "png", None),
    // Numbers and places.
    ("f32", "single", None),
    ("float", "single", None),
    ("half", "single", None),
    ("f64", "double", None),
    ("gpu", "device", None),
    ("cpu", "host", None),
    ("on", "true", None),
    ("yes", "true", None),
    ("off", "false", None),
    ("no", "false", None),
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
    // New scenes.
    ("plane", "floor", None),
    ("ground", "floor", None),
    ("sphere", "ball", None),
    ("picture", "quad", None),
    ("mesh", "model", None),
    // Options.
    ("antialiasing", "spp", None),
    ("aa", "spp", None),
    ("width", "size", None),
    ("height", "size", None),
    ("resolution", "size", None),
    ("region", "crop", None),
    ("time", "budget", None),
    ("timeout", "budget", None),
    ("error", "target-error", None),
    ("gpu", "device", None),
    ("cpu", "device", None),
    ("fov", "set", None),
    ("layers", "aov", None),
    ("layer", "aov", None),
    ("sampler", "pattern", None),
    ("reconstruction-filter", "pixel-filter", None),
    ("mipmaps", "mip", None),
    ("ev", "exposure", None),
    ("quality", "jpeg-quality", None),
    ("rmse", "max-rmse", None),
    ("threshold", "max-rmse", None),
    ("flip", "max-flip", None),
    // Commands.
    ("diff", "compare", None),
    ("benchmark", "study", None),
    ("info", "texture", None),
    ("list", "devices", None),
    ("init", "new", None),
    ("create", "new", None),
    ("preview", "view", None),
    ("serve", "view", None),
    ("test", "verify", None),
];

/// Terms that have no counterpart here, and what there is in their place.
const ABSENT: &[(&[&str], &str)] = &[
    (
        &["fxaa", "smaa"],
        "it smooths finished pictures; here each pixel is the mean of its samples, of which --spp says how many",
    ),
    (&["taa", "dlss"], "it averages frames; here each picture has as many samples as --spp says"),
    (
        &["rec2020", "bt2020", "acescg", "aces2065", "adobe-rgb", "prophoto"],
        "colours have the primaries of sRGB here; a file of others has to be converted, and --gamut display-p3 writes those",
    ),
];

/// Returns what there is in place of a term that has no counterpart.
pub fn absent(word: &str) -> Option<&'static str> {
    let word = word.to_lowercase();
    ABSENT.iter().find(|(words, _)| words.contains(&word.as_str())).map(|(_, instead)| *instead)
}

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
