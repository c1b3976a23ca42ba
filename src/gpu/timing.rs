//! Device time of a submission in seconds, measured with two timestamp queries.

use std::sync::Arc;

use ash::vk;

use super::device::Core;
use super::result::WithOperation;
use crate::core::error::Result;

/// The time that one submission took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunTime {
    /// Device time by timestamps, or the wall time on a queue without timestamps.
    pub device_seconds: f64,
    /// Wall time from the start of recording to the end of the wait.
    pub wall_seconds: f64,
}

pub(super) struct Timestamps {
    core: Arc<Core>,
    pool: vk::QueryPool,
}

impl Timestamps {
    /// Creates the query pool, or returns `None` if the queue has no timestamps.
    pub(super) fn new(core: &Arc<Core>) -> Result<Option<Timestamps>> {
        if core.info.limits.timestamp_valid_bits == 0 {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2);
        // SAFETY: the device is live.
        let pool = unsafe { core.device.create_query_pool(&info, None) }
            .during(|| "creating the timestamp queries".into())?;
        core.set_name(pool, || "timestamps".into());
        Ok(Some(Timestamps { core: Arc::clone(core), pool }))
    }

    pub(super) fn open(&self, commands: vk::CommandBuffer) {
        // SAFETY: the command buffer is recording, on a queue family with timestamps.
        unsafe {
            self.core.device.cmd_reset_query_pool(commands, self.pool, 0, 2);
            self.core.device.cmd_write_timestamp(commands, vk::PipelineStageFlags::TOP_OF_PIPE, self.pool, 0);
        }
    }

    pub(super) fn close(&self, commands: vk::CommandBuffer) {
        // SAFETY: the command buffer is recording, and query 1 was reset in `open`.
        unsafe {
            let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
            self.core.device.cmd_write_timestamp(commands, stage, self.pool, 1);
        }
    }

    /// Returns the time between the queries. The submission must have completed.
    pub(super) fn seconds(&self) -> Result<f64, vk::Result> {
        let mut ticks = [0u64; 2];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the submission wrote both queries, and `ticks` holds two results of 64 bits.
        unsafe { self.core.device.get_query_pool_results(self.pool, 0, &mut ticks, flags)? };
        let limits = &self.core.info.limits;
        Ok(elapsed_ticks(ticks, limits.timestamp_valid_bits) as f64 * limits.timestamp_period_ns * 1e-9)
    }
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        // SAFETY: every submission was waited for.
        self.core.release(|device| unsafe { device.destroy_query_pool(self.pool, None) });
    }
}

/// Returns the difference of two counters of `valid_bits` bits, which wrap around.
fn elapsed_ticks([open, close]: [u64; 2], valid_bits: u32) -> u64 {
    let mask = if valid_bits >= 64 { u64::MAX } else { (1 << valid_bits) - 1 };
    close.wrapping_sub(open) & mask
}

#[cfg(test)]
mod tests {
    use super::elapsed_ticks;

    #[test]
    fn ticks_survive_a_wrap_of_the_counter() {
        assert_eq!(elapsed_ticks([10, 25], 64), 15);
        assert_eq!(elapsed_ticks([u64::MAX - 4, 5], 64), 10);
        assert_eq!(elapsed_ticks([(1 << 36) - 4, 6], 36), 10);
    }
}
