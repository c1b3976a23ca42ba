//! The pipeline that samples batches, and what it is bound to. Input: the resources of a session, a film and a list of
//! batches. Output: a bind group.

use std::sync::Arc;

use super::Resources;
use crate::core::error::Result;
use crate::gpu::shaders::Shader;
use crate::gpu::{BindGroup, Buffer, Gpu, Pipeline};

/// The pipeline that samples batches.
pub struct SamplePipeline {
    pub pipeline: Arc<Pipeline>,
    pub shader: &'static Shader,
    pub groups_per_tile: u32,
}

/// The parameters of binding a list of batches.
pub(super) struct Bindings<'a> {
    pub resources: &'a Resources,
    pub pipeline: &'a Pipeline,
    pub shader: &'a Shader,
}

impl Bindings<'_> {
    pub fn bind(&self, gpu: &Gpu, film: &Buffer, batches: Option<&Buffer>) -> Result<BindGroup> {
        self.resources.bind(gpu, self.pipeline, self.shader, film, batches)
    }
}
