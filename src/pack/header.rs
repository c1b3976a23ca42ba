//! Packs camera, picture and sampling into the header of the scene buffer.

use glam::{DVec3, UVec2};

use super::pixel_filter::Warp;
use super::{ProjectionKind, sample_dimensions};
use crate::core::range::Rect;
use crate::scene::model::{Algorithm, Footprint, Projection, Scene};
use crate::schema::layout::{self, Header};
use crate::texture::sampler_spec::SamplerSpec;

/// Returns the right-handed, orthonormal basis of the camera: right, up, forward.
pub fn camera_basis(scene: &Scene) -> [DVec3; 3] {
    let forward = (scene.camera.look_at - scene.camera.eye).normalize();
    let right = forward.cross(scene.camera.up).normalize();
    [right, right.cross(forward), forward]
}

/// Returns half the picture's height at distance 1, or in scene units for parallel rays, and true if they are
/// parallel.
pub(super) fn half_height(scene: &Scene) -> (f64, bool) {
    match scene.camera.projection {
        Projection::VerticalFov(degrees) => ((0.5 * degrees.to_radians()).tan(), false),
        Projection::CameraConstant(distance) => (0.5 / distance, false),
        Projection::Orthographic(height) => (0.5 * height, true),
    }
}

pub(super) fn header(scene: &Scene, crop: Rect, warp: &Warp) -> Header {
    let [right, up, forward] = camera_basis(scene);
    let (half_height, parallel) = half_height(scene);
    let projection = if parallel { ProjectionKind::Orthographic } else { ProjectionKind::Perspective };
    let pixel = 2.0 * half_height / f64::from(scene.height);
    let share = match footprint(scene) {
        Footprint::None => 0.0,
        _ => warp.width / f64::from(scene.sampling.samples()).sqrt(),
    };
    let [lens_radius, inverse_focus_distance, shutter_opens, shutter_time] =
        sample_dimensions::lens(scene, pixel);
    Header {
        forward,
        step_x: right * pixel,
        sample_side: share,
        step_y: -up * pixel,
        pixel_side: pixel,
        view: scene.camera.look_at - scene.camera.eye,
        up: scene.camera.up.normalize(),
        eye_motion: scene.camera.motion[0],
        view_motion: scene.camera.motion[1] - scene.camera.motion[0],
        background: scene.background.color.as_vec3(),
        projection,
        image_size: UVec2::new(scene.width, scene.height),
        crop: UVec2::new(crop.x, crop.y),
        film_size: UVec2::new(crop.width, crop.height),
        max_depth: scene.sampling.max_depth,
        footprint: footprint(scene),
        pattern: scene.sampling.pattern,
        strata_side: scene.sampling.strata_side(),
        samples: scene.sampling.samples(),
        seed: scene.sampling.seed,
        shares_pattern: scene.sampling.shared && scene.sampling.pattern.can_be_shared(),
        environment_material: layout::NO_MATERIAL,
        lens_radius,
        inverse_focus_distance,
        shutter_opens,
        shutter_time,
        pixel_filter: warp.kind,
        filter_radius: warp.radius as f32,
        filter_width: warp.width as f32,
        first_negative_step: warp.first_negative_step,
        quantity: scene.sampling.quantity,
        // Sample dimensions, cells and the lengths of lists are set when the scene is packed.
        ..Header::default()
    }
}

/// Returns the footprint if any filter needs it, considering all textures and samplers. Beams average without
/// a filter's error, and so do the samples beside them.
pub(super) fn footprint(scene: &Scene) -> Footprint {
    if scene.sampling.algorithm == Algorithm::Beam {
        return Footprint::None;
    }
    if scene.sampling.quantity.is_of_footprints() {
        return if scene.textures.is_empty() { Footprint::None } else { Footprint::Differentials };
    }
    let procedural = scene.textures.iter().any(|t| t.content.procedural().is_some());
    if scene.sampling.algorithm == Algorithm::Cone {
        return Footprint::Cone;
    }
    let needed = procedural || scene.samplers.iter().any(SamplerSpec::needs_footprint);
    if needed { scene.sampling.footprint } else { Footprint::None }
}
