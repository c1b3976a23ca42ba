//! Descriptor sets. Takes a pipeline's declared bindings and a resource for each, checks one
//! against the other and returns a bound set that keeps its resources alive.

use std::sync::Arc;

use ash::vk;

use super::buffer::{Buffer, BufferUse};
use super::convert;
use super::device::Core;
use super::image::Image;
use super::pipeline::Pipeline;
use super::result::WithOperation;
use super::sampler::Sampler;
use crate::core::error::{Error, Result};
use crate::core::named::named_enum;

named_enum! {
    /// The kind of resource that a shader declares at a binding.
    pub enum BindingKind {
        /// `buffer { … }`
        StorageBuffer = "storage buffer",
        /// `uniform { … }`
        UniformBuffer = "uniform buffer",
        /// `usamplerBuffer`, single or an array
        TexelBuffer = "texel buffer",
        /// `sampler2D`, single or an array
        SampledImage = "sampled image",
    }
}

/// One binding of descriptor set 0. `count` is above 1 for arrays only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BindingDesc {
    pub binding: u32,
    pub kind: BindingKind,
    pub count: u32,
}

/// The resource bound at a binding.
#[derive(Clone, Copy)]
pub enum Bound<'a> {
    Buffer(&'a Buffer),
    /// The given number of first bytes of a storage buffer, bound as uniforms.
    Head(&'a Buffer, u64),
    Texels(&'a [Buffer]),
    Images(&'a [(&'a Image, &'a Sampler)]),
}

impl Bound<'_> {
    fn kind(&self) -> BindingKind {
        match self {
            Bound::Buffer(_) => BindingKind::StorageBuffer,
            Bound::Head(..) => BindingKind::UniformBuffer,
            Bound::Texels(_) => BindingKind::TexelBuffer,
            Bound::Images(_) => BindingKind::SampledImage,
        }
    }

    fn count(&self) -> u32 {
        match self {
            Bound::Buffer(_) | Bound::Head(..) => 1,
            Bound::Texels(buffers) => buffers.len() as u32,
            Bound::Images(images) => images.len() as u32,
        }
    }
}

/// A descriptor set for a pipeline, and for any other pipeline with the same bindings.
pub struct BindGroup {
    core: Arc<Core>,
    bindings: Vec<BindingDesc>,
    pool: vk::DescriptorPool,
    set: vk::DescriptorSet,
    /// The resources to which the set refers; they live as long as the set.
    _buffers: Vec<Buffer>,
    _images: Vec<(Image, Sampler)>,
}

impl BindGroup {
    pub(super) fn new(pipeline: &Pipeline, resources: &[(u32, Bound<'_>)]) -> Result<BindGroup> {
        let core = pipeline.core();
        check(pipeline, resources)?;
        let mut group = BindGroup {
            core: Arc::clone(core),
            bindings: pipeline.bindings().to_vec(),
            pool: vk::DescriptorPool::null(),
            set: vk::DescriptorSet::null(),
            _buffers: Vec::new(),
            _images: Vec::new(),
        };
        if !group.bindings.is_empty() {
            let doing = || format!("creating the descriptor set of `{}`", pipeline.name());
            group.allocate(pipeline.set_layout()).during(doing)?;
            core.set_name(group.pool, || format!("descriptor pool of `{}`", pipeline.name()));
            core.set_name(group.set, || format!("descriptors of `{}`", pipeline.name()));
        }
        for (binding, bound) in resources {
            group.write(*binding, bound);
        }
        Ok(group)
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.core
    }

    pub(super) fn bindings(&self) -> &[BindingDesc] {
        &self.bindings
    }

    pub(super) fn set(&self) -> vk::DescriptorSet {
        self.set
    }

    fn allocate(&mut self, layout: vk::DescriptorSetLayout) -> Result<(), vk::Result> {
        let sizes: Vec<vk::DescriptorPoolSize> = self
            .bindings
            .iter()
            .map(|b| vk::DescriptorPoolSize { ty: convert::descriptor(b.kind), descriptor_count: b.count })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        // SAFETY: the device is live; counts are not zero.
        self.pool = unsafe { self.core.device.create_descriptor_pool(&info, None)? };
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(self.pool).set_layouts(&layouts);
        // SAFETY: the pool has room for one set of exactly this layout.
        let sets = unsafe { self.core.device.allocate_descriptor_sets(&info)? };
        self.set = sets.first().copied().ok_or(vk::Result::ERROR_UNKNOWN)?;
        Ok(())
    }

    fn write(&mut self, binding: u32, bound: &Bound<'_>) {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(self.set)
            .dst_binding(binding)
            .descriptor_type(convert::descriptor(bound.kind()));
        let (mut buffers, mut views, mut images) = (Vec::new(), Vec::new(), Vec::new());
        let write = match bound {
            Bound::Buffer(buffer) | Bound::Head(buffer, _) => {
                self._buffers.push((*buffer).clone());
                let range = if let Bound::Head(_, bytes) = bound { *bytes } else { vk::WHOLE_SIZE };
                buffers.push(vk::DescriptorBufferInfo::default().buffer(buffer.handle()).range(range));
                write.buffer_info(&buffers)
            }
            Bound::Texels(buffers) => {
                self._buffers.extend_from_slice(buffers);
                views.extend(buffers.iter().map(Buffer::texel_view));
                write.texel_buffer_view(&views)
            }
            Bound::Images(pairs) => {
                for (image, sampler) in *pairs {
                    self._images.push(((*image).clone(), (*sampler).clone()));
                    images.push(
                        vk::DescriptorImageInfo::default()
                            .sampler(sampler.handle())
                            .image_view(image.view())
                            .image_layout(vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL),
                    );
                }
                write.image_info(&images)
            }
        };
        // SAFETY: kinds and counts were checked against the layout; the set is not in use.
        unsafe { self.core.device.update_descriptor_sets(&[write], &[]) };
    }
}

impl Drop for BindGroup {
    fn drop(&mut self) {
        // SAFETY: calls are synchronous, so the set is not in use; the pool frees it.
        self.core.release(|device| unsafe { device.destroy_descriptor_pool(self.pool, None) });
    }
}

/// Checks that every declared binding is given once, with its kind, count and use, and with a
/// format that its sampler can filter.
fn check(pipeline: &Pipeline, resources: &[(u32, Bound<'_>)]) -> Result<()> {
    let name = pipeline.name();
    for (index, (binding, _)) in resources.iter().enumerate() {
        if !pipeline.bindings().iter().any(|declared| declared.binding == *binding) {
            return Err(Error::new(format!("pipeline `{name}` has no binding {binding}")));
        }
        if resources[..index].iter().any(|(earlier, _)| earlier == binding) {
            return Err(Error::new(format!("binding {binding} of pipeline `{name}` is given twice")));
        }
    }
    for declared in pipeline.bindings() {
        let BindingDesc { binding, kind, count } = *declared;
        let found = resources.iter().find(|(given, _)| *given == binding);
        let Some((_, bound)) = found else {
            return Err(Error::new(format!("binding {binding} of pipeline `{name}`, a {kind}, is missing")));
        };
        if (bound.kind(), bound.count()) != (kind, count) {
            return Err(Error::new(format!(
                "binding {binding} of pipeline `{name}` is {count} × {kind}, and was given {} × {}",
                bound.count(),
                bound.kind()
            )));
        }
        check_resource(pipeline.core(), name, binding, bound)?;
    }
    Ok(())
}

fn check_resource(core: &Arc<Core>, pipeline: &str, binding: u32, bound: &Bound<'_>) -> Result<()> {
    let label = format!("binding {binding} of pipeline `{pipeline}`");
    let check_core = |other: &Arc<Core>| {
        if Arc::ptr_eq(core, other) {
            return Ok(());
        }
        Err(Error::new(format!("{label} was given a resource of another open device")))
    };
    let check_buffer = |buffer: &Buffer, usage: BufferUse| {
        check_core(buffer.core())?;
        if buffer.usage() == usage {
            return Ok(());
        }
        Err(Error::new(format!("{label} needs a {usage} buffer; `{}` is {}", buffer.name(), buffer.usage())))
    };
    match bound {
        Bound::Buffer(buffer) => check_buffer(buffer, BufferUse::Storage),
        Bound::Head(buffer, bytes) => {
            let limit = buffer.bytes().min(core.info.limits.max_uniform_buffer_range);
            if *bytes == 0 || *bytes > limit {
                return Err(Error::new(format!("{label}: {bytes} bytes of uniforms, of at most {limit}")));
            }
            check_buffer(buffer, BufferUse::Storage)
        }
        Bound::Texels(buffers) => buffers.iter().try_for_each(|buffer| {
            let wide = buffer.usage() == BufferUse::TexelUint4;
            check_buffer(buffer, if wide { BufferUse::TexelUint4 } else { BufferUse::TexelUint })
        }),
        Bound::Images(pairs) => pairs.iter().try_for_each(|(image, sampler)| {
            check_core(image.core())?;
            check_core(sampler.core())?;
            if sampler.is_linear() && !core.supports(image.format(), true) {
                return Err(Error::with_help(
                    format!("{}: {} cannot filter this format linearly", image.label(), core.info.name),
                    "Use nearest filtering, or method = \"shader\".",
                ));
            }
            Ok(())
        }),
    }
}
