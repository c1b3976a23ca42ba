//! The charts of a texture: parts of it that connected triangles share, and the levels on which one texel mixes two of
//! them. Input: the triangles of a scene that read the texture by their own coordinates. Output: the number of charts, and
//! for each level the texels that several of them share.

use std::collections::HashMap;

use glam::DVec2;

use crate::scene::model::{Mapping, MappingKind, OwnUv, Scene, TextureUse};

/// More triangles are not looked at.
const MAX_TRIANGLES: usize = 1 << 20;
/// Cells along the longer side of the texture, at most.
const MAX_CELLS: u32 = 2048;
/// How far beyond the texture's edge a coordinate still counts as inside.
const BESIDE: f64 = 1e-6;
/// Charts that share more than this share of the texels of the finest level lie over each other on purpose.
const OVERLAPPING: f64 = 0.05;

/// The charts of a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Charts {
    pub count: usize,
    /// Charts lie over each other: they share texels at every level.
    pub overlap: bool,
    /// The finest level that was looked at.
    pub first_level: u32,
    /// Texels of that level and of each coarser one that several charts share.
    pub shared: Vec<u64>,
}

impl Charts {
    /// Returns the finest level on which texels mix charts.
    pub fn bleeds_from(&self) -> Option<u32> {
        let at = self.shared.iter().position(|shared| *shared > 0)?;
        Some(self.first_level + at as u32)
    }
}

/// No chart covers the cell, or several do; others have the number of their chart.
const EMPTY: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

/// The coordinates of triangles at which a texture is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinates {
    First,
    Second,
    /// Those that one map has for itself.
    Own(OwnUv),
}

impl Coordinates {
    fn of(used: &TextureUse) -> Coordinates {
        match used.own_uv {
            _ if used.second_uv => Coordinates::Second,
            Some(own) => Coordinates::Own(own),
            None => Coordinates::First,
        }
    }

    /// Returns them, from what returns those of a set.
    fn read(&self, of_set: &dyn Fn(Option<usize>) -> [DVec2; 3]) -> [DVec2; 3] {
        match self {
            Coordinates::First => of_set(None),
            Coordinates::Second => of_set(Some(0)),
            Coordinates::Own(own) => of_set(Some(own.set)).map(|uv| own.transform.transform_point2(uv)),
        }
    }
}

/// Returns the materials that read one of some textures by coordinates of triangles, and by which.
pub fn readers(scene: &Scene, textures: &[usize]) -> Vec<(usize, Coordinates)> {
    let own = scene.materials.iter().enumerate().filter(|(_, own)| own.mapping.kind == MappingKind::Surface);
    let all = own
        .flat_map(|(number, own)| own.textures().map(move |used| (number, used)))
        .filter(|(_, used)| textures.contains(&used.texture))
        .map(|(number, used)| (number, Coordinates::of(&used)));
    let mut readers = Vec::new();
    for reader in all {
        if !readers.contains(&reader) {
            readers.push(reader);
        }
    }
    readers
}

/// Returns the charts of an image of this size and number of levels that these materials read; `None` if no triangles have
/// coordinates within the image, or too many.
pub fn charts(
    scene: &Scene,
    readers: &[(usize, Coordinates)],
    size: [u32; 2],
    levels: u32,
) -> Option<Charts> {
    let triangles = triangles(scene, readers)?;
    let inside = |uv: &DVec2| uv.min_element() >= -BESIDE && uv.max_element() <= 1.0 + BESIDE;
    if triangles.is_empty() || !triangles.iter().flatten().all(inside) {
        return None;
    }
    let numbers = connected(&triangles);
    let first_level = (size[0].max(size[1]) as f64 / f64::from(MAX_CELLS)).log2().ceil().max(0.0) as u32;
    let mut grid = Grid::new(size.map(|n| (n >> first_level).max(1) as usize));
    triangles.iter().zip(&numbers).for_each(|(triangle, &chart)| grid.fill(triangle, chart));
    let covered = grid.cells.iter().filter(|cell| **cell != EMPTY).count().max(1);
    let overlap = grid.shared() as f64 / covered as f64 > OVERLAPPING;
    let mut shared = Vec::new();
    for _ in first_level..levels.max(first_level + 1) {
        shared.push(grid.shared());
        grid = grid.halved();
    }
    let count = numbers.iter().collect::<std::collections::BTreeSet<_>>().len();
    Some(Charts { count, overlap, first_level, shared })
}

/// Returns the texture coordinates at which triangles of these materials read.
fn triangles(scene: &Scene, readers: &[(usize, Coordinates)]) -> Option<Vec<[DVec2; 3]>> {
    if readers.is_empty() || scene.shapes.triangle_count() > MAX_TRIANGLES {
        return None;
    }
    let mut found = Vec::new();
    scene.shapes.for_each_coordinates(|material, of_set| {
        for (_, at) in readers.iter().filter(|(own, _)| *own == material) {
            found.push(at.read(of_set).map(|uv| mapped(&scene.materials[material].mapping, uv)));
        }
    });
    Some(found)
}

/// Returns the coordinate after scale, rotation and offset.
fn mapped(mapping: &Mapping, uv: DVec2) -> DVec2 {
    DVec2::from_angle(mapping.rotate.to_radians()).rotate(uv * mapping.scale) + mapping.offset
}

/// Returns the chart of each triangle: those that share a corner's coordinates are of one.
fn connected(triangles: &[[DVec2; 3]]) -> Vec<u32> {
    fn root(parents: &mut [u32], mut of: u32) -> u32 {
        while parents[of as usize] != of {
            parents[of as usize] = parents[parents[of as usize] as usize];
            of = parents[of as usize];
        }
        of
    }
    let mut parents: Vec<u32> = (0..triangles.len() as u32).collect();
    let mut owners: HashMap<[u64; 2], u32> = HashMap::new();
    for (number, triangle) in (0..).zip(triangles) {
        for corner in triangle {
            let owner = *owners.entry([corner.x.to_bits(), corner.y.to_bits()]).or_insert(number);
            let [a, b] = [root(&mut parents, owner), root(&mut parents, number)];
            parents[b as usize] = a;
        }
    }
    (0..triangles.len() as u32).map(|number| root(&mut parents, number)).collect()
}

/// The chart of each texel of a level.
struct Grid {
    size: [usize; 2],
    cells: Vec<u32>,
}

impl Grid {
    fn new(size: [usize; 2]) -> Grid {
        Grid { size, cells: vec![EMPTY; size[0] * size[1]] }
    }

    fn shared(&self) -> u64 {
        self.cells.iter().filter(|cell| **cell == SEVERAL).count() as u64
    }

    fn put(&mut self, x: usize, y: usize, chart: u32) {
        let cell = &mut self.cells[y * self.size[0] + x];
        *cell = joined(*cell, chart);
    }

    /// Marks the texels whose centres lie in the triangle, at least that of its middle.
    fn fill(&mut self, triangle: &[DVec2; 3], chart: u32) {
        let size = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        let [a, b, c] = triangle.map(|uv| uv * size);
        let last = self.size.map(|n| n as f64 - 1.0);
        let cell = |at: f64, axis: usize| at.floor().clamp(0.0, last[axis]) as usize;
        let middle = (a + b + c) / 3.0;
        self.put(cell(middle.x, 0), cell(middle.y, 1), chart);
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let area = (b - a).perp_dot(c - a);
        for y in cell(low.y, 1)..=cell(high.y, 1) {
            for x in cell(low.x, 0)..=cell(high.x, 0) {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let sides =
                    [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(p - from) * area.signum());
                if sides.iter().all(|side| *side >= 0.0) {
                    self.put(x, y, chart);
                }
            }
        }
    }

    /// Returns the next level.
    fn halved(&self) -> Grid {
        let mut next = Grid::new(self.size.map(|n| (n / 2).max(1)));
        for y in 0..self.size[1] {
            for x in 0..self.size[0] {
                let [column, row] = [(x / 2).min(next.size[0] - 1), (y / 2).min(next.size[1] - 1)];
                next.put(column, row, self.cells[y * self.size[0] + x]);
            }
        }
        next
    }
}

fn joined(a: u32, b: u32) -> u32 {
    match (a, b) {
        (EMPTY, other) | (other, EMPTY) => other,
        (a, b) if a == b => a,
        _ => SEVERAL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn charts_are_joined_by_corners() {
        let [a, b, c, d] = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE];
        let [e, f, g] = [DVec2::splat(5.0), DVec2::splat(6.0), DVec2::new(5.0, 6.0)];
        let numbers = connected(&[[a, b, c], [e, f, g], [b, d, c]]);
        assert_eq!(numbers[0], numbers[2]);
        assert_ne!(numbers[0], numbers[1]);
    }

    #[test]
    fn squares_two_texels_apart_mix_where_a_texel_holds_both() {
        let mut grid = Grid::new([16, 16]);
        let square = |x: f64| [DVec2::new(x, 0.0), DVec2::new(x + 0.25, 0.0), DVec2::new(x, 0.5)];
        // Texels 0 to 3, and 6 to 9.
        grid.fill(&square(0.0), 1);
        grid.fill(&square(6.0 / 16.0), 2);
        let shared: Vec<bool> =
            std::iter::successors(Some(grid), |g| Some(g.halved())).take(4).map(|g| g.shared() > 0).collect();
        assert_eq!(shared, [false, false, false, true]);
    }
}
