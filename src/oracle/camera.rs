//! Pixel and position in it → ray, relative to the eye. Twin of `glsl/shared/camera.glsl`.

use glam::{DVec2, DVec3};

use super::disk_sampling::concentric_disc;
use super::math::xyz;
use crate::pack::ProjectionKind;
use crate::schema::layout::Header;

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
    pub time: f64,
}

/// `inside` counts from the pixel's corner, in pixels.
pub fn camera_ray(header: &Header, pixel: [u32; 2], inside: DVec2) -> Ray {
    let corner = DVec2::new(
        f64::from(pixel[0]) - 0.5 * f64::from(header.image[0]),
        f64::from(pixel[1]) - 0.5 * f64::from(header.image[1]),
    );
    let at = corner + inside;
    let point = at.x * xyz(header.step_x) + at.y * xyz(header.step_y);
    let forward = xyz(header.forward);
    if header.size[2] == ProjectionKind::Orthographic as u32 {
        Ray { origin: point, direction: forward, time: 0.0 }
    } else {
        Ray { origin: DVec3::ZERO, direction: forward + point, time: 0.0 }
    }
}

/// The pinhole's ray, bent by a thin lens: from a point of the lens to where the pinhole's ray meets the plane
/// in focus.
pub fn through_lens(header: &Header, ray: &Ray, square: DVec2) -> Ray {
    let place = f64::from(header.lens[0]) * concentric_disc(square);
    let aside = place.x * xyz(header.step_x) + place.y * xyz(header.step_y);
    let direction = ray.direction - f64::from(header.lens[1]) * aside;
    Ray { origin: ray.origin + aside, direction, time: ray.time }
}

/// The camera at a time between 0 and 1: eye and what it looks at have moved, and its axes are formed anew. Rays
/// still start relative to where the eye is then.
pub fn camera_at(header: &Header, time: f64) -> Header {
    let view = xyz(header.view) + time * xyz(header.view_motion);
    let forward = view.normalize();
    let right = forward.cross(xyz(header.up)).normalize();
    let pixel = header.step_y[3];
    let with = |v: DVec3, w: f64| v.extend(w).to_array();
    Header {
        forward: with(forward, header.forward[3]),
        step_x: with(pixel * right, header.step_x[3]),
        step_y: with(pixel * forward.cross(right), header.step_y[3]),
        ..*header
    }
}
