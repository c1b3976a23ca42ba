//! What alpha, sides, emission and cones of light do, against values worked out by hand; on device and oracle.

use std::f64::consts::PI;

use glam::DVec3;
use moire::internal::core::film::Film;
use moire::internal::pack::PackedScene;
use moire::internal::scene::parse;
use moire::internal::texture::data::TextureData;

use super::{floats, scene};
use crate::stage;
use crate::support::told;

const HEAD: &str = "camera = { eye = [0, 0, 2], look_at = [0, 0, 0], orthographic_height = 2 }\n\
    image = { width = 8, height = 8 }\n";
const PLANE: &str = "[[plane]]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\n";

fn both(packed: &PackedScene) -> [Film; 2] {
    [stage::render(packed), stage::render_on_oracle(packed)]
}

fn mean(film: &Film) -> f64 {
    film.pixels.iter().map(|p| f64::from(p[0])).sum::<f64>() / film.pixels.len() as f64
}

fn means(text: &str, textures: Vec<TextureData>) -> [f64; 2] {
    both(&scene(text, textures)).map(|film| mean(&film))
}

fn near(text: &str, textures: Vec<TextureData>, expected: f64, within: f64) {
    for (seen, what) in means(text, textures).into_iter().zip(["device", "oracle"]) {
        assert!((seen - expected).abs() < within, "{what}: {seen}, not {expected}, of\n{text}");
    }
}

/// Two panes of a quarter each before grey: 1/4 + 3/4 (1/4 · 0 + 3/4 · 1/2), without noise.
#[test]
fn blended_surfaces_add_what_they_cover_and_let_the_rest_pass() {
    let text = format!(
        "{HEAD}sampling = {{ pattern = 'center' }}\nbackground = {{ color = [0.5, 0.5, 0.5] }}\n\
         [[material]]\nname = 'white'\nmodel = 'unlit'\nalpha = 'blend'\nopacity = 0.25\n\
         [[material]]\nname = 'black'\nmodel = 'unlit'\ncolor = [0, 0, 0]\nalpha = 'blend'\nopacity = 0.25\n\
         {PLANE}origin = [0, 0, 0]\nmaterial = 'black'\n{PLANE}origin = [0, 0, 1]\nmaterial = 'white'\n"
    );
    near(&text, Vec::new(), 0.25 + 0.75 * (0.75 * 0.5), 1e-6);
}

/// Many layers: each lets half pass, and a path passes 64 of them.
#[test]
fn forty_layers_are_passed() {
    let mut text = format!(
        "{HEAD}sampling = {{ pattern = 'center', max_depth = 1 }}\nbackground = {{ color = [1, 1, 1] }}\n\
         [[material]]\nname = 'pane'\nmodel = 'unlit'\ncolor = [0, 0, 0]\nalpha = 'blend'\nopacity = 0.01\n"
    );
    for i in 0..40 {
        text += &format!("{PLANE}origin = [0, 0, {}]\nmaterial = 'pane'\n", -0.1 * f64::from(i));
    }
    near(&text, Vec::new(), 0.99f64.powi(40), 1e-5);
}

/// Half of a mirror's samples are reflected, the others pass.
#[test]
fn a_blended_mirror_is_met_by_a_part_of_the_samples() {
    let text = format!(
        "{HEAD}sampling = {{ pattern = 'sobol-owen', spp = 256 }}\nbackground = {{ color = [1, 1, 1] }}\n\
         [[material]]\nname = 'm'\nmodel = 'mirror'\ncolor = [0, 0, 0]\nalpha = 'blend'\nopacity = 0.5\n\
         {PLANE}origin = [0, 0, 0]\nmaterial = 'm'\n{PLANE}origin = [0, 0, -1]\nmaterial = 'm'\n"
    );
    near(&text, Vec::new(), 0.25, 0.02);
}

/// Stripes of one texel, half of them holes.
fn stripes() -> TextureData {
    floats(64, 1, |x, _| [1.0, 1.0, 1.0, if x % 2 == 0 { 1.0 } else { 0.0 }])
}

/// A mask of stripes covers half of what it stands before, however small its texels appear and however they are filtered,
/// and so does its shadow.
#[test]
fn a_mask_covers_the_same_share_from_near_and_from_far() {
    for repeats in [0.5, 4.0, 50.0, 1000.0] {
        for footprint in ["none", "differentials"] {
            let text = format!(
                "{HEAD}sampling = {{ pattern = 'sobol-owen', spp = 256, footprint = '{footprint}' }}\n\
                 [[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\nmip = 'linear'\n\
                 [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\nalpha = 'mask'\n\
                 mapping = {{ scale = {} }}\n{PLANE}origin = [0, 0, 0]\nmaterial = 'm'\n",
                repeats / 2.0
            );
            near(&text, vec![stripes()], 0.5, 0.01);
        }
    }
    let shadow = format!(
        "{HEAD}sampling = {{ pattern = 'sobol-owen', spp = 256 }}\n\
         [[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\nfilter = 'nearest'\n\
         [[material]]\nname = 'floor'\n\
         [[material]]\nname = 'm'\ntexture = 't'\nsampler = 's'\nalpha = 'mask'\nmapping = {{ scale = 5 }}\n\
         [[light]]\nkind = 'directional'\ndirection = [0, 1, 1]\nirradiance = [1, 1, 1]\n\
         {PLANE}origin = [0, 0, 0]\nmaterial = 'floor'\n{PLANE}origin = [0, 0, 3]\nmaterial = 'm'\n"
    );
    near(&shadow, vec![stripes()], 0.5 * 0.5f64.sqrt() / PI, 0.005);
}

#[test]
fn opaque_materials_ignore_the_alpha_of_their_texture() {
    let text = format!(
        "{HEAD}[[texture]]\nname = 't'\nfile = 't.exr'\n[[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\n\
         {PLANE}origin = [0, 0, 0]\nmaterial = 'm'\n"
    );
    near(&text, vec![stripes()], 1.0, 1e-6);
}

/// Seen from behind it is not there; light that comes from its back is kept away.
#[test]
fn a_surface_of_one_side_hides_nothing_behind_its_back_and_shades_from_both() {
    let of = |bitangent: &str| {
        format!(
            "{HEAD}sampling = {{ pattern = 'center' }}\nbackground = {{ color = [0.5, 0.5, 0.5] }}\n\
             [[material]]\nname = 'm'\nmodel = 'unlit'\nsides = 'front'\n\
             [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = {bitangent}\nmaterial = 'm'\n"
        )
    };
    near(&of("[0, 1, 0]"), Vec::new(), 1.0, 1e-6);
    near(&of("[0, -1, 0]"), Vec::new(), 0.5, 1e-6);
    let shade = format!(
        "{HEAD}sampling = {{ pattern = 'center' }}\n[[material]]\nname = 'm'\nsides = 'front'\n[[material]]\nname = 'floor'\n\
         [[light]]\nkind = 'directional'\ndirection = [0, 0, 1]\nirradiance = [1, 1, 1]\n\
         {PLANE}origin = [0, 0, 0]\nmaterial = 'floor'\n\
         [[plane]]\norigin = [0, 0, 5]\ntangent = [1, 0, 0]\nbitangent = [0, -1, 0]\nmaterial = 'm'\n"
    );
    near(&shade, Vec::new(), 0.0, 1e-6);
}

#[test]
fn emission_is_added_to_what_every_model_shows() {
    for model in ["unlit", "lambert", "mirror", "metallic-roughness"] {
        let text = format!(
            "{HEAD}sampling = {{ pattern = 'center' }}\n[[texture]]\nname = 't'\nfile = 't.exr'\n\
             [[material]]\nname = 'm'\nmodel = '{model}'\ncolor = [0, 0, 0]\nemission = [3, 3, 3]\nemission_map = 't'\n\
             {PLANE}origin = [0, 0, 0]\nmaterial = 'm'\n"
        );
        near(&text, vec![floats(1, 1, |_, _| [0.5, 1.0, 1.0, 1.0])], 1.5, 1e-6);
    }
}

/// KHR_lights_punctual: the square of (cos - cos outer) / (cos inner - cos outer), and 1 - (d/range)^4.
#[test]
fn a_spot_fades_between_its_angles_and_ends_at_its_range() {
    // Seen from straight above the point (x, 0, 0); the spot is at height 1 and points down.
    let text = |x: f64, more: &str| {
        format!(
            "camera = {{ eye = [{x}, 0, 0.5], look_at = [{x}, 0, 0], orthographic_height = 0.0001 }}\n\
             image = {{ width = 2, height = 2 }}\nsampling = {{ pattern = 'center' }}\n[[material]]\nname = 'm'\n\
             {PLANE}origin = [0, 0, 0]\nmaterial = 'm'\n\
             [[light]]\nkind = 'spot'\nposition = [0, 0, 1]\ndirection = [0, 0, -2]\nintensity = [1, 1, 1]\nouter = 60\n{more}"
        )
    };
    let lit = |x: f64| (1.0 + x * x).powf(-1.5) / PI;
    let fade = |x: f64, inner: f64| {
        let cos = 1.0 / (1.0 + x * x).sqrt();
        ((cos - 0.5) / (inner - 0.5)).clamp(0.0, 1.0).powi(2)
    };
    for x in [0.0, 0.3, 1.0, 1.7] {
        let inner = 30f64.to_radians().cos();
        near(&text(x, "inner = 30"), Vec::new(), lit(x) * fade(x, inner), 1e-6);
    }
    near(&text(1.6, ""), Vec::new(), lit(1.6), 1e-6);
    near(&text(1.8, ""), Vec::new(), 0.0, 1e-6);
    let range = |d: f64| 1.0 - (d / 1.5).powi(4);
    near(&text(0.0, "inner = 30\nrange = 1.5"), Vec::new(), lit(0.0) * range(1.0), 1e-6);
    near(&text(0.0, "inner = 30\nrange = 0.9"), Vec::new(), 0.0, 1e-6);
}

#[test]
fn keys_without_what_they_need_are_refused_by_line_and_key() {
    let said = |body: &str| told(parse(std::path::Path::new("a.toml"), &format!("{HEAD}{body}")));
    for (body, parts) in [
        ("[[material]]\nname = 'm'\nalpha_cutoff = 0.5", ["alpha_cutoff", "alpha = \"mask\""]),
        ("[[material]]\nname = 'm'\nopacity = 0.5", ["opacity", "blend"]),
        ("[[material]]\nname = 'm'\nalpha = 'cutout'", ["alpha", "opaque, mask, blend"]),
        ("[[material]]\nname = 'm'\nmetallic = 0.5", ["metallic", "metallic-roughness"]),
        ("[[material]]\nname = 'm'\nocclusion_strength = 0.5", ["occlusion_strength", "occlusion_map"]),
        ("[[material]]\nname = 'm'\nemission = [-1, 0, 0]", ["emission", "not negative"]),
        ("[[material]]\nname = 'm'\nsides = 'back'", ["sides", "both, front"]),
        ("[[light]]\nkind = 'environment'\nintensity = [1, 1, 1]", ["intensity", "environment"]),
        (
            "[[light]]\nkind = 'spot'\nposition = [0, 0, 1]\ndirection = [0, 0, -1]\nintensity = [1, 1, 1]\nouter = 10\ninner = 20",
            ["inner", "smaller"],
        ),
        (
            "[[light]]\nkind = 'spot'\nposition = [0, 0, 1]\ndirection = [0, 0, 0]\nintensity = [1, 1, 1]\nouter = 10",
            ["direction", "not zero"],
        ),
    ] {
        let said = said(body);
        assert!(parts.iter().all(|part| said.contains(part)), "{body}: {said}");
    }
}

#[test]
fn alpha_and_a_sky_light_keep_a_path_finite_everywhere() {
    let text = "camera = { eye = [0, 0.2, 3], look_at = [0, 0, 0], vertical_fov = 50 }\nimage = { width = 16, height = 16 }\n\
         sampling = { pattern = 'sobol-owen', spp = 16 }\nbackground = { color = [1, 1, 1] }\n\
         [[light]]\nkind = 'environment'\n\
         [[material]]\nname = 'm'\nmodel = 'metallic-roughness'\nroughness = 0.0\nalpha = 'blend'\nopacity = 0.5\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 0.5\nmaterial = 'm'\n";
    for film in both(&scene(text, Vec::new())) {
        let color = |p: &[f32; 3]| DVec3::from_array(p.map(f64::from));
        assert!(film.pixels.iter().all(|p| color(p).is_finite() && color(p).max_element() < 50.0));
        assert!(mean(&film) > 0.3 && mean(&film) < 1.1, "{}", mean(&film));
    }
}
