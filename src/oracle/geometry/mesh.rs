//! Meshes: triangles in a tree of boxes, whose nodes have `TREE_WIDTH` children that rays enter near first (Wald, Benthin
//! & Boulos 2008). Boxes grow by what rounding may misplace (Ize 2013). Cones see a mesh where their axis meets it, beams
//! as the ball around it. Twin of `glsl/shared/geometry/mesh.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::hit::{FAR, Hit, Surface, VertexAttributes};
use super::kinds::{Form, Query, Round, Search, Shape};
use super::mesh_search::{
    Within, hit_of, nearest_in_meshes, occluded_by_meshes, placed_normal, placed_point, placed_vector,
    placement_of, search,
};
use super::mesh_tests::{corners, mesh_texel, point_in};
use super::triangle::{weight_gradients, weights};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::{Covered, Cuts, EVERYTHING, NOTHING};
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::PixelFrustum;
use crate::pack::PackedScene;
use crate::schema::constants::{MESH_MIRRORED_UV, MESH_SMOOTH};
use crate::schema::layout::{Header, Light, Mesh, Sphere, Triangle};

fn ball_of(mesh: &Mesh) -> Sphere {
    Sphere {
        center: mesh.center,
        radius: mesh.radius,
        material: mesh.material,
        uv_projection: mesh.uv_projection,
    }
}

/// A unit vector from two components of 16 bits (Cigolle et al. 2014).
fn octahedral(word: u32) -> DVec3 {
    let [x, y] = [word, word >> 16].map(|half| (f64::from(half as u16 as i16) / 32767.0).max(-1.0));
    let z = 1.0 - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let toward = |x: f64| if x < 0.0 { x + fold } else { x - fold };
    DVec3::new(toward(x), toward(y), z).normalize()
}

fn triangle_in(scene: &PackedScene, mesh: &Mesh, index: u32) -> Triangle {
    let placement = placement_of(scene, mesh);
    let [a, b, c] = corners(scene, mesh.corners + 3 * index).map(|corner| placed_point(placement, corner));
    let [plane, first, second, normals] =
        [0, 1, 2, 3].map(|k| mesh_texel(scene, mesh.attributes + mesh.attribute_count * index + k));
    let [first, second] = [first, second].map(|texel| texel.map(|word| f64::from(f32::from_bits(word))));
    let normal = placed_normal(placement, point_in(plane));
    let [normal_a, normal_b, normal_c] =
        [0, 1, 2].map(|k: usize| placed_normal(placement, octahedral(normals[k])));
    Triangle {
        a,
        u_a: first[0],
        b,
        u_b: first[1],
        c,
        u_c: first[2],
        v: DVec3::new(first[3], second[0], second[1]),
        normal,
        distance: normal.dot(a),
        normal_a,
        normal_b,
        normal_c,
        material: mesh.material,
        uv_projection: mesh.uv_projection,
        is_smooth: plane[3] & MESH_SMOOTH != 0,
    }
}

/// Four components of 16 bits each, from 0 to 1.
fn color_in(low: u32, high: u32) -> DVec4 {
    let part = |word: u32| f64::from(word & 0xFFFF) / 65535.0;
    DVec4::new(part(low), part(low >> 16), part(high), part(high >> 16))
}

/// What the vertices of a triangle have beside normals and texture coordinates, at a point of it.
fn attributes_of(
    scene: &PackedScene,
    mesh: &Mesh,
    triangle: &Triangle,
    index: u32,
    point: DVec3,
) -> VertexAttributes {
    let mut found = VertexAttributes::default();
    let w = weights(triangle, point);
    let mut at = mesh.attributes + mesh.attribute_count * index;
    if mesh.has_tangents {
        let signs = mesh_texel(scene, at)[3];
        let (others, last) = (mesh_texel(scene, at + 2), mesh_texel(scene, at + 3)[3]);
        let sum = w.x * octahedral(others[2]) + w.y * octahedral(others[3]) + w.z * octahedral(last);
        let tangent = placed_vector(placement_of(scene, mesh), sum);
        found.tangent = tangent.extend(if signs & MESH_MIRRORED_UV != 0 { -1.0 } else { 1.0 });
    }
    at += 4;
    let two = |at| [mesh_texel(scene, at), mesh_texel(scene, at + 1)];
    if mesh.has_colors {
        let [first, second] = two(at);
        found.color = w.x * color_in(first[0], first[1])
            + w.y * color_in(first[2], first[3])
            + w.z * color_in(second[0], second[1]);
        at += 2;
    }
    if mesh.has_second_uv {
        let [first, second] = two(at).map(|texel| texel.map(|word| f64::from(f32::from_bits(word))));
        let u = DVec3::new(first[0], first[1], first[2]);
        let v = DVec3::new(first[3], second[0], second[1]);
        found.second_uv = DVec2::new(w.dot(u), w.dot(v));
        let [wa, wb, wc] = weight_gradients(triangle);
        found.second_gradients = [u, v].map(|value| wa * value.x + wb * value.y + wc * value.z);
        found.uv_texel = at;
        found.weights = w;
        found.weight_gradients = [wa, wb, wc];
    }
    found
}

impl Shape for Mesh {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    /// Its triangle's number is the local coordinate.
    fn distance_to(&self, scene: &PackedScene, ray: &Ray, most: f64, kind: Search) -> (f64, DVec2) {
        let mut best = most;
        let placement = placement_of(scene, self);
        let inside = placement.map(|_| Within { mesh: 0, placement, ray: *ray });
        let found = search(scene, self.nodes, inside, 0, ray, kind, &mut best);
        found.map_or((-1.0, DVec2::ZERO), |found| (best, hit_of(scene, &found, 0, best).local))
    }

    fn nearest(meshes: &[Mesh], first: u32, query: &Query, hit: &mut Hit) {
        if !meshes.is_empty() {
            nearest_in_meshes(query, first, hit);
        }
    }

    fn occlude(meshes: &[Mesh], first: u32, query: &Query, t_max: f64) -> bool {
        !meshes.is_empty() && occluded_by_meshes(query, first, t_max)
    }

    fn surface_of(&self, scene: &PackedScene, point: DVec3, local: DVec2) -> Surface {
        let index = local.x as u32;
        let triangle = triangle_in(scene, self, index);
        let surface = triangle.surface_of(scene, point, local);
        Surface { attributes: attributes_of(scene, self, &triangle, index, point), ..surface }
    }

    /// No line stands for a mesh.
    fn cut_by_shape(&self, _: &mut Cuts, _: &Cone) -> bool {
        false
    }

    fn complete(&self, scene: &PackedScene, ray: &Ray, hit: &mut Hit) {
        (hit.t, hit.local) = self.distance_to(scene, ray, FAR, Search::Nearest);
    }

    /// The plane at t that faces the cone.
    fn tangent_plane(&self, cone: &Cone, t: f64) -> DVec4 {
        let normal = -cone.ray.direction.normalize();
        normal.extend(normal.dot(cone.ray.origin + t * cone.ray.direction))
    }

    /// False where no ray of the polygon can meet the ball around the mesh.
    fn may_meet(&self, header: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool {
        ball_of(self).may_meet(header, frame, polygon)
    }

    fn plane_of(&self) -> Option<DVec4> {
        None
    }

    fn is_concave(&self) -> bool {
        true
    }

    fn form(&self) -> Form<'_> {
        Form::Round(self)
    }
}

impl Round for Mesh {
    fn covered_by(&self, scene: &PackedScene, cone: &Cone) -> Covered {
        let is_met = self.distance_to(scene, &cone.ray, FAR, Search::Any).0 > 0.0;
        if is_met { EVERYTHING } else { NOTHING }
    }

    /// False where no way from the polygon to the light can pass that ball.
    fn may_shade(&self, surface: (&PixelFrustum, AffineFunction), polygon: &Polygon, light: &Light) -> bool {
        ball_of(self).may_shade(surface, polygon, light)
    }
}
