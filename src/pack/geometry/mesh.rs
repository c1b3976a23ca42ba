//! Meshes → their records, and their trees, corners and attributes in the buffer of meshes; and how far f32 misplaces what
//! is seen of them.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3, Vec4};
use rayon::prelude::*;

use super::mesh_forest::{LEVELS_OF_ALL, TEXELS_OF_CHILD};
use super::triangle::{CornerUvs, triangle_errors};
use super::{Rounded, add_map, cross, reach};
use crate::core::error::{Error, ErrorKind, Result};
use crate::pack::mapping::{self, Place};
use crate::pack::precision::{Camera, PART_OF_PIXEL, U};
use crate::pack::{MapKind, PackedScene};
use crate::scene::geometry::{AttributeKinds, Stored};
use crate::scene::model::{Mapping, MappingKind, Material, Mesh, Scene, Shape, Sides, Triangle};
use crate::schema::constants::{MESH_MIRRORED_UV, MESH_SMOOTH, NO_PLACEMENT, TREE_WIDTH};
use crate::schema::layout;
use crate::tree::{self, Growing, LEAF, Tree, levels};

/// Triangles of which the errors of texture coordinates are computed.
const TESTED: usize = 1024;
/// Texels that an index of 32 bits with sign reaches in bytes.
const MAX_TEXELS: usize = i32::MAX as usize / 16;

/// Shape of the trees of meshes: with the tree over all above them, they fit the stack of a traversal.
const OF_A_MESH: Growing =
    Growing { width: TREE_WIDTH as usize, leaf: LEAF, levels: levels(TREE_WIDTH as usize) - LEVELS_OF_ALL };

pub(super) fn pack(packed: &mut PackedScene, scene: &Scene, mesh: &Mesh, eye: DVec3) -> Result<layout::Mesh> {
    let material = &scene.materials[mesh.material];
    let place = Place { centroid: mesh.centroid(), bounds: mesh.bounds() };
    let map = add_map(packed, scene, mesh.material, |mapping, sampler, flat| match mapping.kind {
        MappingKind::Surface => layout::UvProjection { kind: MapKind::VertexUv, ..Default::default() },
        _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
    });
    let stored = mesh.stored();
    let before = packed.records.meshes.len();
    let record = match earlier(scene, before, mesh) {
        Some(index) => packed.records.meshes[index],
        None => {
            let origin = stored.placement().map_or(eye, |(_, origin)| origin);
            let texels = Arc::make_mut(&mut packed.mesh_texels);
            let source = Source {
                mesh,
                stored: &stored,
                material,
                uvs: CornerUvs::new(material, &scene.sampler_of(material)),
                origin,
            };
            let record = source.pack(texels, before as u32);
            if texels.len() > MAX_TEXELS {
                let what = format!("meshes take {} MiB; they may take 2048 MiB at most", texels.len() >> 16);
                return Err(Error::with_help(what, "use meshes of fewer triangles").of_kind(ErrorKind::Scene));
            }
            record
        }
    };
    let placement = match stored.placement() {
        None => NO_PLACEMENT,
        Some((placement, _)) => {
            packed.records.placements.push(placement_record(&placement, eye));
            packed.records.placements.len() as u32 - 1
        }
    };
    // Bounds exist, as there are triangles.
    let [min, max] = mesh.bounds().map_or([eye; 2], |bounds| [bounds.min, bounds.max]);
    Ok(layout::Mesh {
        center: 0.5 * (min + max) - eye,
        radius: 0.500001 * (max - min).length(),
        material: mesh.material as u32,
        uv_projection: map,
        placement,
        ..record
    })
}

/// Returns an earlier mesh whose triangles look the same in the buffer.
fn earlier(scene: &Scene, number: usize, mesh: &Mesh) -> Option<usize> {
    let look = |mesh: &Mesh| {
        let material = &scene.materials[mesh.material];
        let sampler = scene.sampler_of(material);
        (
            material.sides,
            mapping::uv_matrix(&material.mapping),
            material.mapping.offset,
            mapping::periods(&sampler),
        )
    };
    // Those of one file follow each other.
    let beside = |&index: &usize| mesh.is_beside(&scene.shapes.meshes[index]);
    let same = |&index: &usize| {
        let other = &scene.shapes.meshes[index];
        mesh.shares_with(other) && look(other) == look(mesh)
    };
    (0..number).rev().take_while(beside).find(same)
}

/// Returns the rows of a transformation to the world as seen from the eye, and of its inverse.
fn placement_record(placement: &DAffine3, eye: DVec3) -> layout::Placement {
    let seen = DAffine3::from_translation(-eye) * *placement;
    let rows = |m: DAffine3| {
        let [x, y, z] = m.matrix3.transpose().to_cols_array_2d().map(DVec3::from_array);
        [x.extend(m.translation.x), y.extend(m.translation.y), z.extend(m.translation.z)]
    };
    let ([x, y, z], [to_mesh_x, to_mesh_y, to_mesh_z]) = (rows(seen), rows(seen.inverse()));
    layout::Placement { x, y, z, to_mesh_x, to_mesh_y, to_mesh_z }
}

/// Texels of the corners of a triangle.
const TEXELS_OF_CORNERS: usize = 3;
/// Triangles that a thread takes at once.
const AT_ONCE: usize = 1 << 12;

/// A mesh that is not in the buffer yet.
struct Source<'a> {
    mesh: &'a Mesh,
    stored: &'a Stored<'a>,
    material: &'a Material,
    uvs: CornerUvs,
    /// Coordinates count from there.
    origin: DVec3,
}

impl Source<'_> {
    /// Appends nodes, corners and attributes. `number`: of the mesh.
    fn pack(&self, texels: &mut Vec<[u32; 4]>, number: u32) -> layout::Mesh {
        let count = self.mesh.triangle_count();
        let box_of = |place: usize| {
            let [a, b, c] = self.seen(self.stored.corners(place));
            [a.min(b).min(c), a.max(b).max(c)]
        };
        let Tree { mut children, order, .. } = tree::build_over(count, box_of, OF_A_MESH);
        let kinds = self.mesh.attribute_kinds();
        let attribute_count = 4 + 2 * usize::from(kinds.colors) + 2 * kinds.further_uvs;
        let nodes = texels.len();
        let first_corner = nodes + TEXELS_OF_CHILD as usize * children.len();
        let first_attribute = first_corner + TEXELS_OF_CORNERS * count;
        // What exceeds the indices' range is refused by the caller.
        for child in children.iter_mut().filter(|child| child.is_used()) {
            child.reference = if child.count > 0 {
                (first_corner as u32).wrapping_add((TEXELS_OF_CORNERS as u32).wrapping_mul(child.reference))
            } else {
                (nodes as u32).wrapping_add(TEXELS_OF_CHILD.wrapping_mul(child.reference))
            };
        }
        lengthen(texels, first_attribute + attribute_count * count);
        texels[nodes..first_corner].copy_from_slice(bytemuck::cast_slice(&children));
        // Before most of the texels are touched and take memory.
        drop(children);
        let (all_corners, all_attributes) = texels[first_corner..].split_at_mut(TEXELS_OF_CORNERS * count);
        let of_corners = all_corners.par_chunks_exact_mut(TEXELS_OF_CORNERS);
        let of_attributes = all_attributes.par_chunks_exact_mut(attribute_count);
        let both = of_corners.zip(of_attributes).with_min_len(AT_ONCE).enumerate();
        let smooth = both.map(|(place, (corners, attributes))| {
            let source = order[place] as usize;
            let triangle = self.stored.triangle(source);
            self.write_corners(&triangle, [number, place as u32], corners);
            self.write_attributes(&triangle, source, kinds, attributes);
            triangle.normals.is_some()
        });
        let is_smooth = smooth.reduce(|| false, |one, other| one || other);
        layout::Mesh {
            nodes: nodes as u32,
            corners: first_corner as u32,
            attributes: first_attribute as u32,
            attribute_count: attribute_count as u32,
            has_colors: kinds.colors,
            has_second_uv: kinds.further_uvs > 0,
            has_tangents: kinds.tangents,
            is_smooth,
            ..Default::default()
        }
    }

    /// Returns corners as devices have them.
    fn seen(&self, corners: [DVec3; 3]) -> [Vec3; 3] {
        corners.map(|v| (v - self.origin).as_vec3())
    }

    /// Writes the corners of a triangle, with the number of its mesh and its place there.
    fn write_corners(&self, triangle: &Triangle, [number, place]: [u32; 2], texels: &mut [[u32; 4]]) {
        let [a, b, c] = self.seen(triangle.vertices);
        let one_sided = u32::from(self.material.sides == Sides::Front);
        texels.copy_from_slice(&[texel(a, one_sided), texel(b, number), texel(c, place)]);
    }

    /// Writes the attributes of the triangle at a place of the mesh.
    fn write_attributes(
        &self,
        triangle: &Triangle,
        place: usize,
        kinds: AttributeKinds,
        texels: &mut [[u32; 4]],
    ) {
        let [a, b, c] = triangle.vertices.map(|v| v - self.origin);
        let turned = cross(b - a, c - a).normalize();
        // Corners in a space of their own have the order of the world, which a mirror turns.
        let normal = if self.stored.is_turned() { -turned } else { turned };
        let shading = triangle.normals.map_or([octahedral(normal); 3], |normals| normals.map(octahedral));
        let [uv_a, uv_b, uv_c] = self.uvs.of(triangle).map(|uv| uv.as_vec2());
        let bits = |numbers: [f32; 4]| numbers.map(f32::to_bits);
        let smooth = if triangle.normals.is_some() { MESH_SMOOTH } else { 0 };
        let others = self.stored.attributes(place);
        let mirrored = if others.tangents[0].w < 0.0 { MESH_MIRRORED_UV } else { 0 };
        // A corner without a direction gets any: look-ups there are of no extent.
        let tangents = if kinds.tangents {
            others.tangents.map(|t| octahedral(t.truncate().normalize_or(DVec3::X)))
        } else {
            [octahedral(DVec3::X); 3]
        };
        let [v_b, v_c] = [uv_b.y, uv_c.y].map(f32::to_bits);
        texels[..4].copy_from_slice(&[
            texel(normal.as_vec3(), smooth | mirrored),
            bits([uv_a.x, uv_b.x, uv_c.x, uv_a.y]),
            [v_b, v_c, tangents[0], tangents[1]],
            [shading[0], shading[1], shading[2], tangents[2]],
        ]);
        let mut rest = &mut texels[4..];
        if kinds.colors {
            let [a, b, c] = others.colors.map(packed_color);
            rest[..2].copy_from_slice(&[[a[0], a[1], b[0], b[1]], [c[0], c[1], 0, 0]]);
            rest = &mut rest[2..];
        }
        for (set, texels) in rest.chunks_exact_mut(2).enumerate() {
            let [a, b, c] = self.stored.further_uvs(place, set).map(|uv| uv.as_vec2());
            texels.copy_from_slice(&[bits([a.x, b.x, c.x, a.y]), bits([b.y, c.y, 0.0, 0.0])]);
        }
    }
}

/// Lengthens a buffer to `length` texels of zeros; the first mesh of a buffer takes memory that is zero already, which
/// whoever writes there is the first to touch.
fn lengthen(texels: &mut Vec<[u32; 4]>, length: usize) {
    if texels.is_empty() {
        *texels = vec![[0; 4]; length];
    } else {
        texels.reserve_exact(length - texels.len());
        texels.resize(length, [0; 4]);
    }
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
    let [x, y] = [x, y].map(|part| u32::from(rounded(part * 32767.0) as i16 as u16));
    x | y << 16
}

/// Rounds to the nearest whole number, halves away from zero, without the call that `round` is on older processors.
fn rounded(x: f64) -> i32 {
    let whole = x as i32;
    let rest = x - f64::from(whole);
    whole + i32::from(rest >= 0.5) - i32::from(rest <= -0.5)
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
