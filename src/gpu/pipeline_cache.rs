//! Pipelines that are kept for their next use. In: a shader, its bindings and constants. Out: the pipeline of an equal
//! description if it is among the last ones, else a new one. Drivers keep machine code at best: to parse and optimise
//! a module takes them up to a second each time.

use std::sync::{Arc, Mutex};

use super::descriptor::BindingDesc;
use super::device::{Core, lock};
use super::pipeline::{Pipeline, PipelineDesc};
use super::shaders::{Shader, specialise};
use crate::core::error::Result;

/// The number of pipelines that are kept.
const MAX_KEPT: usize = 48;

/// Everything that a pipeline of this program's shaders depends on.
#[derive(Clone, Debug, PartialEq, Eq)]
struct ShaderDesc {
    /// The name of the shader, which no other has.
    shader: &'static str,
    bindings: Vec<BindingDesc>,
    push_constant_bytes: u32,
    constants: Vec<(u32, u32)>,
}

/// A place for a pipeline. It is locked while the pipeline is built, so that nobody builds an equal one meanwhile.
type Place = Arc<Mutex<Option<Arc<Pipeline>>>>;

/// The pipelines, the one that was asked for last at the end.
#[derive(Default)]
pub(super) struct PipelineCache(Mutex<Vec<(ShaderDesc, Place)>>);

impl PipelineCache {
    pub(super) fn get(
        &self,
        core: &Arc<Core>,
        shader: &'static Shader,
        bindings: &[BindingDesc],
        push_constant_bytes: u32,
        constants: &[(u32, u32)],
    ) -> Result<Arc<Pipeline>> {
        // By their ids: scenes come with the offsets of their lists in an order of their own.
        let mut constants = constants.to_vec();
        constants.sort_unstable();
        let desc = ShaderDesc {
            shader: shader.name,
            bindings: bindings.to_vec(),
            push_constant_bytes,
            constants: constants.clone(),
        };
        let place = self.place(desc);
        let mut place = lock(&place);
        if let Some(pipeline) = &*place {
            return Ok(Arc::clone(pipeline));
        }
        let spirv = specialise(shader.spirv, &constants);
        let constants = constants.as_slice();
        let desc =
            PipelineDesc { name: shader.name, spirv: &spirv, bindings, push_constant_bytes, constants };
        let pipeline = Arc::new(Pipeline::new(core, &desc)?);
        *place = Some(Arc::clone(&pipeline));
        Ok(pipeline)
    }

    fn place(&self, desc: ShaderDesc) -> Place {
        let mut kept = lock(&self.0);
        let known = kept.iter().position(|(other, _)| *other == desc);
        let entry = known.map_or_else(|| (desc, Place::default()), |index| kept.remove(index));
        let place = Arc::clone(&entry.1);
        kept.push(entry);
        if kept.len() > MAX_KEPT {
            kept.remove(0);
        }
        place
    }
}
