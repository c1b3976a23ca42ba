//! Geometry in f64: the same picture as the oracle's, which scenes use it, and a regression test
//! for each fault that it and the surrounding arithmetic have fixed.

use std::path::Path;

use moire::internal::pack::features::Features;
use moire::internal::pack::{self, PackedScene};
use moire::internal::render::Tuning;
use moire::internal::scene::model::{Algorithm, Precision, Scene};
use moire::internal::scene::{parse, prune::prune};
use moire::internal::texture::load::load;

use crate::stage::{
    assert_same_bits, device, every_scene, packed, render, render_on_oracle, render_with, small,
};

mod faults;

every_scene! { as_the_oracle_of: super::agrees_with_the_oracle }

fn in_double(mut scene: Scene) -> PackedScene {
    scene.sampling.precision = Precision::Double;
    packed(scene, None)
}

/// Both compute the same rays and points to 2^-50; look-ups and light are f32 in one and f64 in the other, and a
/// highlight raises them to a power. Hardware samplers have weights of 1/256.
fn agrees_with_the_oracle(name: &str) {
    let scene = small(name, 40, 4);
    let uses_hardware = scene.samplers.iter().any(|s| s.method.name() == "hardware");
    let is_cone = scene.sampling.algorithm == Algorithm::Cone;
    let packed = in_double(scene);
    assert_eq!(packed.double, !is_cone, "{name}");
    if is_cone || packed.beams || uses_hardware {
        return;
    }
    let (film, exact) = (render(&packed), render_on_oracle(&packed));
    // Random choices of glass and of stochastic filters are f32 on both sides of a threshold.
    let mut beyond = 0;
    for (found, wanted) in film.pixels.iter().flatten().zip(exact.pixels.iter().flatten()) {
        let close = (found - wanted).abs() <= 2e-4 * wanted.abs().max(1.0);
        beyond += u32::from(!close);
    }
    // Half a per cent, for outlines of shadows and random choices; nearest texels with edges under samples.
    let allowed = film.pixels.len() / if name == "quad" { 40 } else { 200 };
    assert!(beyond as usize <= 3 * allowed, "{name}: {beyond} of {} numbers", 3 * film.pixels.len());
}

#[test]
fn what_is_left_out_changes_no_bit_in_f64() {
    for name in ["mappings", "mirrors", "lens", "procedural"] {
        let packed = in_double(small(name, 40, 4));
        let [lean, full] =
            [false, true].map(|everything| render_with(&packed, everything, &Tuning::default()).0);
        assert_same_bits(&lean, &full, name);
    }
}

#[test]
fn an_adaptive_picture_of_f64_with_its_beams_is_the_oracles() {
    let mut scene = small("s1a", 48, 16);
    scene.sampling.precision = Precision::Double;
    scene.sampling.algorithm = Algorithm::Beam;
    let packed = packed(scene, None);
    assert!(packed.double && packed.beams);
    let (film, exact) = (render(&packed), render_on_oracle(&packed));
    for (found, wanted) in film.pixels.iter().flatten().zip(exact.pixels.iter().flatten()) {
        assert!((found - wanted).abs() < 4e-3, "{found} is not {wanted}"); // 1/255, beams are of f32
    }
}

/// A scene of the measuring kind: what `auto` makes of it.
fn chosen(text: &str) -> PackedScene {
    let mut scene = parse(Path::new("scene.toml"), text).unwrap();
    prune(&mut scene);
    let textures = scene.textures.iter().map(|t| load(t).unwrap()).collect();
    pack::pack(&scene, textures, None).unwrap()
}

const CAMERA: &str =
    "[camera]\neye = [0, 1, 0]\nlook_at = [0, 0.2, -4]\n[image]\nwidth = 512\nheight = 512\n";
const CHECKER: &str = "[[texture]]\nname = 't'\nprocedural = 'checker'\n";

fn ground(fov: &str, scale: &str) -> String {
    let camera = CAMERA.replace("[image]", &format!("vertical_fov = {fov}\n[image]"));
    format!(
        "{camera}{CHECKER}[[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\n\
         mapping = {{ kind = 'surface', scale = [{scale}, {scale}] }}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm'\n"
    )
}

#[test]
fn scenes_pay_for_f64_only_where_f32_misplaces_what_is_seen() {
    for name in ["s1a", "s1b", "s2", "lecture", "horizon", "glass", "lens"] {
        assert!(!packed(small(name, 512, 4), None).double, "{name}");
    }
    let cases = [
        ("an ordinary ground", ground("60.0", "1.0"), false),
        ("a million tiles a unit", ground("60.0", "1e6"), true),
        ("a view of a millionth of a degree", ground("1e-6", "1.0"), true),
    ];
    for (what, text, double) in cases {
        assert_eq!(chosen(&text).double, double, "{what}");
    }
    let ball = |radius: f64, distance: f64| {
        let fov = 4.0 * (radius / distance).asin().to_degrees();
        CAMERA.replace("[image]", &format!("vertical_fov = {fov}\n[image]"))
            + &format!(
                "[[sphere]]\ncenter = [0, {}, {}]\nradius = {radius:?}\n",
                1.0 - 0.2 * distance,
                -distance
            )
    };
    assert!(!chosen(&ball(1.0, 20.0)).double);
    assert!(chosen(&ball(1e-4, 1e5)).double);
}

#[test]
fn the_command_line_says_which_precision_a_scene_gets() {
    let text = ground("60.0", "1.0");
    for (precision, double) in [("single", false), ("double", true)] {
        let text = format!("{text}[sampling]\nprecision = '{precision}'\n");
        let packed = chosen(&text);
        assert_eq!(packed.double, double);
        let left_out = Features::new(&packed, false, false).left_out;
        assert_eq!(left_out.iter().any(|what| what == "geometry in f64"), !double);
    }
    let error = parse(Path::new("a.toml"), &format!("{text}[sampling]\nprecision = 'half'\n")).unwrap_err();
    assert!(error.to_string().contains("precision"), "{error}");
}

#[test]
fn the_device_under_test_has_f64() {
    // Lavapipe and data-centre GPUs have f64; without it scenes are rendered in f32.
    assert!(device().info().limits.float64);
}

#[test]
fn a_device_without_f64_renders_in_f32_and_says_so() {
    let mut scene = in_double(small("s1a", 40, 4));
    let single = packed(small("s1a", 40, 4), None);
    let told = scene.adapt_to_device(false).unwrap();
    assert!(told.contains("no f64") && told.contains("--precision single"), "{told}");
    assert!(!scene.double);
    assert_eq!((scene.header, &scene.records.planes), (single.header, &single.records.planes));
    assert_eq!(in_double(small("s1a", 40, 4)).adapt_to_device(true), None);
    assert_eq!(scene.adapt_to_device(false), None, "a scene of f32 has nothing to tell");
}
