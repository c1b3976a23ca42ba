//! The texels of an image that some footprint covers, from any number of threads. Input: the image's size, and
//! footprints. Output: which cells of texels are left.

use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec2;

use crate::oracle::quantities::place_in_tile;
use crate::texture::sampler_spec::Address;

/// Cells along the longer side of a texture in which texels that are read are marked, at most.
const MAX_CELLS: u32 = 1024;
/// Points along each axis of a footprint that mark cells, at most, and texels to each side that a point stands for.
const MAX_POINTS: f64 = 16.0;
const MAX_BLOCK: f64 = 8.0;

/// The parts of a texture that no footprint covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NeverRead {
    pub cells: u64,
    pub all: u64,
    /// Texels along each side of a cell.
    pub side: u32,
}

/// A footprint on a face of an image.
pub struct Mark {
    pub at: DVec2,
    pub change: [DVec2; 2],
    pub address: [Address; 2],
    pub face: u32,
}

/// The cells of a texture that some footprint covers.
pub struct Marks {
    /// In texels.
    size: DVec2,
    side: u32,
    cells: [usize; 2],
    count: usize,
    /// A bit for each cell.
    read: Vec<AtomicU64>,
    left: AtomicU64,
}

impl Marks {
    pub fn new([width, height]: [u32; 2], faces: usize) -> Marks {
        let side = width.max(height).div_ceil(MAX_CELLS);
        let cells = [width, height].map(|n| n.div_ceil(side) as usize);
        let count = cells[0] * cells[1] * faces;
        let read = (0..count.div_ceil(64)).map(|_| AtomicU64::new(0)).collect();
        let size = DVec2::new(width.into(), height.into());
        Marks { size, side, cells, count, read, left: AtomicU64::new(count as u64) }
    }

    /// Marks the cells around points of a footprint; points farther apart than a texel stand for those between them.
    pub fn add(&self, s: &Mark) {
        // Nothing is left to be found in most views of repeated textures.
        if self.left.load(Ordering::Relaxed) == 0 {
            return;
        }
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

    fn mark(&self, face: usize, column: usize, row: usize) {
        let cell = (face * self.cells[1] + row) * self.cells[0] + column;
        let (word, bit) = (&self.read[cell / 64], 1 << (cell % 64));
        if word.load(Ordering::Relaxed) & bit == 0 && word.fetch_or(bit, Ordering::Relaxed) & bit == 0 {
            self.left.fetch_sub(1, Ordering::Relaxed);
        }
    }

    /// Returns what is left.
    pub fn never_read(&self) -> NeverRead {
        NeverRead { cells: self.left.load(Ordering::Relaxed), all: self.count as u64, side: self.side }
    }
}
