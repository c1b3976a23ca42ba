//! Tile culling, before any sample: finds for each cell of pixels the shapes that its camera rays may
//! meet, and how uniform it is. Input: a scene of many shapes on a device. Output: the lists that camera
//! rays read, and the number of samples with which each pixel starts.

use std::sync::Arc;

use super::{Report, Resources, Tuning, build_pipeline, mesh_passes, specialization};
use crate::core::error::Result;
use crate::gpu::shaders;
use crate::gpu::{BindGroup, Buffer, BufferUse, DeviceKind, Gpu, Pipeline};
use crate::pack::PackedScene;
use crate::pack::features::Features;
use crate::schema::enums::TexelSource;
use crate::schema::layout::{
    CELL_BLOCK_HEIGHT, CELL_BLOCK_WIDTH, CELL_COUNTER_DIVISIONS, CELL_COUNTERS, CELL_EMPTY, CELL_UNIFORM,
    CELL_WORDS, CELLS_A_DIVISION, CELLS_A_ROOM, CellRange, MORE_WORDS, SHADE_WORDS, TILE,
};
use crate::schema::specialization::Constant;

const GROUP: u32 = 64;
/// Triangles times cells that one submission tests: some tenths of a second on a CPU and on a slow GPU. The latter has to
/// have many cells at once, as few threads take as long as many.
const MAX_TESTS_CPU: u64 = 1 << 24;
const MAX_TESTS_GPU: u64 = 1 << 28;

/// What stands behind the cells at first: nothing is taken.
const COUNTERS: [u32; CELL_COUNTERS as usize] = [0; CELL_COUNTERS as usize];

/// Boxes and triangles of meshes that are tested for a cell, of few of which more.
const TESTS_OF_MESHES: u64 = 1024;

pub struct TileCulling {
    pub buffer: Buffer,
    pipeline: Arc<Pipeline>,
    group: BindGroup,
    /// Side of a cell in pixels, and the number of cells across and down.
    side: u32,
    cells: [u32; 2],
    cells_at_once: u32,
    /// Behind the cells there is room for more triangles of some of them.
    has_rooms: bool,
    /// They list what may shade the cells, too.
    pub lists_shades: bool,
}

impl TileCulling {
    pub fn new(
        gpu: &Gpu,
        scene: &PackedScene,
        resources: &Resources,
        features: &Features,
    ) -> Result<TileCulling> {
        let shader = shaders::TILE_CULLING_FAMILY.shader(TexelSource::None, features.records())?;
        let slots = resources.slots;
        let lists_shades = mesh_passes::lists_shades(gpu.info(), scene, features);
        let mut constants =
            specialization::constants(shader, features, &resources.sections, [GROUP, 1], slots);
        constants.extend(shader.values([(Constant::ListsShades, u32::from(lists_shades))]));
        let pipeline = build_pipeline(gpu, shader, &constants, slots, size_of::<CellRange>())?;
        let [width, height] = scene.header.film_size.to_array();
        let side = scene.header.cell_side;
        let cells = [width, height].map(|pixels| pixels.div_ceil(side));
        let count = cells.map(u64::from).iter().product::<u64>();
        let cells_end = count * u64::from(CELL_WORDS) * 4;
        let mut bytes = cells_end;
        if scene.has_concave_shapes() {
            let divisions = if Tuning::holds_triangles(gpu.info()) {
                count.div_ceil(u64::from(CELLS_A_DIVISION)) * (1 + 4 * u64::from(CELL_WORDS))
            } else {
                0
            };
            let rooms = count.div_ceil(u64::from(CELLS_A_ROOM)) * u64::from(MORE_WORDS);
            let shades = if lists_shades { count * u64::from(SHADE_WORDS) } else { 0 };
            let limit = gpu.info().limits.max_storage_buffer_range;
            bytes = (cells_end + (COUNTERS.len() as u64 + divisions + rooms + shades) * 4)
                .min(limit.max(cells_end));
        }
        let has_rooms = bytes >= cells_end + COUNTERS.len() as u64 * 4;
        let buffer = gpu.buffer("tile lists", bytes, BufferUse::Storage)?;
        let group = resources.bind(gpu, &pipeline, shader, &buffer, None)?;
        let tests =
            scene.listed_shapes().max(1) as u64 + TESTS_OF_MESHES * u64::from(scene.has_concave_shapes());
        let most = if gpu.info().kind == DeviceKind::Cpu { MAX_TESTS_CPU } else { MAX_TESTS_GPU };
        let cells_at_once = (most / tests).clamp(u64::from(GROUP), 1 << 20) as u32;
        let culling =
            TileCulling { buffer, pipeline, group, side, cells, cells_at_once, has_rooms, lists_shades };
        // Lazy compilation in the driver happens now; the pipelines that read the lists are then tried on the first tile.
        let [across, down] = culling.whole_blocks();
        let end = across * down.min(TILE.div_ceil(side).next_multiple_of(CELL_BLOCK_HEIGHT));
        culling.part(gpu, CellRange { first: 0, end, quarters: 0 }, &mut Report::default())?;
        Ok(culling)
    }

    /// Returns the number of cells across and down, with those that complete the last blocks.
    fn whole_blocks(&self) -> [u32; 2] {
        let [across, down] = self.cells;
        [across.next_multiple_of(CELL_BLOCK_WIDTH), down.next_multiple_of(CELL_BLOCK_HEIGHT)]
    }

    /// Fills the lists.
    pub fn run(&self, gpu: &Gpu, report: &mut Report) -> Result<()> {
        if self.has_rooms {
            gpu.write_buffer(&self.buffer, self.cells_end(), bytemuck::cast_slice(&COUNTERS))?;
        }
        let cells = self.whole_blocks().iter().product();
        for first in (0..cells).step_by(self.cells_at_once as usize) {
            let end = cells.min(first + self.cells_at_once);
            self.part(gpu, CellRange { first, end, quarters: 0 }, report)?;
        }
        if self.has_rooms {
            let mut counters = COUNTERS;
            gpu.read_buffer(&self.buffer, self.cells_end(), bytemuck::cast_slice_mut(&mut counters))?;
            let room = (self.cells[0] * self.cells[1]).div_ceil(CELLS_A_DIVISION);
            let end = 4 * counters[CELL_COUNTER_DIVISIONS as usize].min(room);
            for first in (0..end).step_by(self.cells_at_once as usize) {
                let end = end.min(first + self.cells_at_once);
                self.part(gpu, CellRange { first, end, quarters: 1 }, report)?;
            }
        }
        Ok(())
    }

    /// Returns the bytes of the cells.
    fn cells_end(&self) -> u64 {
        self.cells.map(u64::from).iter().product::<u64>() * u64::from(CELL_WORDS) * 4
    }

    fn part(&self, gpu: &Gpu, part: CellRange, report: &mut Report) -> Result<()> {
        let groups = [(part.end - part.first).div_ceil(GROUP), 1, 1];
        let time = gpu.run(&self.pipeline, &self.group, bytemuck::bytes_of(&part), groups)?;
        report.device_culling_seconds =
            Some(report.device_culling_seconds.unwrap_or(0.0) + time.device_seconds);
        report.longest_slice_seconds = report.longest_slice_seconds.max(time.wall_seconds);
        Ok(())
    }

    /// Reads the `CELL_WORDS` words of each cell.
    pub fn words(&self, gpu: &Gpu) -> Result<Vec<u32>> {
        let mut words = vec![0u32; (self.cells[0] * self.cells[1] * CELL_WORDS) as usize];
        gpu.read_buffer(&self.buffer, 0, bytemuck::cast_slice_mut(&mut words))?;
        Ok(words)
    }

    /// Returns the samples of the first pass for each pixel: one if only the background is seen, two if a
    /// single surface that changes little fills the cell, otherwise `most`.
    pub fn first_samples(&self, gpu: &Gpu, [width, height]: [u32; 2], most: u32) -> Result<Vec<u32>> {
        let words = self.words(gpu)?;
        let of_cell = |x: u32, y: u32| {
            let cell = y / self.side * self.cells[0] + x / self.side;
            match words[(cell * CELL_WORDS + 1) as usize] {
                CELL_EMPTY => 1,
                CELL_UNIFORM => most.min(2),
                _ => most,
            }
        };
        Ok((0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| of_cell(x, y)).collect())
    }
}
