//! Planes → their records, and how far f32 misplaces what is seen of them.

use glam::{DVec2, DVec3, DVec4};

use super::{Rounded, add_map, cross};
use crate::core::error::{Error, Result};
use crate::pack::PackedScene;
use crate::pack::mapping::{self, Place, uv_matrix};
use crate::pack::precision::{Camera, RANGE, RAY, U, tiles_a_unit};
use crate::scene::model::{Entity, Mapping, MappingKind, Plane, Scene, Shape, Space};
use crate::schema::layout::{self, RealBits};

/// Rows u and v of the plane's own coordinates: p ↦ row·(p, 1) solves p + eye - origin =
/// u tangent + v bitangent, also for axes that are neither unit nor orthogonal: with n = t × b, u is
/// (p × b)·n / n² = p·(b × n) / n².
pub fn plane_rows(plane: &Plane, eye: DVec3) -> [DVec4; 2] {
    let (t, b) = (plane.tangent, plane.bitangent);
    let n = cross(t, b);
    let squared = n.length_squared();
    [cross(b, n) / squared, cross(n, t) / squared].map(|row| row.extend(row.dot(eye - plane.origin)))
}

pub(super) fn pack(
    packed: &mut PackedScene,
    scene: &Scene,
    plane: &Plane,
    eye: DVec3,
) -> Result<layout::Plane> {
    let normal = cross(plane.tangent, plane.bitangent).normalize();
    let [u, v] = plane_rows(plane, eye);
    let bounds = plane.bounds();
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
    let place = Place { centroid: plane.centroid(), bounds };
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
        normal,
        distance: normal.dot(plane.origin - eye),
        axis_u: u.truncate(),
        eye_u: u.w,
        axis_v: v.truncate(),
        eye_v: v.w,
        material: plane.material as u32,
        uv_projection: map,
        half_extent: RealBits(plane.half_extent.unwrap_or(-1.0)),
    })
}

/// Error of a plane's texture coordinate where the ray meets it, in tiles.
fn plane_error(camera: &Camera, plane: &Plane, mapping: &Mapping, [origin, way]: [DVec3; 2]) -> Option<f64> {
    let normal = plane.tangent.cross(plane.bitangent).normalize();
    let slope = normal.dot(way);
    let t = normal.dot(plane.origin - camera.eye - origin) / slope;
    let p = origin + t * way;
    let [u, v] = plane_rows(plane, camera.eye);
    let own = DVec2::new(u.dot(p.extend(1.0)), v.dot(p.extend(1.0)));
    let outside = plane.half_extent.is_some_and(|extent| own.abs().max_element() > extent);
    if t.is_nan() || t <= 0.0 || t.is_infinite() || outside {
        return None;
    }
    // Relative error of t, and so of the point along the ray.
    let along = RAY * U * (1.0 + way.length() / slope.abs());
    let matrix = uv_matrix(mapping);
    let tiles = match mapping.kind {
        MappingKind::Surface => {
            let own = matrix.x_axis.abs() * u.truncate().dot(p).abs()
                + matrix.y_axis.abs() * v.truncate().dot(p).abs();
            let steep =
                matrix.x_axis.abs() * u.truncate().length() + matrix.y_axis.abs() * v.truncate().length();
            own.max_element() * along + steep.max_element() * RAY * U * p.length()
        }
        _ => tiles_a_unit(mapping, p + camera.eye, normal) * p.length() * (along + RAY * U),
    };
    Some(tiles)
}

/// Coordinates below this are moderate: their products with a scale as large are numbers in f32.
const MODERATE: f64 = 1e12;

impl Rounded for Plane {
    fn bounds_uv(&self, mapping: &Mapping, eye: DVec3) -> bool {
        let [u, v] = plane_rows(self, eye);
        let own = self.half_extent.map(|extent| extent.max(u.w.abs()).max(v.w.abs()));
        let scale = mapping.scale.abs().max_element().max(mapping.offset.abs().max_element());
        mapping.kind == MappingKind::Surface && own.is_some_and(|own| own < MODERATE) && scale < MODERATE
    }

    fn extent(&self, eye: DVec3) -> f64 {
        let normal = self.tangent.cross(self.bitangent).normalize();
        normal.dot(self.origin - eye).abs().max(RANGE[0])
    }

    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64)) {
        camera.rays.iter().filter_map(|&ray| plane_error(camera, self, mapping, ray)).for_each(add);
    }
}
