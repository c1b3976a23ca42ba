//! Camera, picture and sampling → the header of the scene buffer.

use glam::DVec3;

use super::pixel_filter::Warp;
use super::{Crop, ProjectionKind, real4, sample_dimensions, vec4};
use crate::scene::model::{Algorithm, Footprint, Projection, Scene};
use crate::schema::layout::{self, Header};
use crate::texture::sampler_spec::SamplerSpec;

/// Right-handed basis of the camera: right, up, forward, all of unit length.
pub fn camera_basis(scene: &Scene) -> [DVec3; 3] {
    let forward = (scene.camera.look_at - scene.camera.eye).normalize();
    let right = forward.cross(scene.camera.up).normalize();
    [right, right.cross(forward), forward]
}

/// Half the picture's height at distance 1, or of parallel rays in scene units; and whether they are parallel.
pub(super) fn half_height(scene: &Scene) -> (f64, bool) {
    match scene.camera.projection {
        Projection::VerticalFov(degrees) => ((0.5 * degrees.to_radians()).tan(), false),
        Projection::CameraConstant(distance) => (0.5 / distance, false),
        Projection::Orthographic(height) => (0.5 * height, true),
    }
}

pub(super) fn header(scene: &Scene, crop: Crop, warp: &Warp) -> Header {
    let [right, up, forward] = camera_basis(scene);
    let (half_height, parallel) = half_height(scene);
    let projection = if parallel { ProjectionKind::Orthographic } else { ProjectionKind::Perspective };
    let pixel = 2.0 * half_height / f64::from(scene.height);
    let share = match footprint(scene) {
        Footprint::None => 0.0,
        _ => warp.width / f64::from(scene.sampling.samples()).sqrt(),
    };
    Header {
        forward: real4(forward.extend(0.0)),
        step_x: real4((right * pixel).extend(share)),
        step_y: real4((-up * pixel).extend(pixel)),
        background: vec4(scene.background.color.extend(1.0)),
        image: [scene.width, scene.height, crop.x, crop.y],
        size: [crop.width, crop.height, projection as u32, scene.sampling.max_depth],
        sampling: [
            scene.sampling.pattern as u32,
            scene.sampling.strata_side(),
            scene.sampling.samples(),
            scene.sampling.seed,
        ],
        key: [
            u32::from(scene.sampling.shared && scene.sampling.pattern.can_be_shared()),
            0,
            footprint(scene) as u32,
            0,
        ],
        counts: [0, 0, 0, layout::NO_MATERIAL],
        chances: [0; 4],
        lens: vec4(sample_dimensions::lens(scene, pixel)),
        view: real4((scene.camera.look_at - scene.camera.eye).extend(0.0)),
        up: real4(scene.camera.up.normalize().extend(0.0)),
        eye_motion: real4(scene.camera.motion[0].extend(0.0)),
        view_motion: real4((scene.camera.motion[1] - scene.camera.motion[0]).extend(0.0)),
        pixel_filter: warp.record,
    }
}

/// The footprint, if there is a filter that asks for it. All textures and samplers are read. Beams average
/// without a filter's error, and so do the samples beside them.
pub(super) fn footprint(scene: &Scene) -> Footprint {
    if scene.sampling.algorithm == Algorithm::Beam {
        return Footprint::None;
    }
    let procedural = scene.textures.iter().any(|t| t.content.procedural().is_some());
    if scene.sampling.algorithm == Algorithm::Cone {
        return Footprint::Cone;
    }
    let needed = procedural || scene.samplers.iter().any(SamplerSpec::needs_footprint);
    if needed { scene.sampling.footprint } else { Footprint::None }
}
