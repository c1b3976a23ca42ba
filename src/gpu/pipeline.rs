//! Compute pipelines. Creates one from SPIR-V words, bindings, push constants and specialization
//! constants; `run` dispatches it. Drivers cache compiled code themselves, so that there is no
//! `VkPipelineCache`.

use std::sync::Arc;

use ash::vk;

use super::convert;
use super::descriptor::{BindGroup, BindingDesc, BindingKind};
use super::device::Core;
use super::result::{WithOperation, size_text};
use crate::core::error::{Error, Result};

const SPIRV_MAGIC: u32 = 0x0723_0203;

#[derive(Clone, Copy, Debug)]
pub struct PipelineDesc<'a> {
    pub name: &'a str,
    /// A valid module with the entry point `main`, whose interface matches the rest of this
    /// description; the driver validates neither.
    pub spirv: &'a [u32],
    /// The bindings of descriptor set 0.
    pub bindings: &'a [BindingDesc],
    /// The size of the push constant block, a multiple of four.
    pub push_constant_bytes: u32,
    /// Specialization constants as pairs of id and value; a boolean is 0 or 1.
    pub constants: &'a [(u32, u32)],
}

pub struct Pipeline {
    core: Arc<Core>,
    name: String,
    bindings: Vec<BindingDesc>,
    push_constant_bytes: u32,
    set_layout: vk::DescriptorSetLayout,
    layout: vk::PipelineLayout,
    handle: vk::Pipeline,
}

impl Pipeline {
    pub(super) fn new(core: &Arc<Core>, desc: &PipelineDesc<'_>) -> Result<Pipeline> {
        check(core, desc)?;
        let mut pipeline = Pipeline {
            core: Arc::clone(core),
            name: desc.name.into(),
            bindings: desc.bindings.to_vec(),
            push_constant_bytes: desc.push_constant_bytes,
            set_layout: vk::DescriptorSetLayout::null(),
            layout: vk::PipelineLayout::null(),
            handle: vk::Pipeline::null(),
        };
        pipeline.create_layouts().during(|| format!("creating the layout of pipeline `{}`", desc.name))?;
        pipeline.create(desc).during(|| format!("compiling pipeline `{}`", desc.name))?;
        core.set_name(pipeline.set_layout, || format!("bindings of `{}`", desc.name));
        core.set_name(pipeline.layout, || format!("layout of `{}`", desc.name));
        core.set_name(pipeline.handle, || format!("pipeline `{}`", desc.name));
        Ok(pipeline)
    }

    pub fn name(&self) -> &str {
        &self.name
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.core
    }

    pub(super) fn bindings(&self) -> &[BindingDesc] {
        &self.bindings
    }

    pub(super) fn set_layout(&self) -> vk::DescriptorSetLayout {
        self.set_layout
    }

    fn create_layouts(&mut self) -> Result<(), vk::Result> {
        let device = &self.core.device;
        let bindings: Vec<vk::DescriptorSetLayoutBinding<'_>> = self
            .bindings
            .iter()
            .map(|b| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(b.binding)
                    .descriptor_type(convert::descriptor(b.kind))
                    .descriptor_count(b.count)
                    .stage_flags(vk::ShaderStageFlags::COMPUTE)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: binding numbers are unique and counts within the limits (checked).
        self.set_layout = unsafe { device.create_descriptor_set_layout(&info, None)? };

        let push = [vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
            .size(self.push_constant_bytes)];
        let sets = [self.set_layout];
        let mut info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        if self.push_constant_bytes > 0 {
            info = info.push_constant_ranges(&push);
        }
        // SAFETY: the set layout was created just now; the push constants fit (checked).
        self.layout = unsafe { device.create_pipeline_layout(&info, None)? };
        Ok(())
    }

    fn create(&mut self, desc: &PipelineDesc<'_>) -> Result<(), vk::Result> {
        let device = &self.core.device;
        let info = vk::ShaderModuleCreateInfo::default().code(desc.spirv);
        // SAFETY: the words begin with SPIR-V's magic number; the description's author vouches
        // for the rest.
        let module = unsafe { device.create_shader_module(&info, None)? };
        self.core.set_name(module, || format!("shader `{}`", desc.name));

        let mut data = Vec::with_capacity(desc.constants.len() * 4);
        let mut entries = Vec::with_capacity(desc.constants.len());
        for &(id, value) in desc.constants {
            let offset = data.len() as u32;
            entries.push(vk::SpecializationMapEntry { constant_id: id, offset, size: 4 });
            data.extend_from_slice(&value.to_ne_bytes());
        }
        let constants = vk::SpecializationInfo::default().map_entries(&entries).data(&data);
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main")
            .specialization_info(&constants);
        let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(self.layout)];
        // SAFETY: module and layout are live, and all that `info` points to lives until after it.
        let created = unsafe { device.create_compute_pipelines(vk::PipelineCache::null(), &info, None) };
        // SAFETY: a module may be destroyed once the pipelines created from it exist.
        unsafe { device.destroy_shader_module(module, None) };
        match created {
            Ok(pipelines) => {
                self.handle = pipelines.first().copied().ok_or(vk::Result::ERROR_UNKNOWN)?;
                Ok(())
            }
            // A failed creation returns null handles only, since there is one pipeline.
            Err((_, code)) => Err(code),
        }
    }

    /// Checks the preconditions of [`Pipeline::record`].
    pub(super) fn check_run(&self, group: &BindGroup, push: &[u8], groups: [u32; 3]) -> Result<()> {
        let name = &self.name;
        if group.bindings() != self.bindings {
            return Err(Error::new(format!(
                "pipeline `{name}` was given resources bound for other bindings"
            )));
        }
        if push.len() != self.push_constant_bytes as usize {
            return Err(Error::new(format!(
                "pipeline `{name}` takes {} bytes of push constants, and was given {}",
                self.push_constant_bytes,
                push.len()
            )));
        }
        let limits = self.core.info.limits.max_workgroup_count;
        if groups.iter().zip(&limits).any(|(wanted, limit)| wanted > limit) {
            return Err(Error::new(format!(
                "pipeline `{name}`: {groups:?} workgroups are too many for {}, which takes {limits:?}",
                self.core.info.name
            )));
        }
        Ok(())
    }

    pub(super) fn record(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        group: &BindGroup,
        push: &[u8],
        [x, y, z]: [u32; 3],
    ) {
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the command buffer is recording; `check_run` has compared layout, push constants
        // and workgroup counts; pipeline and group are borrowed until the work is done.
        unsafe {
            device.cmd_bind_pipeline(commands, point, self.handle);
            if !self.bindings.is_empty() {
                device.cmd_bind_descriptor_sets(commands, point, self.layout, 0, &[group.set()], &[]);
            }
            if !push.is_empty() {
                device.cmd_push_constants(commands, self.layout, vk::ShaderStageFlags::COMPUTE, 0, push);
            }
            device.cmd_dispatch(commands, x, y, z);
        }
    }
}

impl Drop for Pipeline {
    fn drop(&mut self) {
        // SAFETY: calls are synchronous, so nothing is in use; null handles are allowed.
        self.core.release(|device| unsafe {
            device.destroy_pipeline(self.handle, None);
            device.destroy_pipeline_layout(self.layout, None);
            device.destroy_descriptor_set_layout(self.set_layout, None);
        });
    }
}

fn check(core: &Core, desc: &PipelineDesc<'_>) -> Result<()> {
    let limits = &core.info.limits;
    let refuse = |reason: String| Err(Error::new(format!("pipeline `{}`: {reason}", desc.name)));
    if desc.spirv.first() != Some(&SPIRV_MAGIC) {
        return refuse("its code is not SPIR-V".into());
    }
    if desc.push_constant_bytes > limits.max_push_constants || !desc.push_constant_bytes.is_multiple_of(4) {
        return refuse(format!(
            "{} bytes of push constants; {} takes multiples of 4 up to {}",
            desc.push_constant_bytes,
            core.info.name,
            size_text(u64::from(limits.max_push_constants))
        ));
    }
    for (index, declared) in desc.bindings.iter().enumerate() {
        if declared.count == 0 {
            return refuse(format!("binding {} is empty", declared.binding));
        }
        if desc.bindings[..index].iter().any(|earlier| earlier.binding == declared.binding) {
            return refuse(format!("binding {} is declared twice", declared.binding));
        }
    }
    let count = |kind: BindingKind| -> u64 {
        desc.bindings.iter().filter(|b| b.kind == kind).map(|b| u64::from(b.count)).sum()
    };
    // A combined image sampler counts as both, a texel buffer as a sampled image.
    let samplers = count(BindingKind::SampledImage);
    let images = samplers + count(BindingKind::TexelBuffer);
    let buffers = count(BindingKind::StorageBuffer);
    for (resources, wanted, limit) in [
        ("sampled textures", samplers, limits.max_samplers_per_stage),
        ("textures and texel buffers", images, limits.max_sampled_images_per_stage),
        ("storage buffers", buffers, limits.max_storage_buffers_per_stage),
    ] {
        if wanted > u64::from(limit) {
            return Err(Error::with_help(
                format!(
                    "pipeline `{}` needs {wanted} {resources}; {} takes {limit}",
                    desc.name, core.info.name
                ),
                "Use fewer textures with method = \"hardware\"; method = \"shader\" has no such limit.",
            ));
        }
    }
    Ok(())
}
