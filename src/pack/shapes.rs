//! Planes, spheres and triangles → their device records, relative to the eye, each with its map; lights.

use glam::{DVec2, DVec3, DVec4};

use super::mapping::{self, Bounds, Place};
use super::{LightKind, MapKind, PackedScene, TextureKind, real4, vec4};
use crate::core::error::{Error, Result};
use crate::scene::model::{
    Entity, Light, Mapping, MappingKind, Material, Plane, Scene, Space, Sphere, Triangle,
};
use crate::schema::layout;
use crate::texture::sampler_spec::SamplerSpec;

pub fn pack_shapes(packed: &mut PackedScene, scene: &Scene) -> Result<()> {
    let eye = scene.camera.eye;
    for plane in &scene.planes {
        let record = pack_plane(packed, scene, plane, eye)?;
        packed.planes.push(record);
    }
    for sphere in &scene.spheres {
        let map = add_map(packed, scene, sphere.material, |mapping, sampler, flat| {
            let around_center = Mapping { origin: sphere.center, ..*mapping };
            let mapping = if mapping.kind == MappingKind::Surface { &around_center } else { mapping };
            let place = Place { centroid: Some(sphere.center), bounds: Some(sphere_bounds(sphere)) };
            mapping::projecting_map(mapping, sampler, eye, &place, flat)
        });
        packed.spheres.push(layout::Sphere {
            ball: real4((sphere.center - eye).extend(sphere.radius)),
            link: [sphere.material as u32, map, 0, 0],
        });
    }
    for triangle in &scene.triangles {
        let record = pack_triangle(packed, scene, triangle, eye);
        packed.triangles.push(record);
    }
    Ok(())
}

/// Rows u and v of the plane's own coordinates: p ↦ row·(p, 1) solves p + eye - origin =
/// u tangent + v bitangent, also for axes that are neither unit nor orthogonal: with n = t × b, u is
/// (p × b)·n / n² = p·(b × n) / n².
pub fn plane_rows(plane: &Plane, eye: DVec3) -> [DVec4; 2] {
    let (t, b) = (plane.tangent, plane.bitangent);
    let n = cross(t, b);
    let squared = n.length_squared();
    [cross(b, n) / squared, cross(n, t) / squared].map(|row| row.extend(row.dot(eye - plane.origin)))
}

/// a × b to two ulps of each component, however near to parallel (Kahan's difference of products; Jeannerod,
/// Louvet & Muller 2013).
pub fn cross(a: DVec3, b: DVec3) -> DVec3 {
    let difference = |a: f64, b: f64, c: f64, d: f64| {
        let cd = c * d;
        a.mul_add(b, -cd) + (-c).mul_add(d, cd)
    };
    DVec3::new(difference(a.y, b.z, a.z, b.y), difference(a.z, b.x, a.x, b.z), difference(a.x, b.y, a.y, b.x))
}

fn pack_plane(packed: &mut PackedScene, scene: &Scene, plane: &Plane, eye: DVec3) -> Result<layout::Plane> {
    let normal = cross(plane.tangent, plane.bitangent).normalize();
    let [u, v] = plane_rows(plane, eye);
    let bounds = plane.half_extent.map(|h| plane_bounds(plane, h));
    let material = &scene.materials[plane.material];
    if material.is_mapped() && material.mapping.space == Space::Bounds && bounds.is_none() {
        return Err(Error::with_help(
            format!(
                "material \"{}\": mapping in the space of the shape's box, on an infinite plane",
                material.name
            ),
            "give the plane a half_extent, or use space = \"world\"",
        ));
    }
    let place = Place { centroid: bounds.map(|_| plane.origin), bounds };
    if material.is_mapped() && material.mapping.entity == Entity::Centroid && place.centroid.is_none() {
        return Err(Error::with_help(
            format!(
                "material \"{}\": entity \"centroid\", on an infinite plane, which has none",
                material.name
            ),
            "give the plane a half_extent, or use entity \"position\" with an origin",
        ));
    }
    let map = add_map(packed, scene, plane.material, |mapping, sampler, flat| match mapping.kind {
        MappingKind::Surface => mapping::plane_map(mapping, sampler, DVec2::new(u.w, v.w)),
        _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
    });
    Ok(layout::Plane {
        normal: real4(normal.extend(normal.dot(plane.origin - eye))),
        axis_u: real4(u),
        axis_v: real4(v),
        // Of f64 until the numbers are rounded.
        link: {
            let [low, high] = layout::Plane::extent_words(plane.half_extent, true);
            [plane.material as u32, map, low, high]
        },
    })
}

fn pack_triangle(
    packed: &mut PackedScene,
    scene: &Scene,
    triangle: &Triangle,
    eye: DVec3,
) -> layout::Triangle {
    let [a, b, c] = triangle.vertices.map(|v| v - eye);
    let normal = cross(b - a, c - a).normalize();
    let material = &scene.materials[triangle.material];
    let uvs = vertex_uvs(triangle, material, &scene.sampler_of(material));
    let place = Place {
        centroid: Some(triangle.vertices.iter().sum::<DVec3>() / 3.0),
        bounds: Some(triangle_bounds(triangle)),
    };
    let map = add_map(packed, scene, triangle.material, |mapping, sampler, flat| match mapping.kind {
        MappingKind::Surface => {
            layout::UvProjection { link: [MapKind::VertexUv as u32, 0, 0, 0], ..Default::default() }
        }
        _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
    });
    let shading = triangle.normals.unwrap_or([normal; 3]).map(|n| real4(n.normalize().extend(0.0)));
    layout::Triangle {
        a: real4(a.extend(uvs[0].x)),
        b: real4(b.extend(uvs[1].x)),
        c: real4(c.extend(uvs[2].x)),
        v: real4(DVec4::new(uvs[0].y, uvs[1].y, uvs[2].y, f64::from(u8::from(triangle.normals.is_some())))),
        normal: real4(normal.extend(normal.dot(a))),
        normal_a: shading[0],
        normal_b: shading[1],
        normal_c: shading[2],
        link: [triangle.material as u32, map, 0, 0],
    }
}

/// The vertices' coordinates after scale, rotation and offset, with the whole tiles of the first
/// vertex taken out of all three.
fn vertex_uvs(triangle: &Triangle, material: &Material, sampler: &SamplerSpec) -> [DVec2; 3] {
    let matrix = mapping::uv_matrix(&material.mapping);
    let uvs = triangle.uvs.map(|uv| matrix * uv + material.mapping.offset);
    let whole = mapping::whole_tiles(uvs[0], mapping::periods(sampler));
    uvs.map(|uv| uv - whole)
}

/// The index of the shape's map; shapes without a texture share map 0, which they never read.
fn add_map(
    packed: &mut PackedScene,
    scene: &Scene,
    material: usize,
    make: impl Fn(&Mapping, &SamplerSpec, bool) -> layout::UvProjection,
) -> u32 {
    let material = &scene.materials[material];
    let Some(texture) = material.texture.or(material.bump.map(|r| r.texture)) else { return 0 };
    let kind = TextureKind::ALL[packed.textures[texture].link[3] as usize];
    let flat = matches!(kind, TextureKind::Flat | TextureKind::Procedural);
    packed.maps.push(make(&material.mapping, &scene.sampler_of(material), flat));
    packed.maps.len() as u32 - 1
}

fn sphere_bounds(sphere: &Sphere) -> Bounds {
    let reach = DVec3::splat(sphere.radius);
    Bounds { min: sphere.center - reach, max: sphere.center + reach }
}

fn plane_bounds(plane: &Plane, half_extent: f64) -> Bounds {
    let reach = half_extent * (plane.tangent.abs() + plane.bitangent.abs());
    Bounds { min: plane.origin - reach, max: plane.origin + reach }
}

fn triangle_bounds(triangle: &Triangle) -> Bounds {
    let [a, b, c] = triangle.vertices;
    Bounds { min: a.min(b).min(c), max: a.max(b).max(c) }
}

/// The largest cosine of sides that count as at right angles: what f32 rounds them to.
const RIGHT_ANGLE: f64 = 1e-6;

pub fn light(light: &Light, eye: DVec3) -> layout::Light {
    let record = |kind: LightKind, place: DVec4, power: DVec3| layout::Light {
        place: real4(place),
        power: vec4(power.extend(0.0)),
        link: [kind as u32, 0, 0, 0],
        ..Default::default()
    };
    match *light {
        Light::Point { position, intensity } => {
            record(LightKind::Point, (position - eye).extend(0.0), intensity)
        }
        Light::Directional { direction, irradiance } => {
            record(LightKind::Directional, direction.normalize().extend(0.0), irradiance)
        }
        Light::Sphere { position, radius, intensity } => {
            record(LightKind::Sphere, (position - eye).extend(radius), intensity)
        }
        Light::Rectangle { position, edge_u, edge_v, radiance } => {
            let wide = edge_u.length_squared() >= edge_v.length_squared();
            // The same rectangle, which shines to the same side.
            let sides = if wide { [edge_u, edge_v] } else { [edge_v, -edge_u] };
            let right = edge_u.normalize().dot(edge_v.normalize()).abs() <= RIGHT_ANGLE;
            let [edge_u, edge_v] = sides.map(|s| real4(s.extend(if right { s.length() } else { 0.0 })));
            layout::Light {
                edge_u,
                edge_v,
                ..record(LightKind::Rectangle, (position - eye).extend(0.0), radiance)
            }
        }
        Light::Sun { direction, angle, irradiance } => {
            // A cap of height h has the solid angle 2 pi h, and a surface that faces its middle receives
            // pi h (2 - h) of its radiance.
            let height = 2.0 * (0.25 * angle.to_radians()).sin().powi(2);
            let power = irradiance * (2.0 / (2.0 - height));
            record(LightKind::Sun, direction.normalize().extend(height), power)
        }
    }
}
