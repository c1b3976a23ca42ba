//! The pipelines that sample batches, and what they are bound to. Input: the resources of a session, a film and a list of
//! batches. Output: a bind group.

use std::sync::Arc;

use super::Resources;
use crate::core::error::Result;
use crate::gpu::shaders::Shader;
use crate::gpu::{BindGroup, Buffer, Gpu, Pipeline};

/// The pipelines that sample batches: one, or one for each pass, of which each takes what those before it leave.
pub struct SamplePipeline {
    pub pipelines: Vec<Arc<Pipeline>>,
    pub shader: &'static Shader,
    pub groups_per_tile: u32,
}

impl SamplePipeline {
    pub(super) fn bind(
        &self,
        gpu: &Gpu,
        resources: &Resources,
        film: &Buffer,
        batches: Option<&Buffer>,
    ) -> Result<BindGroup> {
        resources.bind(gpu, &self.pipelines[0], self.shader, film, batches)
    }
}
