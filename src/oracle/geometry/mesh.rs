//! Meshes: triangles in a tree of boxes, whose nodes have `TREE_WIDTH` children that rays enter near first (Wald, Benthin
//! & Boulos 2008). Boxes grow by what rounding may misplace (Ize 2013). Cones see a mesh where their axis meets it, beams
//! as the ball around it. Twin of `glsl/shared/geometry/mesh.glsl`.

use glam::{BVec3, DVec2, DVec3, DVec4, Vec3};

use super::hit::{FAR, Hit, Surface};
use super::kinds::{Form, Round, Shape};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::{Covered, Cuts, EVERYTHING, NOTHING};
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::PixelFrustum;
use crate::pack::PackedScene;
use crate::schema::constants::{NO_SHAPE, TREE_STACK, TREE_WIDTH};
use crate::schema::layout::{Header, Light, Mesh, Sphere, Triangle};

/// The exchanges that sort the children of a node are for four.
const _: () = assert!(TREE_WIDTH == 4);

fn ball_of(mesh: &Mesh) -> Sphere {
    Sphere {
        center: mesh.center,
        radius: mesh.radius,
        material: mesh.material,
        uv_projection: mesh.uv_projection,
    }
}

fn mesh_texel(scene: &PackedScene, at: u32) -> [u32; 4] {
    scene.mesh_texels[at as usize]
}

fn point_in([x, y, z, _]: [u32; 4]) -> DVec3 {
    Vec3::new(f32::from_bits(x), f32::from_bits(y), f32::from_bits(z)).as_dvec3()
}

/// Boxes grow by this part of the largest coordinate of their corners as seen from the ray's origin: planes of boxes,
/// edge functions and distances of triangles are off by less than 16 roundings of it.
const MARGIN: f64 = 1.0 / (1u64 << 32) as f64;

/// Components of a direction are no less than this part of the largest, so that no reciprocal is infinite. In a box, a
/// ray moves aside by less than `MARGIN` for it.
const AXIAL: f64 = MARGIN / 1024.0;

/// A ray as boxes are tested with it.
struct Slabs {
    origin: DVec3,
    inverse: DVec3,
    falls: BVec3,
    /// Longest component of the direction.
    longest: f64,
}

fn slabs_of(ray: &Ray) -> Slabs {
    let longest = ray.direction.abs().max_element();
    let scaled = ray.direction * (1.0 / longest);
    let falls = scaled.cmplt(DVec3::ZERO);
    let apart = scaled.abs().max(DVec3::splat(AXIAL));
    Slabs { origin: ray.origin, inverse: 1.0 / DVec3::select(falls, -apart, apart), falls, longest }
}

/// Returns where the ray enters the grown box, -1 if it does not up to the scaled distance `most`. Planes of entry and
/// exit follow from the direction: a box that is inside out, in an unused place of a node, is never entered.
fn entry(slabs: &Slabs, least: DVec3, greatest: DVec3, most: f64) -> f64 {
    let low = least - slabs.origin;
    let high = greatest - slabs.origin;
    let margin = MARGIN * low.abs().max(high.abs()).max_element();
    let (low, high) = (low - margin, high + margin);
    let enter = DVec3::select(slabs.falls, high, low) * slabs.inverse;
    let leave = DVec3::select(slabs.falls, low, high) * slabs.inverse;
    let near = enter.max_element().max(0.0);
    let far = leave.min_element().min(most);
    if near <= far { near } else { -1.0 }
}

fn corners(scene: &PackedScene, at: u32) -> [DVec3; 3] {
    [0, 1, 2].map(|k| point_in(mesh_texel(scene, at + k)))
}

/// The mean of the corners' distances along a direction, weighted by edge functions of one sign; else -1.
fn distance_by(edges: DVec3, corners: [DVec3; 3], d: DVec3) -> f64 {
    let front = edges.cmpge(DVec3::ZERO).all();
    let back = edges.cmple(DVec3::ZERO).all();
    if !(front || back) || edges == DVec3::ZERO {
        return -1.0;
    }
    let along = edges.dot(DVec3::from_array(corners.map(|corner| corner.dot(d))));
    along / (edges.element_sum() * d.length_squared())
}

/// Edge functions d·((p + q) × (q - p)), twice the volumes d·(p × q): the two triangles at a shared edge compute the same
/// value with opposite sign, and the error is a part of the edge's length. They are weights of the corners in the point.
/// `at`: the texel of its corners.
fn distance_in(scene: &PackedScene, at: u32, ray: &Ray) -> f64 {
    let [a, b, c] = corners(scene, at).map(|corner| corner - ray.origin);
    let d = ray.direction;
    let edge = |p: DVec3, q: DVec3| d.dot((p + q).cross(q - p));
    distance_by(DVec3::new(edge(b, c), edge(c, a), edge(a, b)), [a, b, c], d)
}

/// The nearest triangle before `most`, or for `any` just one; of those at the same t the first in the tree's order.
fn nearest(scene: &PackedScene, mesh: &Mesh, ray: &Ray, most: f64, any: bool) -> (f64, u32) {
    let slabs = slabs_of(ray);
    let (mut best, mut found) = (most, NO_SHAPE);
    // Children that wait, the nearest on top, and where the ray enters them.
    let mut waiting = [(0u32, 0u32, 0.0); TREE_STACK as usize];
    let mut height = 0;
    let (mut reference, mut count) = (0, 0);
    loop {
        if count == 0 {
            let at = mesh.nodes + 2 * reference;
            let mut children = [0, 1, 2, 3].map(|k| {
                let [least, greatest] = [0, 1].map(|end| mesh_texel(scene, at + 2 * k + end));
                let enter = entry(&slabs, point_in(least), point_in(greatest), best * slabs.longest);
                (least[3], greatest[3], enter)
            });
            // The farthest first, those that are missed last.
            for (i, j) in [(0, 1), (2, 3), (0, 2), (1, 3), (1, 2)] {
                if children[i].2 < children[j].2 {
                    children.swap(i, j);
                }
            }
            for child in children.into_iter().filter(|child| child.2 >= 0.0) {
                waiting[height] = child;
                height += 1;
            }
        }
        for index in reference..reference + count {
            let t = distance_in(scene, mesh.corners + 3 * index, ray);
            if t > 0.0 && (t < best || t == best && found != NO_SHAPE && index < found) {
                (best, found) = (t, index);
            }
        }
        if any && found != NO_SHAPE {
            break;
        }
        // Equal distances are entered as well, for the first of equal triangles.
        while height > 0 && waiting[height - 1].2 > best * slabs.longest {
            height -= 1;
        }
        if height == 0 {
            break;
        }
        height -= 1;
        (reference, count, _) = waiting[height];
    }
    (if found == NO_SHAPE { -1.0 } else { best }, found)
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
    let [a, b, c] = corners(scene, mesh.corners + 3 * index);
    let [plane, first, second, normals] =
        [0, 1, 2, 3].map(|k| mesh_texel(scene, mesh.attributes + 4 * index + k));
    let [first, second] = [first, second].map(|texel| texel.map(|word| f64::from(f32::from_bits(word))));
    let normal = point_in(plane);
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
        normal_a: octahedral(normals[0]),
        normal_b: octahedral(normals[1]),
        normal_c: octahedral(normals[2]),
        material: mesh.material,
        uv_projection: mesh.uv_projection,
        is_smooth: plane[3] != 0,
    }
}

impl Shape for Mesh {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    /// Its triangle's number is the local coordinate.
    fn distance_to(&self, scene: &PackedScene, ray: &Ray, most: f64, any: bool) -> (f64, DVec2) {
        let (t, found) = nearest(scene, self, ray, most, any);
        (t, DVec2::new(f64::from(found), 0.0))
    }

    fn surface_of(&self, scene: &PackedScene, point: DVec3, local: DVec2) -> Surface {
        triangle_in(scene, self, local.x as u32).surface_of(scene, point, local)
    }

    /// No line stands for a mesh.
    fn cut_by_shape(&self, _: &mut Cuts, _: &Cone) -> bool {
        false
    }

    fn complete(&self, scene: &PackedScene, ray: &Ray, hit: &mut Hit) {
        (hit.t, hit.local) = self.distance_to(scene, ray, FAR, false);
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
        let is_met = self.distance_to(scene, &cone.ray, FAR, true).0 > 0.0;
        if is_met { EVERYTHING } else { NOTHING }
    }

    /// False where no way from the polygon to the light can pass that ball.
    fn may_shade(&self, surface: (&PixelFrustum, AffineFunction), polygon: &Polygon, light: &Light) -> bool {
        ball_of(self).may_shade(surface, polygon, light)
    }
}
