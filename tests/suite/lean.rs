//! Omitting unused features changes no bit of the picture, nor does anything else that concerns
//! only speed: the source of texels, the workgroup's shape, slices, bands, crops.

use moire::internal::core::range::Rect;
use moire::internal::lab::metrics::compare;
use moire::internal::pack::features::{Features, TexelSource};
use moire::internal::render::{TexelChoice, Tuning};
use moire::internal::scene::model::Pattern;

use crate::stage::{
    assert_same_bits, cut, every_scene, packed, render, render_on_oracle, render_with, scene, small,
    with_random,
};

every_scene! { same_bits_whatever_is_left_out_of: super::same_bits_whatever_is_left_out }

/// A texel of an image is converted by the device, one of a buffer by the shader: k / 255 to within an ulp each, which
/// a mean of samples preserves. A bump map uses differences of neighbours, over a texel, and a highlight raises them to
/// a power.
///
/// Pipelines with everything take seconds to compile on a CPU device: they are built for scenes that between them use
/// every feature, from images for those that read images differently.
const FULL: [&str; 17] = [
    "beams",
    "cones",
    "discs",
    "environment",
    "filters",
    "glass",
    "glossy",
    "lens",
    "lights",
    "mappings",
    "materials",
    "mirrors",
    "motion",
    "penumbra",
    "physical",
    "procedural",
    "s2",
];

fn same_bits_whatever_is_left_out(name: &str) {
    // Two tiles wide, with a ragged edge.
    let packed = packed(small(name, 70, 4), None);
    let [buffer, image] = [TexelChoice::Buffer, TexelChoice::Image].map(|texels| {
        let tuning = Tuning { texels, ..Tuning::default() };
        let (lean, lean_report) = render_with(&packed, false, &tuning);
        assert!(!lean_report.left_out.is_empty(), "{name} leaves nothing out");
        let own_images = ["formats", "samplers", "volume", "environment_cube", "hardware"];
        let full = if texels == TexelChoice::Buffer { FULL.as_slice() } else { own_images.as_slice() };
        if full.contains(&name) {
            let (full, full_report) = render_with(&packed, true, &tuning);
            assert_same_bits(&lean, &full, &format!("{name} with texels from {texels}"));
            assert_eq!(full_report.left_out, [""; 0], "{name} keeps not everything");
        }
        lean
    });
    // Highlights magnify the rounding of texels; where their roughness is a picture, by its fourth power. So single pixels
    // may differ more, the picture as a whole hardly does.
    let (ulps, mean_ulps) = match name {
        "physical" => (8192.0, 128.0),
        "materials" => (256.0, 16.0),
        _ => (4.0, 4.0),
    };
    let apart = compare(&buffer, &image).unwrap().rmse;
    assert!(apart <= mean_ulps * f64::from(f32::EPSILON), "{name}: pictures are {apart} apart");
    for (p, q) in buffer.pixels.iter().flatten().zip(image.pixels.iter().flatten()) {
        assert!((p - q).abs() <= ulps * f32::EPSILON * p.abs().max(1.0), "{name}: {p} and {q}");
    }
}

#[test]
fn the_default_source_of_texels_is_one_of_the_two() {
    let packed = packed(small("lecture", 70, 4), None);
    let film = |texels| render_with(&packed, false, &Tuning { texels, ..Tuning::default() }).0;
    let default = film(TexelChoice::Auto);
    assert!([TexelChoice::Buffer, TexelChoice::Image].iter().any(|&texels| film(texels) == default));
}

fn value(features: &Features, constant: &str) -> u32 {
    let found = features.values.iter().find(|(known, _)| known.name() == constant);
    found.unwrap_or_else(|| panic!("no constant {constant}")).1
}

#[test]
fn a_ground_without_light_pays_for_nothing_else() {
    let packed = packed(scene("s1a"), None);
    let features = Features::new(&packed, false, false);
    for absent in [
        "SHADOWS",
        "BOUNCES",
        "SPHERES",
        "TRIANGLES",
        "LIGHTS",
        "UNTEXTURED",
        "COMPENSATED",
        "SMOOTH_NORMALS",
        "SAMPLE_DIMENSIONS",
        "MOTIONS",
        "MOVING_CAMERA",
    ] {
        assert_eq!(value(&features, absent), 0, "{absent}");
    }
    for single in ["PLANES", "TEXTURES", "SAMPLERS", "MATERIALS", "UV_PROJECTIONS"] {
        assert_eq!(value(&features, single), 1, "{single}");
    }
    for mode in [
        "PATTERNS",
        "MODELS",
        "METHODS",
        "ADDRESSES_U",
        "ADDRESSES_V",
        "FILTERS",
        "TEXEL_CENTERS",
        "MAPPINGS",
    ] {
        assert_eq!(value(&features, mode).count_ones(), 1, "{mode} is not one mode");
    }
    assert_eq!(value(&features, "PATTERNS"), 1 << Pattern::Stratified as u32);
    assert_eq!((features.source, features.compensated), (TexelSource::Buffer, false));
    assert!(features.left_out.iter().any(|line| line == "shadow rays"), "{:?}", features.left_out);
}

#[test]
fn what_a_scene_uses_is_kept() {
    let features = |name: &str| Features::new(&packed(scene(name), None), false, false);
    assert_eq!(value(&features("lecture"), "SHADOWS"), 1);
    assert_eq!(value(&features("lecture"), "BOUNCES"), 1);
    assert_eq!(value(&features("lights"), "LIGHT_KINDS"), 0b11);
    assert_eq!(value(&features("lights"), "BOUNCES"), 0);
    assert_eq!(value(&features("samplers"), "ADDRESSES_U"), 0b1_1111);
    assert_eq!(value(&features("lights"), "SMOOTH_NORMALS"), 1);
}

#[test]
fn an_untextured_scene_has_no_source_of_texels() {
    let mut plain = scene("lights");
    plain.materials.iter_mut().for_each(|m| m.texture = None);
    plain.width = 70;
    plain.height = 50;
    let packed = packed(plain, None);
    assert_eq!(Features::new(&packed, true, false).source, TexelSource::None);
    let (lean, _) = render_with(&packed, false, &Tuning::default());
    let (full, _) = render_with(&packed, true, &Tuning::default());
    assert_same_bits(&lean, &full, "no textures");
}

#[test]
fn shape_of_the_workgroup_changes_no_bit() {
    let packed = packed(small("lights", 130, 4), None);
    let of = |group| render_with(&packed, false, &Tuning { group, ..Tuning::default() }).0;
    let default = of(None);
    for group in [[64, 1], [8, 8], [1, 8], [16, 64]] {
        assert_same_bits(&of(Some(group)), &default, &format!("workgroups of {group:?}"));
    }
}

#[test]
fn a_crop_has_the_pixels_of_the_full_picture() {
    for name in ["mirrors", "lights", "shared", "hardware"] {
        let scene = small(name, 130, 4);
        let (width, height) = (scene.width, scene.height);
        let full = render(&packed(scene.clone(), None));
        for crop in [
            Rect { x: 0, y: 0, width: 1, height: 1 },
            Rect { x: width - 1, y: height - 1, width: 1, height: 1 },
            Rect { x: 17, y: 5, width: 66, height: height - 5 },
        ] {
            let part = render(&packed(scene.clone(), Some(crop)));
            assert_same_bits(&part, &cut(&full, crop), &format!("{name}, {crop:?}"));
        }
    }
}

#[test]
fn slices_change_no_bit() {
    let mut scene = scene("horizon");
    (scene.width, scene.height) = (300, 300);
    let (full, report) = render_with(&packed(scene.clone(), None), false, &Tuning::default());
    assert!(report.slices > 1, "one slice proves nothing");
    let crop = Rect { x: 100, y: 130, width: 64, height: 64 };
    let (part, report) = render_with(&packed(scene, Some(crop)), false, &Tuning::default());
    assert_eq!(report.slices, 1);
    assert_same_bits(&part, &cut(&full, crop), "slices");
}

/// On a CPU device a film of this width takes several bands.
#[test]
fn bands_change_no_bit() {
    let mut scene = scene("quad");
    (scene.width, scene.height) = (16_384, 330);
    let full = render(&packed(scene.clone(), None));
    for y in [200, 255, 300] {
        let crop = Rect { x: 8000, y, width: 100, height: 30 };
        let part = render(&packed(scene.clone(), Some(crop)));
        assert_same_bits(&part, &cut(&full, crop), &format!("rows from {y}"));
    }
}

/// `random` keeps no stratum, so that the order of 1000 samples matters only to the sum.
#[test]
fn many_samples_are_summed_as_the_oracle_sums_them() {
    let packed = packed(with_random(small("lights", 24, 1), 1000), None);
    let (device, oracle) = (render(&packed), render_on_oracle(&packed));
    let (full, _) = render_with(&packed, true, &Tuning::default());
    assert_same_bits(&device, &full, "1000 samples");
    let compared = moire::internal::lab::metrics::compare(&device, &oracle).unwrap();
    // One sample in a thousand on the other side of an edge moves a pixel by up to 1e-3.
    assert!(
        compared.rmse <= 2e-5 && compared.max <= 1e-3,
        "RMSE {:e}, largest {:e}",
        compared.rmse,
        compared.max
    );
}

/// One f32 sum of 2²⁰ copies of 0.1 is off by a hundredth of itself. Blocks are plain sums of 256, each addition
/// rounding by at most 2⁻²⁴; adding the blocks must not lose anything more.
#[test]
fn a_constant_stays_constant_over_a_million_samples() {
    let mut scene = with_random(small("quad", 4, 1), 1 << 20);
    scene.shapes.planes.clear();
    scene.background.color = glam::DVec3::new(0.1, 0.3, 0.7);
    let film = render(&packed(scene, None));
    for (value, wanted) in film.pixels.iter().flat_map(|p| p.iter().zip([0.1f32, 0.3, 0.7])) {
        assert!((value - wanted).abs() <= 256.0 * f32::EPSILON / 2.0 * wanted, "{value} for {wanted}");
    }
}
