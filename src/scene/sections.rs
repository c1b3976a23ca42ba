//! Camera, image and sampling. In: the tables of those sections. Out: the types of the model, with the
//! defaults of keys that are not given.

use glam::DVec3;

use super::model::*;
use super::reader::{COORDINATE, FOV, Field, LENGTH, NOT_NEGATIVE, UNIT};
use super::table::Table;
use super::validate::{MAX_DEPTH, MAX_SIZE, MAX_SPP, check_shared, check_spp, parallel};
use crate::core::error::Result;

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
pub(super) const IMAGE: &[&str] = &["width", "height", "pixel_filter", "pixel_filter_radius"];
pub(super) const SAMPLING: &[&str] =
    &["algorithm", "pattern", "spp", "shared", "seed", "max_depth", "footprint", "precision"];

pub(super) fn camera(table: &Table<'_>) -> Result<Camera> {
    let eye = table.required("eye")?.vec3(&COORDINATE)?;
    let look_at_field = table.required("look_at")?;
    let look_at = look_at_field.vec3(&COORDINATE)?;
    let view = look_at - eye;
    if view.abs().max_element() < 1e-30 {
        let what = "look_at is where the eye is, so there is no view direction; move one of them";
        return Err(look_at_field.error(what, "same point as eye"));
    }
    let up_field = table.get("up");
    let up = up_field.map_or(Ok(DVec3::Y), Field::direction)?;
    if parallel(view, up) {
        let what = "up is parallel to the view direction look_at - eye";
        return Err(match up_field {
            Some(field) => field.error(&format!("{what}; choose another up"), "parallel to the view"),
            None => {
                let what = format!("key \"camera.up\": the default [0, 1, 0] for {what}; set up");
                table.error(&what, "up is parallel to the view")
            }
        });
    }
    let projection = projection(table)?;
    let lens = lens(table, projection, view.length())?;
    let shutter = shutter(table)?;
    let motion = motion(table, view, up)?;
    Ok(Camera { eye, look_at, up, projection, lens, shutter, motion })
}

fn shutter(table: &Table<'_>) -> Result<[f64; 2]> {
    let Some(field) = table.get("shutter") else { return Ok([0.0, 1.0]) };
    let [opens, closes] = field.numbers(&UNIT)?;
    if opens > closes {
        return Err(field.error("the shutter closes before it opens; swap the two times", "closes too early"));
    }
    Ok([opens, closes])
}

/// At no time may the eye be where it looks, or look along up.
fn motion(table: &Table<'_>, view: DVec3, up: DVec3) -> Result<[DVec3; 2]> {
    let Some(field) = table.get("motion") else { return Ok([DVec3::ZERO; 2]) };
    let moves = Table::inline(field, "camera.motion", &["eye", "look_at"])?;
    let of = |key| moves.get(key).map_or(Ok(DVec3::ZERO), |field| field.vec3(&COORDINATE));
    let [eye, look_at] = [of("eye")?, of("look_at")?];
    // Both change evenly with time, so that the least of them is at one of the ends or in between.
    let least = |start: DVec3, change: DVec3| {
        let time = -start.dot(change) / change.length_squared().max(f64::MIN_POSITIVE);
        start + time.clamp(0.0, 1.0) * change
    };
    let change = look_at - eye;
    let reach = view.length().max((view + change).length());
    if least(view, change).length() <= 1e-9 * reach {
        return Err(
            field.error("the eye passes through what it looks at; choose other motions", "meets look_at")
        );
    }
    if least(view.cross(up), change.cross(up)).length() <= 1e-9 * reach * up.length() {
        let what = "at some time the view direction is parallel to up; choose other motions, or another up";
        return Err(field.error(what, "looks along up"));
    }
    Ok([eye, look_at])
}

/// What is looked at is in focus, unless a distance is given.
fn lens(table: &Table<'_>, projection: Projection, distance: f64) -> Result<Option<Lens>> {
    let radius_field = table.get("lens_radius");
    let radius = radius_field.map_or(Ok(0.0), |field| field.number(&NOT_NEGATIVE))?;
    let focus_distance = table.get("focus_distance").map_or(Ok(distance), |field| field.number(&LENGTH))?;
    match (radius_field, projection) {
        (Some(field), Projection::Orthographic(_)) if radius > 0.0 => {
            let what =
                "parallel rays pass through no lens; remove it, or use vertical_fov or camera_constant";
            Err(field.error(what, "not with orthographic_height"))
        }
        _ => Ok((radius > 0.0).then_some(Lens { radius, focus_distance })),
    }
}

fn projection(table: &Table<'_>) -> Result<Projection> {
    const KEYS: [&str; 3] = ["vertical_fov", "camera_constant", "orthographic_height"];
    let given: Vec<Field<'_>> = KEYS.iter().filter_map(|key| table.get(key)).collect();
    match given.as_slice() {
        [] => {
            let what = format!("key \"camera.vertical_fov\" is missing: give one of {}", KEYS.join(", "));
            Err(table.error(&what, "needs a field of view"))
        }
        [field] => match field.key {
            "vertical_fov" => field.number(&FOV).map(Projection::VerticalFov),
            "camera_constant" => field.number(&LENGTH).map(Projection::CameraConstant),
            _ => field.number(&LENGTH).map(Projection::Orthographic),
        },
        [first, second, ..] => {
            let what = format!("{} is given too; keep exactly one of {}", first.key, KEYS.join(", "));
            Err(second.error(&what, format!("excludes {}", first.key)))
        }
    }
}

pub(super) fn image(table: &Table<'_>) -> Result<(u32, u32)> {
    let width = table.required("width")?.integer(1..=MAX_SIZE)?;
    let height = table.required("height")?.integer(1..=MAX_SIZE)?;
    Ok((width, height))
}

pub(super) fn sampling(table: Option<&Table<'_>>) -> Result<Sampling> {
    let mut sampling = Sampling {
        algorithm: Algorithm::Samples,
        pattern: Pattern::Stratified,
        spp: 16,
        shared: false,
        seed: 1,
        max_depth: 5,
        footprint: Footprint::None,
        precision: Precision::Auto,
    };
    let Some(table) = table else { return Ok(sampling) };
    if let Some(field) = table.get("algorithm") {
        sampling.algorithm = field.choice(Algorithm::NAMES, Algorithm::ALL)?;
    }
    if let Some(field) = table.get("pattern") {
        sampling.pattern = field.choice(Pattern::NAMES, Pattern::ALL)?;
    }
    if let Some(field) = table.get("spp") {
        sampling.spp = field.integer(1..=MAX_SPP)?;
        check_spp(sampling.pattern, sampling.spp)
            .map_err(|what| field.error(&what, "not with this pattern"))?;
    }
    if let Some(field) = table.get("shared") {
        sampling.shared = field.boolean()?;
        check_shared(sampling.pattern, sampling.shared)
            .map_err(|what| field.error(&what, "nothing to share"))?;
    }
    if let Some(field) = table.get("seed") {
        sampling.seed = field.integer(0..=u32::MAX)?;
    }
    if let Some(field) = table.get("max_depth") {
        sampling.max_depth = field.integer(0..=MAX_DEPTH)?;
    }
    if let Some(field) = table.get("footprint") {
        sampling.footprint = field.choice(Footprint::NAMES, Footprint::ALL)?;
    }
    if let Some(field) = table.get("precision") {
        sampling.precision = field.choice(Precision::NAMES, Precision::ALL)?;
    }
    Ok(sampling)
}
