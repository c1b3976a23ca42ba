//! Planes, infinite or bounded by a parallelogram. Twin of `glsl/shared/geometry/plane.glsl`.

use glam::{DVec2, DVec3, DVec4};

use super::hit::{FAR, Hit, Surface, surface};
use super::kinds::{Form, Polygonal, Search, Shape};
use crate::oracle::camera::Ray;
use crate::oracle::cone::{Cone, FlatDepth, flat_in};
use crate::oracle::coverage::Cuts;
use crate::oracle::polygon::{AffineFunction, Polygon, range};
use crate::oracle::projective::{
    ConvexRegion, PixelFrustum, RationalMap, add, along, below, region_of_plane,
};
use crate::pack::{LightKind, PackedScene};
use crate::schema::layout::{Header, Light, Plane, UvProjection};

/// Numerator of the own coordinate row·p + row.w of the place met at u, over facing + s tilt·u.
pub(super) fn own_place(cone: &Cone, plane: &FlatDepth, row: DVec4) -> DVec3 {
    let start = row.truncate().dot(cone.ray.origin) + row.w;
    let along = row.truncate().dot(cone.ray.direction);
    let tilt = (start * cone.spread - along * cone.width) * plane.tilt
        + (cone.width * plane.facing + cone.spread * plane.height) * cone.aside(row.truncate());
    tilt.extend(start * plane.facing + along * plane.height)
}

/// The plane's own coordinate row·p + row.w lies within ±extent.
pub(super) fn cut_bounds(cuts: &mut Cuts, cone: &Cone, plane: &FlatDepth, row: DVec4, extent: f64) {
    let place = own_place(cone, plane, row);
    let limit = extent * (cone.spread * plane.tilt).extend(plane.facing);
    cuts.by(limit - place);
    cuts.by(limit + place);
}

/// Returns t = (h - n·o) / n·d for the plane n·p = h, and the point there.
pub(super) fn distance_to_plane(normal: DVec3, height: f64, ray: &Ray) -> (f64, DVec3) {
    let t = (height - normal.dot(ray.origin)) / normal.dot(ray.direction);
    (t, ray.origin + t * ray.direction)
}

impl Shape for Plane {
    fn links(&self) -> [u32; 2] {
        [self.material, self.uv_projection]
    }

    fn distance_to(&self, _: &PackedScene, ray: &Ray, _: f64, _: Search) -> (f64, DVec2) {
        let (t, p) = distance_to_plane(self.normal, self.distance, ray);
        let local = DVec2::new(self.axis_u.dot(p), self.axis_v.dot(p));
        if let Some(extent) = self.bounds() {
            let (u, v) = (local.x + self.eye_u, local.y + self.eye_v);
            let inside = u.abs() <= extent && v.abs() <= extent;
            return (if inside { t } else { -1.0 }, local);
        }
        (t, local)
    }

    fn surface_of(&self, _: &PackedScene, point: DVec3, uv: DVec2) -> Surface {
        let normal = self.normal.normalize();
        let own_gradients = [self.axis_u, self.axis_v];
        Surface { own_uv: uv, own_gradients, ..surface(point, normal, normal, self.links()) }
    }

    fn cut_by_shape(&self, cuts: &mut Cuts, cone: &Cone) -> bool {
        let seen = flat_in(cone, self.normal, self.distance);
        cuts.by((-cone.width * seen.tilt).extend(seen.height));
        if let Some(extent) = self.bounds() {
            cut_bounds(cuts, cone, &seen, self.axis_u.extend(self.eye_u), extent);
            cut_bounds(cuts, cone, &seen, self.axis_v.extend(self.eye_v), extent);
        } else {
            cuts.by((cone.spread * seen.tilt).extend(seen.facing));
        }
        true
    }

    fn complete(&self, scene: &PackedScene, ray: &Ray, hit: &mut Hit) {
        hit.local = self.distance_to(scene, ray, FAR, Search::Nearest).1;
    }

    fn tangent_plane(&self, _: &Cone, _: f64) -> DVec4 {
        self.normal.extend(self.distance)
    }

    fn may_meet(&self, _: &Header, frame: &PixelFrustum, polygon: &Polygon) -> bool {
        let mut region = region_of_plane(frame, self.normal.extend(self.distance));
        self.add_outline(frame, region.inverse_depth, &mut region);
        region.lines[..region.count].iter().all(|&line| range(polygon, line).1 > 0.0)
    }

    fn plane_of(&self) -> Option<DVec4> {
        Some(self.normal.extend(self.distance))
    }

    fn form(&self) -> Form<'_> {
        Form::Polygonal(self)
    }
}

impl Polygonal for Plane {
    fn has_smooth_normals(&self) -> bool {
        false
    }

    fn add_outline(&self, frame: &PixelFrustum, near: AffineFunction, region: &mut ConvexRegion) {
        let Some(half_extent) = self.bounds() else { return };
        let extent = half_extent * below(frame, near);
        for row in [self.axis_u.extend(self.eye_u), self.axis_v.extend(self.eye_v)] {
            let own = along(frame, near, row);
            add(region, extent - own);
            add(region, extent + own);
        }
    }

    /// Its own coordinates count from the eye.
    fn own_coordinates(&self, frame: &PixelFrustum, near: AffineFunction, map: &UvProjection) -> RationalMap {
        let under = below(frame, near);
        let own = |axis: DVec3| along(frame, near, axis.extend(0.0));
        let (u, v) = (own(self.axis_u), own(self.axis_v));
        RationalMap {
            u: map.m00 * u + map.m01 * v + map.offset.x * under,
            v: map.m10 * u + map.m11 * v + map.offset.y * under,
            below: under,
        }
    }

    fn add_shadow(
        &self,
        (frame, near): (&PixelFrustum, AffineFunction),
        light: &Light,
        rise: f64,
        region: &mut ConvexRegion,
    ) {
        let Some(extent) = self.bounds() else { return };
        let point = light.kind == LightKind::Point;
        let place = if point { light.position } else { light.direction };
        let plane = self.normal.extend(self.distance);
        let n = plane.truncate();
        let side = if rise == 0.0 { 0.0 } else { rise.signum() };
        // A place's distance below the light, in |rise|, or its own height.
        let depth = if point { side * n.extend(-n.dot(place)) } else { DVec4::W * rise.abs() };
        for row in [self.axis_u.extend(self.eye_u), self.axis_v.extend(self.eye_v)] {
            let axis = row.truncate();
            let own = if point {
                // u of light + (p - light) rise / (n·(p - light)), times the depth.
                (axis.dot(place) + row.w) * depth + rise.abs() * axis.extend(-axis.dot(place))
            } else {
                // u of p + way (height - n·p) / rise, times |rise|.
                rise.abs() * row + side * axis.dot(place) * (-n).extend(plane.w)
            };
            add(region, along(frame, near, extent * depth - own));
            add(region, along(frame, near, extent * depth + own));
        }
    }
}
