//! A cell of pixels → the triangles that its camera rays may meet, in f64 without slack: those that the
//! device's lists must have. Twin of `glsl/shared/tile_culling_main.glsl`.

use glam::{DVec2, DVec3};

use super::math::xyz;
use super::projective::{PixelFrustum, frame_over, ray_at};
use crate::pack::PackedScene;
use crate::schema::layout::{Header, Triangle};

/// Triangles of the cell whose first pixel of the film is `place`.
pub fn triangles_of(scene: &PackedScene, place: [u32; 2]) -> Vec<u32> {
    let header = &scene.header;
    let pixel = [place[0] + header.image[2], place[1] + header.image[3]];
    let frame = frame_over(header, pixel, f64::from(header.chances[3] - 1), 0.0);
    let triangles = (0..).zip(&scene.triangles);
    triangles.filter(|(_, t)| may_meet_triangle(header, &frame, t)).map(|(i, _)| i).collect()
}

/// A ray meets a triangle where all three edge functions have one sign. These are affine in the ray's place,
/// so that their corners' extremes bound them.
fn may_meet_triangle(header: &Header, frame: &PixelFrustum, triangle: &Triangle) -> bool {
    let vertices = [triangle.a, triangle.b, triangle.c].map(xyz);
    if vertices.iter().all(|v| v.dot(xyz(header.forward)) <= 0.0) {
        return false;
    }
    let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for corner in [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y] {
        let (way, origin) = ray_at(frame, corner);
        let [a, b, c] = vertices.map(|v| v - origin);
        let edges = DVec3::new(way.dot(b.cross(c)), way.dot(c.cross(a)), way.dot(a.cross(b)));
        (least, most) = (least.min(edges), most.max(edges));
    }
    most.min_element() >= 0.0 || least.max_element() <= 0.0
}
