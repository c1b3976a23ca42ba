//! Ray → radiance, one hit of the path at a time. Twin of `glsl/shared/shade.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::bsdf::facets::widened_differential;
use super::bsdf::mirror::mirrored;
use super::bsdf::specular::sample_bsdf;
use super::bsdf::{bsdf_at, emitted, is_lit, is_specular, reflected};
use super::camera::Ray;
use super::filter::sample_texture;
use super::footprint::{
    Footprint, Meeting, RayDifferential, any_tangent, endless_footprint, footprint_at, is_filtered,
    mirrored_change, reflected_differential, refracted_differential,
};
use super::geometry::hit::{Hit, Surface};
use super::geometry::rays::{hit_surface, nearest_hit, offset_origin};
use super::light::direct_light;
use super::mapping::{Coordinate, MapInput, texture_coordinate};
use super::patterns::Points;
use super::quantities::{LookUp, is_of_look_ups, look_up, look_up_quantity, surface_quantity};
use super::rng::pcg2d;
use super::sample_dimensions::{SampleDimensions, choose, chosen_light};
use super::shading_normal::consistent_normal;
use crate::pack::{EntityKind, PackedScene};
use crate::scene::model::BumpKind;
use crate::schema::enums::Quantity;
use crate::schema::layout::{Header, Material, NO_MATERIAL, NO_SHAPE, NO_TEXTURE, UvProjection};

/// Returns the inputs of the surface's mapping.
pub fn map_input(map: &UvProjection, ray: &Ray, surface: &Surface, print: &Footprint) -> MapInput {
    let own = |d: DVec3| DVec2::from_array(surface.own_gradients.map(|g| g.dot(d)));
    let mut seen = MapInput {
        entity: surface.at_rest,
        entity_change: print.point,
        own: surface.own_uv,
        own_change: print.point.map(own),
        gradients: false,
    };
    let bent = print.point.map(|d| surface.shape_operator * d);
    let (mut way, mut change) = (ray.direction, print.direction);
    match map.entity {
        EntityKind::Position => return seen,
        EntityKind::Normal => {
            (seen.entity, seen.entity_change) = (surface.normal, bent);
            return seen;
        }
        EntityKind::Reflection => {
            let mut mirror = *surface;
            consistent_normal(way, &mut mirror);
            let bent = print.point.map(|d| mirror.shape_operator * d);
            change = [0, 1].map(|i| mirrored_change(way, mirror.normal, change[i], bent[i]));
            way = mirrored(way, mirror.normal);
        }
        EntityKind::Direction => {}
    }
    // Of unit length; the change is perpendicular to it.
    let length = way.length();
    let unit = way / length;
    seen.entity = unit;
    seen.entity_change = change.map(|d| (d - unit.dot(d) * unit) / length);
    seen
}

/// Returns the gradients of u and v along the surface, from their changes along two tangents.
pub fn uv_gradients(map: &UvProjection, ray: &Ray, surface: &Surface) -> [DVec3; 2] {
    let n = surface.geometric_normal;
    let first = any_tangent(n);
    let second = n.cross(first);
    let print = Footprint { point: [first, second], direction: [DVec3::ZERO; 2] };
    let seen = MapInput { gradients: true, ..map_input(map, ray, surface, &print) };
    let [x, y] = texture_coordinate(map, &seen).change;
    [first * x.x + second * y.x, first * x.y + second * y.y]
}

/// Returns true for a map of normals, false for one of heights.
fn is_normal_map(material: &Material) -> bool {
    material.bump_kind.is_normal_map()
}

fn detail(scene: &PackedScene, material: &Material, c: &Coordinate, random: [u32; 2]) -> DVec4 {
    let image = &scene.records.textures[material.bump_texture_index as usize];
    sample_texture(scene, image, &scene.records.samplers[material.sampler_index as usize], c, random)
}

/// Returns the shading normal after the material's bump map.
pub fn bumped_normal(
    scene: &PackedScene,
    material: &Material,
    map: &UvProjection,
    at: (&Ray, &Surface, &Footprint),
    random: [u32; 2],
) -> DVec3 {
    let (ray, surface, print) = at;
    let texture = material.bump_texture_index;
    if texture == NO_TEXTURE {
        return surface.normal;
    }
    let side = if surface.inside { -1.0 } else { 1.0 };
    let n = side * surface.normal;
    let strength = f64::from(material.bump_strength);
    let [u, v] = uv_gradients(map, ray, surface);
    let c = texture_coordinate(map, &map_input(map, ray, surface, print));
    let result = if is_normal_map(material) {
        let handed = if u.cross(v).dot(n) < 0.0 { -1.0 } else { 1.0 };
        let mut m = 2.0 * detail(scene, material, &c, random).truncate() - 1.0;
        if material.bump_kind == BumpKind::NormalDown {
            m.y = -m.y;
        }
        let t = v.cross(n).normalize_or_zero();
        let b = n.cross(u).normalize_or_zero();
        n * m.z + (t * m.x + b * m.y) * strength * handed
    } else {
        let image = &scene.records.textures[texture as usize];
        let texel = DVec2::new(1.0 / f64::from(image.size.x), 1.0 / f64::from(image.size.y));
        let wide = 0.5 * c.change[0].abs().max(c.change[1].abs()).truncate();
        let step = texel.max(wide);
        let height = |x: f64, y: f64| {
            let at = c.at + DVec3::new(x, y, 0.0);
            detail(scene, material, &Coordinate { at, ..c }, random).x
        };
        let rise = DVec2::new(
            height(step.x, 0.0) - height(-step.x, 0.0),
            height(0.0, step.y) - height(0.0, -step.y),
        );
        let slope = 0.5 * strength * rise / step;
        n - slope.x * u - slope.y * v
    };
    side * result.try_normalize().unwrap_or(n)
}

/// Returns the material's colour, linear RGB, times its texture if it has one.
pub fn surface_color(
    scene: &PackedScene,
    material: &Material,
    map: Option<&UvProjection>,
    at: (&Ray, &Surface, &Footprint),
    random: [u32; 2],
) -> DVec3 {
    let color = material.color.as_dvec3();
    let (texture, sampler) = (material.texture_index, material.sampler_index);
    let (Some(map), true) = (map, texture != NO_TEXTURE) else { return color };
    let (ray, surface, print) = at;
    let c = texture_coordinate(map, &map_input(map, ray, surface, print));
    let image = &scene.records.textures[texture as usize];
    color * sample_texture(scene, image, &scene.records.samplers[sampler as usize], &c, random).truncate()
}

/// A path between two hits: the ray, its width, the path's throughput, and the shape that it leaves.
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
    /// The pixel's point set and the sample; `None` uses the middle in every dimension.
    pub points: Option<(Points, u32)>,
}

pub fn camera_path(ray: Ray, beam: RayDifferential, random: [u32; 2]) -> Path {
    let throughput = DVec3::ONE;
    Path { ray, beam, throughput, random, skip: NO_SHAPE, depth: 0, is_alive: true, points: None }
}

/// Continues a reflected or refracted path; returns false if the material ends it.
fn bounced(
    header: &Header,
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

/// What a camera ray meets first: a surface of the scene, or the environment.
pub struct FirstHit<'a> {
    /// None for the environment.
    pub hit: Option<Hit>,
    pub surface: Surface,
    material: &'a Material,
    map: Option<&'a UvProjection>,
    print: Footprint,
}

/// Returns what a ray meets; `None` for a background of one colour.
pub fn first_hit<'a>(scene: &'a PackedScene, path: &Path) -> Option<FirstHit<'a>> {
    let header = &scene.header;
    let hit = nearest_hit(scene, &path.ray, path.skip);
    if hit.shape == NO_SHAPE {
        let material = scene.records.materials.get(header.environment_material as usize)?;
        let map = scene.records.uv_projections.get(header.environment_projection as usize);
        let print = endless_footprint(header, &path.beam, &path.ray);
        let surface = Surface { material: header.environment_material, ..Surface::default() };
        return Some(FirstHit { hit: None, surface, material, map, print });
    }
    let surface = hit_surface(scene, &path.ray, &hit);
    let print = footprint_at(header, &path.beam, &path.ray, hit.t, surface.geometric_normal);
    let material = &scene.records.materials[surface.material as usize];
    let map = scene.records.uv_projections.get(surface.map as usize);
    Some(FirstHit { hit: Some(hit), surface, material, map, print })
}

impl<'a> FirstHit<'a> {
    /// Returns the look-up of the material's texture, if it has texels.
    pub fn look_up(&self, scene: &'a PackedScene, ray: &Ray) -> Option<LookUp<'a>> {
        let map = self.map?;
        let mapped = texture_coordinate(map, &map_input(map, ray, &self.surface, &self.print));
        look_up(scene, self.material, &mapped)
    }
}

/// Returns the quantity that samples measure in place of radiance.
fn measured(scene: &PackedScene, path: &Path) -> DVec3 {
    let quantity = scene.header.quantity;
    let Some(mut first) = first_hit(scene, path) else { return DVec3::ZERO };
    if is_of_look_ups(quantity) {
        let look_up = first.look_up(scene, &path.ray);
        return look_up.map_or(DVec3::ZERO, |look_up| look_up_quantity(quantity, &look_up));
    }
    let mut albedo = DVec3::ZERO;
    if matches!(quantity, Quantity::Albedo | Quantity::Normal) {
        let FirstHit { material, map, print, .. } = first;
        if let (Some(map), Some(_)) = (map, first.hit) {
            let at = (&path.ray, &first.surface, &print);
            first.surface.normal = bumped_normal(scene, material, map, at, path.random);
        }
        albedo = surface_color(scene, material, map, (&path.ray, &first.surface, &print), path.random);
    }
    surface_quantity(quantity, first.hit.as_ref(), &first.surface, albedo)
}

/// Returns the radiance of a ray that hits nothing.
fn background(scene: &PackedScene, path: &Path) -> DVec3 {
    let header = &scene.header;
    if header.environment_material == NO_MATERIAL {
        return path.throughput * header.background.as_dvec3();
    }
    let material = &scene.records.materials[header.environment_material as usize];
    let map = &scene.records.uv_projections[header.environment_projection as usize];
    let print = if is_filtered(header) {
        endless_footprint(header, &path.beam, &path.ray)
    } else {
        Footprint::default()
    };
    let nowhere = Surface::default();
    path.throughput * surface_color(scene, material, Some(map), (&path.ray, &nowhere, &print), path.random)
}

/// Follows the path to its next hit; returns the radiance that it adds to the sample.
pub fn advance(scene: &PackedScene, path: &mut Path) -> DVec3 {
    if scene.header.quantity != Quantity::Radiance {
        path.is_alive = false;
        return measured(scene, path);
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
    let carried = path.throughput;
    let albedo = surface_color(scene, material, map, (&ray, &surface, &print), path.random);
    path.throughput *= albedo;
    if is_lit(material.model) {
        let bsdf = bsdf_at(material, albedo, surface.normal, ray.direction);
        let points = path.points.as_ref().map(|(points, _)| points);
        let chosen = |i: u32| chosen_light(points, &dimensions, i);
        let lit = direct_light(scene, &surface, ray.time, hit.shape, &bsdf, &chosen);
        return reflected(&bsdf, path.throughput, carried, lit);
    }
    if !is_specular(material.model) {
        return emitted(material.model, path.throughput);
    }
    let is_alive = bounced(header, &hit, surface, print, material, &dimensions, path);
    path.skip = hit.shape;
    path.is_alive = is_alive && path.depth < header.max_depth;
    path.depth += 1;
    path.random = pcg2d(path.random);
    DVec3::ZERO
}
