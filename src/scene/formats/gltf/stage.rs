//! Cameras and lights of a glTF file as those of a scene. A spot shines to all sides here, which is told.

use glam::{DAffine3, DVec3};

use crate::mesh::gltf::{self, LightKind, Model};
use crate::scene::model::{self, Light, Projection};

/// Returns a camera of the drawn nodes by its number from 0, and the ratio of width to height that it asks for.
pub(in crate::scene::formats) fn camera(
    model: &Model,
    number: usize,
    drawn: &[bool],
) -> Option<(model::Camera, f64)> {
    let mut cameras = model.cameras.iter().filter(|camera| drawn.get(camera.node) == Some(&true));
    let found = cameras.nth(number)?;
    let (projection, aspect) = match found.projection {
        gltf::Projection::Perspective { yfov, aspect } => {
            (Projection::VerticalFov(yfov.to_degrees()), aspect.unwrap_or(1.0))
        }
        gltf::Projection::Orthographic { xmag, ymag } => {
            (Projection::Orthographic(2.0 * ymag.abs()), (xmag / ymag).abs())
        }
    };
    let eye = found.matrix.translation;
    let camera = model::Camera {
        eye,
        look_at: eye - axis(&found.matrix, DVec3::Z),
        up: axis(&found.matrix, DVec3::Y),
        projection,
        lens: None,
        shutter: [0.0, 1.0],
        motion: [DVec3::ZERO; 2],
    };
    Some((camera, aspect))
}

/// Returns the lights of the drawn nodes, and what is told about them.
pub(in crate::scene::formats) fn lights(model: &Model, drawn: &[bool]) -> (Vec<Light>, Vec<String>) {
    let mut notes = Vec::new();
    let found = model.lights.iter().filter(|light| drawn.get(light.node) == Some(&true));
    let lights = found.map(|light| {
        let power = light.intensity * light.color;
        let position = light.matrix.translation;
        match light.kind {
            LightKind::Directional => {
                Light::Directional { direction: axis(&light.matrix, DVec3::Z), irradiance: power }
            }
            LightKind::Point => Light::Point { position, intensity: power },
            LightKind::Spot { .. } => {
                notes.push(format!("light {:?} is a spot; it shines to all sides", light.name));
                Light::Point { position, intensity: power }
            }
        }
    });
    (lights.collect(), notes)
}

/// Returns a unit axis of a frame in the world; the axis itself where the frame is flat.
fn axis(frame: &DAffine3, axis: DVec3) -> DVec3 {
    frame.transform_vector3(axis).try_normalize().unwrap_or(axis)
}
