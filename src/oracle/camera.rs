//! Generates camera rays from a pixel and a position in it, relative to the eye. Twin of `glsl/shared/camera.glsl`.

use glam::{DVec2, DVec3};

use super::disk_sampling::concentric_disc;
use crate::pack::ProjectionKind;
use crate::schema::layout::Header;

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
    pub time: f64,
}

/// Returns the pinhole camera's ray; `inside` counts from the pixel's corner, in pixels.
pub fn camera_ray(header: &Header, pixel: [u32; 2], inside: DVec2) -> Ray {
    let corner = DVec2::new(
        f64::from(pixel[0]) - 0.5 * f64::from(header.image_size.x),
        f64::from(pixel[1]) - 0.5 * f64::from(header.image_size.y),
    );
    let at = corner + inside;
    let point = at.x * header.step_x + at.y * header.step_y;
    let forward = header.forward;
    if header.projection == ProjectionKind::Orthographic {
        Ray { origin: point, direction: forward, time: 0.0 }
    } else {
        Ray { origin: DVec3::ZERO, direction: forward + point, time: 0.0 }
    }
}

/// Returns the thin lens's ray: from a point on the lens to the point where the pinhole's ray meets the plane of focus.
pub fn through_lens(header: &Header, ray: &Ray, square: DVec2) -> Ray {
    let place = f64::from(header.lens_radius) * concentric_disc(square);
    let aside = place.x * header.step_x + place.y * header.step_y;
    let direction = ray.direction - f64::from(header.inverse_focus_distance) * aside;
    Ray { origin: ray.origin + aside, direction, time: ray.time }
}

/// Returns the camera at a time between 0 and 1: the eye and the point that it looks at have moved, and the axes are
/// recomputed. Rays still start relative to the eye at that time.
pub fn camera_at(header: &Header, time: f64) -> Header {
    let view = header.view + time * header.view_motion;
    let forward = view.normalize();
    let right = forward.cross(header.up).normalize();
    let pixel = header.pixel_side;
    Header { forward, step_x: pixel * right, step_y: pixel * forward.cross(right), ..*header }
}
