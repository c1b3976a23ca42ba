//! Mirrors and glass, smooth or of facets: the ray that leaves them, by chance one of the two that glass sends on.
//! Twin of `glsl/shared/bsdf/specular.glsl`.

use glam::DVec3;

use super::dielectric::{fresnel_dielectric, refracted};
use super::facets::{smith_g1_refracted, smith_g2_over_g1, visible_normal};
use super::mirror::mirrored;
use crate::oracle::geometry::hit::Surface;
use crate::oracle::sample_dimensions::{SampleDimensions, unit_line, unit_square};
use crate::oracle::shading_normal::on_its_side;
use crate::scene::model::Model;
use crate::schema::layout::Material;

/// The ray that leaves a specular surface.
pub struct Bounce {
    pub direction: DVec3,
    /// Normal of the surface, or of the facet that the ray met.
    pub normal: DVec3,
    /// Ratio of refractive indices, before over behind.
    pub ratio: f64,
    /// Roughness alpha of the facets; 0: smooth.
    pub alpha: f64,
    /// Share of its light that facets do not mask.
    pub weight: f64,
    /// Else refracted.
    pub mirrored: bool,
    /// False: a facet sends it into the surface.
    pub leaves: bool,
    /// True if it would have entered the surface.
    pub is_raised: bool,
}

/// Ratio of the refractive indices before and behind a surface.
pub fn index_ratio(material: &Material, inside: bool) -> f64 {
    let ior = f64::from(material.ior);
    if inside { ior } else { 1.0 / ior }
}

/// Share of the light that is mirrored; the rest is refracted.
pub fn mirrored_share(material: &Material, direction: DVec3, normal: DVec3, ratio: f64) -> f64 {
    if material.model == Model::Dielectric { fresnel_dielectric(direction, normal, ratio) } else { 1.0 }
}

/// The mirrored or the refracted way, on its own side of surfaces whose normals lean; and whether it was moved there.
pub fn bounced_way(
    direction: DVec3,
    normal: DVec3,
    surface: &Surface,
    ratio: f64,
    mirror: bool,
) -> (DVec3, bool) {
    let way = if mirror { mirrored(direction, normal) } else { refracted(direction, normal, ratio) };
    let side = if mirror { 1.0 } else { -1.0 };
    let other = on_its_side(direction, way, side * surface.normal, side * surface.geometric_normal);
    (other, other != way)
}

/// A sample of what a specular material sends on.
pub fn sample_bsdf(
    material: &Material,
    surface: &Surface,
    direction: DVec3,
    dimensions: &SampleDimensions,
) -> Bounce {
    let alpha = f64::from(material.alpha);
    let lobe = unit_square(dimensions.lobe);
    let normal =
        if alpha > 0.0 { visible_normal(direction, surface.normal, alpha, lobe) } else { surface.normal };
    let ratio = index_ratio(material, surface.inside);
    let mirror = unit_line(dimensions.fresnel) < mirrored_share(material, direction, normal, ratio);
    let (way, is_raised) = bounced_way(direction, normal, surface, ratio, mirror);
    let bounce = Bounce {
        direction: way,
        normal,
        ratio,
        alpha,
        weight: 1.0,
        mirrored: mirror,
        leaves: true,
        is_raised,
    };
    if alpha <= 0.0 {
        return bounce;
    }
    let outward = if mirror { way } else { -way };
    let seen = (-direction.dot(surface.normal) / direction.length()).max(0.0);
    let leaving = outward.dot(surface.normal) / outward.length();
    // Light that a facet reflects into the surface is lost.
    let leaves = leaving > 0.0 && outward.dot(surface.geometric_normal) > 0.0;
    let weight =
        if mirror { smith_g2_over_g1(seen, leaving, alpha) } else { smith_g1_refracted(leaving, alpha) };
    Bounce { weight, leaves, ..bounce }
}
