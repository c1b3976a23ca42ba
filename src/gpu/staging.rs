//! The one host-visible staging buffer through which all transfers go in chunks. It grows on demand
//! up to the chunk size, so that peak memory stays low however large the transfers are.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::buffer::RawBuffer;
use super::device::Core;
use crate::core::error::Result;

/// The largest size of one transfer in bytes.
pub(super) const STAGING_BYTES: usize = 16 << 20;
const SMALLEST: usize = 64 << 10;

pub(super) struct Staging {
    core: Arc<Core>,
    buffer: Option<RawBuffer>,
    bytes: usize,
}

impl Staging {
    pub(super) fn new(core: &Arc<Core>) -> Staging {
        Staging { core: Arc::clone(core), buffer: None, bytes: 0 }
    }

    /// Returns a buffer of at least `min(bytes, STAGING_BYTES)` bytes.
    pub(super) fn get(&mut self, bytes: usize) -> Result<&mut RawBuffer> {
        let wanted = bytes.min(STAGING_BYTES);
        let current = self.buffer.take().filter(|_| self.bytes >= wanted);
        let buffer = match current {
            Some(buffer) => buffer,
            None => {
                self.bytes = wanted.next_power_of_two().max(SMALLEST);
                // Host-cached memory: reads are as fast as from any host memory, and writes no
                // slower; the allocator requests coherent memory in addition.
                RawBuffer::new(
                    &self.core,
                    "staging",
                    self.bytes as u64,
                    vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST,
                    MemoryLocation::GpuToCpu,
                )?
            }
        };
        Ok(self.buffer.insert(buffer))
    }
}
