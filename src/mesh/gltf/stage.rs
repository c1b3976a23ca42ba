//! Cameras and lights. Input: the file's lists of them. Output: each as the file describes it, and, once nodes are
//! known, each where a node holds it.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use glam::{DAffine3, DVec3};

use super::document::Document;
use super::json::Json;
use crate::mesh::Fault;

/// A camera, which looks along −z of its node, with y upwards.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Empty if it has none.
    pub name: String,
    /// Index of the node.
    pub node: usize,
    /// World from camera.
    pub matrix: DAffine3,
    /// What it sees.
    pub projection: Projection,
}

/// What a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// From one point.
    Perspective {
        /// Vertical angle of view in radians.
        yfov: f64,
        /// Width over height; without it, that of the picture.
        aspect: Option<f64>,
    },
    /// Along parallels.
    Orthographic {
        /// Half the width.
        xmag: f64,
        /// Half the height.
        ymag: f64,
    },
}

/// A light (KHR_lights_punctual), which shines along −z of its node.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    /// Empty if it has none.
    pub name: String,
    /// Index of the node.
    pub node: usize,
    /// World from light. Its scale means nothing.
    pub matrix: DAffine3,
    /// Linear colour.
    pub color: DVec3,
    /// In candela, or in lux if it is directional.
    pub intensity: f64,
    /// How it shines.
    pub kind: LightKind,
    /// Distance from which on it is not seen; without it, there is none.
    pub range: Option<f64>,
}

/// How a light shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightKind {
    /// From infinitely far.
    Directional,
    /// From a point to all sides.
    Point,
    /// From a point within a cone.
    Spot {
        /// Angle from the axis where it begins to fade, in radians.
        inner: f64,
        /// Angle from the axis where it ends.
        outer: f64,
    },
}

/// Reads all cameras; their nodes are not known yet.
pub(super) fn cameras(document: &Document) -> Result<Vec<Camera>, Fault> {
    document.list("cameras")?.elements().map(|element| camera(element?.json())).collect()
}

/// Reads all lights; their nodes are not known yet.
pub(super) fn lights(document: &Document) -> Result<Vec<Light>, Fault> {
    let element = document.members(&["extensions"])?;
    match element.json().extension("KHR_lights_punctual")? {
        Some(lights) => lights.list("lights")?.into_iter().map(light).collect(),
        None => Ok(Vec::new()),
    }
}

/// Reads a camera.
fn camera(json: Json) -> Result<Camera, Fault> {
    let kind = json.needed("type", json.text("type")?)?;
    if !matches!(kind, "perspective" | "orthographic") {
        return Err(json.other_than("type", "perspective and orthographic are allowed"));
    }
    let values = json.needed(kind, json.object(kind)?)?;
    let positive = |key| values.number_if(key, "greater than 0", |number| number > 0.0);
    let projection = if kind == "perspective" {
        let angle = |yfov| yfov > 0.0 && yfov < PI;
        let yfov = values.number_if("yfov", "between 0 and π", angle)?;
        Projection::Perspective { yfov: values.needed("yfov", yfov)?, aspect: positive("aspectRatio")? }
    } else {
        Projection::Orthographic {
            xmag: values.needed("xmag", positive("xmag")?)?,
            ymag: values.needed("ymag", positive("ymag")?)?,
        }
    };
    Ok(Camera { name: json.name()?, node: 0, matrix: DAffine3::IDENTITY, projection })
}

/// Reads a light.
fn light(json: Json) -> Result<Light, Fault> {
    let kind = match json.needed("type", json.text("type")?)? {
        "directional" => LightKind::Directional,
        "point" => LightKind::Point,
        "spot" => spot(json)?,
        _ => return Err(json.other_than("type", "directional, point and spot are allowed")),
    };
    let color = json.numbers("color")?.unwrap_or([1.0; 3]);
    if color.iter().any(|value| *value < 0.0) {
        return Err(json.other_than("color", "numbers from 0 are allowed"));
    }
    Ok(Light {
        name: json.name()?,
        node: 0,
        matrix: DAffine3::IDENTITY,
        color: color.into(),
        intensity: json.number_if("intensity", "at least 0", |number| number >= 0.0)?.unwrap_or(1.0),
        kind,
        range: json.number_if("range", "greater than 0", |number| number > 0.0)?,
    })
}

/// Reads the cone of a light.
fn spot(json: Json) -> Result<LightKind, Fault> {
    let spot = json.needed("spot", json.object("spot")?)?;
    // Programs write π/2 in single precision, which is greater.
    let angle = |number| (0.0..=FRAC_PI_2 + 1e-6).contains(&number);
    let inner = spot.number_if("innerConeAngle", "between 0 and π/2", angle)?.unwrap_or(0.0);
    let outer = spot.number_if("outerConeAngle", "between 0 and π/2", angle)?.unwrap_or(FRAC_PI_4);
    if inner > outer {
        let what = format!("it is {inner}, greater than the outer angle, {outer}");
        return Err(spot.fault_at("innerConeAngle", what));
    }
    Ok(LightKind::Spot { inner, outer })
}
