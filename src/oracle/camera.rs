//! Pixel and position in it → ray, relative to the eye. Twin of `glsl/shared/camera.glsl`.

use glam::{DVec2, DVec3};

use super::math::xyz;
use crate::layout::Header;
use crate::pack::ProjectionKind;

#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: DVec3,
    pub direction: DVec3,
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
        Ray { origin: point, direction: forward }
    } else {
        Ray { origin: DVec3::ZERO, direction: forward + point }
    }
}
