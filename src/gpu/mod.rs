//! The Vulkan device layer: a small safe interface over `ash` and `gpu-allocator` with its own
//! types. It takes bytes, texels, SPIR-V words and sampler descriptions and returns bytes and
//! times. It knows buffers, images, samplers, compute pipelines and dispatches, but no scenes.
//! Every call is synchronous: when it returns, the device is idle.
//!
//! Ownership: each object owns its Vulkan handles and memory and holds an `Arc` of the device core,
//! so that objects and the [`Gpu`] may be dropped in any order; a [`BindGroup`] keeps its resources
//! alive. The core is destroyed last: allocator, device, messenger, instance, loader.

mod buffer;
mod command;
mod convert;
mod copy;
mod debug;
mod descriptor;
mod device;
#[cfg(unix)]
mod driver_cache;
mod host_memory;
mod image;
mod image_check;
mod info;
mod instance;
mod memory;
mod pipeline;
mod pipeline_cache;
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
pub use driver_cache::{advised as advised_driver_cache, prepare as prepare_driver_cache};
pub use host_memory::{give_back as give_back_host_memory, prepare as prepare_host_memory};
pub use image::{Image, ImageDesc, ImageFormat, ImageShape, Swizzle};
pub use info::{DeviceInfo, DeviceKind, DeviceLimits};
pub use instance::{API_VERSION_TEXT, list_devices};
pub use pipeline::{Pipeline, PipelineDesc};
pub use sampler::Sampler;
pub use select::DeviceSelect;
pub use timing::RunTime;

use crate::core::error::{Error, ErrorKind, Result};
use crate::texture::sampler_spec::SamplerSpec;
use command::{Commands, barrier};
use device::{Core, lock};
use image_check::Texels;
use pipeline_cache::PipelineCache;
use shaders::Shader;
use staging::Staging;

/// Does nothing: Mesa has a shader cache on Unix only.
#[cfg(not(unix))]
pub fn prepare_driver_cache() {}

/// Returns nothing, for the same reason.
#[cfg(not(unix))]
pub fn advised_driver_cache() -> Option<(&'static str, std::ffi::OsString)> {
    None
}

/// Options for opening a device.
#[derive(Clone, Copy, Debug, Default)]
pub struct OpenOptions {
    /// Loads the Khronos validation layer with synchronization validation, if it is installed.
    pub validation: bool,
}

impl OpenOptions {
    /// Returns the default options, with validation if the environment sets `MOIRE_VALIDATION=1`.
    pub fn from_env() -> OpenOptions {
        OpenOptions { validation: std::env::var_os("MOIRE_VALIDATION").is_some_and(|v| v == "1") }
    }
}

/// One dispatch of a submission. `push` has exactly the pipeline's push constant bytes.
pub struct Dispatch<'a> {
    pub pipeline: &'a Pipeline,
    pub group: &'a BindGroup,
    pub push: &'a [u8],
    pub groups: [u32; 3],
}

/// An open device with one compute queue.
pub struct Gpu {
    // Lock order: staging before commands, so that no two calls can deadlock.
    staging: Mutex<Staging>,
    commands: Mutex<Commands>,
    pipelines: PipelineCache,
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
            pipelines: PipelineCache::default(),
            core,
        })
    }

    pub fn info(&self) -> &DeviceInfo {
        &self.core.info
    }

    /// Returns false if validation was not requested or the layer is not installed.
    pub fn validation_active(&self) -> bool {
        self.core.instance.messages().is_some()
    }

    /// Returns the warnings and errors of the validation layer so far.
    pub fn messages(&self) -> Vec<String> {
        self.core.instance.messages().map(MessageLog::to_vec).unwrap_or_default()
    }

    /// Returns the log of those messages. It outlives the device and therefore also records objects
    /// that were never destroyed.
    pub fn message_log(&self) -> MessageLog {
        self.core.instance.messages().cloned().unwrap_or_default()
    }

    /// Returns the bytes of device and staging memory that objects use at present.
    pub fn memory_in_use(&self) -> u64 {
        self.core.memory.in_use()
    }

    /// Creates a buffer with undefined content.
    pub fn buffer(&self, name: &str, bytes: u64, usage: BufferUse) -> Result<Buffer> {
        Buffer::new(&self.core, name, bytes, usage).map_err(unsupported)
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

    /// Reads into `out` the bytes from `offset` on.
    pub fn read_buffer(&self, buffer: &Buffer, offset: u64, out: &mut [u8]) -> Result<()> {
        self.owns(buffer.core(), buffer.name())?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        readback::from_buffer(&mut staging, &mut commands, buffer, offset, out)
    }

    /// Passes parts of a buffer that begin at `starts`, each of `bytes` bytes, to `each`: some bytes of all parts at a
    /// time, in order, whole multiples of `unit`. While `each` works, the next ones are copied. It must not use the
    /// device.
    pub fn read_parts(
        &self,
        buffer: &Buffer,
        starts: &[u64],
        [bytes, unit]: [usize; 2],
        each: &mut dyn FnMut(&[&[u8]]),
    ) -> Result<()> {
        self.owns(buffer.core(), buffer.name())?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        readback::parts(&mut staging, &mut commands, buffer, starts, [bytes, unit], each)
    }

    /// Copies bytes from one buffer into another.
    pub fn copy_buffer(&self, from: &Buffer, start: u64, to: &Buffer, at: u64, bytes: u64) -> Result<()> {
        self.owns(from.core(), from.name())?;
        self.owns(to.core(), to.name())?;
        copy::to_buffer(&mut lock(&self.commands), from, start, to, at, bytes)
    }

    /// Returns true if images of this format can be sampled and, on request, filtered linearly.
    pub fn supports(&self, format: ImageFormat, linear_filter: bool) -> bool {
        self.core.supports(format, linear_filter)
    }

    /// Creates a sampled image and uploads its texels.
    pub fn image(&self, desc: &ImageDesc<'_>) -> Result<Image> {
        let image = Image::new(&self.core, desc, &Texels::Host(desc.levels)).map_err(unsupported)?;
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        upload::to_image(&mut staging, &mut commands, &image, desc.levels)?;
        Ok(image)
    }

    /// Creates a sampled image whose levels begin at the byte offsets `starts` of a buffer;
    /// `desc.levels` is ignored.
    pub fn image_from(&self, desc: &ImageDesc<'_>, buffer: &Buffer, starts: &[u64]) -> Result<Image> {
        self.owns(buffer.core(), buffer.name())?;
        let image = Image::new(&self.core, desc, &Texels::Device(buffer, starts)).map_err(unsupported)?;
        copy::to_image(&mut lock(&self.commands), &image, buffer, starts)?;
        Ok(image)
    }

    pub fn sampler(&self, spec: &SamplerSpec) -> Result<Sampler> {
        Sampler::new(&self.core, spec).map_err(unsupported)
    }

    pub fn pipeline(&self, desc: &PipelineDesc<'_>) -> Result<Pipeline> {
        Pipeline::new(&self.core, desc).map_err(unsupported)
    }

    /// Returns the pipeline of one of this program's shaders with these constants, and builds it unless an equal one
    /// was asked for shortly before.
    pub fn shader_pipeline(
        &self,
        shader: &'static Shader,
        bindings: &[BindingDesc],
        push_constant_bytes: u32,
        constants: &[(u32, u32)],
    ) -> Result<Arc<Pipeline>> {
        self.pipelines.get(&self.core, shader, bindings, push_constant_bytes, constants).map_err(unsupported)
    }

    /// Binds a list of resources, one entry for each binding that the pipeline declares.
    pub fn bind(&self, pipeline: &Pipeline, resources: &[(u32, Bound<'_>)]) -> Result<BindGroup> {
        self.owns(pipeline.core(), pipeline.name())?;
        BindGroup::new(pipeline, resources).map_err(unsupported)
    }

    /// Runs one dispatch and waits for it. `push` has exactly the pipeline's push constant bytes.
    pub fn run(
        &self,
        pipeline: &Pipeline,
        group: &BindGroup,
        push: &[u8],
        groups: [u32; 3],
    ) -> Result<RunTime> {
        self.run_all(pipeline, group, &[(push, groups)])
    }

    /// Runs several dispatches in one submission, each of which sees the writes of the ones before it, and then reads into
    /// `out` the bytes of a buffer from `offset` on.
    pub fn run_and_read(
        &self,
        dispatches: &[Dispatch<'_>],
        buffer: &Buffer,
        offset: u64,
        out: &mut [u8],
    ) -> Result<RunTime> {
        self.owns(buffer.core(), buffer.name())?;
        for dispatch in dispatches {
            self.owns(dispatch.pipeline.core(), dispatch.pipeline.name())?;
            self.owns(dispatch.group.core(), dispatch.pipeline.name())?;
            dispatch.pipeline.check_run(dispatch.group, dispatch.push, dispatch.groups)?;
        }
        let (mut staging, mut commands) = (lock(&self.staging), lock(&self.commands));
        readback::after(&mut staging, &mut commands, dispatches, buffer, offset, out)
    }

    /// Runs several dispatches, each with its push constants and workgroup counts, in one
    /// submission; each sees the writes of the ones before it.
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

/// Returns an error without a kind as one of an object that the device cannot have.
fn unsupported(error: Error) -> Error {
    error.or_kind(ErrorKind::Unsupported)
}
