//! The shapes that a cell's camera rays may meet, in f64 without a margin: the device's lists must contain
//! them. Twin of `glsl/shared/tile_culling_main.glsl`.

use super::geometry::kinds::{shape_count, shape_of};
use super::polygon::unit_square;
use super::projective::frame_over;
use crate::pack::PackedScene;

/// Returns the listed shapes of the cell whose first pixel of the film is `place`.
pub fn shapes_of(scene: &PackedScene, place: [u32; 2]) -> Vec<u32> {
    let header = &scene.header;
    let pixel = [place[0] + header.crop.x, place[1] + header.crop.y];
    let frame = frame_over(header, pixel, f64::from(header.cell_side - 1), 0.0);
    let may_meet = |shape: u32| shape_of(scene, shape).may_meet(header, &frame, &unit_square());
    let listed = (0..shape_count(scene)).filter(|&shape| scene.is_listed(shape as usize));
    listed.filter(|&shape| may_meet(shape)).collect()
}
