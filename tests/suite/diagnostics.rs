//! Diagnostic counters of exceeded limits: each count is correct in scenes from which the number
//! follows; a render without counting has no counts and the same picture.

use std::path::Path;

use moire::internal::pack::{Diagnostic, PackedScene, pack};
use moire::internal::render::Tuning;
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};

use crate::stage::{assert_same_bits, render_with};

fn grey(side: u32, value: impl Fn(u32) -> f32) -> TextureData {
    TextureData {
        name: "t".into(),
        dimension: Dimension::Two,
        width: side,
        height: side,
        depth: 1,
        format: TexelFormat::new(1, Component::Float32),
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: (0..side * side).flat_map(|i| value(i).to_ne_bytes()).collect(),
        stored_levels: Vec::new(),
    }
}

/// 8 × 8 pixels, 4 samples each.
fn scene(text: &str, texture: Option<TextureData>) -> PackedScene {
    let head = "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\northographic_height = 2\n\
                [image]\nwidth = 8\nheight = 8\n";
    let parsed = parse(Path::new("guards.toml"), &format!("{head}{text}")).unwrap();
    pack(&parsed, texture.into_iter().collect(), None).unwrap()
}

fn counts(mut packed: PackedScene) -> Vec<(Diagnostic, u64)> {
    let (plain, report) = render_with(&packed, false, &Tuning::default());
    assert!(report.diagnostics.is_none(), "a render counts that was not asked to");
    packed.diagnosed = true;
    let (counted, report) = render_with(&packed, false, &Tuning::default());
    assert_same_bits(&plain, &counted, "counting changes the picture");
    report.diagnostics.unwrap()
}

/// Expects that only `guard` counts, and this number.
fn only(found: &[(Diagnostic, u64)], guard: Diagnostic, count: u64) {
    for &(other, n) in found {
        assert_eq!(n, if other == guard { count } else { 0 }, "{other}, in {found:?}");
    }
}

const SAMPLES: &str = "[sampling]\nspp = 4\nfootprint = 'cone'\nmax_depth = 3\n";
const WALL: &str =
    "[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";

fn textured(sampler: &str, mapping: &str) -> String {
    format!(
        "{SAMPLES}[[texture]]\nname = 't'\nfile = 't.exr'\n[[sampler]]\nname = 's'\n{sampler}\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\nmapping = {{ kind = 'surface', {mapping} }}\n{WALL}"
    )
}

#[test]
fn an_ordinary_picture_goes_beyond_no_limit() {
    let text = textured("filter = 'linear'\nmip = 'linear'", "scale = [4, 4]");
    only(&counts(scene(&text, Some(grey(16, |i| i as f32)))), Diagnostic::Depth, 0);
}

#[test]
fn every_look_up_over_more_than_the_last_level_is_counted() {
    // A pixel is a quarter, its share an eighth of a unit: 2 tiles of 16 texels.
    let text = textured("filter = 'linear'\nmip = 'linear'", "scale = [16, 16]");
    only(&counts(scene(&text, Some(grey(16, |i| i as f32)))), Diagnostic::Levels, 8 * 8 * 4);
}

#[test]
fn every_look_up_of_a_longer_footprint_than_the_sampler_follows_is_counted() {
    let text = textured("filter = 'anisotropic'\nmax_anisotropy = 4\nmip = 'linear'", "scale = [4, 0.25]");
    only(&counts(scene(&text, Some(grey(64, |i| i as f32)))), Diagnostic::Anisotropy, 8 * 8 * 4);
}

#[test]
fn every_look_up_at_a_coordinate_that_is_no_number_is_counted() {
    // Beyond f32, with precision single.
    let text = textured("", "scale = [1e30, 1e30]").replace("spp = 4", "spp = 4\nprecision = 'single'");
    let text = text.replace("tangent = [1, 0, 0]", "tangent = [1e-20, 0, 0]");
    let found = counts(scene(&text.replace("footprint = 'cone'", ""), Some(grey(4, |i| i as f32))));
    only(&found, Diagnostic::Coordinates, 8 * 8 * 4);
}

#[test]
fn every_sample_whose_radiance_is_no_number_is_counted() {
    let text = textured("filter = 'nearest'", "scale = [0.5, 0.5], offset = [0.5, 0.5]");
    // One of four texels, over the picture as large as it.
    let texture = grey(2, |i| if i == 2 { f32::NAN } else { 1.0 });
    let packed = scene(&text.replace("footprint = 'cone'", "pattern = 'grid'"), Some(texture));
    let mut packed = packed;
    packed.diagnosed = true;
    let found = render_with(&packed, false, &Tuning::default()).1.diagnostics.unwrap();
    only(&found, Diagnostic::Radiance, 8 * 8 * 4 / 4);
}

#[test]
fn every_path_that_ends_at_the_greatest_depth_is_counted() {
    let mirrors = "[[material]]\nname = 'm'\nmodel = 'mirror'\n\
                   [[plane]]\norigin = [0, 0, 2]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n";
    only(&counts(scene(&format!("{SAMPLES}{mirrors}{WALL}"), None)), Diagnostic::Depth, 8 * 8 * 4);
}

#[test]
fn footprints_of_rays_that_graze_a_plane_are_counted() {
    let text = textured("filter = 'linear'\nmip = 'linear'", "scale = [1e-9, 1e-9]").replace(
        "origin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]",
        "origin = [0, -2, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1e-6, -1]",
    );
    let found = counts(scene(&text, Some(grey(4, |i| i as f32))));
    let grazing = found.iter().find(|(guard, _)| *guard == Diagnostic::Grazing).unwrap().1;
    assert_eq!(grazing, 8 * 8 * 4, "{found:?}");
}

#[test]
fn cones_without_room_are_counted() {
    let mut text = "[sampling]\nalgorithm = 'cone'\n[[material]]\nname = 'm'\nmodel = 'unlit'\n".to_string();
    for i in 0..40 {
        let x = f64::from(i % 8) * 0.012 - 0.05;
        let y = f64::from(i / 8) * 0.02 - 0.05;
        text += &format!(
            "[[sphere]]\ncenter = [{x:?}, {y:?}, {:?}]\nradius = 0.005\nmaterial = 'm'\n",
            -0.1 * f64::from(i)
        );
    }
    let found = counts(scene(&text, None));
    let pieces = found.iter().find(|(guard, _)| *guard == Diagnostic::Pieces).unwrap().1;
    assert!(pieces > 0, "{found:?}");
}

/// 64 surfaces let rays pass, and what is behind them is black.
#[test]
fn paths_through_more_layers_than_are_followed_are_counted() {
    let layers = |count: usize| {
        let glass = "[[material]]\nname = 'm'\nmodel = 'unlit'\nalpha = 'blend'\nopacity = 0.01\n";
        let walls: String = (0..count)
            .map(|i| WALL.replace("[0, 0, 0]", &format!("[0, 0, {:?}]", -0.01 * i as f64)))
            .collect();
        counts(scene(&format!("{SAMPLES}{glass}{walls}"), None))
    };
    only(&layers(63), Diagnostic::Layers, 0);
    only(&layers(70), Diagnostic::Layers, 8 * 8 * 4);
}
