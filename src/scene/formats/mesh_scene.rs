//! Mesh files as scenes. Input: a mesh file. Output: the mesh with the materials of its own libraries, seen
//! whole from the front, a little from above and from the right, before grey and under two lights.

use std::path::Path;

use glam::DVec3;

use super::Reading;
use super::mesh_file::{MeshFile, Usage};
use super::toml::View;
use crate::core::error::{Error, ErrorKind, Result};
use crate::scene::builder::SceneBuilder;
use crate::scene::limits::check_filters;
use crate::scene::model::{Camera, Footprint, Light, PixelFilter, Projection, Sampling, Scene};

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

/// Reads a mesh file as a scene; with the chosen camera of the file, or its first, and its lights where it has them.
pub(super) fn read(path: &Path, reading: &Reading<'_>) -> Result<Scene> {
    let failed = |what: String| Error::new(format!("{}: {what}", path.display())).of_kind(ErrorKind::Scene);
    // The file decides what the camera sees, but its name belongs to the scene.
    let mut builder = SceneBuilder::new(camera_of([DVec3::ZERO; 2]), SIZE, SIZE);
    builder.path(path);
    builder.keep_meshes(reading.keeps_meshes);
    let file = MeshFile::open(path, &mut builder)?;
    let unknown = |what| Error::new(format!("--camera: {}: {what}", path.display()));
    let mut view = view(&file, reading.camera).map_err(unknown)?;
    if !reading.settings.is_empty() {
        builder.settings(reading.settings);
        view = view.changed(path, reading.settings)?;
    }
    view.build(&mut builder);
    let dropped = file.add(&[Usage::default()], &mut builder)?.map_err(|unsuited| failed(unsuited.what))?;
    if !builder.has_shapes() {
        return Err(failed(format!(
            "the file has no triangles ({dropped} degenerate, points and lines left out)"
        ))
        .and_help(Some(
            "export its surfaces as triangles with an area, below nodes of its default scene".into(),
        )));
    }
    let scene = builder.check().map_err(|refusal| failed(refusal.to_string()))?;
    check_filters(&scene)?;
    Ok(scene)
}

/// Returns what a scene of the file has beside its surfaces.
fn view(file: &MeshFile, chosen: Option<&str>) -> Result<View, String> {
    let (camera, aspect) = file.camera(chosen)?.unwrap_or_else(|| (camera_of(file.bounds()), 1.0));
    let mut view = View {
        camera,
        size: [(f64::from(SIZE) * aspect).round() as u32, SIZE],
        pixel_filter: PixelFilter::default(),
        sampling: Sampling { footprint: Footprint::Differentials, ..Sampling::default() },
        background: DVec3::splat(BACKGROUND),
        lights: file.lights(),
    };
    if view.lights.is_empty() {
        let light =
            |(direction, irradiance)| Light::Directional { direction, irradiance: DVec3::splat(irradiance) };
        view.lights.extend(LIGHTS.map(light));
    }
    Ok(view)
}

/// What a model is seen by, as the text of a scene.
pub struct ModelView {
    /// Camera, picture and sampling.
    pub view: String,
    /// What is behind it.
    pub background: String,
    /// Its lights, or those that models without any have.
    pub lights: String,
}

/// Returns camera, picture, sampling, background and lights of a model as the text of a scene, in round numbers.
pub fn model_view(path: &Path) -> Result<ModelView> {
    let mut builder = SceneBuilder::new(camera_of([DVec3::ZERO; 2]), SIZE, SIZE);
    let file = MeshFile::open(path, &mut builder)?;
    let mut view = view(&file, None).map_err(Error::new)?;
    for vector in [&mut view.camera.eye, &mut view.camera.look_at] {
        *vector = vector.map(rounded);
    }
    let [view, background, lights] = view.parts();
    Ok(ModelView { view, background, lights })
}

/// Returns a number to five digits.
fn rounded(number: f64) -> f64 {
    format!("{number:.4e}").parse().unwrap_or(number)
}

/// Returns the camera that sees the ball around the mesh's box.
fn camera_of([min, max]: [DVec3; 2]) -> Camera {
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
