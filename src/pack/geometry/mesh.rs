//! Meshes → their records, and their trees, corners and attributes in the buffer of meshes; and how far f32 misplaces what
//! is seen of them.

use std::sync::Arc;

use glam::{DVec3, Vec3, Vec4};

use super::triangle::{corner_uvs, triangle_errors};
use super::{Rounded, add_map, cross, reach};
use crate::core::error::{Error, ErrorKind, Result};
use crate::pack::mapping::{self, Place};
use crate::pack::precision::{Camera, PART_OF_PIXEL, U};
use crate::pack::{MapKind, PackedScene};
use crate::scene::model::{Mapping, MappingKind, Mesh, Scene, Shape, Sides};
use crate::schema::constants::{MESH_MIRRORED_UV, MESH_SMOOTH, TREE_WIDTH};
use crate::schema::layout;
use crate::tree;

/// Triangles of which the errors of texture coordinates are computed.
const TESTED: usize = 1024;
/// Texels that an index of 32 bits with sign reaches in bytes.
const MAX_TEXELS: usize = i32::MAX as usize / 16;

pub(super) fn pack(packed: &mut PackedScene, scene: &Scene, mesh: &Mesh, eye: DVec3) -> Result<layout::Mesh> {
    let material = &scene.materials[mesh.material];
    let sampler = scene.sampler_of(material);
    let place = Place { centroid: mesh.centroid(), bounds: mesh.bounds() };
    let map = add_map(packed, scene, mesh.material, |mapping, sampler, flat| match mapping.kind {
        MappingKind::Surface => layout::UvProjection { kind: MapKind::VertexUv, ..Default::default() },
        _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
    });
    let count = mesh.triangle_count();
    let (mut boxes, mut corners) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut is_smooth = false;
    let one_sided = u32::from(material.sides == Sides::Front);
    let kinds = mesh.attribute_kinds();
    let mut attributes: Vec<[u32; 4]> = Vec::with_capacity(4 * count);
    mesh.for_each_with_attributes(|triangle, others| {
        let seen = triangle.vertices.map(|v| v - eye);
        let normal = cross(seen[1] - seen[0], seen[2] - seen[0]).normalize();
        let [a, b, c] = seen.map(|v| v.as_vec3());
        is_smooth |= triangle.normals.is_some();
        let shading = triangle.normals.unwrap_or([normal; 3]).map(octahedral);
        let [uv_a, uv_b, uv_c] = corner_uvs(&triangle, material, &sampler).map(|uv| uv.as_vec2());
        let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        boxes.push([a.min(b).min(c), a.max(b).max(c)]);
        corners.push([a, b, c]);
        let smooth = if triangle.normals.is_some() { MESH_SMOOTH } else { 0 };
        let mirrored = if others.tangents[0].w < 0.0 { MESH_MIRRORED_UV } else { 0 };
        // A corner without a direction gets any: look-ups there are of no extent.
        let tangents = others.tangents.map(|t| octahedral(t.truncate().normalize_or(DVec3::X)));
        let [v_b, v_c] = [uv_b.y, uv_c.y].map(f32::to_bits);
        attributes.extend([
            texel(normal.as_vec3(), smooth | mirrored),
            bits([uv_a.x, uv_b.x, uv_c.x, uv_a.y]),
            [v_b, v_c, tangents[0], tangents[1]],
            [shading[0], shading[1], shading[2], tangents[2]],
        ]);
        if kinds.colors {
            let [a, b, c] = others.colors.map(packed_color);
            attributes.extend([[a[0], a[1], b[0], b[1]], [c[0], c[1], 0, 0]]);
        }
        if kinds.second_uvs {
            let [a, b, c] = others.second_uvs.map(|uv| uv.as_vec2());
            attributes.extend([bits([a.x, b.x, c.x, a.y]), bits([b.y, c.y, 0.0, 0.0])]);
        }
    });
    let attribute_count = attributes.len() / count.max(1);
    let tree = tree::build(&boxes, TREE_WIDTH as usize);
    let texels = Arc::make_mut(&mut packed.mesh_texels);
    let nodes = texels.len();
    texels.reserve(2 * tree.children.len() + (3 + attribute_count) * count);
    texels.extend_from_slice(bytemuck::cast_slice(&tree.children));
    let first_corner = texels.len();
    let ordered = || tree.order.iter().map(|&index| index as usize);
    texels.extend(ordered().flat_map(|index| corners[index]).map(|corner| texel(corner, one_sided)));
    let first_attribute = texels.len();
    for index in ordered() {
        texels.extend_from_slice(&attributes[index * attribute_count..][..attribute_count]);
    }
    if texels.len() > MAX_TEXELS {
        let what = format!("meshes take {} MiB; they may take 2048 MiB at most", texels.len() >> 16);
        return Err(Error::with_help(what, "use meshes of fewer triangles").of_kind(ErrorKind::Scene));
    }
    // Bounds exist, as there are triangles.
    let [min, max] = mesh.bounds().map_or([eye; 2], |bounds| [bounds.min, bounds.max]);
    Ok(layout::Mesh {
        center: 0.5 * (min + max) - eye,
        radius: 0.500001 * (max - min).length(),
        material: mesh.material as u32,
        uv_projection: map,
        nodes: nodes as u32,
        corners: first_corner as u32,
        attributes: first_attribute as u32,
        attribute_count: attribute_count as u32,
        has_colors: kinds.colors,
        has_second_uv: kinds.second_uvs,
        has_tangents: kinds.tangents,
        is_smooth,
    })
}

/// Linear colour and alpha in four components of 16 bits; brighter than 1 is none.
fn packed_color(color: Vec4) -> [u32; 2] {
    let [r, g, b, a] = color.clamp(Vec4::ZERO, Vec4::ONE).to_array().map(|x| (x * 65535.0).round() as u32);
    [r | g << 16, b | a << 16]
}

fn texel(point: Vec3, word: u32) -> [u32; 4] {
    [point.x.to_bits(), point.y.to_bits(), point.z.to_bits(), word]
}

/// A unit vector in two components of 16 bits (Cigolle et al. 2014).
fn octahedral(v: DVec3) -> u32 {
    let flat = v / v.abs().element_sum();
    let fold = |this: f64, other: f64| (1.0 - other.abs()).copysign(this);
    let [x, y] = if flat.z < 0.0 { [fold(flat.x, flat.y), fold(flat.y, flat.x)] } else { [flat.x, flat.y] };
    let [x, y] = [x, y].map(|part| u32::from((part * 32767.0).round() as i16 as u16));
    x | y << 16
}

impl Rounded for Mesh {
    fn is_small(&self) -> bool {
        true
    }

    fn extent(&self, eye: DVec3) -> f64 {
        self.bounds().map_or(0.0, |bounds| reach(bounds.min, eye).max(reach(bounds.max, eye)))
    }

    /// Corners are rounded; edge functions err by less.
    fn misses_outline(&self, camera: &Camera) -> bool {
        let far = self.extent(camera.eye);
        U * far > camera.pixel_at(far) * PART_OF_PIXEL
    }

    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64)) {
        let step = self.triangle_count().div_ceil(TESTED).max(1);
        self.for_each(step, |triangle| {
            let [a, b, c] = triangle.vertices;
            let normal = (b - a).cross(c - a);
            // As much as is seen of it: of a closed surface many triangles are seen from the side.
            let slope = (normal.dot((a - camera.eye).normalize()) / normal.length()).abs();
            let errors = triangle_errors(camera, &triangle, mapping);
            errors.into_iter().take((4.0 * slope).round() as usize).for_each(&mut *add);
        });
    }
}
