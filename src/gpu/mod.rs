//! The Vulkan device layer: a safe, small interface in own types over `ash` and `gpu-allocator`.
//! In: bytes, texels, SPIR-V words, sampler descriptions. Out: bytes and times. It knows buffers,
//! images, samplers, compute pipelines and dispatches, and nothing of scenes. Every call is
//! synchronous: when it returns, the device is idle.
//!
//! Ownership: each object owns its Vulkan handles and memory and holds an `Arc` of the device core,
//! so objects and the [`Gpu`] may be dropped in any order; a [`BindGroup`] keeps what it binds. The
//! core goes last: allocator, then device, then messenger and instance, then the loader.

mod buffer;
mod command;
mod convert;
mod copy;
mod debug;
mod descriptor;
mod device;
#[cfg(unix)]
mod driver_cache;
mod image;
mod image_check;
mod info;
mod instance;
mod memory;
mod pipeline;
mod readback;
mod result;
mod sampler;
mod select;
pub mod shaders;
mod staging;
mod timing;
mod upload;

use std::sync::{Arc, Mutex};

pub use buffer::{Buffer, BufferUse};
pub use debug::{MessageLog, validation_available};
pub use descriptor::{BindGroup, BindingDesc, BindingKind, Bound};
#[cfg(unix)]
pub use driver_cache::prepare as prepare_driver_cache;
pub use image::{Image, ImageDesc, ImageFormat, ImageShape, Swizzle};
pub use info::{DeviceInfo, DeviceKind, DeviceLimits};
pub use instance::list_devices;
pub use pipeline::{Pipeline, PipelineDesc};
pub use sampler::Sampler;
pub use select::DeviceSelect;
pub use timing::RunTime;

use crate::core::error::{Error, Result};
use crate::texture::sampler_spec::SamplerSpec;
use command::{Commands, barrier};
use device::{Core, lock};
use image_check::Texels;
use staging::Staging;

/// Does nothing: Mesa keeps a cache on Unix alone.
#[cfg(not(unix))]
pub fn prepare_driver_cache() {}

/// How a device is opened.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenOptions {
    /// Load the Khronos validation layer, with synchronization validation, if it is installed.
    pub validation: bool,
}

impl OpenOptions {
    /// Validation when the environment says `MOIRE_VALIDATION=1`.
    pub fn from_env() -> OpenOptions {
        OpenOptions { validation: std::env::var_os("MOIRE_VALIDATION").is_some_and(|v| v == "1") }
    }
}

/// One open device with one compute queue.
pub struct Gpu {
    // The order of a run: staging before commands, so that no two calls can wait on each other.
    staging: Mutex<Staging>,
    commands: Mutex<Commands>,
    core: Arc<Core>,
}

impl Gpu {
    pub fn open(select: &DeviceSelect) -> Result<Gpu> {
        Gpu::open_with(select, OpenOptions::from_env())
    }

    pub fn open_with(select: &DeviceSelect, options: OpenOptions) -> Result<Gpu> {
        let core = Core::open(select, options)?;
        Ok(Gpu {
            commands: Mutex::new(Commands::new(&core)?),
            staging: Mutex::new(Staging::new(&core)),
            core,
        })
    }

    pub fn info(&self) -> &DeviceInfo {
        &self.core.info
    }

    /// False where validation was not asked for or the layer is not installed.
    pub fn validation_active(&self) -> bool {
        self.core.instance.messages().is_some()
    }

    /// Warnings and errors of the validation layer so far.
    pub fn messages(&self) -> Vec<String> {
        self.core.instance.messages().map(MessageLog::to_vec).unwrap_or_default()
    }

    /// Where those messages go; it outlives the device, so it also hears of objects left alive.
    pub fn message_log(&self) -> MessageLog {
        self.core.instance.messages().cloned().unwrap_or_default()
    }

    /// Bytes of device and staging memory that objects hold now.
    pub fn memory_in_use(&self) -> u64 {
        self.core.memory.in_use()
    }

    /// A buffer of undefined content.
    pub fn buffer(&self, name: &str, bytes: u64, usage: BufferUse) -> Result<Buffer> {
        Buffer::new(&self.core, name, bytes, usage)
    }

    pub fn upload_buffer(&self, name: &str, usage: BufferUse, data: &[u8]) -> Result<Buffer> {
        let buffer = self.buffer(name, data.len() as u64, usage)?;
        self.write_buffer(&buffer, 0, data)?;
        Ok(buffer)
    }

    pub fn write_buffer(&self, buffer: &Buffer, offset: u64, data: &[u8]) -> Result<()> {
        self.owns(buffer.core(), buffer.name())?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        upload::to_buffer(&mut staging, &mut commands, buffer, offset, data)
    }

    /// Fills `out` from `offset` on.
    pub fn read_buffer(&self, buffer: &Buffer, offset: u64, out: &mut [u8]) -> Result<()> {
        self.owns(buffer.core(), buffer.name())?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        readback::from_buffer(&mut staging, &mut commands, buffer, offset, out)
    }

    /// Copies bytes from one buffer into another.
    pub fn copy_buffer(&self, from: &Buffer, start: u64, to: &Buffer, at: u64, bytes: u64) -> Result<()> {
        self.owns(from.core(), from.name())?;
        self.owns(to.core(), to.name())?;
        copy::to_buffer(&mut lock(&self.commands), from, start, to, at, bytes)
    }

    /// Whether images of this format can be sampled, with linear filtering if asked for.
    pub fn supports(&self, format: ImageFormat, linear_filter: bool) -> bool {
        self.core.supports(format, linear_filter)
    }

    /// A sampled image with its texels uploaded.
    pub fn image(&self, desc: &ImageDesc<'_>) -> Result<Image> {
        let image = Image::new(&self.core, desc, &Texels::Host(desc.levels))?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        upload::to_image(&mut staging, &mut commands, &image, desc.levels)?;
        Ok(image)
    }

    /// A sampled image whose levels begin at these bytes of a buffer; `levels` of the description is not
    /// read.
    pub fn image_from(&self, desc: &ImageDesc<'_>, buffer: &Buffer, starts: &[u64]) -> Result<Image> {
        self.owns(buffer.core(), buffer.name())?;
        let image = Image::new(&self.core, desc, &Texels::Device(buffer, starts))?;
        copy::to_image(&mut lock(&self.commands), &image, buffer, starts)?;
        Ok(image)
    }

    pub fn sampler(&self, spec: &SamplerSpec) -> Result<Sampler> {
        Sampler::new(&self.core, spec)
    }

    pub fn pipeline(&self, desc: &PipelineDesc<'_>) -> Result<Pipeline> {
        Pipeline::new(&self.core, desc)
    }

    /// One resource list for every binding that the pipeline declares.
    pub fn bind(&self, pipeline: &Pipeline, resources: &[(u32, Bound<'_>)]) -> Result<BindGroup> {
        self.owns(pipeline.core(), pipeline.name())?;
        BindGroup::new(pipeline, resources)
    }

    /// One dispatch, waited for. `push` has exactly the pipeline's push constant bytes.
    pub fn run(
        &self,
        pipeline: &Pipeline,
        group: &BindGroup,
        push: &[u8],
        groups: [u32; 3],
    ) -> Result<RunTime> {
        self.run_all(pipeline, group, &[(push, groups)])
    }

    /// Several dispatches, given by push constants and workgroups, in one submission; each sees what the
    /// ones before it wrote.
    pub fn run_all(
        &self,
        pipeline: &Pipeline,
        group: &BindGroup,
        dispatches: &[(&[u8], [u32; 3])],
    ) -> Result<RunTime> {
        self.owns(pipeline.core(), pipeline.name())?;
        self.owns(group.core(), pipeline.name())?;
        dispatches.iter().try_for_each(|(push, groups)| pipeline.check_run(group, push, *groups))?;
        lock(&self.commands).run(pipeline.name(), |device, commands| {
            for (index, (push, groups)) in dispatches.iter().enumerate() {
                if index > 0 {
                    barrier(device, commands);
                }
                pipeline.record(device, commands, group, push, *groups);
            }
        })
    }

    fn owns(&self, core: &Arc<Core>, name: &str) -> Result<()> {
        if Arc::ptr_eq(core, &self.core) {
            return Ok(());
        }
        Err(Error::new(format!("`{name}` belongs to another open device than {}", self.core.info.name)))
    }
}
