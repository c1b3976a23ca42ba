//! Scene → film on any number of devices, including the oracle: loads textures, packs the scene, opens sessions, and
//! runs an integrator on their backends. On a device: resources by features, one pipeline, work in slices, sums read
//! back. Uses the types of `gpu` only, none of Vulkan's.

mod aov;
mod backend;
mod batch_apart;
mod batch_lists;
mod batch_passes;
mod batches;
mod beams;
mod diagnostics;
mod dispatch_plan;
mod film_buffer;
mod goal;
mod images;
mod kept;
mod layer_samples;
mod layer_surfaces;
pub mod layers;
mod load;
mod loop_budget;
mod mesh_passes;
mod mesh_upload;
mod mip_chain;
mod options;
mod picture;
mod plan;
mod resources;
mod rivals;
mod sample_pipeline;
mod session;
mod session_pipelines;
pub mod specialization;
mod texel_buffer;
mod tile_culling;
mod tiles;
mod trial;
mod tuning;
mod unfinished;
mod unfinished_list;

use std::sync::Arc;

use serde::Serialize;

use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::shaders::{ReflectedBinding, Shader};
use crate::gpu::{BindingDesc, BindingKind, Gpu, Pipeline, RunTime};
use crate::integrators::Integrated;
use crate::integrators::adaptive::{Goal, Outcome};
use crate::pack::{PackedScene, SlotCounts};
use crate::schema::bindings;
use crate::schema::specialization::Constant;

pub use backend::DeviceBackend;
pub use images::can_sample;
pub use kept::{FileStamp, Kept, KeptTextures, stamp};
pub(crate) use mip_chain::{MipGenerator, MipSource};
pub use options::{On, Options};
pub use picture::{Picture, oracle_driver, render_kept, render_on, render_scene};
pub use plan::integrator;
pub(crate) use resources::Resources;
pub use session::{Prepared, Session};
pub use tuning::{EstimateChoice, MipChoice, TexelChoice, Tuning};

/// Wall-clock seconds by stage, in order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Opening the device.
    pub startup: f64,
    /// Reading and packing scene and textures.
    pub load: f64,
    /// Building pipelines, including a dispatch of one workgroup, as drivers compile lazily.
    pub compile: f64,
    pub upload: f64,
    pub render: f64,
    pub readback: f64,
    /// Encoding and writing the pictures.
    pub write: f64,
    pub total: f64,
}

/// The statistics of a render.
#[derive(Clone, Debug, Default)]
pub struct Report {
    pub left_out: Vec<String>,
    /// Warnings for the user about the picture.
    pub warnings: Vec<String>,
    pub seconds: Seconds,
    /// The result of sampling to a goal.
    pub outcome: Option<Outcome>,
    /// The number of pixels that beams left to samples.
    pub sampled_pixels: Option<u64>,
    /// The weight of secondary rays for which no cone was traced and of fragments for which there was no room, over
    /// that of the whole picture.
    pub dropped: Option<f64>,
    /// True if geometry was computed in f64.
    pub double: bool,
    /// How often each limit was exceeded, if that is counted.
    pub diagnostics: Option<diagnostics::Counts>,
    /// Sum of the device timestamps around all slices.
    pub device_render_seconds: f64,
    /// The same around the passes that generate mip levels, if there were any.
    pub device_mips_seconds: Option<f64>,
    /// The same around tile culling, if there was any.
    pub device_culling_seconds: Option<f64>,
    pub slices: u32,
    /// Wall time of the longest slice: an upper bound of the response time to Ctrl-C.
    pub longest_slice_seconds: f64,
    /// Bytes of device memory at the end of the render.
    pub device_bytes: u64,
}

impl Report {
    /// Adds the statistics of another device of the same render; stages that ran concurrently take as long as the
    /// longest.
    fn join(&mut self, other: &Report) {
        let longest = |a: &mut f64, b: f64| *a = a.max(b);
        longest(&mut self.seconds.compile, other.seconds.compile);
        longest(&mut self.seconds.upload, other.seconds.upload);
        longest(&mut self.seconds.readback, other.seconds.readback);
        longest(&mut self.longest_slice_seconds, other.longest_slice_seconds);
        let sum = |a: Option<f64>, b: Option<f64>| a.map_or(b, |a| Some(a + b.unwrap_or(0.0)));
        self.device_mips_seconds = sum(self.device_mips_seconds, other.device_mips_seconds);
        self.device_culling_seconds = sum(self.device_culling_seconds, other.device_culling_seconds);
        self.device_render_seconds += other.device_render_seconds;
        self.slices += other.slices;
        self.device_bytes += other.device_bytes;
        self.double |= other.double;
        let news = other.warnings.iter().filter(|w| !self.warnings.contains(w)).cloned().collect::<Vec<_>>();
        self.warnings.extend(news);
        match (&mut self.diagnostics, &other.diagnostics) {
            (Some(own), Some(others)) => own.iter_mut().zip(others).for_each(|(own, (_, n))| own.1 += n),
            (own @ None, others) => own.clone_from(others),
            (Some(_), None) => {}
        }
    }

    /// Records the integrator's statistics and returns its film.
    fn take(&mut self, integrated: Integrated) -> Film {
        let Integrated { film, outcome, sampled_pixels, dropped, .. } = integrated;
        (self.outcome, self.sampled_pixels, self.dropped) = (outcome, sampled_pixels, dropped);
        film
    }

    /// Adds the device's statistics of another session of the same render.
    fn add_rival(&mut self, other: Report) {
        self.device_render_seconds += other.device_render_seconds;
        self.slices += other.slices;
        self.longest_slice_seconds = self.longest_slice_seconds.max(other.longest_slice_seconds);
        let news = other.warnings.into_iter().filter(|w| !self.warnings.contains(w)).collect::<Vec<_>>();
        self.warnings.extend(news);
    }

    fn add_slice(&mut self, time: RunTime) {
        self.device_render_seconds += time.device_seconds;
        self.slices += 1;
        self.longest_slice_seconds = self.longest_slice_seconds.max(time.wall_seconds);
    }
}

/// Renders on an open device. The texels of `scene` are freed on the host once the device has them.
pub fn render(
    gpu: &Gpu,
    scene: PackedScene,
    keep_everything: bool,
    tuning: &Tuning,
    progress: &dyn Progress,
) -> Result<(Film, Report)> {
    render_to_goal(gpu, scene, keep_everything, tuning, None, progress)
}

/// Renders as [`render`] does; a scene that is sampled by batches ends at `goal`, by default its number of samples.
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

/// Builds a pipeline of `shader` with these constants and numbers of descriptors.
pub(crate) fn build_pipeline(
    gpu: &Gpu,
    shader: &'static Shader,
    constants: &[(u32, u32)],
    slots: SlotCounts,
    push_constant_bytes: usize,
) -> Result<Arc<Pipeline>> {
    let describe = |b: &ReflectedBinding| {
        let count = match (b.kind, b.binding) {
            (BindingKind::SampledImage, bindings::VOLUMES) => slots.volumes.max(1),
            (BindingKind::SampledImage, bindings::CUBES) => slots.cubes.max(1),
            (BindingKind::SampledImage, _) => slots.flat.max(1),
            (BindingKind::TexelBuffer, bindings::TEXELS) => slots.texel_blocks.max(1),
            _ => 1,
        };
        BindingDesc { binding: b.binding, kind: b.kind, count }
    };
    let is_bound = |b: &&ReflectedBinding| b.binding != bindings::MESHES || slots.meshes;
    let bindings: Vec<BindingDesc> = shader.bindings.iter().filter(is_bound).map(describe).collect();
    let opaque = (Constant::OpaqueUniforms, u32::from(Tuning::opaque_uniforms(gpu.info())));
    let holds = (Constant::HoldsTriangles, u32::from(Tuning::holds_triangles(gpu.info())));
    let loops_end = (Constant::LoopsEnd, u32::from(Tuning::loops_end(gpu.info())));
    let constants = [constants, &shader.values([opaque, holds, loops_end])].concat();
    gpu.shader_pipeline(shader, &bindings, push_constant_bytes as u32, &constants)
}
