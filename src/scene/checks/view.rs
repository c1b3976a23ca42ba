//! Checks of camera, image and sampling.

use glam::DVec3;

use super::super::limits::{
    COORDINATE, DEPTH, FOV, LENGTH, NOT_NEGATIVE, RADIUS, SIZE, SPP, UNIT, check_shared, check_spp, parallel,
};
use super::super::model::{Camera, PixelFilter, Projection, Sampling};
use super::super::refusal::{Check, Key};

pub fn camera(key: Key, camera: &Camera) -> Check {
    key.of("eye").vector(camera.eye, &COORDINATE)?;
    key.of("look_at").vector(camera.look_at, &COORDINATE)?;
    let view = camera.look_at - camera.eye;
    if view.abs().max_element() < 1e-30 {
        let what = "look_at is where the eye is, so there is no view direction; move one of them";
        return key.of("look_at").refuse(what, "same point as eye");
    }
    let up = key.of("up").or_default("[0, 1, 0]");
    up.direction(camera.up)?;
    if parallel(view, camera.up) {
        let what = "up is parallel to the view direction look_at - eye; choose another up";
        return up.refuse(what, "parallel to the view");
    }
    match camera.projection {
        Projection::VerticalFov(fov) => key.of("vertical_fov").number(fov, &FOV)?,
        Projection::CameraConstant(constant) => key.of("camera_constant").number(constant, &LENGTH)?,
        Projection::Orthographic(height) => key.of("orthographic_height").number(height, &LENGTH)?,
    }
    lens(key, camera)?;
    shutter(key.of("shutter"), camera.shutter)?;
    motion(key, camera, view)
}

fn lens(key: Key, camera: &Camera) -> Check {
    let Some(lens) = camera.lens else { return Ok(()) };
    key.of("lens_radius").number(lens.radius, &NOT_NEGATIVE)?;
    key.of("focus_distance").number(lens.focus_distance, &LENGTH)?;
    if lens.radius > 0.0 && matches!(camera.projection, Projection::Orthographic(_)) {
        let what = "parallel rays pass through no lens; remove it, or use vertical_fov or camera_constant";
        return key.of("lens_radius").refuse(what, "not with orthographic_height");
    }
    Ok(())
}

fn shutter(key: Key, [opens, closes]: [f64; 2]) -> Check {
    key.numbers([opens, closes], &UNIT)?;
    if opens > closes {
        return key.refuse("the shutter closes before it opens; swap the two times", "closes too early");
    }
    Ok(())
}

/// At no time may the eye coincide with its target, or the view be parallel to up.
fn motion(key: Key, camera: &Camera, view: DVec3) -> Check {
    let [eye, look_at] = camera.motion;
    key.of("motion.eye").vector(eye, &COORDINATE)?;
    key.of("motion.look_at").vector(look_at, &COORDINATE)?;
    if !camera.moves() {
        return Ok(());
    }
    // Both change linearly with time, so the minimum is at an end or in between.
    let least = |start: DVec3, change: DVec3| {
        let time = -start.dot(change) / change.length_squared().max(f64::MIN_POSITIVE);
        start + time.clamp(0.0, 1.0) * change
    };
    let (change, up) = (look_at - eye, camera.up);
    let reach = view.length().max((view + change).length());
    let key = key.of("motion");
    if least(view, change).length() <= 1e-9 * reach {
        return key.refuse("the eye passes through what it looks at; choose other motions", "meets look_at");
    }
    if least(view.cross(up), change.cross(up)).length() <= 1e-9 * reach * up.length() {
        let what = "at some time the view direction is parallel to up; choose other motions, or another up";
        return key.refuse(what, "looks along up");
    }
    Ok(())
}

pub fn image(key: Key, [width, height]: [u32; 2], filter: &PixelFilter) -> Check {
    key.of("width").integer(width, &SIZE)?;
    key.of("height").integer(height, &SIZE)?;
    key.of("pixel_filter_radius").number(filter.radius, &RADIUS)
}

pub fn sampling(key: Key, sampling: &Sampling) -> Check {
    key.of("spp").integer(sampling.spp, &SPP)?;
    key.of("shared").rule(check_shared(sampling.pattern, sampling.shared), "nothing to share")?;
    key.of("max_depth").integer(sampling.max_depth, &DEPTH)?;
    key.of("spp").or_default("16").rule(check_spp(sampling.pattern, sampling.spp), "not with this pattern")
}
