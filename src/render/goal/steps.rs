//! The steps of a pass of sampling to a goal as pipelines, and the buffers that they share. Input: a device and the size of
//! a picture. Output: submissions of several steps, each followed by a few words about the whole picture.

use std::sync::Arc;

use rayon::prelude::*;

use crate::core::error::{Error, Result};
use crate::gpu::shaders::{self, ReflectedBinding};
use crate::gpu::{BindGroup, Bound, Buffer, BufferUse, Dispatch, Gpu, Pipeline};
use crate::pack::{PackedScene, SlotCounts};
use crate::render::batches::PIXEL_BYTES;
use crate::render::build_pipeline;
use crate::schema::bindings;
use crate::schema::blocks::{GoalStep, PixelBatch};
use crate::schema::constants::{
    DRAW_CELLS, GOAL_ARRAYS, GOAL_BINS, GOAL_BINS_AT, GOAL_COLUMNS, GOAL_PART_SIDE, GOAL_PARTIALS,
    GOAL_THREADS, MAX_GOAL_DRAWS,
};
use crate::schema::enums::GoalStepKind;
use crate::schema::specialization::Constant;

/// Pixels of a workgroup that fills bins.
const PIXELS_OF_BINS: u32 = 16 * GOAL_THREADS;
/// Parts of batches for which there is room: four for each pixel, but at least and at most these.
const LEAST_PARTS: u64 = 1 << 16;
const MOST_PARTS: u64 = 1 << 22;
/// Workgroups in a row; every device supports 65535.
const LONGEST_ROW: u32 = 1 << 15;

pub struct GoalSteps {
    pipelines: Vec<Arc<Pipeline>>,
    pub size: [u32; 2],
    /// Sums of both halves of all pixels.
    pub film: Buffer,
    pub pixels: Buffer,
    pub totals: Buffer,
    pub batches: Buffer,
    pub long: Parts,
}

/// Parts of long batches.
pub struct Parts {
    pub list: Buffer,
    pub sums: Buffer,
    pub room: u32,
}

impl Parts {
    fn new(gpu: &Gpu, room: u32) -> Result<Parts> {
        let buffer = |name| gpu.buffer(name, 16 * u64::from(room), BufferUse::Storage);
        Ok(Parts { list: buffer("parts of batches")?, sums: buffer("sums of parts")?, room })
    }
}

impl GoalSteps {
    /// Builds all steps; `None` if the device has no room for them or allows less than they need, or if samples have signs,
    /// whose sums the host makes.
    pub fn new(gpu: &Gpu, scene: &PackedScene) -> Result<Option<GoalSteps>> {
        let size = scene.header.film_size.to_array();
        let pixels = size.map(u64::from).iter().product::<u64>();
        let pixel_bytes = 4 * pixels * u64::from(GOAL_ARRAYS);
        let totals_bytes = 4 * (u64::from(GOAL_PARTIALS) + u64::from(GOAL_COLUMNS) * u64::from(parts(size)));
        let batch_bytes = 2 * pixels * size_of::<PixelBatch>() as u64;
        let film_bytes = pixels * PIXEL_BYTES;
        let limits = &gpu.info().limits;
        let largest = pixel_bytes.max(batch_bytes).max(totals_bytes).max(film_bytes);
        let fits = largest <= limits.max_storage_buffer_range
            && pixel_bytes + 3 * film_bytes + batch_bytes <= limits.heap_bytes / 2
            && GOAL_THREADS <= limits.max_workgroup_invocations
            && shaders::GOAL.bindings.len() <= limits.max_storage_buffers_per_stage as usize;
        if scene.mean_sign.is_some() || !fits {
            return Ok(None);
        }
        let buffer = |name, bytes| gpu.buffer(name, bytes, BufferUse::Storage);
        let buffers = || {
            let large = [("film", film_bytes), ("goal pixels", pixel_bytes), ("goal batches", batch_bytes)];
            let [film, pixels_of, batches] = large.map(|(name, bytes)| buffer(name, bytes));
            let long = Parts::new(gpu, (4 * pixels).clamp(LEAST_PARTS, MOST_PARTS) as u32);
            Ok::<_, Error>((film?, pixels_of?, batches?, buffer("goal totals", totals_bytes)?, long?))
        };
        // Where other programs have taken the memory, the host's own may do.
        let Ok((film, pixels, batches, totals, long)) = buffers() else { return Ok(None) };
        // Bins are empty before and after each plan.
        gpu.write_buffer(&totals, 0, &vec![0; 4 * (GOAL_BINS_AT + 3 * GOAL_BINS) as usize])?;
        let shader = &shaders::GOAL;
        let build = |&kind: &GoalStepKind| {
            let constants = shader.values([(Constant::GoalStepKind, kind as u32)]);
            build_pipeline(gpu, shader, &constants, SlotCounts::default(), size_of::<GoalStep>())
        };
        let pipelines = GoalStepKind::ALL.par_iter().map(build).collect::<Result<Vec<_>>>()?;
        Ok(Some(GoalSteps { pipelines, size, film, pixels, totals, batches, long }))
    }

    /// Returns the number of pixels.
    pub fn count(&self) -> u32 {
        self.size[0] * self.size[1]
    }

    /// Returns the parts of the picture with partial sums.
    pub fn parts(&self) -> u32 {
        parts(self.size)
    }

    /// Binds pixels that beams resolved, if there are any.
    pub fn bind(&self, gpu: &Gpu, resolved: Option<&Buffer>) -> Result<BindGroup> {
        let resource = |b: &ReflectedBinding| {
            let buffer = match b.binding {
                bindings::OUTPUT => &self.film,
                bindings::LIST => &self.batches,
                bindings::GOAL_PIXELS => &self.pixels,
                bindings::GOAL_RESOLVED => resolved.unwrap_or(&self.film),
                bindings::GOAL_PARTS => &self.long.list,
                bindings::GOAL_PART_SUMS => &self.long.sums,
                _ => &self.totals,
            };
            (b.binding, Bound::Buffer(buffer))
        };
        let bound: Vec<(u32, Bound<'_>)> = shaders::GOAL.bindings.iter().map(resource).collect();
        gpu.bind(&self.pipelines[0], &bound)
    }

    /// Returns the dispatch of a step.
    pub fn dispatch<'a>(
        &'a self,
        group: &'a BindGroup,
        kind: GoalStepKind,
        push: &'a GoalStep,
    ) -> Dispatch<'a> {
        Dispatch {
            pipeline: &self.pipelines[kind as usize],
            group,
            push: bytemuck::bytes_of(push),
            groups: rows(self.groups(kind, push)),
        }
    }

    /// Returns the workgroups of a step.
    fn groups(&self, kind: GoalStepKind, push: &GoalStep) -> u32 {
        match kind {
            GoalStepKind::FindUnseen | GoalStepKind::SumCapped => self.parts(),
            GoalStepKind::SumPartials => GOAL_COLUMNS,
            GoalStepKind::RaiseListed | GoalStepKind::EndParts => push.count.div_ceil(GOAL_THREADS),
            GoalStepKind::FillBins => self.count().div_ceil(PIXELS_OF_BINS),
            GoalStepKind::Solve | GoalStepKind::SumMasses => 1,
            GoalStepKind::WeighCells => DRAW_CELLS * DRAW_CELLS,
            GoalStepKind::DrawPixels | GoalStepKind::DrawParts | GoalStepKind::SumDraws => {
                MAX_GOAL_DRAWS.div_ceil(GOAL_THREADS)
            }
            _ => self.count().div_ceil(GOAL_THREADS),
        }
    }
}

fn parts([width, height]: [u32; 2]) -> u32 {
    width.div_ceil(GOAL_PART_SIDE) * height.div_ceil(GOAL_PART_SIDE)
}

fn rows(groups: u32) -> [u32; 3] {
    let row = groups.clamp(1, LONGEST_ROW);
    [row, groups.div_ceil(row).max(1), 1]
}
