//! What rays see that hit nothing, and how its light is sampled: cells of equal solid angle, each with the share of the
//! light that it has (Pharr & Humphreys 2004). Twin of `glsl/shared/environment.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::camera::Ray;
use super::filter::sample_texture;
use super::footprint::Footprint;
use super::geometry::hit::Surface;
use super::mapping::texture_coordinate;
use super::math::atan2_accurate;
use crate::oracle::appearance::map_input;
use crate::pack::PackedScene;
use crate::schema::layout::{Header, NO_MATERIAL};

/// A direction towards the environment, a unit vector, and its density over solid angle.
#[derive(Clone, Copy, Debug)]
pub struct SkySample {
    pub way: DVec3,
    pub density: f64,
}

/// Number `i` of the distribution.
fn environment_number(scene: &PackedScene, i: u32) -> f64 {
    scene.records.environment_parts[i as usize / 4].values[i as usize % 4].into()
}

/// Returns the cell that a number in [0, 1) falls in, of `count` cells whose cumulative shares begin at `first`.
fn cell_of(scene: &PackedScene, first: u32, count: u32, u: f64) -> u32 {
    let (mut low, mut left) = (0, count);
    while left > 1 {
        let step = left >> 1;
        low += if environment_number(scene, first + low + step) <= u { step } else { 0 };
        left -= step;
    }
    low
}

/// Returns the share of a cell, and where in it a number lies.
fn within_cell(scene: &PackedScene, first: u32, cell: u32, u: f64) -> DVec2 {
    let begin = environment_number(scene, first + cell);
    let share = environment_number(scene, first + cell + 1) - begin;
    let place = if share > 0.0 { (u - begin) / share } else { 0.5 };
    DVec2::new(share, place.clamp(0.0, 1.0))
}

/// Where the columns of a row begin.
fn row_begin(header: &Header, row: u32) -> u32 {
    header.environment_rows + 1 + row * (header.environment_columns + 1)
}

fn cell_density(header: &Header, row_share: f64, share: f64) -> f64 {
    let cells = f64::from(header.environment_rows) * f64::from(header.environment_columns);
    row_share * share * cells * (0.25 / PI)
}

/// A sample of the environment's light.
pub fn sampled_sky(scene: &PackedScene, square: DVec2) -> SkySample {
    let header = &scene.header;
    let row = cell_of(scene, 0, header.environment_rows, square.y);
    let high = within_cell(scene, 0, row, square.y);
    let begin = row_begin(header, row);
    let column = cell_of(scene, begin, header.environment_columns, square.x);
    let beside = within_cell(scene, begin, column, square.x);
    let below = (f64::from(row) + high.y) / f64::from(header.environment_rows);
    let turn = (f64::from(column) + beside.y) / f64::from(header.environment_columns);
    let across = (4.0 * below * (1.0 - below)).max(0.0).sqrt();
    let (sine, cosine) = (2.0 * PI * turn).sin_cos();
    let way = DVec3::new(across * cosine, 1.0 - 2.0 * below, across * sine);
    SkySample { way, density: cell_density(header, high.x, beside.x) }
}

/// The density with which `sampled_sky` returns a direction.
pub fn sky_density(scene: &PackedScene, direction: DVec3) -> f64 {
    let header = &scene.header;
    let way = direction.normalize();
    let turn = (atan2_accurate(way.z, way.x) * (0.5 / PI)).rem_euclid(1.0);
    let cell = |place: f64, count: u32| ((place.max(0.0) * f64::from(count)) as u32).min(count - 1);
    let row = cell(0.5 - 0.5 * way.y, header.environment_rows);
    let column = cell(turn, header.environment_columns);
    let begin = row_begin(header, row);
    let number = |i| environment_number(scene, i);
    let row_share = number(row + 1) - number(row);
    let share = number(begin + column + 1) - number(begin + column);
    cell_density(header, row_share, share)
}

/// The environment in the direction of a ray, without a footprint, or the background.
pub fn sky_radiance(scene: &PackedScene, ray: &Ray, random: [u32; 2]) -> DVec3 {
    let header = &scene.header;
    if header.environment_material == NO_MATERIAL {
        return header.background.as_dvec3();
    }
    let records = &scene.records;
    let material = &records.materials[header.environment_material as usize];
    let map = &records.uv_projections[header.environment_projection as usize];
    let c = texture_coordinate(map, &map_input(map, ray, &Surface::default(), &Footprint::default()));
    let image = &records.textures[material.texture_index as usize];
    let sampler = &records.samplers[material.sampler_index as usize];
    material.color.as_dvec3() * sample_texture(scene, image, sampler, &c, random).truncate()
}
