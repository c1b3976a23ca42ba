//! Meshes → their records, and their trees, corners and attributes in the buffer of meshes; and how far f32 misplaces what
//! is seen of them.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::triangle::{corner_uvs, triangle_errors};
use super::{Rounded, add_map, cross, reach};
use crate::core::error::{Error, ErrorKind, Result};
use crate::pack::mapping::{self, Place};
use crate::pack::precision::{Camera, PART_OF_PIXEL, U};
use crate::pack::{MapKind, PackedScene};
use crate::scene::model::{Mapping, MappingKind, Mesh, Scene, Shape};
use crate::schema::constants::TREE_WIDTH;
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
    let (mut boxes, mut corners, mut attributes) =
        (Vec::with_capacity(count), Vec::with_capacity(count), Vec::with_capacity(count));
    let mut is_smooth = false;
    mesh.for_each(1, |triangle| {
        let seen = triangle.vertices.map(|v| v - eye);
        let normal = cross(seen[1] - seen[0], seen[2] - seen[0]).normalize();
        let [a, b, c] = seen.map(|v| v.as_vec3());
        is_smooth |= triangle.normals.is_some();
        let shading = triangle.normals.unwrap_or([normal; 3]).map(octahedral);
        let [uv_a, uv_b, uv_c] = corner_uvs(&triangle, material, &sampler).map(|uv| uv.as_vec2());
        let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        boxes.push([a.min(b).min(c), a.max(b).max(c)]);
        corners.push([a, b, c]);
        attributes.push([
            texel(normal.as_vec3(), u32::from(triangle.normals.is_some())),
            bits([uv_a.x, uv_b.x, uv_c.x, uv_a.y]),
            bits([uv_b.y, uv_c.y, 0.0, 0.0]),
            [shading[0], shading[1], shading[2], 0],
        ]);
    });
    let tree = tree::build(&boxes, TREE_WIDTH as usize);
    let texels = Arc::make_mut(&mut packed.mesh_texels);
    let nodes = texels.len();
    texels.reserve(2 * tree.children.len() + 7 * count);
    texels.extend_from_slice(bytemuck::cast_slice(&tree.children));
    let first_corner = texels.len();
    let ordered = || tree.order.iter().map(|&index| index as usize);
    texels.extend(ordered().flat_map(|index| corners[index]).map(|corner| texel(corner, 0)));
    let first_attribute = texels.len();
    texels.extend(ordered().flat_map(|index| attributes[index]));
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
        is_smooth,
    })
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
