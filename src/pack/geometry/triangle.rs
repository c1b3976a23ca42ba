//! Triangles → their records, and how far f32 misplaces what is seen of them.

use glam::{DMat2, DVec2, DVec3};

use super::{Rounded, add_map, cross, reach};
use crate::core::error::Result;
use crate::pack::mapping::{self, Place, uv_matrix};
use crate::pack::precision::{Camera, RAY, U, tiles_a_unit};
use crate::pack::{MapKind, PackedScene};
use crate::scene::model::{Mapping, MappingKind, Material, Scene, Shape, Triangle};
use crate::schema::layout;
use crate::texture::sampler_spec::SamplerSpec;

/// Rounding errors of an edge function, as they add up.
const EDGE: f64 = 3.0;
/// An edge may be off by this part of a pixel.
const PART_FOR_EDGES: f64 = 0.25;
/// Triangles smaller than this part of a pixel have no outline that could be seen.
const MIN_PART: f64 = 0.25;

pub(super) fn pack(
    packed: &mut PackedScene,
    scene: &Scene,
    triangle: &Triangle,
    eye: DVec3,
) -> Result<layout::Triangle> {
    let [a, b, c] = triangle.vertices.map(|v| v - eye);
    let normal = cross(b - a, c - a).normalize();
    let material = &scene.materials[triangle.material];
    let uvs = CornerUvs::new(material, &scene.sampler_of(material)).of(triangle);
    let place = Place { centroid: triangle.centroid(), bounds: triangle.bounds() };
    let map = add_map(packed, scene, triangle.material, |mapping, sampler, flat| match mapping.kind {
        MappingKind::Surface => layout::UvProjection { kind: MapKind::VertexUv, ..Default::default() },
        _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
    });
    let shading = triangle.normals.unwrap_or([normal; 3]).map(DVec3::normalize);
    Ok(layout::Triangle {
        a,
        u_a: uvs[0].x,
        b,
        u_b: uvs[1].x,
        c,
        u_c: uvs[2].x,
        v: DVec3::new(uvs[0].y, uvs[1].y, uvs[2].y),
        normal,
        distance: normal.dot(a),
        normal_a: shading[0],
        normal_b: shading[1],
        normal_c: shading[2],
        material: triangle.material as u32,
        uv_projection: map,
        is_smooth: triangle.normals.is_some(),
    })
}

/// What becomes of the texture coordinates of the corners of triangles that have one material.
pub(super) struct CornerUvs {
    matrix: DMat2,
    offset: DVec2,
    periods: DVec2,
}

impl CornerUvs {
    pub(super) fn new(material: &Material, sampler: &SamplerSpec) -> CornerUvs {
        let mapping = &material.mapping;
        let (matrix, periods) = (mapping::uv_matrix(mapping), mapping::periods(sampler));
        CornerUvs { matrix, offset: mapping.offset, periods }
    }

    /// Returns the mapped coordinates of a triangle, without whole tiles of the first.
    pub(super) fn of(&self, triangle: &Triangle) -> [DVec2; 3] {
        let uvs = triangle.uvs.map(|uv| self.matrix * uv + self.offset);
        let whole = mapping::whole_tiles(uvs[0], self.periods);
        uvs.map(|uv| uv - whole)
    }
}

/// An edge function is the volume d·(p × q); it is off by a part of |d| |p| |q|, and vanishes along the edge.
fn misses_triangle(camera: &Camera, triangle: &Triangle) -> bool {
    let corners = triangle.vertices.map(|v| v - camera.eye);
    if corners.iter().all(|v| v.dot(camera.forward) <= 0.0) {
        return false;
    }
    let edges = [[1, 2], [2, 0], [0, 1]].map(|[i, j]| {
        let (p, q) = (corners[i], corners[j]);
        let seen = if camera.parallel { camera.forward.cross(q - p) } else { p.cross(q) }.length();
        // Its length in pixels, and the error of its place.
        let reach = if camera.parallel { 1.0 } else { p.length() * q.length() };
        let error = EDGE * U * p.length() * q.length() / seen;
        (seen / reach / camera.pixel, error / camera.pixel)
    });
    let size = edges.iter().map(|e| e.0).fold(0.0, f64::max);
    size > MIN_PART && edges.iter().any(|e| e.1 > PART_FOR_EDGES)
}

/// At four points of the triangle.
pub(super) fn triangle_errors(camera: &Camera, triangle: &Triangle, mapping: &Mapping) -> [f64; 4] {
    let [a, b, c] = triangle.vertices;
    let doubled = (b - a).cross(c - a);
    let normal = doubled.normalize();
    let third = 1.0 / 3.0;
    let weights = [[third; 3], [0.8, 0.1, 0.1], [0.1, 0.8, 0.1], [0.1, 0.1, 0.8]];
    weights.map(|w| {
        let place = w[0] * a + w[1] * b + w[2] * c;
        let p = place - camera.eye;
        let way = if camera.parallel { camera.forward } else { p };
        if way.dot(camera.forward) <= 0.0 {
            return 0.0;
        }
        // Rays that graze see no texels.
        let slope = (normal.dot(way) / way.length()).abs().max(1e-3);
        let reach = [a, b, c].map(|v| (v - camera.eye).length()).into_iter().fold(0.0, f64::max);
        let error = RAY * U * (p.length() * (1.0 + 1.0 / slope) + reach);
        let tiles = match mapping.kind {
            MappingKind::Surface => {
                let uvs = triangle.uvs.map(|uv| uv_matrix(mapping) * uv);
                let longest = (uvs[1] - uvs[0]).length().max((uvs[2] - uvs[0]).length());
                let longest = longest.max((uvs[2] - uvs[1]).length());
                // Over the least height.
                longest * (b - a).length().max((c - a).length()).max((c - b).length()) / doubled.length()
            }
            _ => tiles_a_unit(mapping, place, normal),
        };
        error * tiles
    })
}

impl Rounded for Triangle {
    fn is_small(&self) -> bool {
        true
    }

    fn extent(&self, eye: DVec3) -> f64 {
        self.vertices.map(|v| reach(v, eye)).into_iter().fold(0.0, f64::max)
    }

    fn misses_outline(&self, camera: &Camera) -> bool {
        misses_triangle(camera, self)
    }

    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64)) {
        triangle_errors(camera, self, mapping).into_iter().for_each(add);
    }
}
