//! Ray → radiance, one hit of the path at a time. Twin of `glsl/shared/shade.glsl`.

use glam::DVec3;

use super::appearance::{appearance, bumped_normal, covered_share};
use super::bsdf::facets::widened_differential;
use super::bsdf::metallic_roughness::mirrored_density;
use super::bsdf::scattering::scattered;
use super::bsdf::specular::{index_ratio, sample_bsdf};
use super::bsdf::{Bsdf, bsdf_at, emitted, is_glossy, is_lit, is_rough_mirror, is_specular, reflected};
use super::camera::Ray;
use super::environment::sky_density;
use super::footprint::{
    Footprint, Meeting, RayDifferential, endless_footprint, footprint_at, is_filtered,
    reflected_differential, refracted_differential,
};
use super::geometry::hit::{Hit, Surface};
use super::geometry::rays::{hit_surface, nearest_hit, offset_origin};
use super::light::{Directions, direct_light, is_lit_by_environment};
use super::patterns::Points;
use super::quantities::measured;
use super::rng::pcg2d;
use super::sample_dimensions::{SampleDimensions, choose, chosen_light, unit_line};
use super::shading_normal::consistent_normal;
use crate::pack::PackedScene;
use crate::schema::constants::MAX_LAYERS;
use crate::schema::enums::Quantity;
use crate::schema::layout::{Material, NO_MATERIAL, NO_SHAPE};

/// A path between two hits: the ray, its width, the path's throughput, and the shape that it leaves.
#[derive(Clone)]
pub struct Path {
    pub ray: Ray,
    pub beam: RayDifferential,
    pub throughput: DVec3,
    /// Random bits for stochastic look-ups at the next hit.
    pub random: [u32; 2],
    pub skip: u32,
    pub depth: u32,
    /// False if the path has ended.
    pub is_alive: bool,
    /// Surfaces that it has passed by their alpha.
    pub layers: u32,
    /// Density of the ray, where the environment's light is sampled by other means as well; else 0.
    pub density: f64,
    /// True if the environment alone counts.
    pub diffuse: bool,
    /// The pixel's point set and the sample; `None` uses the middle in every dimension.
    pub points: Option<(Points, u32)>,
}

pub fn camera_path(ray: Ray, beam: RayDifferential, random: [u32; 2]) -> Path {
    let throughput = DVec3::ONE;
    Path {
        ray,
        beam,
        throughput,
        random,
        skip: NO_SHAPE,
        depth: 0,
        is_alive: true,
        layers: 0,
        density: 0.0,
        diffuse: false,
        points: None,
    }
}

/// Continues a reflected or refracted path; returns false if the material ends it.
fn bounced(
    scene: &PackedScene,
    hit: &Hit,
    mut surface: Surface,
    print: Footprint,
    material: &Material,
    dimensions: &SampleDimensions,
    path: &mut Path,
) -> bool {
    if !is_specular(material.model) {
        return false;
    }
    let header = &scene.header;
    let direction = path.ray.direction;
    consistent_normal(direction, &mut surface);
    let bounce = sample_bsdf(material, &surface, direction, dimensions);
    let meeting = Meeting {
        ray: path.ray,
        t: hit.t,
        print,
        normal: bounce.normal,
        shape_operator: surface.shape_operator,
        curvature: surface.curvature,
    };
    let normal = if bounce.mirrored { surface.geometric_normal } else { -surface.geometric_normal };
    let origin = offset_origin(surface.point, normal, surface.size);
    path.ray = Ray { origin, direction: bounce.direction, time: path.ray.time };
    // Where nothing is seen from the surface by itself, no light is sampled.
    path.density = if is_rough_mirror(material) && is_lit_by_environment(scene) && !bounce.is_raised {
        mirrored_density(surface.normal, direction, bounce.direction, bounce.alpha)
    } else {
        0.0
    };
    path.beam = if bounce.mirrored {
        reflected_differential(&path.beam, &meeting)
    } else {
        refracted_differential(&path.beam, &meeting, bounce.ratio)
    };
    if bounce.alpha > 0.0 {
        path.throughput *= if bounce.leaves { bounce.weight } else { 0.0 };
        path.beam = widened_differential(header, &path.beam, path.ray.direction, bounce.alpha);
    }
    bounce.leaves
}

/// Continues a path at a lit surface that reflects what is around it; returns false if it ends there.
fn goes_on(
    scene: &PackedScene,
    at: (&Hit, Surface, Footprint),
    bsdf: &Bsdf<'_>,
    carried: DVec3,
    occlusion: f64,
    dimensions: &SampleDimensions,
    path: &mut Path,
) -> bool {
    let (hit, mut surface, print) = at;
    let to_sky = is_lit_by_environment(scene);
    if !is_glossy(bsdf.material.model) && !to_sky {
        return false;
    }
    let ray = path.ray;
    consistent_normal(ray.direction, &mut surface);
    let bsdf = Bsdf { normal: surface.normal, ..*bsdf };
    let ratio = index_ratio(bsdf.material, surface.inside);
    let next = scattered(&bsdf, &surface, path.throughput, carried, dimensions, to_sky, ratio);
    path.throughput = if next.occluded { next.weight * occlusion } else { next.weight };
    (path.density, path.diffuse) = (next.density, next.diffuse);
    let side = if next.through { -surface.geometric_normal } else { surface.geometric_normal };
    let origin = offset_origin(surface.point, side, surface.size);
    path.ray = Ray { origin, direction: next.direction, time: ray.time };
    let meeting = Meeting {
        ray,
        t: hit.t,
        print,
        normal: surface.normal,
        shape_operator: surface.shape_operator,
        curvature: surface.curvature,
    };
    let beam = if next.through {
        refracted_differential(&path.beam, &Meeting { normal: next.facet, ..meeting }, ratio)
    } else {
        reflected_differential(&path.beam, &meeting)
    };
    path.beam = widened_differential(&scene.header, &beam, next.direction, next.alpha);
    next.leaves
}

/// Continues a path straight behind a surface that lets some of its light pass.
fn passes(hit: &Hit, surface: &Surface, print: Footprint, path: &mut Path) {
    let ray = path.ray;
    path.ray.origin = offset_origin(surface.point, -surface.geometric_normal, surface.size);
    path.layers += 1;
    let normal = surface.geometric_normal;
    let meeting =
        Meeting { ray, t: hit.t, print, normal, shape_operator: Default::default(), curvature: 0.0 };
    path.beam = refracted_differential(&path.beam, &meeting, 1.0);
}

/// Returns a number in [0, 1) by which a sample passes a surface or not.
fn layer_choice(path: &Path) -> f64 {
    unit_line(pcg2d(path.random.map(|bits| bits ^ 0xA511_E9B3))[0] >> 8)
}

/// Returns the share with which the environment's light counts that a ray meets by chance.
fn sky_weight(scene: &PackedScene, path: &Path) -> f64 {
    if path.density <= 0.0 {
        return 1.0;
    }
    path.density / (path.density + sky_density(scene, path.ray.direction))
}

/// Returns the radiance of a ray that hits nothing.
fn background(scene: &PackedScene, path: &Path) -> DVec3 {
    let header = &scene.header;
    let throughput = path.throughput * sky_weight(scene, path);
    if header.environment_material == NO_MATERIAL {
        return throughput * header.background.as_dvec3();
    }
    let material = &scene.records.materials[header.environment_material as usize];
    let map = &scene.records.uv_projections[header.environment_projection as usize];
    let print = if is_filtered(header) {
        endless_footprint(header, &path.beam, &path.ray)
    } else {
        Footprint::default()
    };
    let nowhere = Surface::default();
    throughput * appearance(scene, material, Some(map), (&path.ray, &nowhere, &print), path.random).color
}

/// Follows the path to its next hit; returns the radiance that it adds to the sample.
pub fn advance(scene: &PackedScene, path: &mut Path) -> DVec3 {
    if scene.header.quantity != Quantity::Radiance {
        path.is_alive = false;
        return measured(scene, &path.ray, &path.beam, path.skip, path.random);
    }
    let hit = nearest_hit(scene, &path.ray, path.skip);
    path.is_alive = false;
    if hit.shape == NO_SHAPE {
        return background(scene, path);
    }
    let header = &scene.header;
    let dimensions = match &path.points {
        Some((points, s)) => choose(header, points, *s, path.depth, false),
        None => SampleDimensions::MIDDLE,
    };
    let mut surface = hit_surface(scene, &path.ray, &hit);
    let print = if is_filtered(header) {
        footprint_at(header, &path.beam, &path.ray, hit.t, surface.geometric_normal)
    } else {
        Footprint::default()
    };
    let material = &scene.records.materials[surface.material as usize];
    let map = scene.records.uv_projections.get(surface.map as usize);
    let ray = path.ray;
    if let Some(map) = map {
        surface.normal = bumped_normal(scene, material, map, (&ray, &surface, &print), path.random);
    }
    let look = appearance(scene, material, map, (&ray, &surface, &print), path.random);
    let before = path.clone();
    let continues = path.depth < header.max_depth;
    let color = path.throughput * look.color;
    path.throughput = color;
    let mut is_alive = bounced(scene, &hit, surface, print, material, &dimensions, path);
    let mut seen = emitted(material.model, color);
    let mirrors = continues && is_rough_mirror(material) && is_lit_by_environment(scene);
    if is_lit(material.model) || mirrors {
        if mirrors {
            consistent_normal(ray.direction, &mut surface);
        }
        let bsdf = bsdf_at(scene, material, &look, surface.normal, ray.direction);
        if !mirrors {
            is_alive = goes_on(
                scene,
                (&hit, surface, print),
                &bsdf,
                before.throughput,
                look.occlusion,
                &dimensions,
                path,
            );
        }
        let points = before.points.as_ref().map(|(points, _)| points);
        let lit = direct_light(
            scene,
            &surface,
            &Directions {
                time: ray.time,
                shape: hit.shape,
                occlusion: look.occlusion,
                continues,
                random: before.random,
                chosen: &|i| chosen_light(points, &dimensions, i),
            },
            &bsdf,
        );
        seen = reflected(&bsdf, color, before.throughput, lit);
    }
    seen += before.throughput * look.emission;
    if before.diffuse {
        (seen, is_alive) = (DVec3::ZERO, false);
    }
    let share = covered_share(material, &surface, look.opacity);
    seen *= share;
    // A surface that ends paths is passed by all of what it does not cover, others by a part of the samples.
    let splits = !is_alive || !continues;
    let has_passed = if splits { share < 1.0 } else { share <= layer_choice(&before) };
    if has_passed {
        *path = before.clone();
        path.throughput *= if splits { 1.0 - share } else { 1.0 };
        passes(&hit, &surface, print, path);
        is_alive = path.layers < MAX_LAYERS;
    }
    path.skip = hit.shape;
    path.is_alive = is_alive && (has_passed || path.depth < header.max_depth);
    path.depth += u32::from(!has_passed);
    path.random = pcg2d(path.random);
    seen
}
