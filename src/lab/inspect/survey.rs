//! What the view reads of each texture, by the oracle: one ray through the centre of each pixel, with the footprint of the
//! whole pixel. Input: a packed scene. Output: for each texture of texels its density, the levels that are read, and the
//! texels that no footprint covers. In large pictures every n-th pixel of every n-th row is looked at.

use glam::DVec2;
use rayon::prelude::*;

use super::density::Density;
use crate::oracle::camera::camera_ray;
use crate::oracle::footprint::camera_differential;
use crate::oracle::quantities::{first_hit, place_in_tile};
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{NO_SHAPE, Texture};
use crate::texture::sampler_spec::{Address, MipMode};

/// Pixels that are looked at, at most.
const MAX_PIXELS: u64 = 1 << 20;
/// Cells along the longer side of a texture in which texels that are read are marked, at most.
const MAX_CELLS: u32 = 1024;
/// Points along each axis of a footprint that mark cells, at most, and texels to each side that a point stands for.
const MAX_POINTS: f64 = 16.0;
const MAX_BLOCK: f64 = 8.0;
/// Footprints longer than this many widths count as elongated.
pub const ELONGATED: f64 = 2.0;

/// The parts of a texture that no footprint covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NeverRead {
    pub cells: u64,
    pub all: u64,
    /// Texels along each side of a cell.
    pub side: u32,
}

/// How a texture is seen.
#[derive(Clone, Debug)]
pub struct View {
    /// Index of the texture.
    pub texture: usize,
    pub size: [u32; 2],
    pub levels: u32,
    pub density: Density,
    /// Pixels whose footprint covers more than a texel, and those of them that are elongated.
    pub minified: u64,
    pub elongated: u64,
    /// Pixels that read each level; those between two levels read both.
    pub level_pixels: Vec<u64>,
    /// Of level 0; none for volumes.
    pub never_read: Option<NeverRead>,
}

/// How all textures are seen.
#[derive(Clone, Debug)]
pub struct Survey {
    pub views: Vec<View>,
    /// Pixels that were looked at.
    pub pixels: u64,
    /// Pixels without a texture of texels.
    pub untextured: u64,
    /// Every so many pixels along both axes.
    pub step: u32,
}

/// The look-up of one pixel.
struct Sighting {
    texture: usize,
    at: DVec2,
    change: [DVec2; 2],
    address: [Address; 2],
    face: u32,
    major: f64,
    minor: f64,
    level: f64,
    blends: bool,
}

/// Looks at the pixels of a scene that was packed for rays through their centres.
pub fn survey(scene: &PackedScene) -> Survey {
    let [width, height] = scene.header.film_size.to_array();
    let all = u64::from(width) * u64::from(height);
    let step = (all as f64 / MAX_PIXELS as f64).sqrt().ceil().max(1.0) as u32;
    let rows: Vec<u32> = (0..height).step_by(step as usize).collect();
    let row =
        |&y: &u32| (0..width).step_by(step as usize).map(|x| sighting(scene, [x, y])).collect::<Vec<_>>();
    let sightings: Vec<Option<Sighting>> = rows.par_iter().flat_map_iter(row).collect();
    let pixels = sightings.len() as u64;
    let mut of: Vec<Vec<Sighting>> = scene.records.textures.iter().map(|_| Vec::new()).collect();
    for sighting in sightings.into_iter().flatten() {
        of[sighting.texture].push(sighting);
    }
    let untextured = pixels - of.iter().map(|own| own.len() as u64).sum::<u64>();
    let textures = scene.records.textures.iter().zip(&of).enumerate();
    let has_texels = textures.filter(|(_, (image, _))| image.kind != TextureKind::Procedural);
    let views = has_texels.map(|(texture, (image, own))| view(texture, image, own)).collect();
    Survey { views, pixels, untextured, step }
}

fn sighting(scene: &PackedScene, [x, y]: [u32; 2]) -> Option<Sighting> {
    let header = &scene.header;
    let place = [x + header.crop.x, y + header.crop.y];
    let ray = camera_ray(header, place, DVec2::splat(0.5));
    let first = first_hit(scene, &ray, &camera_differential(header, &ray), NO_SHAPE)?;
    let look_up = first.look_up(scene, &ray)?;
    Some(Sighting {
        texture: look_up.texture as usize,
        at: look_up.coordinate.at.truncate(),
        change: look_up.coordinate.change.map(|d| d.truncate()),
        address: [look_up.how.address_u, look_up.how.address_v],
        face: look_up.face,
        major: look_up.spread.major.sqrt(),
        minor: look_up.spread.minor.sqrt(),
        level: look_up.level(),
        blends: look_up.how.mip_mode == MipMode::Linear,
    })
}

fn view(texture: usize, image: &Texture, sightings: &[Sighting]) -> View {
    let minified = || sightings.iter().filter(|s| s.major > 1.0);
    let mut level_pixels = vec![0; image.levels as usize];
    for s in sightings {
        let low = (s.level.floor() as usize).min(level_pixels.len() - 1);
        level_pixels[low] += 1;
        if s.blends && s.level.fract() > 0.0 && low + 1 < level_pixels.len() {
            level_pixels[low + 1] += 1;
        }
    }
    View {
        texture,
        size: [image.size.x, image.size.y],
        levels: image.levels,
        density: Density::new(sightings.iter().map(|s| s.major).collect()),
        minified: minified().count() as u64,
        elongated: minified().filter(|s| s.major > ELONGATED * s.minor).count() as u64,
        level_pixels,
        never_read: (image.kind != TextureKind::Volume).then(|| never_read(image, sightings)),
    }
}

/// Marks the cells of the texels around points of each footprint, and counts those that are left.
fn never_read(image: &Texture, sightings: &[Sighting]) -> NeverRead {
    let faces = if image.kind == TextureKind::Cube { 6 } else { 1 };
    let mut marks = Marks::new([image.size.x, image.size.y], faces);
    for s in sightings {
        // Nothing is left to be found in most views of repeated textures.
        if marks.left == 0 {
            break;
        }
        marks.add(s);
    }
    NeverRead { cells: marks.left, all: marks.read.len() as u64, side: marks.side }
}

/// The cells of a texture that some footprint covers.
struct Marks {
    /// In texels.
    size: DVec2,
    side: u32,
    cells: [usize; 2],
    read: Vec<bool>,
    left: u64,
}

impl Marks {
    fn new([width, height]: [u32; 2], faces: usize) -> Marks {
        let side = width.max(height).div_ceil(MAX_CELLS);
        let cells = [width, height].map(|n| n.div_ceil(side) as usize);
        let read = vec![false; cells[0] * cells[1] * faces];
        Marks { size: DVec2::new(width.into(), height.into()), side, cells, left: read.len() as u64, read }
    }

    /// Marks the cells around points of a footprint; points farther apart than a texel stand for those between them.
    fn add(&mut self, s: &Sighting) {
        let lengths = s.change.map(|d| (d * self.size).length());
        let points = lengths.map(|length| length.ceil().clamp(1.0, MAX_POINTS));
        let spacing = (lengths[0] / points[0]).max(lengths[1] / points[1]);
        let half = 0.5 * spacing.clamp(1.0, MAX_BLOCK);
        for i in 0..points[0] as u32 {
            for j in 0..points[1] as u32 {
                let way = [(i, points[0]), (j, points[1])].map(|(i, n)| (f64::from(i) + 0.5) / n - 0.5);
                let at = s.at + way[0] * s.change[0] + way[1] * s.change[1];
                let [columns, rows] = [0, 1].map(|axis| self.around(s.address[axis], at[axis], half, axis));
                for &row in rows.iter().flatten() {
                    columns.iter().flatten().for_each(|&column| self.mark(s.face as usize, column, row));
                }
            }
        }
    }

    /// Returns the cells along an axis within `half` texels of a coordinate.
    fn around(
        &self,
        address: Address,
        at: f64,
        half: f64,
        axis: usize,
    ) -> [Option<usize>; MAX_BLOCK as usize + 1] {
        let size = self.size[axis];
        let count = (2.0 * half / f64::from(self.side)).ceil() as usize;
        let mut cells = [None; MAX_BLOCK as usize + 1];
        for (k, cell) in cells.iter_mut().enumerate().take(count + 1) {
            let beside = half * (2.0 * k as f64 / count as f64 - 1.0);
            let place = place_in_tile(address, at + beside / size) * size;
            *cell = Some((place as usize / self.side as usize).min(self.cells[axis] - 1));
        }
        cells
    }

    fn mark(&mut self, face: usize, column: usize, row: usize) {
        let read = &mut self.read[(face * self.cells[1] + row) * self.cells[0] + column];
        self.left -= u64::from(!*read);
        *read = true;
    }
}
