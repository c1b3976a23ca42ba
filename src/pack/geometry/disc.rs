//! Discs → their records, and how far f32 misplaces what is seen of them.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{Rounded, add_map, reach};
use crate::core::error::Result;
use crate::pack::PackedScene;
use crate::pack::mapping::{self, Place};
use crate::pack::precision::{Camera, PART_OF_PIXEL, RAY, U, tiles_a_unit};
use crate::scene::geometry::{Disc, DiscUv};
use crate::scene::model::{Mapping, MappingKind, Scene, Shape};
use crate::schema::layout;

/// Rounding errors of the vector from the centre to a point, as they add up.
const OWN: f64 = 2.5;

pub(super) fn pack(packed: &mut PackedScene, scene: &Scene, disc: &Disc, eye: DVec3) -> Result<layout::Disc> {
    let map = add_map(packed, scene, disc.material, |mapping, sampler, flat| {
        let place = Place { centroid: disc.centroid(), bounds: disc.bounds() };
        match mapping.kind {
            MappingKind::Surface => mapping::plane_map(mapping, sampler, DVec2::ZERO),
            _ => mapping::projecting_map(mapping, sampler, eye, &place, flat),
        }
    });
    let normal = disc.normal.normalize();
    let [axis_u, axis_v] = disc.axes().map(|axis| axis / disc.radius);
    Ok(layout::Disc {
        normal,
        distance: normal.dot(disc.center - eye),
        center: disc.center - eye,
        radius: disc.radius,
        axis_u,
        axis_v,
        material: disc.material as u32,
        uv_projection: map,
        is_polar: disc.uv == DiscUv::Polar,
    })
}

/// Error of a texture coordinate where the ray meets the disc, in tiles.
fn disc_error(camera: &Camera, disc: &Disc, mapping: &Mapping, [origin, way]: [DVec3; 2]) -> Option<f64> {
    let normal = disc.normal.normalize();
    let center = disc.center - camera.eye;
    let slope = normal.dot(way);
    let p = origin + normal.dot(center - origin) / slope * way;
    let across = (p - center).length() / disc.radius;
    if across.is_nan() || across > 1.0 || normal.dot(center - origin) / slope <= 0.0 {
        return None;
    }
    let along = RAY * U * (1.0 + way.length() / slope.abs());
    let error = p.length() * along + OWN * U * (center.length() + p.length());
    let tiles = match (mapping.kind, disc.uv) {
        (MappingKind::Surface, DiscUv::Planar) => mapping.scale.abs().max_element() * 0.5 / disc.radius,
        (MappingKind::Surface, DiscUv::Polar) => {
            mapping.scale.abs().max_element() * (1.0 / (TAU * across.max(U))).max(1.0) / disc.radius
        }
        _ => tiles_a_unit(mapping, p + camera.eye, normal),
    };
    Some(error * tiles)
}

impl Rounded for Disc {
    fn extent(&self, eye: DVec3) -> f64 {
        reach(self.center, eye) + self.radius
    }

    /// Its rim is off by the error of the vector from the centre.
    fn misses_outline(&self, camera: &Camera) -> bool {
        let center = self.center - camera.eye;
        let height = self.normal.normalize().dot(center);
        let aside = (center.length_squared() - height * height).max(0.0).sqrt();
        let nearest = height.hypot(aside - self.radius);
        OWN * U * (center.length() + self.radius) > camera.pixel_at(nearest) * PART_OF_PIXEL
    }

    fn errors(&self, camera: &Camera, mapping: &Mapping, add: &mut dyn FnMut(f64)) {
        camera.rays.iter().filter_map(|&ray| disc_error(camera, self, mapping, ray)).for_each(add);
    }
}
