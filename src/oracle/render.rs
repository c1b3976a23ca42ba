//! Packed scene → sums of samples and means of pixels, in f64. Twin of `glsl/shared/render_main.glsl`.

use std::ops;

use glam::DVec3;

use super::camera_sample::camera_sample;
use super::cone_shade;
use super::shade::advance;
use crate::pack::{PackedScene, filtered_mean};
use crate::scene::model::Algorithm;
use crate::schema::layout::Header;

/// The sums of a pixel's samples.
#[derive(Clone, Copy, Debug, Default)]
pub struct PixelSums {
    /// Sum of radiance, each sample with the sign of the pixel filter at its position.
    pub sum: DVec3,
    /// Sum of the mean of the squared channels.
    pub squares: f64,
    /// Sum of radiance where the sign is negative, without the sign.
    pub negative: DVec3,
    pub signs: f64,
}

/// Sums samples of a pixel, one after the other; the header may differ from the scene's in the samples' share of the
/// pixel.
pub fn sums(
    scene: &PackedScene,
    header: &Header,
    place: [u32; 2],
    stream: u32,
    of: ops::Range<u32>,
) -> PixelSums {
    let mut sums = PixelSums::default();
    for s in of {
        let (radiance, sign) = sample(scene, header, place, stream, s);
        sums.sum += sign * radiance;
        sums.squares += radiance.length_squared() / 3.0;
        sums.negative += if sign < 0.0 { radiance } else { DVec3::ZERO };
        sums.signs += sign;
    }
    sums
}

/// Returns the mean radiance of pixel (x, y) of the film, that is of the crop if there is one.
pub fn pixel(scene: &PackedScene, x: u32, y: u32) -> DVec3 {
    if scene.algorithm == Algorithm::Cone {
        return cone_shade::pixel(scene, x, y).0;
    }
    let PixelSums { sum, negative, signs, .. } = sums(scene, &scene.header, [x, y], 0, 0..scene.samples);
    let samples = f64::from(scene.samples);
    let Some(mean) = scene.mean_sign else { return sum / samples };
    DVec3::from_array([0, 1, 2].map(|c| filtered_mean(sum[c], negative[c], signs, samples, mean)))
}

/// Returns the radiance of one sample and the pixel filter's sign; the header may differ from the scene's in the
/// samples' share of the pixel. The second half of an adaptive picture has a different seed.
pub fn sample(scene: &PackedScene, header: &Header, place: [u32; 2], stream: u32, s: u32) -> (DVec3, f64) {
    let (mut path, at) = camera_sample(scene, header, place, stream, s);
    let mut sum = DVec3::ZERO;
    while path.is_alive {
        sum += advance(scene, &mut path);
    }
    (sum, at.sign)
}
