//! Reads camera, image and sampling. Input: the tables of those sections. Output: types of the model, with
//! the defaults of keys that are not given.

use glam::DVec3;

use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::limits::{DEPTH, SIZE, SPP};
use crate::scene::model::*;

pub(super) const CAMERA: &[&str] = &[
    "eye",
    "look_at",
    "up",
    "vertical_fov",
    "camera_constant",
    "orthographic_height",
    "lens_radius",
    "focus_distance",
    "shutter",
    "motion",
];
pub(super) const PROJECTIONS: [&str; 3] = ["vertical_fov", "camera_constant", "orthographic_height"];
pub(super) const IMAGE: &[&str] = &["width", "height", "size", "pixel_filter", "pixel_filter_radius"];
pub(super) const SAMPLING: &[&str] =
    &["algorithm", "pattern", "spp", "shared", "seed", "max_depth", "footprint", "precision"];

pub(super) fn camera(table: &Table<'_>) -> Result<Camera> {
    let eye = table.required("eye")?.vec3()?;
    let look_at = table.required("look_at")?.vec3()?;
    let up = table.get("up").map_or(Ok(DVec3::Y), Field::vec3)?;
    let projection = projection(table)?;
    let lens = lens(table, (look_at - eye).length())?;
    let shutter = table.get("shutter").map_or(Ok([0.0, 1.0]), Field::numbers)?;
    let motion = motion(table)?;
    Ok(Camera { eye, look_at, up, projection, lens, shutter, motion })
}

fn motion(table: &Table<'_>) -> Result<[DVec3; 2]> {
    let Some(field) = table.get("motion") else { return Ok([DVec3::ZERO; 2]) };
    let moves = Table::inline(field, "camera.motion", &["eye", "look_at"])?;
    let of = |key| moves.get(key).map_or(Ok(DVec3::ZERO), Field::vec3);
    Ok([of("eye")?, of("look_at")?])
}

/// Focuses on `look_at` unless a distance is given. A radius of 0 is a pinhole.
fn lens(table: &Table<'_>, distance: f64) -> Result<Option<Lens>> {
    let (radius, focus) = (table.get("lens_radius"), table.get("focus_distance"));
    if radius.is_none() && focus.is_none() {
        return Ok(None);
    }
    let radius = radius.map_or(Ok(0.0), Field::number)?;
    Ok(Some(Lens { radius, focus_distance: focus.map_or(Ok(distance), Field::number)? }))
}

fn projection(table: &Table<'_>) -> Result<Projection> {
    let given: Vec<Field<'_>> = PROJECTIONS.iter().filter_map(|key| table.get(key)).collect();
    match given.as_slice() {
        [] => {
            let what =
                format!("key \"camera.vertical_fov\" is missing: give one of {}", PROJECTIONS.join(", "));
            Err(table.error(&what, "needs a field of view"))
        }
        [field] => match field.key {
            "vertical_fov" => field.number().map(Projection::VerticalFov),
            "camera_constant" => field.number().map(Projection::CameraConstant),
            _ => field.number().map(Projection::Orthographic),
        },
        [first, second, ..] => {
            let what = format!("{} is given too; keep exactly one of {}", first.key, PROJECTIONS.join(", "));
            Err(second.error(&what, format!("excludes {}", first.key)))
        }
    }
}

pub(super) fn image(table: &Table<'_>) -> Result<(u32, u32)> {
    if let Some(field) = table.get("size") {
        if let Some(other) = ["width", "height"].iter().find_map(|key| table.get(key)) {
            let what = format!("{} is given too; keep size, or width and height", other.key);
            return Err(field.error(&what, format!("excludes {}", other.key)));
        }
        let [width, height] =
            field.array("2 integers, width and height", [0; 2], |field| field.integer(&SIZE))?;
        return Ok((width, height));
    }
    let width = table.required("width")?.integer(&SIZE)?;
    let height = table.required("height")?.integer(&SIZE)?;
    Ok((width, height))
}

/// Uses the default radius of the kind if none is given.
pub(super) fn pixel_filter(image: &Table<'_>) -> Result<PixelFilter> {
    let kind = match image.get("pixel_filter") {
        Some(field) => field.choice(PixelFilterKind::NAMES, PixelFilterKind::ALL)?,
        None => PixelFilterKind::default(),
    };
    let radius = image.get("pixel_filter_radius").map(Field::number).transpose()?;
    Ok(PixelFilter::new(kind, radius))
}

pub(super) fn sampling(table: Option<&Table<'_>>) -> Result<Sampling> {
    let mut sampling = Sampling::default();
    let Some(table) = table else { return Ok(sampling) };
    if let Some(field) = table.get("algorithm") {
        sampling.algorithm = field.choice(Algorithm::NAMES, Algorithm::ALL)?;
    }
    if let Some(field) = table.get("pattern") {
        sampling.pattern = field.choice(Pattern::NAMES, Pattern::ALL)?;
    }
    if let Some(field) = table.get("spp") {
        sampling.spp = field.integer(&SPP)?;
    }
    if let Some(field) = table.get("shared") {
        sampling.shared = field.boolean()?;
    }
    if let Some(field) = table.get("seed") {
        sampling.seed = field.integer(&(0..=u32::MAX))?;
    }
    if let Some(field) = table.get("max_depth") {
        sampling.max_depth = field.integer(&DEPTH)?;
    }
    if let Some(field) = table.get("footprint") {
        sampling.footprint = field.choice(Footprint::NAMES, Footprint::ALL)?;
    }
    if let Some(field) = table.get("precision") {
        sampling.precision = field.choice(Precision::NAMES, Precision::ALL)?;
    }
    Ok(sampling)
}
