//! Device buffers. Creates a buffer with bound memory from a name, a size and a use; a texel buffer
//! also gets its buffer view.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocation;

use super::command::Commands;
use super::convert;
use super::device::Core;
use super::result::{WithOperation, size_text};
use crate::core::error::{Error, Result};
use crate::core::named::named_enum;

named_enum! {
    /// The descriptor types under which shaders read a buffer.
    pub enum BufferUse {
        /// A `buffer` block, read and written; its first bytes may also be bound as a `uniform`
        /// block.
        Storage = "storage",
        /// A `usamplerBuffer` of 32-bit unsigned texels.
        TexelUint = "texel-uint",
        /// A `usamplerBuffer` of texels of four 32-bit unsigned words.
        TexelUint4 = "texel-uint4",
    }
}

impl BufferUse {
    /// Returns the bytes of a texel, or of a word.
    fn texel_bytes(self) -> u64 {
        if self == BufferUse::TexelUint4 { 16 } else { 4 }
    }
}

/// A device-local buffer. Clones share the same Vulkan object.
#[derive(Clone)]
pub struct Buffer {
    raw: Arc<RawBuffer>,
    usage: BufferUse,
}

impl Buffer {
    pub(super) fn new(core: &Arc<Core>, name: &str, bytes: u64, usage: BufferUse) -> Result<Buffer> {
        check_size(core, name, bytes, usage)?;
        let flags = convert::buffer_usage(usage)
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let mut raw = RawBuffer::new(core, name, bytes, flags, MemoryLocation::GpuOnly)?;
        match usage {
            BufferUse::TexelUint => raw.create_texel_view(vk::Format::R32_UINT)?,
            BufferUse::TexelUint4 => raw.create_texel_view(vk::Format::R32G32B32A32_UINT)?,
            BufferUse::Storage => {}
        }
        Ok(Buffer { raw: Arc::new(raw), usage })
    }

    pub fn name(&self) -> &str {
        &self.raw.name
    }

    /// Returns the size with which the buffer was created.
    pub fn bytes(&self) -> u64 {
        self.raw.bytes
    }

    pub fn usage(&self) -> BufferUse {
        self.usage
    }

    pub(super) fn core(&self) -> &Arc<Core> {
        &self.raw.core
    }

    pub(super) fn handle(&self) -> vk::Buffer {
        self.raw.handle
    }

    /// Returns the buffer view, which is null unless the use is a texel buffer.
    pub(super) fn texel_view(&self) -> vk::BufferView {
        self.raw.view
    }

    /// Returns the content if it lies in memory that the host reads and writes as its own, so that nothing need be copied
    /// by way of another buffer. While `commands` are lent, no submission runs and nobody else has the content.
    pub(super) fn host_bytes<'a>(&'a self, commands: &'a mut Commands) -> Option<&'a mut [u8]> {
        use vk::MemoryPropertyFlags as Flags;
        let core = &self.raw.core;
        if !commands.are_of(core) || core.is_hung() {
            return None;
        }
        let allocation = self.raw.allocation.as_ref()?;
        let needed = Flags::HOST_COHERENT | Flags::HOST_CACHED;
        let mapped = allocation.mapped_ptr().filter(|_| allocation.memory_properties().contains(needed))?;
        // SAFETY: the memory is mapped while the allocation lives, and at least as long as the buffer. The only commands of
        // the device are borrowed by the slice, so no submission uses the buffer and there is no second slice; what earlier
        // ones wrote was made visible to the host by their closing barrier.
        Some(unsafe { std::slice::from_raw_parts_mut(mapped.cast().as_ptr(), self.bytes() as usize) })
    }

    /// Refuses a range `offset .. offset + len` that does not lie inside the buffer.
    pub(super) fn check_range(&self, offset: u64, len: usize) -> Result<()> {
        if offset.checked_add(len as u64).is_some_and(|end| end <= self.bytes()) {
            return Ok(());
        }
        Err(Error::new(format!(
            "bytes {offset}..{offset}+{len} lie outside buffer `{}` of {} bytes",
            self.name(),
            self.bytes()
        )))
    }
}

fn check_size(core: &Core, name: &str, bytes: u64, usage: BufferUse) -> Result<()> {
    let limits = &core.info.limits;
    let refuse = |reason: String| {
        let size = size_text(bytes);
        Err(Error::new(format!("buffer `{name}` ({size}) does not fit {}: {reason}", core.info.name)))
    };
    if bytes == 0 {
        return Err(Error::new(format!("buffer `{name}` has no bytes")));
    }
    match usage {
        BufferUse::Storage if bytes > limits.max_storage_buffer_range => refuse(format!(
            "a storage buffer there has at most {}",
            size_text(limits.max_storage_buffer_range)
        )),
        BufferUse::TexelUint | BufferUse::TexelUint4
            if bytes.div_ceil(usage.texel_bytes()) > limits.max_texel_buffer_elements =>
        {
            refuse(format!("a texel buffer there has at most {} texels", limits.max_texel_buffer_elements))
        }
        _ => core.memory.check_heap(&format!("buffer `{name}`"), bytes),
    }
}

/// A handle with its view and memory; the staging buffer is one too.
pub(super) struct RawBuffer {
    core: Arc<Core>,
    name: String,
    bytes: u64,
    handle: vk::Buffer,
    view: vk::BufferView,
    allocation: Option<Allocation>,
}

impl RawBuffer {
    pub(super) fn new(
        core: &Arc<Core>,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<RawBuffer> {
        // Texel views need a size that is a multiple of four bytes.
        let info = vk::BufferCreateInfo::default()
            .size(bytes.next_multiple_of(4))
            .usage(usage)
            .sharing_mode(vk::SharingMode::EXCLUSIVE);
        let label = || format!("buffer `{name}`");
        // SAFETY: the device is live; the size is not zero (checked by the callers).
        let handle =
            unsafe { core.device.create_buffer(&info, None) }.during(|| format!("creating {}", label()))?;
        let mut raw = RawBuffer {
            core: Arc::clone(core),
            name: name.into(),
            bytes,
            handle,
            view: vk::BufferView::null(),
            allocation: None,
        };
        core.set_name(handle, label);
        // SAFETY: the handle was created just now.
        let requirements = unsafe { core.device.get_buffer_memory_requirements(handle) };
        let allocation =
            raw.allocation.insert(core.memory.allocate(&label(), requirements, location, true)?);
        // SAFETY: memory of the required size, type and alignment, bound once, and freed after
        // the buffer is destroyed.
        unsafe { core.device.bind_buffer_memory(handle, allocation.memory(), allocation.offset()) }
            .during(|| format!("binding memory to {}", label()))?;
        Ok(raw)
    }

    fn create_texel_view(&mut self, format: vk::Format) -> Result<()> {
        let info =
            vk::BufferViewCreateInfo::default().buffer(self.handle).format(format).range(vk::WHOLE_SIZE);
        // SAFETY: the buffer has memory and the uniform texel usage; both formats are always supported
        // for it (Vulkan 1.2, "Required Format Support").
        self.view = unsafe { self.core.device.create_buffer_view(&info, None) }
            .during(|| format!("creating the texel view of buffer `{}`", self.name))?;
        self.core.set_name(self.view, || format!("texels of `{}`", self.name));
        Ok(())
    }

    pub(super) fn handle(&self) -> vk::Buffer {
        self.handle
    }

    /// Returns the mapped bytes of host-visible memory.
    pub(super) fn mapped(&mut self) -> Result<&mut [u8]> {
        let slice = self.allocation.as_mut().and_then(Allocation::mapped_slice_mut);
        slice.ok_or_else(|| Error::new(format!("buffer `{}` is not mapped to host memory", self.name)))
    }
}

impl Drop for RawBuffer {
    fn drop(&mut self) {
        self.core.release(|device| {
            // SAFETY: calls are synchronous, so the device does not use the buffer; null handles
            // are allowed.
            unsafe {
                device.destroy_buffer_view(self.view, None);
                device.destroy_buffer(self.handle, None);
            }
            if let Some(allocation) = self.allocation.take() {
                self.core.memory.free(allocation);
            }
        });
    }
}
