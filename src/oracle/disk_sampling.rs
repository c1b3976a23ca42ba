//! Mappings from the unit square to the shapes that are sampled. Twin of `glsl/shared/disk_sampling.glsl`.

use glam::{DVec2, DVec3};

use super::math::sine_turns;

/// Returns a point on the disc by the concentric map of Shirley & Chiu 1997: squares around the centre become
/// circles.
pub fn concentric_disc(square: DVec2) -> DVec2 {
    let p = 2.0 * square - 1.0;
    let wide = p.x.abs() > p.y.abs();
    let (radius, other) = if wide { (p.x, p.y) } else { (p.y, p.x) };
    let turns = if radius == 0.0 { 0.0 } else { 0.125 * other / radius };
    let (along, beside) = (radius * sine_turns(0.25 + turns), radius * sine_turns(turns));
    if wide { DVec2::new(along, beside) } else { DVec2::new(beside, along) }
}

/// Returns a point on the cap of the unit sphere around +z of height `height`; 2 is the whole sphere.
pub fn on_cap(disc: DVec2, height: f64) -> DVec3 {
    let fall = height * disc.length_squared();
    let stretch = (height * (2.0 - fall)).max(0.0).sqrt();
    DVec3::new(stretch * disc.x, stretch * disc.y, 1.0 - fall)
}
