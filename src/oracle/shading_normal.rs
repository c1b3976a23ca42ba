//! Shading normals that differ from the geometric one, by interpolation or by a bump map: rays that they send to the
//! wrong side of the surface are raised to the horizon (Keller et al. 2017, "The Iray Light Transport Simulation and
//! Rendering System"), as far above it as in Cycles. Twin of `glsl/shared/shading_normal.glsl`.

use glam::DVec3;

use super::bsdf::mirror::mirrored;
use super::geometry::hit::Surface;

/// Returns the least cosine with the geometric normal. `flat_cosine` is that of a surface whose normals coincide, whose
/// rays stay unchanged.
fn least_cosine(flat_cosine: f64) -> f64 {
    (0.9 * flat_cosine).min(0.01)
}

/// Rotates the unit vector `way` towards the unit vector g until their cosine is `least`.
fn raised(way: DVec3, g: DVec3, least: f64) -> DVec3 {
    let cosine = way.dot(g);
    if cosine >= least {
        return way;
    }
    let along = (way - cosine * g).try_normalize();
    along.map_or(g, |along| (1.0 - least * least).sqrt() * along + least * g)
}

/// Flips the shading normal towards the ray, and moves it towards the geometric one until it reflects the ray to the
/// surface's own side.
pub fn consistent_normal(direction: DVec3, surface: &mut Surface) {
    let view = -direction.normalize();
    if view.dot(surface.normal) < 0.0 {
        surface.normal = -surface.normal;
        surface.shape_operator = -surface.shape_operator;
        surface.curvature = -surface.curvature;
    }
    let least = least_cosine(view.dot(surface.geometric_normal));
    let way = mirrored(-view, surface.normal);
    if way.dot(surface.geometric_normal) < least {
        surface.normal = (view + raised(way, surface.geometric_normal, least)).normalize();
    }
}

/// Returns the direction of a ray that leaves on the side of n and g, the shading and the geometric normal, or by a
/// facet around n: a direction that is above n alone is raised above g.
pub fn on_its_side(direction: DVec3, way: DVec3, n: DVec3, g: DVec3) -> DVec3 {
    let size = way.length();
    let unit = way / size;
    let cosine = unit.dot(n).min(direction.dot(g).abs() / direction.length());
    let least = least_cosine(cosine);
    if unit.dot(g) >= least || cosine <= 0.0 { way } else { raised(unit, g, least) * size }
}
