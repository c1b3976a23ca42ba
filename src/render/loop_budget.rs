//! Estimates the samples that one invocation takes at once. Mesa's CPU driver ends all loops of an invocation after 65 535
//! iterations (`LP_MAX_TGSI_LOOP_ITERATIONS` of its shader compiler), whatever remains. Input: a scene and a device.
//! Output: the number of samples whose loops should stay below that.

use super::Tuning;
use crate::gpu::DeviceInfo;
use crate::pack::features::{bends_rays, bounces};
use crate::pack::{PackedScene, SampleDimension, TextureKind};
use crate::scene::model::Algorithm;
use crate::schema::constants::{MAX_BOXES, MAX_CONE_FRAGMENTS, MAX_CONES, MAX_ELLIPSE_STEPS};
use crate::schema::enums::AlphaMode;
use crate::schema::layout::{MAX_SAMPLES_AT_ONCE, NO_TEXTURE, Procedural, Sampler};
use crate::texture::filter::LoopCost;

const MAX_ITERATIONS: u64 = 65_535;
const ELLIPSE: u64 = MAX_ELLIPSE_STEPS as u64;
/// Eight texels, or twice four.
const SOLID: u64 = 10;
/// Look-ups of a bump map, and of the colour.
const TAPS: u64 = 5;
const BOXES: u64 = MAX_BOXES as u64;
const CONES: u64 = MAX_CONES as u64;
/// Nodes and triangles of the tree over all meshes that each of a sample's first rays meets, with a margin: tens of them.
/// With as many for a shadow ray, 64 samples are taken at once.
const TREE: u64 = 480;
const FIRST_RAYS: u64 = 4;
/// Those of each further ray: of many rays the mean counts.
const TREE_OF_FURTHER: u64 = 192;
/// Surfaces that a path passes by their alpha, of which few have many.
const LAYERS: u64 = 4;
/// Digits of Halton points, or iterations to find an order, with a margin.
const POINTS: u64 = 64;

/// Returns the samples that an invocation takes at once, from 1 to `MAX_SAMPLES_AT_ONCE`. Where they are too many all the
/// same, the device's loops are ended and the samples are taken again in parts; that takes longer.
pub fn samples_at_once(device: &DeviceInfo, scene: &PackedScene) -> u32 {
    if !Tuning::loops_end(device) {
        return MAX_SAMPLES_AT_ONCE;
    }
    let iterations = iterations_of_a_sample(scene, ELLIPSE);
    (MAX_ITERATIONS / iterations).clamp(1, u64::from(MAX_SAMPLES_AT_ONCE)) as u32
}

/// Returns an upper bound of the iterations for a pixel's cones, except for the number of fragments of each: if there
/// are many cones, few of them see more than three.
fn iterations_of_cones(scene: &PackedScene, ellipse: u64) -> u64 {
    const PIECES: u64 = MAX_CONE_FRAGMENTS as u64;
    const SEEN: u64 = 3;
    let shapes = scene.shape_count() as u64;
    let lights = scene.records.lights.len() as u64;
    let cones = if bounces(scene) { CONES } else { CONES.min(1 + PIECES * lights) };
    let gathered = 4 + shapes + shapes / 16 + 2 * PIECES;
    // Each pair in both orders, with two shapes each time.
    let laid_over = 3 * SEEN * (SEEN - 1);
    let bumped = scene.records.materials.iter().any(|m| m.bump_texture_index != NO_TEXTURE);
    let look_ups = if bumped { TAPS } else { 1 } * iterations_of_a_look_up(scene, 0);
    let records = (scene.records.materials.len() + scene.records.uv_projections.len()) as u64;
    let shaded = SEEN * (1 + records + look_ups + lights.max(2) * (2 + lights));
    // Ellipses of that size occur at the horizon, which few cones see.
    cones * (gathered + laid_over + shaded) + ellipse
}

/// Returns about the iterations of one sample, rather too many, given those of an ellipse.
fn iterations_of_a_sample(scene: &PackedScene, ellipse: u64) -> u64 {
    if scene.algorithm == Algorithm::Cone {
        return iterations_of_cones(scene, ellipse);
    }
    let count = |n: usize| n as u64;
    let shapes = count(scene.shape_count() - scene.records.meshes.len()) + 3;
    let lights = count(scene.records.lights.len());
    let records = count(
        scene.records.materials.len() + scene.records.uv_projections.len() + scene.records.motions.len(),
    );
    let rays = bent_rays(scene) + layers(scene);
    let bumped = scene.records.materials.iter().any(|m| m.bump_texture_index != NO_TEXTURE);
    let taps = if bumped { TAPS } else { 1 };
    let hit = 1 + shapes + records + lights * (1 + shapes);
    let chances = scene.header.sample_dimensions;
    let glass = u64::from(chances >> SampleDimension::Fresnel as u32 & 1);
    let choices = if chances == 0 { 0 } else { (4 + glass) * (1 + POINTS) };
    let trees = if scene.has_concave_shapes() { iterations_in_trees(rays * (1 + lights)) } else { 0 };
    trees + rays * (choices + hit + taps * iterations_of_a_look_up(scene, ellipse))
}

/// Returns the most rays of a path that are not those before them, gone on straight.
fn bent_rays(scene: &PackedScene) -> u64 {
    if bends_rays(scene) { 1 + u64::from(scene.header.max_depth) } else { 1 }
}

/// Returns the surfaces that a path passes. One without a back is passed from behind alone, which a straight ray can do
/// once; what has alpha may be passed again and again. Backs of meshes are not met at all.
fn layers(scene: &PackedScene) -> u64 {
    if scene.records.materials.iter().any(|m| m.alpha_mode != AlphaMode::Opaque) {
        return LAYERS;
    }
    let shapes = scene.shape_count() - scene.records.meshes.len();
    if scene.has_one_sided_shapes() { LAYERS.min(bent_rays(scene) * shapes as u64) } else { 0 }
}

fn iterations_in_trees(rays: u64) -> u64 {
    let first = rays.min(FIRST_RAYS);
    first * TREE + (rays - first) * TREE_OF_FURTHER
}

fn iterations_of_a_look_up(scene: &PackedScene, ellipse: u64) -> u64 {
    let records = (scene.records.textures.len()
        + scene.records.samplers.len()
        + scene.records.procedurals.len()) as u64;
    let is = |kind: TextureKind| scene.records.textures.iter().any(|t| t.kind == kind);
    let procedural = scene.records.procedurals.iter().map(iterations_of_a_procedural).max().unwrap_or(0);
    let solid = if is(TextureKind::Volume) || is(TextureKind::Cube) { SOLID } else { 1 };
    let of_sampler = |sampler: &Sampler| {
        let iterations = [sampler.mag_filter, sampler.min_filter].map(|f| f.traits().loop_cost);
        let most = |of: &dyn Fn(LoopCost) -> u64| iterations.into_iter().map(of).max().unwrap_or(0);
        let place =
            most(&|t| if let LoopCost::Place(iterations) = t { iterations.max(solid) } else { solid });
        let probes = most(&|t| if t == LoopCost::Walk { u64::from(sampler.max_anisotropy) + 2 } else { 2 });
        let area = most(&|t| match t {
            LoopCost::Ellipse => ellipse,
            LoopCost::Footprint(iterations) => iterations,
            LoopCost::Place(_) | LoopCost::Walk => 0,
        });
        area.max(probes * (1 + place))
    };
    let stored = scene.records.samplers.iter().map(of_sampler).max().unwrap_or(0);
    records + stored.max(procedural)
}

/// Returns the iterations of a procedural: octaves, the 27 cells around a point, or boxes along a footprint.
fn iterations_of_a_procedural(pattern: &Procedural) -> u64 {
    u64::from(pattern.octaves).max(27) + BOXES
}
