//! The distribution of an environment's light over directions, for sampling by importance (Pharr & Humphreys 2004). Input:
//! its texture and how it is turned. Output: cells of equal solid angle, rows of height and columns of azimuth about +y:
//! the cumulative shares of the rows, then for each row those of its cells.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec4};

use super::mapping::environment_map;
use crate::core::color::srgb_to_linear;
use crate::scene::model::{Environment, EnvironmentLayout};
use crate::schema::layout::{EnvironmentPart, UvProjection};
use crate::texture::data::{ColorSpace, Component, TextureData};

/// Most columns and rows.
const MOST: [usize; 2] = [512, 256];
/// About the number of points at which small pictures are read.
const MOST_POINTS: usize = 1 << 18;
/// Of a cell's share what its neighbours have a part in, as look-ups blend texels.
const BLEND: f64 = 0.25;

/// The distribution of the light of an environment.
pub struct Distribution {
    pub columns: u32,
    pub rows: u32,
    pub parts: Vec<EnvironmentPart>,
}

/// Returns the distribution of a texture's light; alike in all directions without one.
pub fn distribution(environment: Option<(&Environment, &TextureData)>) -> Distribution {
    let Some((environment, texture)) = environment else { return of_cells(1, 1, &[1.0]) };
    let directions = Directions::new(environment, texture);
    // Cells are about as large as texels, so that a small sun fills the few that it lies in.
    let [columns, rows] = directions.cells();
    let mut cells = vec![0.0; columns * rows];
    directions.for_each(|way, light| {
        let turn = (way.z.atan2(way.x) / TAU).rem_euclid(1.0);
        let column = ((turn * columns as f64) as usize).min(columns - 1);
        let row = (((0.5 - 0.5 * way.y).max(0.0) * rows as f64) as usize).min(rows - 1);
        cells[row * columns + column] += light;
    });
    of_cells(columns, rows, &blended(&cells, columns, rows))
}

/// Returns cells with a part of the light of those around them.
fn blended(cells: &[f64], columns: usize, rows: usize) -> Vec<f64> {
    let near = |row: usize, column: usize| {
        let around = (row.saturating_sub(1)..(row + 2).min(rows))
            .flat_map(|r| [columns - 1, 0, 1].map(|step| cells[r * columns + (column + step) % columns]));
        let around: Vec<f64> = around.collect();
        around.iter().sum::<f64>() / around.len() as f64
    };
    let blend = |i: usize| (1.0 - BLEND) * cells[i] + BLEND * near(i / columns, i % columns);
    (0..cells.len()).map(blend).collect()
}

/// Returns the cumulative shares. Rows without any light have equal cells, and so has a picture without any.
fn of_cells(columns: usize, rows: usize, cells: &[f64]) -> Distribution {
    let mut numbers = Vec::with_capacity((rows + 1) + rows * (columns + 1));
    let of_rows: Vec<f64> = cells.chunks(columns).map(|row| row.iter().sum()).collect();
    cumulate(&of_rows, &mut numbers);
    cells.chunks(columns).for_each(|row| cumulate(row, &mut numbers));
    let parts = numbers.chunks(4).map(|four| {
        let number = |i: usize| four.get(i).copied().unwrap_or(1.0);
        EnvironmentPart { values: Vec4::new(number(0), number(1), number(2), number(3)) }
    });
    Distribution { columns: columns as u32, rows: rows as u32, parts: parts.collect() }
}

fn cumulate(shares: &[f64], numbers: &mut Vec<f32>) {
    let all: f64 = shares.iter().sum();
    let share = |s: f64| if all > 0.0 { s / all } else { 1.0 / shares.len() as f64 };
    let mut sum = 0.0;
    numbers.push(0.0);
    for &s in &shares[..shares.len() - 1] {
        sum += share(s);
        numbers.push(sum.min(1.0) as f32);
    }
    numbers.push(1.0);
}

/// The texels of an environment as light from directions.
struct Directions<'a> {
    texture: &'a TextureData,
    layout: EnvironmentLayout,
    /// From directions of the texture to those of the world.
    to_world: [DVec3; 3],
}

impl<'a> Directions<'a> {
    fn new(environment: &Environment, texture: &'a TextureData) -> Directions<'a> {
        let UvProjection { x, y, z, .. } = environment_map(environment);
        // Its rows are the axes of the texture in the world; they are orthonormal.
        let to_world = [x, y, z].map(|row| row.truncate());
        Directions { texture, layout: environment.layout, to_world }
    }

    fn cells(&self) -> [usize; 2] {
        let [width, height] = [self.texture.width, self.texture.height].map(|n| n as usize);
        let [columns, rows] = match self.layout {
            EnvironmentLayout::Equirectangular => [width, height],
            EnvironmentLayout::Cube => [4 * width, 2 * width],
        };
        [columns.clamp(1, MOST[0]), rows.clamp(1, MOST[1])]
    }

    fn world(&self, local: DVec3) -> DVec3 {
        let [x, y, z] = self.to_world;
        (local.x * x + local.y * y + local.z * z).normalize_or(DVec3::Y)
    }

    /// Calls `each` with directions all over every texel, and for each the luminance times the solid angle it stands for.
    fn for_each(&self, mut each: impl FnMut(DVec3, f64)) {
        let [width, height] = [self.texture.width, self.texture.height].map(|n| n as usize);
        let depth = self.texture.depth as usize;
        let side = ((MOST_POINTS as f64 / (depth * height * width) as f64).sqrt() as usize).clamp(1, 8);
        let place = |i: usize, part: usize, count: usize| {
            (i as f64 + (part as f64 + 0.5) / side as f64) / count as f64
        };
        for texel in 0..depth * height * width {
            let light = self.luminance(texel) / (side * side) as f64;
            if light == 0.0 {
                continue;
            }
            let (slice, row, column) = (texel / width / height, texel / width % height, texel % width);
            for part in 0..side * side {
                let (u, v) = (place(column, part % side, width), place(row, part / side, height));
                let (local, area) = match self.layout {
                    EnvironmentLayout::Equirectangular => sphere_point(u, v),
                    EnvironmentLayout::Cube => cube_point(slice, 2.0 * u - 1.0, 2.0 * v - 1.0),
                };
                each(self.world(local), light * area);
            }
        }
    }

    fn luminance(&self, texel: usize) -> f64 {
        let texture = self.texture;
        let channels = texture.format.channels();
        let bytes = &texture.texels[texel * texture.format.bytes_per_texel()..];
        let linear =
            |code: f64| if texture.color_space == ColorSpace::Srgb { srgb_to_linear(code) } else { code };
        let channel = |c: usize| match texture.format.component() {
            Component::Unorm8 => linear(f64::from(bytes[c]) / 255.0),
            Component::Unorm16 => {
                linear(f64::from(u16::from_ne_bytes([bytes[2 * c], bytes[2 * c + 1]])) / 65535.0)
            }
            Component::Float32 => {
                let word = [0, 1, 2, 3].map(|i| bytes[4 * c + i]);
                f64::from(f32::from_ne_bytes(word))
            }
        };
        let color = if channels < 3 { [channel(0); 3] } else { [channel(0), channel(1), channel(2)] };
        let light = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
        if light.is_finite() { light.max(0.0) } else { 0.0 }
    }
}

/// Returns the direction of a point of an equirectangular picture in its mapping's frame, up to a factor its solid angle.
fn sphere_point(u: f64, v: f64) -> (DVec3, f64) {
    let (polar, turn) = (PI * v, TAU * u);
    (DVec3::new(polar.sin() * turn.cos(), polar.cos(), polar.sin() * turn.sin()), polar.sin())
}

/// Returns the direction of (s, t) on the face of a cube (Vulkan 1.3, "Cube Map Face Selection").
fn cube_point(face: usize, s: f64, t: f64) -> (DVec3, f64) {
    let way = match face {
        0 => DVec3::new(1.0, -t, -s),
        1 => DVec3::new(-1.0, -t, s),
        2 => DVec3::new(s, 1.0, t),
        3 => DVec3::new(s, -1.0, -t),
        4 => DVec3::new(s, -t, 1.0),
        _ => DVec3::new(-s, -t, -1.0),
    };
    (way, way.length().powi(-3))
}
