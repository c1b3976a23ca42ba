//! Cone → radiance, deterministically. Twin of `glsl/shared/cone_shade.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::appearance::{appearance, bumped_normal};
use super::bsdf::dielectric::refracted;
use super::bsdf::mirror::mirrored;
use super::bsdf::specular::{index_ratio, mirrored_share};
use super::bsdf::{Lit, bsdf_at, emitted, evaluate, is_lit, is_specular, reflected};
use super::camera::{Ray, camera_ray};
use super::cone::{Cone, cone_of};
use super::coverage::{Covered, MIN_SHARE};
use super::footprint::{
    Footprint, Meeting, RayDifferential, camera_differential, endless_footprint, footprint_at,
    reflected_differential, refracted_differential,
};
use super::fragments::{collect_fragments, composite};
use super::geometry::cones::{is_concave, leaving, left_shape, meet};
use super::geometry::hit::{FAR, Hit, Surface};
use super::geometry::rays::{hit_surface, offset_origin};
use super::light::punctual_share;
use super::material_maps::Appearance;
use super::shading_normal::{consistent_normal, on_its_side};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::{Light, Material, NO_MATERIAL, NO_SHAPE};

/// Most pending cones, most cones per pixel, and the least weight of a cone. Anything beyond is dropped.
const MAX_WAITING: usize = 32;
const MAX_CONES: u32 = 64;
const MIN_WEIGHT: f64 = 1.0 / 1024.0;

/// The purpose of a cone.
#[derive(Clone, Copy, Debug)]
enum Goal {
    /// The colour that it sees, after this number of bounces.
    Color(u32),
    /// The visibility of a light up to this t; the weight is the light's contribution.
    Light(f64),
}

/// A pending cone.
#[derive(Clone, Copy, Debug)]
struct Branch {
    ray: Ray,
    width: f64,
    spread: f64,
    weight: DVec3,
    skip: u32,
    goal: Goal,
}

#[derive(Default)]
struct Waiting {
    list: Vec<Branch>,
    /// Sum of the dropped weights.
    dropped: f64,
}

/// Returns the largest absolute value of a channel; NaN and infinity count as 1, so that they stay visible.
fn largest(v: DVec3) -> f64 {
    if v.is_finite() { v.abs().max_element() } else { 1.0 }
}

impl Waiting {
    fn send(&mut self, branch: Branch) {
        if self.list.len() == MAX_WAITING {
            self.dropped += largest(branch.weight);
        } else {
            self.list.push(branch);
        }
    }
}

fn cone_beam(branch: &Branch) -> RayDifferential {
    RayDifferential { width: branch.width, spread: branch.spread, ..RayDifferential::default() }
}

/// The intersection of a part of a cone with a shape.
struct Met<'a> {
    hit: Hit,
    surface: Surface,
    print: Footprint,
    material: &'a Material,
    /// The surface's colour, and the weight before it.
    look: Appearance,
    carried: DVec3,
}

/// Returns the contribution of an unoccluded light by way of a surface, and the cone that tests its
/// visibility.
fn lit_branch(scene: &PackedScene, branch: &Branch, met: &Met<'_>, skip: u32, light: &Light) -> Branch {
    let Met { surface, material, .. } = met;
    let point_light = matches!(light.kind, LightKind::Point | LightKind::Spot);
    let way = if point_light { light.position - surface.point } else { light.direction };
    let length = way.length();
    let facing = surface.normal.dot(way);
    let above = surface.geometric_normal.dot(way);
    let shines = facing > 0.0 && above > 0.0;
    let share = if point_light { facing / length.powi(3) } else { facing };
    let share = if point_light { share * punctual_share(light, way) } else { share };
    let more = light.power.as_dvec3() * (if shines { share } else { 0.0 } / PI);
    let bsdf = bsdf_at(scene, material, &met.look, surface.normal, branch.ray.direction);
    let lobes = evaluate(&bsdf, way);
    let lit = Lit { first: more * lobes.x, second: more * lobes.y, third: more * lobes.z };
    let seen = reflected(&bsdf, branch.weight, met.carried, lit);
    let origin = offset_origin(surface.point, surface.geometric_normal, surface.size);
    let direction = if point_light { light.position - origin } else { light.direction };
    let area = met.print.point[0].cross(met.print.point[1]).length();
    let width = (area * above.max(0.0) / length).sqrt();
    let (spread, t_max) = if point_light { (-width, 1.0) } else { (0.0, FAR) };
    Branch {
        ray: Ray { origin, direction, time: 0.0 },
        width,
        spread,
        weight: seen,
        skip,
        goal: Goal::Light(t_max),
    }
}

/// Returns the cone reflected by a mirror or glass, or refracted if `through`.
fn bent_branch(branch: &Branch, met: &Met<'_>, ratio: f64, share: f64, skip: u32, through: bool) -> Branch {
    let surface = &met.surface;
    let beam = cone_beam(branch);
    let meeting = Meeting {
        ray: branch.ray,
        t: met.hit.t,
        print: met.print,
        normal: surface.normal,
        shape_operator: surface.shape_operator,
        curvature: surface.curvature,
    };
    let direction = branch.ray.direction;
    let (beam, direction, side) = if through {
        let way = refracted(direction, surface.normal, ratio);
        let way = on_its_side(direction, way, -surface.normal, -surface.geometric_normal);
        (refracted_differential(&beam, &meeting, ratio), way, -1.0)
    } else {
        (reflected_differential(&beam, &meeting), mirrored(direction, surface.normal), 1.0)
    };
    let origin = offset_origin(surface.point, side * surface.geometric_normal, surface.size);
    let depth = if let Goal::Color(depth) = branch.goal { depth + 1 } else { 0 };
    Branch {
        ray: Ray { origin, direction, time: 0.0 },
        width: beam.width,
        spread: beam.spread,
        weight: branch.weight * share,
        skip,
        goal: Goal::Color(depth),
    }
}

/// Returns the radiance of a part of a cone: of a shape, or of the background behind all shapes.
fn shade_part(waiting: &mut Waiting, scene: &PackedScene, mut branch: Branch, shape: u32) -> DVec3 {
    let header = &scene.header;
    let ray = branch.ray;
    let beam = cone_beam(&branch);
    if shape == NO_SHAPE {
        if header.environment_material == NO_MATERIAL {
            return branch.weight * header.background.as_dvec3();
        }
        let material = &scene.records.materials[header.environment_material as usize];
        let map = &scene.records.uv_projections[header.environment_projection as usize];
        let print = endless_footprint(header, &beam, &ray);
        let nowhere = Surface::default();
        let look = appearance(scene, material, Some(map), (&ray, &nowhere, &print), [0; 2]);
        return branch.weight * look.color;
    }
    let hit = meet(scene, &ray, shape);
    // Cones know no outline of a concave shape, so that the ray may pass it.
    if hit.t <= 0.0 && is_concave(scene, shape) {
        return branch.weight * header.background.as_dvec3();
    }
    let mut surface = hit_surface(scene, &ray, &hit);
    let print = footprint_at(header, &beam, &ray, hit.t, surface.geometric_normal);
    let material = &scene.records.materials[surface.material as usize];
    let map = scene.records.uv_projections.get(surface.map as usize);
    if let Some(map) = map {
        surface.normal = bumped_normal(scene, material, map, (&ray, &surface, &print), [0; 2]);
    }
    let carried = branch.weight;
    let look = appearance(scene, material, map, (&ray, &surface, &print), [0; 2]);
    branch.weight *= look.color;
    let emission = carried * look.emission;
    let inside = surface.inside;
    if is_specular(material.model) {
        consistent_normal(ray.direction, &mut surface);
    }
    let met = Met { hit, surface, print, material, look, carried };
    if !is_lit(material.model) && !is_specular(material.model) {
        return emission + emitted(material.model, branch.weight);
    }
    if is_lit(material.model) {
        for light in &scene.records.lights {
            let next = lit_branch(scene, &branch, &met, left_shape(scene, shape, inside), light);
            if largest(next.weight) > 0.0 {
                waiting.send(next);
            }
        }
        return emission;
    }
    if matches!(branch.goal, Goal::Color(depth) if depth >= header.max_depth) {
        return emission;
    }
    let ratio = index_ratio(material, inside);
    let back = mirrored_share(material, ray.direction, surface.normal, ratio);
    // The refracted cone first, then the reflected one, which as the last on the stack is traced first.
    for (through, share) in [(true, 1.0 - back), (false, back)] {
        let skip = left_shape(scene, shape, inside != through);
        let next = bent_branch(&branch, &met, ratio, share, skip, through);
        let weight = largest(next.weight);
        if weight >= MIN_WEIGHT {
            waiting.send(next);
        } else {
            waiting.dropped += weight;
        }
    }
    emission
}

/// Returns the part of a branch that is visible around `covered.center` of its cone.
fn part_of(branch: &Branch, cone: &Cone, covered: Covered, norm: f64) -> Branch {
    let side = covered.share.sqrt();
    Branch {
        ray: cone.ray_at(covered.center),
        width: branch.width * side,
        spread: branch.spread * side,
        weight: branch.weight * covered.share * norm,
        ..*branch
    }
}

/// Returns the radiance of the cone around a camera ray, and the weight that was dropped.
pub fn trace_cone(scene: &PackedScene, ray: Ray, beam: RayDifferential) -> (DVec3, f64) {
    let first = Branch {
        ray,
        width: beam.width,
        spread: beam.spread,
        weight: DVec3::ONE,
        skip: NO_SHAPE,
        goal: Goal::Color(0),
    };
    let mut waiting = Waiting { list: vec![first], dropped: 0.0 };
    let mut sum = DVec3::ZERO;
    for _ in 0..MAX_CONES {
        let Some(branch) = waiting.list.pop() else { break };
        let from_camera = matches!(branch.goal, Goal::Color(0));
        let across = if from_camera { scene.header.step_x } else { DVec3::ZERO };
        let cone = cone_of(branch.ray, branch.width, branch.spread, across);
        let cone = leaving(scene, cone, branch.skip);
        let t_max = if let Goal::Light(t_max) = branch.goal { t_max } else { FAR };
        let mut fragments = collect_fragments(scene, &cone, branch.skip, t_max);
        let mut rest = composite(&mut fragments, scene, &cone);
        if let Goal::Light(_) = branch.goal {
            sum += branch.weight * rest.share * fragments.clear;
            continue;
        }
        // Fragments that were kept represent those that were not.
        let replaced = rest.share * (1.0 - fragments.clear);
        let norm = 1.0 + replaced / (1.0 - rest.share).max(MIN_SHARE);
        waiting.dropped += largest(branch.weight) * replaced;
        rest.share -= replaced;
        for fragment in fragments.list.iter().filter(|p| p.seen > 0.0) {
            let part = Covered { share: fragment.seen, center: fragment.center };
            sum += shade_part(&mut waiting, scene, part_of(&branch, &cone, part, norm), fragment.shape);
        }
        if rest.share > 0.0 {
            sum += shade_part(&mut waiting, scene, part_of(&branch, &cone, rest, 1.0), NO_SHAPE);
        }
    }
    let left: f64 = waiting.list.iter().map(|b| largest(b.weight)).sum();
    (sum, waiting.dropped + left)
}

/// Returns the radiance of pixel (x, y) of the film, and the dropped weight.
pub fn pixel(scene: &PackedScene, x: u32, y: u32) -> (DVec3, f64) {
    const MIDDLE: DVec2 = DVec2::splat(0.5);
    let header = &scene.header;
    let ray = camera_ray(header, [x + header.crop.x, y + header.crop.y], MIDDLE);
    trace_cone(scene, ray, camera_differential(header, &ray))
}
