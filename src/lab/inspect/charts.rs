//! The charts of a texture: parts of it that connected triangles share, and the finest level on which one of them is seen on
//! another. Input: the triangles of a scene that read the texture by their own coordinates. Output: the number of charts,
//! and that level.

use std::collections::HashMap;

use glam::DVec2;

use super::chart_grid::{EMPTY, Grid};
use crate::scene::model::{Mapping, MappingKind, OwnUv, Scene, TextureUse};
use crate::texture::sampler_spec::Address;

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
    /// Where they bleed.
    pub bleeding: Option<Bleeding>,
}

/// The finest level on which the linear filter reads, within one chart, texels that show another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bleeding {
    pub level: u32,
    /// The number of these texels.
    pub texels: u64,
}

impl Charts {
    /// Returns the finest level on which charts mix.
    pub fn bleeds_from(&self) -> Option<u32> {
        self.bleeding.map(|bleeding| bleeding.level)
    }
}

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
    let repeats = repeats(scene, readers);
    let mut bleeding = None;
    for level in first_level..levels.max(first_level + 1) {
        let texels = grid.foreign(&triangles, &numbers, repeats);
        if texels > 0 {
            bleeding = Some(Bleeding { level, texels });
            break;
        }
        grid = grid.halved();
    }
    let count = numbers.iter().collect::<std::collections::BTreeSet<_>>().len();
    Some(Charts { count, overlap, bleeding })
}

/// Returns along which axes a sampler of these materials repeats the texture.
fn repeats(scene: &Scene, readers: &[(usize, Coordinates)]) -> [bool; 2] {
    let uses = readers.iter().flat_map(|(material, at)| {
        scene.materials[*material].textures().filter(move |used| Coordinates::of(used) == *at)
    });
    let samplers: Vec<_> = uses.filter_map(|used| scene.samplers.get(used.sampler)).collect();
    [0, 1].map(|axis| samplers.iter().any(|sampler| sampler.address[axis] == Address::Repeat))
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
}
