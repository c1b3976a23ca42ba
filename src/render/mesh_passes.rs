//! Decides in which passes the samples of a scene of meshes are taken: where camera rays search their triangles, and whether
//! a pixel lists what may shade it. Input: a scene, its features and the kind of device. Output: constants of pipelines.

use super::Tuning;
use crate::gpu::DeviceInfo;
use crate::pack::features::{Features, bounces};
use crate::pack::{PackedScene, Schedule};
use crate::schema::constants::{
    SEARCH_ALL, SEARCH_FEW, SEARCH_MANY, SEARCH_MORE, SEARCH_REST, SEARCH_TEAM, SEARCH_TEAM_REST,
};
use crate::schema::enums::{AlphaMode, LightKind, ProjectionKind};
use crate::schema::specialization::Constant;

/// Returns the passes of a scene by the `MESH_SEARCH` of each, given whether tile culling lists shades. Each one after the
/// first takes the pixels that those before it leave unfinished. Pixels whose lists are not enough are sampled by passes of
/// their own, if camera rays alone have lists. Workgroups sample together if
/// no ray is left for trees, whose search would slow down all others.
pub fn passes(
    device: &DeviceInfo,
    scene: &PackedScene,
    features: &Features,
    lists_shades: bool,
) -> &'static [u32] {
    let has_lists = scene.culls_tiles() && scene.has_concave_shapes() && !features.everything;
    match (has_lists && !bounces(scene), Tuning::holds_triangles(device)) {
        (true, true) if lists_shades => &[SEARCH_FEW, SEARCH_MORE, SEARCH_MANY, SEARCH_REST],
        (true, true) => &[SEARCH_FEW, SEARCH_MANY, SEARCH_REST],
        (true, false) if samples_by_teams(scene, features, lists_shades) => &[SEARCH_TEAM, SEARCH_TEAM_REST],
        _ => &[SEARCH_ALL],
    }
}

/// Samples of a pixel from which on workgroups are faster together, lists included.
const TEAM_SAMPLES: u32 = 12;

fn samples_by_teams(scene: &PackedScene, features: &Features, lists_shades: bool) -> bool {
    let many = scene.samples >= TEAM_SAMPLES;
    let by_lists = has_only(features, Constant::Projections, ProjectionKind::Perspective as u32)
        && (lists_shades || !features.has(Constant::Shadows));
    // Pixels that they leave have a mark in the place of the sum of signs.
    let has_mark = scene.schedule == Schedule::Tiles && scene.mean_sign.is_none();
    many && by_lists && has_mark && !scene.diagnosed
}

/// Returns true if what may shade a pixel can be listed, and pixels are sampled in passes that use it: triangles of meshes
/// at rest, where nothing else is and one directional light shines.
pub fn lists_shades(device: &DeviceInfo, scene: &PackedScene, features: &Features) -> bool {
    (scene.schedule == Schedule::Tiles || Tuning::holds_triangles(device))
        && !bounces(scene)
        && scene.mean_sign.is_none()
        && !features.everything
        && features.has(Constant::Shadows)
        && scene.records.lights.len() == 1
        && has_only(features, Constant::LightKinds, LightKind::Directional as u32)
        && has_only(features, Constant::Projections, ProjectionKind::Perspective as u32)
        && has_only(features, Constant::AlphaModes, AlphaMode::Opaque as u32)
        && scene.has_concave_shapes_alone()
        && scene.records.placements.is_empty()
        && scene.records.motions.is_empty()
        && ![Constant::OneSided, Constant::Bounces].into_iter().any(|switch| features.has(switch))
}

/// Returns true if a scene has no other than this one of the modes of a constant.
fn has_only(features: &Features, constant: Constant, mode: u32) -> bool {
    features.value(constant) == Some(1 << mode)
}
