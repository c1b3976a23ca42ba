//! The one command buffer of a device, recorded and submitted again for each piece of work. Takes a
//! recording, returns its run time once the device has finished. A closing barrier makes all writes
//! visible to later submissions and to the host.

use std::panic::{self, AssertUnwindSafe};
use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;

use super::device::Core;
use super::info::DeviceKind;
use super::result::{WithOperation, device_lost, failed};
use super::timing::{RunTime, Timestamps};
use crate::core::error::Result;

/// The time after which a submission counts as hung: dispatches are sliced to well under a second.
const TIME_OUT: Duration = Duration::from_secs(120);
/// The same on the CPU, where the first submission of a pipeline also compiles it: half a minute for one with all
/// features, and many times that on a slow machine that others share.
const TIME_OUT_CPU: Duration = Duration::from_secs(1800);

pub(super) struct Commands {
    core: Arc<Core>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    timestamps: Option<Timestamps>,
}

impl Commands {
    pub(super) fn new(core: &Arc<Core>) -> Result<Commands> {
        let mut commands = Commands {
            core: Arc::clone(core),
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            timestamps: Timestamps::new(core)?,
        };
        commands.create().during(|| "creating the command buffer".into())?;
        core.set_name(commands.pool, || "command pool".into());
        core.set_name(commands.buffer, || "commands".into());
        core.set_name(commands.fence, || "commands done".into());
        Ok(commands)
    }

    fn create(&mut self) -> Result<(), vk::Result> {
        let device = &self.core.device;
        let pool = vk::CommandPoolCreateInfo::default()
            .flags(vk::CommandPoolCreateFlags::TRANSIENT)
            .queue_family_index(self.core.queue_family);
        // SAFETY: the device is live and has a queue of that family.
        self.pool = unsafe { device.create_command_pool(&pool, None)? };
        let buffer = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .level(vk::CommandBufferLevel::PRIMARY)
            .command_buffer_count(1);
        // SAFETY: the pool was created just now.
        let buffers = unsafe { device.allocate_command_buffers(&buffer)? };
        self.buffer = buffers.first().copied().ok_or(vk::Result::ERROR_UNKNOWN)?;
        // SAFETY: the device is live.
        self.fence = unsafe { device.create_fence(&vk::FenceCreateInfo::default(), None)? };
        Ok(())
    }

    /// Returns true if these are the commands of that device.
    pub(super) fn are_of(&self, core: &Arc<Core>) -> bool {
        Arc::ptr_eq(&self.core, core)
    }

    /// Records, submits and waits for the fence. `name` names the work in errors.
    pub(super) fn run(
        &mut self,
        name: &str,
        record: impl FnOnce(&ash::Device, vk::CommandBuffer),
    ) -> Result<RunTime> {
        self.run_beside(name, record, || ())
    }

    /// Runs as [`Commands::run`] does, and does work of the host while the device is busy. The host must not touch
    /// what the device writes.
    pub(super) fn run_beside(
        &mut self,
        name: &str,
        record: impl FnOnce(&ash::Device, vk::CommandBuffer),
        host: impl FnOnce(),
    ) -> Result<RunTime> {
        if self.core.is_hung() {
            return Err(device_lost(&format!("`{name}`: the device does not answer since an earlier call")));
        }
        let start = Instant::now();
        self.record(record).during(|| format!("recording `{name}`"))?;
        self.submit().during(|| format!("submitting `{name}`"))?;
        // Waited for in any case: else the device would still write what a panic frees.
        let done = panic::catch_unwind(AssertUnwindSafe(host));
        self.wait(name)?;
        done.unwrap_or_else(|payload| panic::resume_unwind(payload));
        let wall_seconds = start.elapsed().as_secs_f64();
        let device_seconds = match &self.timestamps {
            Some(timestamps) => timestamps.seconds().during(|| format!("reading the times of `{name}`"))?,
            None => wall_seconds,
        };
        Ok(RunTime { device_seconds, wall_seconds })
    }

    fn record(&mut self, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) -> Result<(), vk::Result> {
        let device = &self.core.device;
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the last submission was waited for, so that pool and buffer are not in use;
        // `&mut self` makes this thread their only user.
        unsafe {
            device.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())?;
            device.begin_command_buffer(self.buffer, &begin)?;
        }
        if let Some(timestamps) = &self.timestamps {
            timestamps.open(self.buffer);
        }
        record(device, self.buffer);
        barrier(device, self.buffer);
        // The timestamp follows the barrier: a driver may let an earlier one overtake the work.
        if let Some(timestamps) = &self.timestamps {
            timestamps.close(self.buffer);
        }
        // SAFETY: the buffer is in the recording state.
        unsafe { device.end_command_buffer(self.buffer) }
    }

    fn submit(&mut self) -> Result<(), vk::Result> {
        let buffers = [self.buffer];
        let submits = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the buffer is executable, the fence is not in use, and `&mut self` of the
        // device's only `Commands` makes this thread the queue's only user.
        unsafe {
            self.core.device.reset_fences(&[self.fence])?;
            self.core.device.queue_submit(self.core.queue, &submits, self.fence)
        }
    }

    fn wait(&self, name: &str) -> Result<()> {
        let time_out = if self.core.info.kind == DeviceKind::Cpu { TIME_OUT_CPU } else { TIME_OUT };
        // SAFETY: the fence is of this device and was submitted.
        let waited =
            unsafe { self.core.device.wait_for_fences(&[self.fence], true, time_out.as_nanos() as u64) };
        match waited {
            Ok(()) => Ok(()),
            // A lost device executes nothing any more, so that its objects may be destroyed as
            // usual.
            Err(vk::Result::ERROR_DEVICE_LOST) => {
                Err(failed(&format!("running `{name}`"), vk::Result::ERROR_DEVICE_LOST))
            }
            Err(vk::Result::TIMEOUT) => {
                self.core.set_hung();
                let seconds = time_out.as_secs();
                Err(device_lost(&format!("running `{name}`: the device did not finish within {seconds} s")))
            }
            Err(code) => {
                self.core.set_hung();
                Err(failed(&format!("waiting for `{name}`"), code))
            }
        }
    }
}

/// Records a memory barrier between all earlier writes and all later accesses, including those of
/// later submissions and of the host.
pub(super) fn barrier(device: &ash::Device, commands: vk::CommandBuffer) {
    use vk::{AccessFlags as Access, PipelineStageFlags as Stage};
    let memory = vk::MemoryBarrier::default()
        .src_access_mask(Access::SHADER_WRITE | Access::TRANSFER_WRITE)
        .dst_access_mask(
            Access::UNIFORM_READ
                | Access::SHADER_READ
                | Access::SHADER_WRITE
                | Access::TRANSFER_READ
                | Access::TRANSFER_WRITE
                | Access::HOST_READ,
        );
    // SAFETY: the command buffer is in the recording state, outside a render pass.
    unsafe {
        device.cmd_pipeline_barrier(
            commands,
            Stage::COMPUTE_SHADER | Stage::TRANSFER,
            Stage::COMPUTE_SHADER | Stage::TRANSFER | Stage::HOST,
            vk::DependencyFlags::empty(),
            &[memory],
            &[],
            &[],
        );
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for; null handles are allowed, and the pool frees
        // its command buffer.
        self.core.release(|device| unsafe {
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        });
    }
}
