//! Spheres → their records, and how far f32 misplaces what is seen of them.

use glam::DVec3;

use super::{Rounded, add_map, reach};
use crate::core::error::Result;
use crate::pack::PackedScene;
use crate::pack::mapping::{self, Place};
use crate::pack::precision::{Camera, PART_OF_PIXEL, U, tiles_a_unit};
use crate::scene::model::{Mapping, MappingKind, Scene, Shape, Sphere};
use crate::schema::layout;

/// Rounding errors of the vector from a sphere's centre, as they add up.
const SPHERE: f64 = 2.5;

pub(super) fn pack(
    packed: &mut PackedScene,
    scene: &Scene,
    sphere: &Sphere,
    eye: DVec3,
) -> Result<layout::Sphere> {
    let map = add_map(packed, scene, sphere.material, |mapping, sampler, flat| {
        let around_center = Mapping { origin: sphere.center, ..*mapping };
        let mapping = if mapping.kind == MappingKind::Surface { &around_center } else { mapping };
        let place = Place { centroid: sphere.centroid(), bounds: sphere.bounds() };
        mapping::projecting_map(mapping, sampler, eye, &place, flat)
    });
    Ok(layout::Sphere {
        center: sphere.center - eye,
        radius: sphere.radius,
        material: sphere.material as u32,
        uv_projection: map,
    })
}

fn misses_sphere(camera: &Camera, sphere: &Sphere) -> bool {
    let center = sphere.center - camera.eye;
    let far = center.length();
    // From outside the outline is seen along tangents; from within there is none.
    let tangent = (far * far - sphere.radius * sphere.radius).max(0.0).sqrt();
    let error = SPHERE * U * (far + sphere.radius);
    far > sphere.radius && error > camera.pixel_at(tangent) * PART_OF_PIXEL
}

fn sphere_error(
    camera: &Camera,
    sphere: &Sphere,
    mapping: &Mapping,
    [origin, way]: [DVec3; 2],
) -> Option<f64> {
    let center = sphere.center - camera.eye - origin;
    let unit = way.normalize();
    let ahead = center.dot(unit);
    let aside = (center - ahead * unit).length();
    if aside >= sphere.radius || ahead <= 0.0 {
        return None;
    }
    let error = SPHERE * U * (center.length() + sphere.radius);
    let normal = (ahead * unit - center).normalize();
    let tiles = match mapping.kind {
        MappingKind::Surface => mapping.scale.abs().max_element() / (2.0 * sphere.radius),
        _ => tiles_a_unit(mapping, sphere.center + sphere.radius * normal, normal),
    };
    Some(error * tiles * if mapping.entity.is_direction() { 1.0 / sphere.radius } else { 1.0 })
}

impl Rounded for Sphere {
    fn extent(&self, eye: DVec3) -> f64 {
        reach(self.center, eye) + self.radius
    }

    fn misses_outline(&self, camera: &Camera) -> bool {
        misses_sphere(camera, self)
    }

    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64)) {
        camera.rays.iter().filter_map(|&ray| sphere_error(camera, self, mapping, ray)).for_each(add);
    }
}
