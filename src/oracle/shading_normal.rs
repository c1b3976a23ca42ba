//! Shading normals that lean away from the surface, interpolated or by a bump map: rays that they send to the wrong
//! side of the surface are raised to the horizon (Keller et al. 2017, "The Iray Light Transport Simulation and
//! Rendering System"), as far above it as in Cycles. Twin of `glsl/shared/shading_normal.glsl`.

use glam::DVec3;

use super::bsdf::mirror::mirrored;
use super::geometry::hit::Surface;

/// The least cosine with the geometric normal, where `flat_cosine` is what a surface that does not lean would give:
/// rays of such a surface stay as they are.
fn least_cosine(flat_cosine: f64) -> f64 {
    (0.9 * flat_cosine).min(0.01)
}

/// The unit vector `way`, turned towards the unit vector g until their cosine is `least`.
fn raised(way: DVec3, g: DVec3, least: f64) -> DVec3 {
    let cosine = way.dot(g);
    if cosine >= least {
        return way;
    }
    let along = (way - cosine * g).try_normalize();
    along.map_or(g, |along| (1.0 - least * least).sqrt() * along + least * g)
}

/// Turns the shading normal towards the ray, and as far towards the geometric one that it mirrors the ray to the
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

/// The way of a ray that leaves on the side of n and g, the shading and the geometric normal, or by a facet around
/// n: one that is above n alone is raised above g.
pub fn on_its_side(direction: DVec3, way: DVec3, n: DVec3, g: DVec3) -> DVec3 {
    let size = way.length();
    let unit = way / size;
    let cosine = unit.dot(n).min(direction.dot(g).abs() / direction.length());
    let least = least_cosine(cosine);
    if unit.dot(g) >= least || cosine <= 0.0 { way } else { raised(unit, g, least) * size }
}
