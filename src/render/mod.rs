//! Packed scene → film on a device: resources from the features, one pipeline, work handed out in
//! slices, film read back. Orchestrates `gpu`'s own types and knows nothing of Vulkan's.

mod beams;
mod diagnostics;
mod film_buffer;
mod images;
mod jobs;
mod loop_budget;
mod mip_chain;
mod resources;
mod session;
mod slices;
pub mod specialization;
mod texel_buffer;
mod tile_culling;
mod tuning;

use serde::Serialize;

use crate::adaptive::{Goal, Outcome};
use crate::core::error::{Error, Result};
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::shaders::{ReflectedBinding, Shader, specialise};
use crate::gpu::{BindGroup, BindingDesc, BindingKind, Gpu, Pipeline, PipelineDesc, RunTime};
use crate::pack::{PackedScene, SlotCounts};
use crate::schema::layout::Slice;

use film_buffer::{Band, FilmBuffer};

pub use images::can_sample;
pub(crate) use mip_chain::{MipGenerator, MipSource};
pub(crate) use resources::Resources;
pub use session::{Prepared, Session};
pub use tuning::{MipChoice, TexelChoice, Tuning};

/// Wall seconds by stage, in the order in which they come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Opening the device.
    pub startup: f64,
    /// Reading and packing scene and textures.
    pub load: f64,
    /// Building pipelines, with a dispatch of one workgroup: drivers compile just in time.
    pub compile: f64,
    pub upload: f64,
    pub render: f64,
    pub readback: f64,
    /// Encoding and writing the pictures.
    pub write: f64,
    pub total: f64,
}

/// What a render did beside its film.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub left_out: Vec<String>,
    /// What a person should know before looking at the picture.
    pub warnings: Vec<String>,
    pub seconds: Seconds,
    /// How far sampling to a goal came.
    pub outcome: Option<Outcome>,
    /// Of beams: pixels that were left to samples.
    pub sampled_pixels: Option<u64>,
    /// Of cones: weight of what none was traced for, or no room was kept, over that of the whole picture.
    pub dropped: Option<f64>,
    /// Geometry was of f64.
    pub double: bool,
    /// How often what went beyond a limit, where that is counted.
    pub guards: Option<diagnostics::Counts>,
    /// Device timestamps around the slices, summed.
    pub device_render_seconds: f64,
    /// The same around the passes that make levels of textures, if there were any.
    pub device_mips_seconds: Option<f64>,
    /// The same around the survey of the picture, if there was one.
    pub device_survey_seconds: Option<f64>,
    pub slices: u32,
    /// Wall time of the longest slice: how long a Ctrl-C may wait.
    pub longest_slice_seconds: f64,
    /// Bytes of device memory at the end of the render.
    pub device_bytes: u64,
}

impl Report {
    fn add_slice(&mut self, time: RunTime) {
        self.device_render_seconds += time.device_seconds;
        self.slices += 1;
        self.longest_slice_seconds = self.longest_slice_seconds.max(time.wall_seconds);
    }
}

/// Renders on an open device. The texels of `scene` leave the host's memory once the device has them.
pub fn render(
    gpu: &Gpu,
    scene: PackedScene,
    keep_everything: bool,
    tuning: &Tuning,
    progress: &dyn Progress,
) -> Result<(Film, Report)> {
    render_to_goal(gpu, scene, keep_everything, tuning, None, progress)
}

/// The same; of a scene that is sampled by jobs, `goal` says when it is done, without one its own number of
/// samples.
pub fn render_to_goal(
    gpu: &Gpu,
    scene: PackedScene,
    keep_everything: bool,
    tuning: &Tuning,
    goal: Option<Goal>,
    progress: &dyn Progress,
) -> Result<(Film, Report)> {
    Session::open(gpu, scene, keep_everything, tuning)?.prepare()?.render_to_goal(goal, progress)
}

/// A pipeline of `shader` with these constants; the scene has so many descriptors.
pub(crate) fn build_pipeline(
    gpu: &Gpu,
    shader: &Shader,
    constants: &[(u32, u32)],
    slots: SlotCounts,
    push_constant_bytes: usize,
) -> Result<Pipeline> {
    let describe = |b: &ReflectedBinding| {
        let count = match (b.kind, b.binding) {
            (BindingKind::SampledImage, resources::VOLUMES) => slots.volumes.max(1),
            (BindingKind::SampledImage, resources::CUBES) => slots.cubes.max(1),
            (BindingKind::SampledImage, _) => slots.flat.max(1),
            (BindingKind::TexelBuffer, resources::TEXELS) => slots.texel_blocks.max(1),
            _ => 1,
        };
        BindingDesc { binding: b.binding, kind: b.kind, count }
    };
    let bindings: Vec<BindingDesc> = shader.bindings.iter().map(describe).collect();
    let opaque = shader.constant("OPAQUE_UNIFORMS").map(|c| (c.id, Tuning::opaque_uniforms(gpu.info())));
    let constants: Vec<(u32, u32)> =
        constants.iter().copied().chain(opaque.map(|(id, is)| (id, u32::from(is)))).collect();
    gpu.pipeline(&PipelineDesc {
        name: shader.name,
        spirv: &specialise(shader.spirv, &constants),
        bindings: &bindings,
        push_constant_bytes: push_constant_bytes as u32,
        constants: &constants,
    })
}

struct Renderer<'a> {
    gpu: &'a Gpu,
    pipeline: Pipeline,
    group: BindGroup,
    groups_per_tile: u32,
}

impl Renderer<'_> {
    /// One workgroup of the first slice: whatever the driver compiles late, it compiles now.
    fn warm_up(&self, film: &FilmBuffer) -> Result<()> {
        if let Some(band) = film.bands().next() {
            let slice = Slice { sample_count: 1, ..band.slice() };
            self.gpu.run(&self.pipeline, &self.group, bytemuck::bytes_of(&slice), [1, 1, 1])?;
        }
        Ok(())
    }

    /// All samples of all tiles of a band, in slices as long as the plan allows.
    fn band(
        &self,
        band: &Band,
        plan: &mut slices::Plan,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        self.tiles(band, band.tiles, plan, report, progress)
    }

    /// The first `count` tiles in line alone.
    fn tiles(
        &self,
        band: &Band,
        count: u32,
        plan: &mut slices::Plan,
        report: &mut Report,
        progress: &dyn Progress,
    ) -> Result<()> {
        for (first_sample, sample_count) in plan.chunks() {
            let mut first_tile = 0;
            while first_tile < count {
                let tiles = plan.tiles(count - first_tile, sample_count);
                let slice = Slice { first_tile, first_sample, sample_count, ..band.slice() };
                let groups = [self.groups_per_tile, tiles, 1];
                let time = self.gpu.run(&self.pipeline, &self.group, bytemuck::bytes_of(&slice), groups)?;
                plan.learn(tiles, sample_count, time.wall_seconds);
                report.add_slice(time);
                progress.advance(plan.done());
                if progress.cancelled() {
                    return Err(Error::Interrupted);
                }
                first_tile += tiles;
            }
        }
        Ok(())
    }
}
