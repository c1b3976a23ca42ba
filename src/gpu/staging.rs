//! The one host-visible buffer that all transfers go through, in chunks: in go sizes, out comes a
//! buffer at least that large, up to the chunk size. It grows when needed and is never larger than
//! a chunk, so that peak memory stays low however large the transfers are.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;

use super::buffer::RawBuffer;
use super::device::Core;
use crate::core::error::Result;

/// Most bytes of one transfer.
pub(super) const CHUNK: usize = 16 << 20;
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

    /// A buffer of at least `min(bytes, CHUNK)`.
    pub(super) fn get(&mut self, bytes: usize) -> Result<&mut RawBuffer> {
        let wanted = bytes.min(CHUNK);
        let current = self.buffer.take().filter(|_| self.bytes >= wanted);
        let buffer = match current {
            Some(buffer) => buffer,
            None => {
                self.bytes = wanted.next_power_of_two().max(SMALLEST);
                // Cached memory: reading it back is then as fast as any host memory, and writing
                // no slower; the allocator asks for coherent memory besides.
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
