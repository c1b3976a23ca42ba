//! Model `oren-nayar`, rough and diffuse, which keeps all light: EON (Portsmouth, Kutz & Hill 2025), Fujii's single
//! scattering and what that loses. Twin of `glsl/shared/bsdf/oren_nayar.glsl`.

use std::f64::consts::PI;

use glam::DVec3;

const FUJII_A: f64 = 0.5 - 2.0 / (3.0 * PI);
/// Mean of G/π.
const FUJII_MEAN: f64 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

/// G/π of a direction with that cosine, without the paper's quotient by the cosine.
pub fn fujii_share(cosine: f64) -> f64 {
    let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
    let rest = sine * cosine * (1.0 + sine + sine * sine) / (1.0 + sine);
    (sine * (sine.atan2(cosine) - sine * cosine) + 2.0 / 3.0 * (rest - sine)) / PI
}

/// The lobe that the albedo colours, and that of light which was scattered more than once, over 1/π.
pub fn oren_nayar_lobes(normal: DVec3, direction: DVec3, way: DVec3, roughness: f64) -> [f64; 2] {
    let (view, light) = (-direction.normalize(), way.normalize());
    let [seen, lit] = [view, light].map(|v| normal.dot(v).clamp(0.0, 1.0));
    let s = light.dot(view) - lit * seen;
    let over_t = if s > 0.0 { s / lit.max(seen) } else { s };
    let a = 1.0 / (1.0 + FUJII_A * roughness);
    let lost = (FUJII_A - fujii_share(seen)) * (FUJII_A - fujii_share(lit)) / (FUJII_A - FUJII_MEAN);
    [a * (1.0 + roughness * over_t), a * roughness * lost]
}

/// The colour of the second lobe: of light that each scattering colours once more.
pub fn scattered_albedo(albedo: DVec3, roughness: f64) -> DVec3 {
    let mean = (1.0 + FUJII_MEAN * roughness) / (1.0 + FUJII_A * roughness);
    albedo * albedo * mean / (1.0 - albedo.min(DVec3::ONE) * (1.0 - mean))
}
