//! The path with which a sample begins. Input: a pixel and the number of the sample. Output: the ray in the scene and its
//! differential, and the sample's place about the pixel. Twin of `glsl/shared/camera_sample.glsl`.

use super::camera::{camera_at, camera_ray, through_lens};
use super::footprint::camera_differential;
use super::patterns::pixel_points;
use super::pixel_filter::{Place, filtered_place};
use super::rng::{pcg2d, pixel_key, sample_bits};
use super::sample_dimensions::{choose, unit_square};
use super::shade::{Path, camera_path};
use crate::pack::PackedScene;
use crate::schema::layout::Header;

/// Returns the path of sample `s` of a pixel of the film, and its place about the pixel.
pub fn camera_sample(
    scene: &PackedScene,
    header: &Header,
    [x, y]: [u32; 2],
    stream: u32,
    s: u32,
) -> (Path, Place) {
    let place = [x + header.crop.x, y + header.crop.y];
    let seed = header.seed.wrapping_add(stream.wrapping_mul(0x9E37_79B9));
    let key = pixel_key(place, seed, header.shares_pattern);
    let points = pixel_points(header, place, key);
    let dimensions = choose(header, &points, s, 0, true);
    let moves = header.camera_moves;
    let [opens, open] = [header.shutter_opens, header.shutter_time].map(f64::from);
    let time = opens + open * unit_square(dimensions.time).x;
    let camera = if moves { &camera_at(header, time) } else { header };
    let at = filtered_place(scene, dimensions.place);
    let mut ray = camera_ray(camera, place, at.inside);
    if header.lens_radius > 0.0 {
        ray = through_lens(camera, &ray, unit_square(dimensions.lens));
    }
    ray.time = time;
    if moves {
        ray.origin += time * header.eye_motion;
    }
    // Bits that are independent of the sample's position.
    let random = pcg2d(sample_bits(key, s).map(|bits| bits ^ 0x5BD1_E995));
    let mut path = camera_path(ray, camera_differential(camera, &ray), random);
    path.points = Some((points, s));
    (path, at)
}
