//! Model `dielectric`: the way of a refracted ray (Snell) and the share of light that is mirrored (Fresnel). Twin of
//! `glsl/shared/bsdf/dielectric.glsl`.

use glam::DVec3;

/// Square of what of a ray as long as d goes along the normal behind a surface; `ratio` of refractive indices, in
/// front over behind. Not above 0 where everything is reflected.
pub fn straight_behind(direction: DVec3, n: DVec3, ratio: f64) -> f64 {
    let sine = ratio * direction.cross(n).length();
    let size = direction.length();
    (size - sine) * (size + sine)
}

/// Snell: the direction behind a surface with unit normal n against the ray. As long as d; d itself where
/// everything is reflected.
pub fn refracted(direction: DVec3, n: DVec3, ratio: f64) -> DVec3 {
    let under = straight_behind(direction, n, ratio);
    let along = n.cross(direction.cross(n)); // the surface
    if under > 0.0 { ratio * along - under.sqrt() * n } else { direction }
}

/// Share of unpolarised light that is mirrored (Fresnel); 1 beyond the critical angle.
pub fn fresnel_dielectric(direction: DVec3, n: DVec3, ratio: f64) -> f64 {
    let under = straight_behind(direction, n, ratio);
    if under <= 0.0 {
        return 1.0;
    }
    let before = direction.dot(n).abs();
    let behind = under.sqrt();
    let s = (ratio * before - behind) / (ratio * before + behind);
    let p = (before - ratio * behind) / (before + ratio * behind);
    0.5 * (s * s + p * p)
}
