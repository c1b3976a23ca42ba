//! Cameras and lights of a glTF file as those of a scene. Input: the model, which of its nodes are drawn, and which camera
//! is asked for. Output: each as the scene has it, or which cameras there are.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3};

use crate::core::counted::counted;
use crate::mesh::gltf::{self, LightKind, Model};
use crate::scene::model::{self, Light, Projection};
use crate::scene::suggestion::suggestion;

/// A camera, and the ratio of width to height that it asks for.
pub(in crate::scene::formats) type View = (model::Camera, f64);

/// Returns a camera of the drawn nodes, by its number from 0 or its name; without either the first one, if there is any.
/// The error says which cameras there are.
pub(in crate::scene::formats) fn camera(
    model: &Model,
    chosen: Option<&str>,
    drawn: &[bool],
) -> Result<Option<View>, String> {
    let cameras = model.cameras.iter().filter(|camera| drawn.get(camera.node) == Some(&true));
    let cameras: Vec<(&gltf::Camera, &str)> =
        cameras.map(|camera| (camera, name_of(model, camera))).collect();
    let Some(chosen) = chosen else { return Ok(cameras.first().map(|(camera, _)| view(camera))) };
    if let Some((camera, _)) = chosen.parse().ok().and_then(|number: usize| cameras.get(number)) {
        return Ok(Some(view(camera)));
    }
    let mut named = cameras.iter().filter(|(_, name)| !name.is_empty() && *name == chosen);
    match (named.next(), named.next()) {
        (Some((camera, _)), None) => Ok(Some(view(camera))),
        (Some(_), Some(_)) => {
            Err(format!("several cameras are named {chosen:?}; it has {}", listed(&cameras)))
        }
        (None, _) => Err(format!(
            "expected the number or the name of a camera, found {chosen:?}; it has {}{}",
            listed(&cameras),
            suggestion(chosen, cameras.iter().map(|(_, name)| *name))
        )),
    }
}

/// Returns the name of a camera, or of its node where it has none itself.
fn name_of<'a>(model: &'a Model, camera: &'a gltf::Camera) -> &'a str {
    match camera.name.as_str() {
        "" => model.nodes.get(camera.node).map_or("", |node| node.name.as_str()),
        name => name,
    }
}

/// Returns a list of cameras for a message: `2 cameras: 0 "front", 1`.
fn listed(cameras: &[(&gltf::Camera, &str)]) -> String {
    const MOST: usize = 12;
    let names = cameras.iter().enumerate().take(MOST).map(|(number, (_, name))| match *name {
        "" => number.to_string(),
        name => format!("{number} {name:?}"),
    });
    let names = names.collect::<Vec<_>>().join(", ");
    match cameras.len() {
        0 => "no cameras".into(),
        count if count > MOST => format!("{count} cameras: {names}, …"),
        count => format!("{}: {names}", counted(count, "camera")),
    }
}

/// Returns a camera as a scene has it.
fn view(found: &gltf::Camera) -> View {
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
    (camera, aspect)
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
