//! Omitting unused features changes no bit: small scenes of the features that need footprints,
//! environments, bounces and texels of more than two dimensions, each with and without all code.

use std::path::Path;

use moire::internal::pack::{self, PackedScene};
use moire::internal::render::Tuning;
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::source::TextureSource;

use crate::footprints::bench::solid;
use crate::stage::{assert_same_bits, render_with};

const VIEW: &str = "
[camera]\neye = [0.4, 1.2, 5]\nlook_at = [0, 0.2, 0]\nvertical_fov = 50
[image]\nwidth = 16\nheight = 16
[[texture]]\nname = 'flat'\nfile = 'f'
[[texture]]\nname = 'cube'\nfile = 'c'\ndimension = 'cube'
[[texture]]\nname = 'volume'\nslices = ['v']
[[light]]\nkind = 'point'\nposition = [2, 4, 3]\nintensity = [40, 30, 30]
";

fn packed(text: &str) -> PackedScene {
    let text = format!("{VIEW}{text}");
    let mut scene = parse(Path::new("lean.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    prune(&mut scene);
    let texture = |source: &TextureSource| {
        let size = match source.dimension {
            Dimension::Three => [12, 9, 7],
            Dimension::Cube => [9, 9, 6],
            Dimension::One | Dimension::Two => [24, 16, 1],
        };
        solid(source.dimension, size, TexelFormat::Rgba8)
    };
    let textures = scene.textures.iter().map(texture).collect();
    pack::pack(&scene, textures, None).unwrap()
}

fn same_bits(what: &str, text: &str) {
    let packed = packed(text);
    let (lean, report) = render_with(&packed, false, &Tuning::default());
    let (full, _) = render_with(&packed, true, &Tuning::default());
    assert!(!report.left_out.is_empty(), "{what} leaves nothing out");
    let first = lean.pixels[0];
    assert!(lean.pixels.iter().any(|p| *p != first), "{what}: a picture of one colour");
    assert_same_bits(&lean, &full, what);
}

#[test]
fn ellipses_highlights_and_normal_maps_below_an_equirectangular_sky() {
    same_bits(
        "cones",
        "[sampling]\nspp = 1\nfootprint = 'cone'\n[background]\nenvironment = 'flat'\nsampler = 's'\nrotate = 70
[[sampler]]\nname = 's'\nfilter = 'ewa'\nmip = 'linear'
[[material]]\nname = 'ground'\nmodel = 'phong'\ntexture = 'flat'\nnormal_map = 'flat'\nstrength = 0.2\nsampler = 's'
[[material]]\nname = 'ball'\nmodel = 'mirror'
[[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'ground'\nhalf_extent = 5
[[sphere]]\ncenter = [0, 0.4, 0]\nradius = 0.9\nmaterial = 'ball'\n",
    );
}

#[test]
fn glass_anisotropic_and_stochastic_look_ups_in_a_cube_and_a_volume() {
    same_bits(
        "differentials",
        "[sampling]\nspp = 4\nfootprint = 'differentials'\n[background]\nenvironment = 'cube'\nsampler = 'any'
[[sampler]]\nname = 'long'\nfilter = 'anisotropic'\nmip = 'linear'
[[sampler]]\nname = 'any'\nfilter = 'stochastic'\nmip = 'linear'
[[material]]\nname = 'ground'\ntexture = 'flat'\nsampler = 'long'\nmodel = 'unlit'
[[material]]\nname = 'fog'\ntexture = 'volume'\nsampler = 'long'\nmodel = 'unlit'\nmapping = { kind = 'solid', axis = [1, 2, 0] }
[[material]]\nname = 'ball'\nmodel = 'dielectric'\nior = 1.4
[[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'ground'
[[sphere]]\ncenter = [1.2, 0.4, 0]\nradius = 0.8\nmaterial = 'fog'
[[sphere]]\ncenter = [-0.8, 0.4, 0]\nradius = 0.9\nmaterial = 'ball'\n",
    );
}

#[test]
fn bodies_that_let_light_through_below_a_sky_that_lights() {
    same_bits(
        "transmission",
        "[sampling]\nspp = 4\nfootprint = 'differentials'\n[background]\nenvironment = 'flat'\nsampler = 's'
[[light]]\nkind = 'environment'
[[sampler]]\nname = 's'\nfilter = 'linear'\nmip = 'linear'
[[material]]\nname = 'ground'\ntexture = 'flat'\nsampler = 's'
[[material]]\nname = 'pane'\nmodel = 'metallic-roughness'\ntransmission_texture = 'flat'\nroughness = 0.3\nsampler = 's'
[[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'ground'\nhalf_extent = 5
[[sphere]]\ncenter = [0, 0.4, 0]\nradius = 0.9\nmaterial = 'pane'\n",
    );
}

#[test]
fn patterns_bumps_cubic_look_ups_and_boxes() {
    same_bits(
        "patterns",
        "[sampling]\nspp = 1\nfootprint = 'cone'
[[texture]]\nname = 'marble'\nprocedural = 'marble'
[[texture]]\nname = 'checker'\nprocedural = 'checker'
[[sampler]]\nname = 's'\nfilter = { mag = 'cubic', min = 'linear' }\nmip = 'nearest'\naddress = 'mirrored-repeat'
[[material]]\nname = 'ground'\ntexture = 'checker'\nmodel = 'lambert'
[[material]]\nname = 'stone'\ntexture = 'marble'\nbump_map = 'flat'\nsampler = 's'\nstrength = 0.05
mapping = { kind = 'spherical', entity = 'centroid' }
[[material]]\nname = 'box'\ntexture = 'flat'\nsampler = 's'\nmapping = { kind = 'cube', entity = 'normal', axis = [1, 1, 0] }
[[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'ground'
[[sphere]]\ncenter = [1.2, 0.4, 0]\nradius = 0.8\nmaterial = 'stone'
[[sphere]]\ncenter = [-0.8, 0.4, 0]\nradius = 0.9\nmaterial = 'box'\n",
    );
}
