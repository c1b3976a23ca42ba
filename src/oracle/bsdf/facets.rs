//! Glossy mirrors and glass: facets whose normals follow GGX (Walter et al. 2007), of which a sample takes one
//! that its ray can see, weighted by G2 / G1 of Smith. alpha = roughness². Twin of `glsl/shared/bsdf/facets.glsl`.

use glam::{DVec2, DVec3};

use crate::oracle::disk_sampling::{concentric_disc, on_cap};
use crate::oracle::footprint::{RayDifferential, around};
use crate::oracle::math::any_tangent;
use crate::schema::layout::Header;

/// The normal of a facet that a ray along `direction` meets, on a surface with unit normal n against the ray.
pub fn visible_normal(direction: DVec3, n: DVec3, alpha: f64, square: DVec2) -> DVec3 {
    let tangent = any_tangent(n);
    let bitangent = n.cross(tangent);
    let [x, y] = [tangent, bitangent].map(|side| -alpha * direction.dot(side));
    let view = DVec3::new(x, y, (-direction.dot(n)).max(0.0)).normalize_or_zero();
    let sum = on_cap(concentric_disc(square), 1.0 + view.z) + view;
    around(n, DVec3::new(alpha * sum.x, alpha * sum.y, sum.z.max(0.0)).normalize_or_zero())
}

/// 2 z / (z + smith) is G1 of a direction whose cosine is z.
pub fn smith(cosine: f64, alpha: f64) -> f64 {
    (cosine * cosine + alpha * alpha * (1.0 - cosine * cosine).max(0.0)).sqrt()
}

/// G2 / G1 of reflection, heights correlated (Heitz 2014).
pub fn smith_g2_over_g1(seen: f64, leaving: f64, alpha: f64) -> f64 {
    let a = smith(seen, alpha);
    leaving * (seen + a) / (a * leaving + smith(leaving, alpha) * seen)
}

/// G2 / G1 of refraction, whose two sides are taken as independent: G1 of the way that leaves.
pub fn smith_g1_refracted(leaving: f64, alpha: f64) -> f64 {
    2.0 * leaving / (leaving + smith(leaving, alpha))
}

/// The beam as wide as the part of the lobe that a sample stands for.
pub fn widened_differential(
    header: &Header,
    beam: &RayDifferential,
    direction: DVec3,
    alpha: f64,
) -> RayDifferential {
    let size = direction.length();
    let by = 2.0 * alpha * header.sample_side * size;
    let unit = direction / size;
    let [x, y] = beam.direction;
    let first = (x - unit.dot(x) * unit).try_normalize().unwrap_or_else(|| any_tangent(unit));
    let second = unit.cross(first);
    let side = if second.dot(y) < 0.0 { -by } else { by };
    RayDifferential { direction: [x + by * first, y + side * second], spread: beam.spread + by, ..*beam }
}
