//! Pixel and position in it → ray, relative to the eye. Twin of `glsl/shared/camera.glsl`.

use glam::{DVec2, DVec3};

use super::math::xyz;
use super::strata::UNIT;
use super::warps::concentric_disc;
use crate::layout::Header;
use crate::pack::ProjectionKind;

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
}

pub fn camera_ray(header: &Header, pixel: [u32; 2], position: [u32; 2]) -> Ray {
    let inside = DVec2::new(f64::from(position[0]), f64::from(position[1])) * UNIT;
    let corner = DVec2::new(
        f64::from(pixel[0]) - 0.5 * f64::from(header.image[0]),
        f64::from(pixel[1]) - 0.5 * f64::from(header.image[1]),
    );
    let at = corner + inside;
    let point = at.x * xyz(header.step_x) + at.y * xyz(header.step_y);
    let forward = xyz(header.forward);
    if header.size[2] == ProjectionKind::Orthographic as u32 {
        Ray { origin: point, direction: forward }
    } else {
        Ray { origin: DVec3::ZERO, direction: forward + point }
    }
}

/// The pinhole's ray, bent by a thin lens: from a point of the lens to where the pinhole's ray meets the plane
/// in focus.
pub fn through_lens(header: &Header, ray: &Ray, square: DVec2) -> Ray {
    let place = f64::from(header.lens[0]) * concentric_disc(square);
    let aside = place.x * xyz(header.step_x) + place.y * xyz(header.step_y);
    Ray { origin: ray.origin + aside, direction: ray.direction - f64::from(header.lens[1]) * aside }
}
