//! Model `phong`: Lambert, and beside it a highlight, energy-normalised (Lafortune & Willems 1994). Twin of
//! `glsl/shared/bsdf/phong.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::oracle::footprint::around;

/// cosⁿ α (n + 2) / 2 between the mirror direction and the way to the light.
pub fn phong_lobe(mirror: DVec3, way: DVec3, exponent: f64) -> f64 {
    let cosine = mirror.dot(way) / (mirror.length() * way.length());
    if cosine > 0.0 { cosine.min(1.0).powf(exponent) * (0.5 * exponent + 1.0) } else { 0.0 }
}

/// The lobe that the albedo colours, and the highlight.
pub fn phong_lobes(mirror: DVec3, way: DVec3, exponent: f64) -> [f64; 2] {
    [1.0, phong_lobe(mirror, way, exponent)]
}

/// Density over solid angle with which `sampled_highlight` returns a way.
pub fn highlight_density(mirror: DVec3, way: DVec3, exponent: f64) -> f64 {
    phong_lobe(mirror, way, exponent) * ((exponent + 1.0) / (exponent + 2.0)) / PI
}

/// A way around the mirror direction, as often as cosⁿ is large (Walter 2005); of a point that is uniform in the disc.
pub fn sampled_highlight(mirror: DVec3, disc: DVec2, exponent: f64) -> DVec3 {
    let squared = disc.length_squared();
    let rise = (1.0 - squared).max(1e-7).ln() / (exponent + 1.0);
    let sine = -(2.0 * rise).exp_m1();
    let size = (sine / squared.max(1e-30)).sqrt();
    around(mirror.normalize(), (disc * size).extend((1.0 - sine).max(0.0).sqrt()))
}

pub fn with_highlight(diffuse: DVec3, carried: DVec3, specular: DVec3, light: DVec3) -> DVec3 {
    diffuse + carried * specular * light
}
