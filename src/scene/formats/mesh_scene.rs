//! Mesh files as scenes. Input: a mesh file. Output: the mesh with the materials of its own libraries, seen
//! whole from the front, a little from above and from the right, before grey and under two lights.

use std::path::Path;

use glam::DVec3;

use super::mesh_file;
use crate::core::error::{Error, ErrorKind, Result};
use crate::mesh::{Mesh, MeshFormat};
use crate::scene::builder::SceneBuilder;
use crate::scene::geometry::meshes::{self, Placement};
use crate::scene::limits::check_filters;
use crate::scene::model::{Background, Camera, DEFAULT, Footprint, Light, Projection, Sampling, Scene};

const SIZE: u32 = 512;
/// Vertical angle of view in degrees.
const ANGLE: f64 = 35.0;
/// Room around the ball that holds the mesh.
const MARGIN: f64 = 1.05;
/// From the mesh towards the eye.
const VIEW: DVec3 = DVec3::new(0.45, 0.35, 1.0);
const BACKGROUND: f64 = 0.18;
/// Towards the light, and its irradiance in W/m²: from the eye's left, and a weaker one from behind.
const LIGHTS: [(DVec3, f64); 2] = [(DVec3::new(-0.4, 0.9, 1.0), 2.6), (DVec3::new(0.8, 0.3, -0.6), 1.2)];

/// Reads a mesh file as a scene.
pub(super) fn read(path: &Path, format: &MeshFormat) -> Result<Scene> {
    let mesh = mesh_file::open(path, format)?;
    let failed = |what: String| Error::new(format!("{}: {what}", path.display())).of_kind(ErrorKind::Scene);
    let mut builder = SceneBuilder::new(camera_of(&mesh), SIZE, SIZE);
    builder.path(path);
    builder.background(Background { color: DVec3::splat(BACKGROUND), environment: None });
    builder.sampling(Sampling { footprint: Footprint::Differentials, ..Sampling::default() });
    for (direction, irradiance) in LIGHTS {
        builder.light(Light::Directional { direction, irradiance: DVec3::splat(irradiance) });
    }
    let materials = mesh_file::add_materials(path, &mesh, &mut builder)?;
    meshes::add(&mut builder, &mesh, &Placement::IDENTITY, &materials, DEFAULT, DVec3::ZERO)
        .map_err(failed)?;
    let scene = builder.check().map_err(|refusal| failed(refusal.to_string()))?;
    check_filters(&scene)?;
    Ok(scene)
}

/// Returns the camera that sees the ball around the mesh's box.
fn camera_of(mesh: &Mesh) -> Camera {
    let [min, max] = mesh.bounds();
    let middle = 0.5 * (min + max);
    let radius = (0.5 * (max - min).length()).max(f64::MIN_POSITIVE);
    let distance = MARGIN * radius / (0.5 * ANGLE).to_radians().sin();
    Camera {
        eye: middle + distance * VIEW.normalize(),
        look_at: middle,
        up: DVec3::Y,
        projection: Projection::VerticalFov(ANGLE),
        lens: None,
        shutter: [0.0, 1.0],
        motion: [DVec3::ZERO; 2],
    }
}
