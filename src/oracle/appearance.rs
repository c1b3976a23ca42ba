//! What a material looks like at a hit: its colour, times its texture and that of the vertices, and what its other maps
//! say. Twin of `glsl/shared/appearance.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::bsdf::mirror::mirrored;
use super::camera::Ray;
use super::filter::sample_texture;
use super::footprint::{Footprint, mirrored_change};
use super::geometry::hit::Surface;
use super::geometry::mesh_tests::mesh_texel;
use super::mapping::{Coordinate, MapInput, texture_coordinate};
use super::material_maps::{Appearance, TextureUse, apply_map, use_of};
use super::math::any_tangent;
use super::shading_normal::consistent_normal;
use crate::pack::{EntityKind, PackedScene};
use crate::scene::model::BumpKind;
use crate::schema::constants::SECOND_UV_BUMP;
use crate::schema::enums::{AlphaMode, MaterialMap};
use crate::schema::layout::{MapUv, Material, NO_TEXTURE, UvProjection};

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

/// Returns the surface with coordinates that a map has for itself.
fn at_own_uv(scene: &PackedScene, own: &MapUv, surface: &Surface) -> Surface {
    let seen = &surface.attributes;
    let at = seen.uv_texel + 2 * own.set;
    let [first, second] =
        [at, at + 1].map(|at| mesh_texel(scene, at).map(|word| f64::from(f32::from_bits(word))));
    let u = DVec3::new(first[0], first[1], first[2]);
    let v = DVec3::new(first[3], second[0], second[1]);
    let uv = DVec2::new(seen.weights.dot(u), seen.weights.dot(v));
    let [wa, wb, wc] = seen.weight_gradients;
    let [along_u, along_v] = [u, v].map(|value| wa * value.x + wb * value.y + wc * value.z);
    Surface {
        own_uv: DVec2::new(own.row_u.dot(uv), own.row_v.dot(uv)) + own.offset,
        own_gradients: [own.row_u, own.row_v].map(|row| row.x * along_u + row.y * along_v),
        ..*surface
    }
}

/// Returns the surface with the texture coordinates of one of the material's maps in place of its own.
pub fn at_uv_of(scene: &PackedScene, material: &Material, map_bit: u32, surface: &Surface) -> Surface {
    let attributes = &surface.attributes;
    if material.second_uv_maps & map_bit != 0 {
        return Surface {
            own_uv: attributes.second_uv,
            own_gradients: attributes.second_gradients,
            ..*surface
        };
    }
    if material.own_uv_maps & map_bit != 0 && attributes.uv_texel != 0 {
        let place = material.first_map_uv + (material.own_uv_maps & (map_bit - 1)).count_ones();
        return at_own_uv(scene, &scene.records.map_uvs[place as usize], surface);
    }
    *surface
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
    sample_texture(scene, image, &scene.records.samplers[material.bump_sampler_index as usize], c, random)
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
    let surface = &at_uv_of(scene, material, SECOND_UV_BUMP, surface);
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
        let tangent = surface.attributes.tangent;
        if tangent.w != 0.0 {
            let bitangent = n.cross(tangent.truncate()) * tangent.w;
            n * m.z + (tangent.truncate() * m.x - bitangent * m.y) * strength
        } else {
            let t = v.cross(n).normalize_or_zero();
            let b = n.cross(u).normalize_or_zero();
            n * m.z + (t * m.x + b * m.y) * strength * handed
        }
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

/// Returns what is read of a texture of the material; `None` without one.
fn read(
    scene: &PackedScene,
    material: &Material,
    texture: &TextureUse,
    map: Option<&UvProjection>,
    at: (&Ray, &Surface, &Footprint),
    random: [u32; 2],
) -> Option<DVec4> {
    let (ray, surface, print) = at;
    let map = map.filter(|_| texture.texture_index != NO_TEXTURE)?;
    let shown = at_uv_of(scene, material, texture.second_uv, surface);
    let c = texture_coordinate(map, &map_input(map, ray, &shown, print));
    let records = &scene.records;
    let image = &records.textures[texture.texture_index as usize];
    Some(sample_texture(scene, image, &records.samplers[texture.sampler_index as usize], &c, random))
}

/// Returns the share of a ray's light that a surface has, by what alpha means. A surface without a back lets rays pass
/// that come from behind it.
pub fn covered_share(material: &Material, surface: &Surface, alpha: f64) -> f64 {
    if material.one_sided && surface.inside { 0.0 } else { alpha_share(material, alpha) }
}

fn alpha_share(material: &Material, alpha: f64) -> f64 {
    match material.alpha_mode {
        AlphaMode::Opaque => 1.0,
        AlphaMode::Mask => f64::from(alpha >= f64::from(material.alpha_cutoff)),
        AlphaMode::Blend => alpha.min(1.0),
    }
}

/// Returns what the material looks like.
pub fn appearance(
    scene: &PackedScene,
    material: &Material,
    map: Option<&UvProjection>,
    at: (&Ray, &Surface, &Footprint),
    random: [u32; 2],
) -> Appearance {
    let vertex = at.1.attributes.color;
    let opacity = f64::from(material.opacity) * vertex.w;
    let texture = |map_of| use_of(material, map_of);
    let sampled = |map_of| read(scene, material, &texture(map_of), map, at, random);
    let texel = sampled(MaterialMap::Mask).unwrap_or(DVec4::ONE);
    let mut look = Appearance {
        color: material.color.as_dvec3() * vertex.truncate() * texel.truncate(),
        opacity: opacity * texel.w,
        metallic: material.metallic.into(),
        roughness: material.roughness.into(),
        emission: material.emission.as_dvec3(),
        occlusion: 1.0,
        dielectric: material.specular.as_dvec3(),
        edge: material.edge.into(),
        transmission: material.transmission.into(),
    };
    for &map_of in MaterialMap::ALL.iter().filter(|map_of| **map_of != MaterialMap::Mask) {
        if let Some(texel) = sampled(map_of) {
            apply_map(map_of, texel, material, &mut look);
        }
    }
    if material.alpha_mode == AlphaMode::Mask {
        let point = (at.0, at.1, &Footprint::default());
        let texel = read(scene, material, &texture(MaterialMap::Mask), map, point, random);
        look.opacity = opacity * texel.map_or(1.0, |texel| texel.w);
    }
    look
}

/// Returns the share of a shadow ray's light that a surface has: without a footprint, and on both of its sides.
pub fn opacity_at(
    scene: &PackedScene,
    material: &Material,
    map: Option<&UvProjection>,
    ray: &Ray,
    surface: &Surface,
    random: [u32; 2],
) -> f64 {
    let at = (ray, surface, &Footprint::default());
    let texel = read(scene, material, &use_of(material, MaterialMap::Mask), map, at, random);
    let alpha = f64::from(material.opacity) * surface.attributes.color.w * texel.map_or(1.0, |texel| texel.w);
    alpha_share(material, alpha)
}
