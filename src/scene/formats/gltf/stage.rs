//! Cameras and lights of a glTF file as those of a scene.

use std::f64::consts::PI;

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

/// Returns a light that shines within a cone; angles are in radians.
fn spot(light: &gltf::Light, intensity: DVec3, inner: f64, outer: f64) -> Light {
    Light::Spot {
        position: light.matrix.translation,
        direction: -axis(&light.matrix, DVec3::Z),
        intensity,
        inner: inner.to_degrees().min(180.0),
        outer: outer.to_degrees().min(180.0),
        range: light.range.unwrap_or(f64::INFINITY),
    }
}

/// Returns the lights of the drawn nodes.
pub(in crate::scene::formats) fn lights(model: &Model, drawn: &[bool]) -> Vec<Light> {
    let found = model.lights.iter().filter(|light| drawn.get(light.node) == Some(&true));
    let lights = found.map(|light| {
        let power = light.intensity * light.color;
        let position = light.matrix.translation;
        match light.kind {
            LightKind::Directional => {
                Light::Directional { direction: axis(&light.matrix, DVec3::Z), irradiance: power }
            }
            LightKind::Point if light.range.is_none() => Light::Point { position, intensity: power },
            LightKind::Point => spot(light, power, PI, PI),
            LightKind::Spot { inner, outer } => spot(light, power, inner, outer),
        }
    });
    lights.collect()
}

/// Returns a unit axis of a frame in the world; the axis itself where the frame is flat.
fn axis(frame: &DAffine3, axis: DVec3) -> DVec3 {
    frame.transform_vector3(axis).try_normalize().unwrap_or(axis)
}
