//! Triangles, with uv and, if they are smooth, normals that are interpolated over them. Twin of
//! `glsl/shared/geometry/triangle.glsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use super::hit::{Hit, Surface, surface};
use super::kinds::{Form, Polygonal, Search, Shape};
use crate::oracle::camera::Ray;
use crate::oracle::cone::Cone;
use crate::oracle::coverage::Cuts;
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::{ConvexRegion, PixelFrustum, RationalMap, add, along, form, ray_at};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::{Header, Light, Triangle, UvProjection};

/// -1 on a miss: the edge functions d·(p × q) have one sign within the triangle.
pub fn triangle_distance(triangle: &Triangle, ray: &Ray) -> f64 {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| v - ray.origin);
    let d = ray.direction;
    let edges = DVec3::new(d.dot(b.cross(c)), d.dot(c.cross(a)), d.dot(a.cross(b)));
    let front = edges.cmpge(DVec3::ZERO).all();
    let back = edges.cmple(DVec3::ZERO).all();
    if !(front || back) || edges == DVec3::ZERO {
        return -1.0;
    }
    let normal = triangle.normal;
    let height = triangle.distance - normal.dot(ray.origin);
    height / normal.dot(ray.direction)
}

/// Barycentric weights of a point of the triangle, from the vectors to its corners.
pub(super) fn weights(triangle: &Triangle, point: DVec3) -> DVec3 {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c].map(|v| v - point);
    let n = triangle.normal;
    let areas = DVec3::new(n.dot(b.cross(c)), n.dot(c.cross(a)), n.dot(a.cross(b)));
    areas / areas.element_sum()
}

/// A point as a place of the disc, homogeneous.
fn in_disc(cone: &Cone, point: DVec3) -> DVec3 {
    let p = point - cone.ray.origin;
    let t = cone.ray.direction.dot(p) / cone.ray.direction.length_squared();
    cone.aside(p).extend(cone.width + cone.spread * t)
}

/// Barycentric weights of a triangle's corners times their sum, positive within it.
fn edge_forms(frame: &PixelFrustum, triangle: &Triangle) -> [AffineFunction; 3] {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c];
    let way = frame.same;
    if frame.parallel {
        let side = way.dot((b - a).cross(c - a)).signum();
        let edge =
            |p: DVec3, q: DVec3| side * (form(frame, (p - q).cross(way)) + DVec3::Z * way.dot(p.cross(q)));
        return [edge(b, c), edge(c, a), edge(a, b)];
    }
    let [a, b, c] = [a - way, b - way, c - way];
    let side = a.dot(b.cross(c)).signum();
    [side * form(frame, b.cross(c)), side * form(frame, c.cross(a)), side * form(frame, a.cross(b))]
}

/// Gradients of the weights: at right angles to the opposite side, 1 over the height.
pub(super) fn weight_gradients(triangle: &Triangle) -> [DVec3; 3] {
    let [a, b, c] = [triangle.a, triangle.b, triangle.c];
    let n = triangle.normal.normalize();
    let twice_area = n.dot((b - a).cross(c - b));
    [c - b, a - c, b - a].map(|side| n.cross(side) / twice_area)
}

impl Shape for Triangle {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    fn distance_to(&self, _: &PackedScene, ray: &Ray, _: f64, _: Search) -> (f64, DVec2) {
        (triangle_distance(self, ray), DVec2::ZERO)
    }

    fn surface_of(&self, _: &PackedScene, point: DVec3, _: DVec2) -> Surface {
        let w = weights(self, point);
        let u = DVec3::new(self.u_a, self.u_b, self.u_c);
        let v = self.v;
        let n = self.normal.normalize();
        let [wa, wb, wc] = weight_gradients(self);
        let gradient = |value: DVec3| wa * value.x + wb * value.y + wc * value.z;
        let mut result = surface(point, n, n, self.links());
        result.own_uv = DVec2::new(w.dot(u), w.dot(v));
        result.own_gradients = [gradient(u), gradient(v)];
        if self.is_smooth {
            let normals = [self.normal_a, self.normal_b, self.normal_c];
            let blend = w.x * normals[0] + w.y * normals[1] + w.z * normals[2];
            if let Some(normal) = blend.try_normalize() {
                let outer = |p: DVec3, q: DVec3| DMat3::from_cols(p * q.x, p * q.y, p * q.z);
                let change = outer(normals[0], wa) + outer(normals[1], wb) + outer(normals[2], wc);
                // The normal keeps unit length: its change along itself vanishes.
                let lost = outer(normal, change.transpose() * normal);
                result.normal = normal;
                result.shape_operator = (change - lost) * (1.0 / blend.length());
                result.curvature = 0.5
                    * (result.shape_operator.x_axis.x
                        + result.shape_operator.y_axis.y
                        + result.shape_operator.z_axis.z);
            }
        }
        result
    }

    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool {
        let [a, b, c] = [self.a, self.b, self.c].map(|v| in_disc(cone, v));
        let normal = self.normal;
        let height = self.distance - normal.dot(cone.ray.origin);
        let side = if height < 0.0 { -1.0 } else { 1.0 };
        cuts.by(((-side * cone.width) * cone.aside(normal)).extend(side * height));
        cuts.by(side * a.cross(b));
        cuts.by(side * b.cross(c));
        cuts.by(side * c.cross(a));
        true
    }

    fn complete(&self, _: &PackedScene, _: &Ray, _: &mut Hit) {}

    fn tangent_plane(&self, _: &Cone, _: f64) -> DVec4 {
        self.normal.extend(self.distance)
    }

    /// A ray meets a triangle where all three edge functions have one sign. These are affine in the ray's place, so
    /// that their corners' extremes bound them.
    fn may_meet(&self, header: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool {
        let vertices = [self.a, self.b, self.c];
        if vertices.iter().all(|v| v.dot(header.forward) <= 0.0) {
            return false;
        }
        let (mut least, mut most) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for corner in polygon.corners[..polygon.count].iter().copied() {
            let (way, origin) = ray_at(frame, corner);
            let [a, b, c] = vertices.map(|v| v - origin);
            let edges = DVec3::new(way.dot(b.cross(c)), way.dot(c.cross(a)), way.dot(a.cross(b)));
            (least, most) = (least.min(edges), most.max(edges));
        }
        most.min_element() >= 0.0 || least.max_element() <= 0.0
    }

    fn plane_of(&self) -> Option<DVec4> {
        Some(self.normal.extend(self.distance))
    }

    fn form(&self) -> Form<'_> {
        Form::Polygonal(self)
    }
}

impl Polygonal for Triangle {
    fn has_smooth_normals(&self) -> bool {
        self.is_smooth
    }

    fn add_outline(&self, frame: &PixelFrustum, _: AffineFunction, region: &mut ConvexRegion) {
        for edge in edge_forms(frame, self) {
            add(region, edge);
        }
    }

    /// Interpolated between the corners.
    fn own_coordinates(&self, frame: &PixelFrustum, _: AffineFunction, _: &UvProjection) -> RationalMap {
        let e = edge_forms(frame, self);
        let v = self.v;
        RationalMap {
            u: self.u_a * e[0] + self.u_b * e[1] + self.u_c * e[2],
            v: v.x * e[0] + v.y * e[1] + v.z * e[2],
            below: e[0] + e[1] + e[2],
        }
    }

    fn add_shadow(
        &self,
        (frame, near): (&PixelFrustum, AffineFunction),
        light: &Light,
        _: f64,
        region: &mut ConvexRegion,
    ) {
        let point = light.kind == LightKind::Point;
        let place = if point { light.position } else { light.direction };
        let [a, b, c] = [self.a, self.b, self.c];
        let turn = if point {
            (a - place).dot((b - place).cross(c - place))
        } else {
            place.dot((b - a).cross(c - a))
        };
        for (p, q) in [(b, c), (c, a), (a, b)] {
            let row = if point {
                let m = (p - place).cross(q - place);
                m.extend(-m.dot(place))
            } else {
                (p - q).cross(place).extend(place.dot(p.cross(q)))
            };
            add(region, along(frame, near, turn.signum() * row));
        }
    }
}
