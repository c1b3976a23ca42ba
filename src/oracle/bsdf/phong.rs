//! Model `phong`: Lambert, and beside it a highlight, energy-normalised (Lafortune & Willems 1994). Twin of
//! `glsl/shared/bsdf/phong.glsl`.

use glam::DVec3;

/// cosⁿ α (n + 2) / 2 between the mirror direction and the way to the light.
pub fn phong_lobe(mirror: DVec3, way: DVec3, exponent: f64) -> f64 {
    let cosine = mirror.dot(way) / (mirror.length() * way.length());
    if cosine > 0.0 { cosine.min(1.0).powf(exponent) * (0.5 * exponent + 1.0) } else { 0.0 }
}

/// The lobe that the albedo colours, and the highlight.
pub fn phong_lobes(mirror: DVec3, way: DVec3, exponent: f64) -> [f64; 2] {
    [1.0, phong_lobe(mirror, way, exponent)]
}

pub fn with_highlight(diffuse: DVec3, carried: DVec3, specular: DVec3, light: DVec3) -> DVec3 {
    diffuse + carried * specular * light
}
