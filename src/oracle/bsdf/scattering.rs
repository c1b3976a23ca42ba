//! How a lit surface continues a path: by one of its facets, through the body, or, where the environment lights surfaces,
//! by its diffuse lobe to that alone; with the balance heuristic (Veach 1997, 9.2). Twin of `glsl/shared/bsdf/scattering.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::dielectric::straight_behind;
use super::facets::{smith_g1_refracted, smith_g2_over_g1, visible_normal};
use super::metallic_roughness::{MetallicRoughness, luminance, mirrored_density, schlick};
use super::mirror::mirrored;
use super::phong::{highlight_density, sampled_highlight};
use super::specular::bounced_way;
use super::{Bsdf, Lit, evaluate, is_both_diffuse, is_glossy, reflected};
use crate::oracle::disk_sampling::concentric_disc;
use crate::oracle::footprint::around;
use crate::oracle::geometry::hit::Surface;
use crate::oracle::sample_dimensions::{SampleDimensions, unit_square};
use crate::scene::model::Model;

/// The ray by which a lit surface continues a path.
pub struct Scattered {
    pub direction: DVec3,
    /// Of its light.
    pub weight: DVec3,
    /// Over solid angle; 0 where nothing else samples this light.
    pub density: f64,
    /// Of the lobe.
    pub alpha: f64,
    /// True if the environment alone counts.
    pub diffuse: bool,
    /// By what keeps the environment's diffuse light away.
    pub occluded: bool,
    /// False if it enters the surface.
    pub leaves: bool,
    /// True if it goes to the other side of the surface.
    pub through: bool,
    /// Normal of what refracted it.
    pub facet: DVec3,
}

/// Facets of the least roughness refract as a smooth surface does.
const SMOOTH_ALPHA: f64 = 0.001;

/// Share of the bounces that facets have, or Phong's highlight; `to_sky`: the environment lights surfaces.
fn facet_bounces(bsdf: &Bsdf<'_>, to_sky: bool) -> f64 {
    if bsdf.material.model == Model::Phong {
        let highlight = luminance(bsdf.material.specular.as_dvec3());
        let all = highlight + luminance(bsdf.albedo);
        return if all > 0.0 && to_sky { highlight / all } else { 0.0 };
    }
    match &bsdf.facets {
        Some(_) if !to_sky => 1.0,
        Some(facets) => facets.bounced,
        None => 0.0,
    }
}

/// Share of the rays that pass the body.
fn passing_share(bsdf: &Bsdf<'_>, to_sky: bool) -> f64 {
    bsdf.facets.as_ref().map_or(0.0, |facets| facets.passing[usize::from(to_sky)])
}

/// Densities with which `scattered` chooses a way, by the diffuse lobe and by facets.
fn scattered_densities(bsdf: &Bsdf<'_>, way: DVec3) -> DVec2 {
    let facets = facet_bounces(bsdf, true);
    let cosine = bsdf.normal.dot(way.normalize()).max(0.0);
    let mirrors = bsdf
        .facets
        .as_ref()
        .map_or(0.0, |found| facets * mirrored_density(bsdf.normal, bsdf.direction, way, found.alpha));
    let highlights = match bsdf.material.model {
        Model::Phong => facets * highlight_density(bsdf.mirror, way, bsdf.material.exponent.into()),
        _ => 0.0,
    };
    DVec2::new((1.0 - facets) * cosine / PI, mirrors + highlights) * (1.0 - passing_share(bsdf, true))
}

/// Lobes of light that is sampled with `density`, where `scattered` samples it as well.
pub fn balanced_lobes(bsdf: &Bsdf<'_>, lobes: DVec3, way: DVec3, density: f64) -> DVec3 {
    let others = scattered_densities(bsdf, way);
    let [diffuse, facets] = others.to_array().map(|other| density / (density + other));
    let second = if is_both_diffuse(bsdf.material.model) { diffuse } else { facets };
    lobes * DVec3::new(diffuse, second, facets)
}

/// A sample of the light that passes a body: refracted, or mirrored where nothing is refracted (Snell). Nothing else samples
/// it.
fn passed(
    bsdf: &Bsdf<'_>,
    surface: &Surface,
    found: &MetallicRoughness,
    carried: DVec3,
    square: DVec2,
    ratio: f64,
) -> Scattered {
    let alpha = if found.alpha > SMOOTH_ALPHA { found.alpha } else { 0.0 };
    let direction = bsdf.direction;
    let facet =
        if alpha > 0.0 { visible_normal(direction, bsdf.normal, alpha, square) } else { surface.normal };
    let through = straight_behind(direction, facet, ratio) > 0.0;
    let (way, _) = bounced_way(direction, facet, surface, ratio, !through);
    let outward = if through { -way } else { way };
    let leaving = outward.dot(surface.normal) / outward.length();
    let seen = (-direction.dot(surface.normal) / direction.length()).max(0.0);
    let unmasked = match through {
        _ if alpha <= 0.0 => 1.0,
        true => smith_g1_refracted(leaving, alpha),
        false => smith_g2_over_g1(seen, leaving, alpha),
    };
    Scattered {
        direction: way,
        weight: carried * found.transmitted * unmasked,
        density: 0.0,
        alpha,
        diffuse: false,
        occluded: false,
        leaves: (alpha <= 0.0 || leaving > 0.0) && outward.dot(surface.geometric_normal) > 0.0,
        through,
        facet,
    }
}

/// A sample of the ways by which a lit surface reflects what is around it, or lets it through. Its normal is towards the ray;
/// `ratio` of refractive indices, before over behind.
pub fn scattered(
    bsdf: &Bsdf<'_>,
    surface: &Surface,
    color: DVec3,
    carried: DVec3,
    dimensions: &SampleDimensions,
    to_sky: bool,
    ratio: f64,
) -> Scattered {
    let mut square = unit_square(dimensions.lobe);
    let passing = passing_share(bsdf, to_sky);
    let passes_body = square.x < passing;
    let kept = if passes_body {
        square.x / passing.max(1e-6)
    } else {
        (square.x - passing) / (1.0 - passing).max(1e-6)
    };
    square.x = kept.min(1.0 - 1.0 / 16_777_216.0);
    if let (Some(found), true) = (&bsdf.facets, passes_body) {
        let next = passed(bsdf, surface, found, carried, square, ratio);
        return Scattered { weight: next.weight / passing.max(1e-6), ..next };
    }
    let next = mirrored_or_diffuse(bsdf, surface, color, carried, square, to_sky);
    Scattered {
        weight: next.weight / (1.0 - passing).max(1e-6),
        density: next.density * (1.0 - passing),
        ..next
    }
}

/// A sample of the ways by which a lit surface reflects what is around it.
fn mirrored_or_diffuse(
    bsdf: &Bsdf<'_>,
    surface: &Surface,
    color: DVec3,
    carried: DVec3,
    mut square: DVec2,
    to_sky: bool,
) -> Scattered {
    let facets = facet_bounces(bsdf, to_sky);
    let by_facet = square.x < facets;
    // The choice leaves a number that is uniform again.
    square.x =
        if by_facet { square.x / facets.max(1e-6) } else { (square.x - facets) / (1.0 - facets).max(1e-6) };
    square.x = square.x.min(1.0 - 1.0 / 16_777_216.0);
    let n = bsdf.normal;
    let disc = concentric_disc(square);
    let way = around(n, disc.extend((1.0 - disc.length_squared()).max(0.0).sqrt()));
    let above = surface.geometric_normal;
    if bsdf.material.model == Model::Phong && by_facet {
        let exponent = f64::from(bsdf.material.exponent);
        let highlight = sampled_highlight(bsdf.mirror, disc, exponent);
        let cosine = n.dot(highlight);
        let gain = (exponent + 2.0) / (exponent + 1.0) * cosine.max(0.0) / facets.max(1e-6);
        return Scattered {
            direction: highlight,
            weight: carried * bsdf.material.specular.as_dvec3() * gain,
            density: facets * highlight_density(bsdf.mirror, highlight, exponent),
            alpha: (2.0 / (exponent + 2.0)).sqrt(),
            diffuse: true,
            occluded: false,
            leaves: cosine > 0.0 && highlight.dot(above) > 0.0,
            through: false,
            facet: surface.normal,
        };
    }
    if let (Some(found), true) = (&bsdf.facets, by_facet) {
        let facet = visible_normal(bsdf.direction, n, found.alpha, square);
        let view = -bsdf.direction.normalize();
        let mirror = mirrored(-view, facet);
        let leaving = n.dot(mirror);
        let rise = schlick(view.dot(facet));
        let passes =
            smith_g2_over_g1(n.dot(view).max(1e-4), leaving.max(1e-6), found.alpha) / facets.max(1e-6);
        let density = facets * mirrored_density(n, bsdf.direction, mirror, found.alpha);
        return Scattered {
            direction: mirror,
            weight: carried * (found.head_on * (1.0 - rise) + found.grazing * rise) * passes,
            density: if to_sky { density } else { 0.0 },
            alpha: found.alpha,
            diffuse: false,
            occluded: false,
            leaves: leaving > 0.0 && mirror.dot(above) > 0.0,
            through: false,
            facet: surface.normal,
        };
    }
    let lobes = evaluate(bsdf, way);
    let second = if is_both_diffuse(bsdf.material.model) { lobes.y } else { 0.0 };
    let lit = Lit { first: DVec3::splat(lobes.x), second: DVec3::splat(second), third: DVec3::ZERO };
    debug_assert!(to_sky || is_glossy(bsdf.material.model));
    Scattered {
        direction: way,
        weight: reflected(bsdf, color, carried, lit) / (1.0 - facets).max(1e-6),
        density: (1.0 - facets) * n.dot(way).max(0.0) / PI,
        alpha: 1.0,
        diffuse: true,
        occluded: true,
        leaves: way.dot(above) > 0.0,
        through: false,
        facet: surface.normal,
    }
}
