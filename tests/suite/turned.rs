//! A scene rotated as a whole, with its camera, lights and the axes of its mappings, gives the same
//! picture: no seam, no pole and no direction of the world is visible. Computed in f64, where only
//! the packed values are rounded anew for every rotation.

use std::f64::consts::TAU;
use std::path::Path;

use glam::{DQuat, DVec3};
use moire::internal::core::film::Film;
use moire::internal::lab::metrics::compare;
use moire::internal::pack;
use moire::internal::scene::model::{Light, MappingKind, Scene};
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};

use crate::lookup::bench::{Rng, Vectors, texture};
use crate::stage::{render, render_on_oracle};

const COMMON: &str = "
[camera]\neye = [1.0, 2.0, 6.0]\nlook_at = [0, 0.3, 0]\nvertical_fov = 45
[image]\nwidth = 28\nheight = 24
[sampling]\nspp = 4\nfootprint = 'differentials'
[[texture]]\nname = 't'\nfile = 't'
[[texture]]\nname = 'solid'\nprocedural = 'noise'
[[sampler]]\nname = 's'\nmip = 'linear'
[[material]]\nname = 'ground'\ntexture = 't'\nsampler = 's'\nmapping = { scale = 0.3, rotate = 20 }
[[material]]\nname = 'globe'\ntexture = 't'\nsampler = 's'\nmodel = 'phong'
mapping = { kind = 'spherical', origin = [-1.5, 0.5, 0], axis = [0.2, 1, 0.3], scale = [1, 2] }
[[material]]\nname = 'can'\ntexture = 't'\nsampler = 's'
mapping = { kind = 'cylindrical', entity = 'centroid', axis = [0.5, 1, -0.3] }
[[material]]\nname = 'shine'\ntexture = 't'\nsampler = 's'\nmodel = 'unlit'
mapping = { kind = 'spherical', entity = 'reflection', axis = [0, 0, 1] }
[[material]]\nname = 'cloud'\ntexture = 'solid'\nmodel = 'unlit'
mapping = { kind = 'solid', axis = [0, 1, 1], scale = 2, origin = [0.3, 0, 0.1] }
[[material]]\nname = 'mirror'\nmodel = 'mirror'\ncolor = [0.9, 0.9, 0.9]
[[plane]]\norigin = [0, -0.5, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nhalf_extent = 4\nmaterial = 'ground'
[[sphere]]\ncenter = [-1.5, 0.5, 0]\nradius = 0.8\nmaterial = 'globe'
[[sphere]]\ncenter = [0.2, 0.5, 0.4]\nradius = 0.7\nmaterial = 'can'
[[sphere]]\ncenter = [1.9, 0.4, 0]\nradius = 0.7\nmaterial = 'shine'
[[sphere]]\ncenter = [0.8, 0.0, 2.2]\nradius = 0.4\nmaterial = 'cloud'
[[sphere]]\ncenter = [-0.6, 1.7, -0.6]\nradius = 0.6\nmaterial = 'mirror'
[[triangle]]\nvertices = [[1, 1, 0], [2.5, 1.2, 0.2], [1.4, 2.4, -0.3]]\nmaterial = 'ground'
[[light]]\nkind = 'point'\nposition = [2, 4, 3]\nintensity = [40, 30, 30]
[[light]]\nkind = 'directional'\ndirection = [-1, 2, 1]\nirradiance = [1, 1, 2]
";

const AROUND: &str = "[background]\nenvironment = 't'\nsampler = 's'\nrotate = 25\n";

fn load(text: &str) -> Scene {
    let mut scene = parse(Path::new("turned.toml"), text).unwrap_or_else(|e| panic!("{e}"));
    prune(&mut scene);
    scene
}

fn packed(scene: &Scene) -> pack::PackedScene {
    let data = |_| texture(16, 8, TexelFormat::RgbaFloat, ColorSpace::Linear, 5);
    let mut textures: Vec<_> = scene.textures.iter().map(data).collect();
    // Light is not negative: [-2, 6] becomes [0, 1].
    for data in &mut textures {
        assert_eq!(data.dimension, Dimension::Two);
        let texels: &mut [f32] = bytemuck::cast_slice_mut(&mut data.texels);
        texels.iter_mut().for_each(|t| *t = (*t + 2.0) / 8.0);
    }
    pack::pack(scene, textures, None).unwrap()
}

/// Rotates the whole scene. A mapping's frame follows its axis by the shortest rotation, so that a rotation about the
/// axis itself remains, which the mapping's own offset or rotation compensates.
fn turned(scene: &Scene, turn: DQuat) -> Scene {
    let mut scene = scene.clone();
    let spin = |v: &mut DVec3| *v = turn * *v;
    [&mut scene.camera.eye, &mut scene.camera.look_at, &mut scene.camera.up].into_iter().for_each(spin);
    for plane in &mut scene.shapes.planes {
        [&mut plane.origin, &mut plane.tangent, &mut plane.bitangent].into_iter().for_each(spin);
    }
    scene.shapes.spheres.iter_mut().for_each(|s| spin(&mut s.center));
    scene.shapes.triangles.iter_mut().for_each(|t| t.vertices.iter_mut().for_each(spin));
    scene.camera.motion.iter_mut().for_each(spin);
    scene.shapes.planes.iter_mut().for_each(|p| spin(&mut p.motion));
    scene.shapes.spheres.iter_mut().for_each(|s| spin(&mut s.motion));
    scene.shapes.triangles.iter_mut().for_each(|t| spin(&mut t.motion));
    for light in &mut scene.lights {
        match light {
            Light::Point { position, .. } | Light::Sphere { position, .. } => spin(position),
            Light::Spot { position, direction, .. } => [position, direction].into_iter().for_each(spin),
            Light::Environment => panic!("an environment turns about +y alone"),
            Light::Directional { direction, .. } | Light::Sun { direction, .. } => spin(direction),
            Light::Rectangle { position, edge_u, edge_v, .. } => {
                [position, edge_u, edge_v].into_iter().for_each(spin);
            }
        }
    }
    for material in &mut scene.materials {
        let mapping = &mut material.mapping;
        let before = DQuat::from_rotation_arc(DVec3::Y, mapping.axis.normalize());
        spin(&mut mapping.axis);
        spin(&mut mapping.origin);
        let after = DQuat::from_rotation_arc(DVec3::Y, mapping.axis.normalize());
        let left = after.inverse() * turn * before * DVec3::X;
        assert!(left.y.abs() < 1e-9, "a turn about the axis");
        let angle = (-left.z).atan2(left.x);
        match mapping.kind {
            MappingKind::Cylindrical => mapping.offset.x += mapping.scale.x * angle / TAU,
            MappingKind::Spherical => mapping.offset.y += mapping.scale.y * angle / TAU,
            MappingKind::Solid => mapping.rotate -= angle.to_degrees(),
            MappingKind::Surface | MappingKind::Planar | MappingKind::Cube => {}
        }
    }
    scene
}

fn reseeded(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.sampling.seed += 1;
    scene
}

/// The same samples see the same up to rounding: far less than different samples would.
fn assert_same(a: &Film, b: &Film, other_samples: &Film, what: &str) {
    let [turned, noise] = [b, other_samples].map(|f| compare(a, f).unwrap().rmse);
    assert!(noise > 1e-3, "no noise to compare with: {noise}");
    assert!(turned < 0.05 * noise, "{what}: RMSE {turned}, of other samples {noise}");
}

#[test]
fn turning_the_whole_scene_changes_nothing() {
    let scene = load(COMMON);
    let straight = render_on_oracle(&packed(&scene));
    let other = render_on_oracle(&packed(&reseeded(&scene)));
    let mut rng = Rng::new(71);
    for _ in 0..5 {
        let turn = DQuat::from_axis_angle(rng.direction(), rng.between(0.0, TAU));
        let film = render_on_oracle(&packed(&turned(&scene, turn)));
        assert_same(&straight, &film, &other, &format!("{turn}"));
    }
}

/// Environments turn about +y, counter-clockwise from above as the camera does.
#[test]
fn turning_an_environment_with_its_scene_changes_nothing() {
    let scene = load(&format!("{COMMON}{AROUND}"));
    let straight = render_on_oracle(&packed(&scene));
    let other = render_on_oracle(&packed(&reseeded(&scene)));
    for degrees in [90.0, 155.0, -140.0] {
        let mut around = turned(&scene, DQuat::from_rotation_y(f64::to_radians(degrees)));
        around.background.environment.as_mut().unwrap().rotate += degrees;
        let film = render_on_oracle(&packed(&around));
        assert_same(&straight, &film, &other, &format!("{degrees} degrees"));
    }
}

/// Once on the device, where the seam is elsewhere after the rotation.
#[test]
fn the_device_sees_the_same_after_a_turn() {
    let scene = load(&format!("{COMMON}{AROUND}"));
    let straight = render(&packed(&scene));
    let other = render(&packed(&reseeded(&scene)));
    let mut around = turned(&scene, DQuat::from_rotation_y(f64::to_radians(115.0)));
    around.background.environment.as_mut().unwrap().rotate += 115.0;
    assert_same(&straight, &render(&packed(&around)), &other, "115 degrees");
}
