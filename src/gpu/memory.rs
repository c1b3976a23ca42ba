//! Device memory. Allocates memory for an object's requirements, or returns an error that names the
//! object, its size and the heap.

use std::sync::Mutex;

use ash::vk;
use gpu_allocator::vulkan::{
    Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc,
};
use gpu_allocator::{AllocationError, AllocationSizes, MemoryLocation};

use super::device::lock;
use super::result::{LESS_MEMORY, size_text};
use crate::core::error::{Error, ErrorKind, Result};

const MIB: u64 = 1024 * 1024;

/// The size of the first memory block. Objects smaller than a block share blocks; larger ones get
/// dedicated memory, which is freed with them. Blocks start small because a CPU driver takes them
/// from this process's own memory.
const FIRST_BLOCK: u64 = 4 * MIB;
const LAST_BLOCK: u64 = 64 * MIB;

pub(super) struct Memory {
    /// The allocator, `None` once closed.
    allocator: Mutex<Option<Allocator>>,
    heap_bytes: u64,
}

impl Memory {
    pub(super) fn new(
        instance: &ash::Instance,
        device: &ash::Device,
        physical_device: vk::PhysicalDevice,
        heap_bytes: u64,
    ) -> Result<Memory> {
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: device.clone(),
            physical_device,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(FIRST_BLOCK, FIRST_BLOCK)
                .with_max_device_memblock_size(LAST_BLOCK)
                .with_max_host_memblock_size(LAST_BLOCK),
        })
        .map_err(|error| Error::new(format!("setting up the device memory allocator: {error}")))?;
        Ok(Memory { allocator: Mutex::new(Some(allocator)), heap_bytes })
    }

    /// Refuses an object that is larger than the heap before it is created.
    pub(super) fn check_heap(&self, object: &str, bytes: u64) -> Result<()> {
        if bytes <= self.heap_bytes {
            return Ok(());
        }
        Err(self.error(object, bytes, "out of device memory"))
    }

    /// Allocates memory for the object that `object` names, such as `texture `ground` 1024×1024 rgba8`.
    pub(super) fn allocate(
        &self,
        object: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Allocation> {
        let desc = AllocationCreateDesc {
            name: object,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let result = match lock(&self.allocator).as_mut() {
            Some(allocator) => allocator.allocate(&desc),
            None => Err(AllocationError::Internal("the device is closed".into())),
        };
        result.map_err(|error| match error {
            AllocationError::OutOfMemory => self.error(object, requirements.size, "out of device memory"),
            other => self.error(object, requirements.size, &other.to_string()),
        })
    }

    pub(super) fn free(&self, allocation: Allocation) {
        if let Some(allocator) = lock(&self.allocator).as_mut() {
            // This fails only for an allocation of another allocator, in which case there is
            // nothing to free.
            let _ = allocator.free(allocation);
        }
    }

    pub(super) fn in_use(&self) -> u64 {
        lock(&self.allocator)
            .as_ref()
            .map_or(0, |allocator| allocator.generate_report().total_allocated_bytes)
    }

    /// Frees all blocks. Must be called before the device is destroyed.
    pub(super) fn close(&self) {
        drop(lock(&self.allocator).take());
    }

    fn error(&self, object: &str, bytes: u64, reason: &str) -> Error {
        Error::with_help(
            format!(
                "allocating {object} ({}): {reason}; the device has {}, of which {} are in use here",
                size_text(bytes),
                size_text(self.heap_bytes),
                size_text(self.in_use()),
            ),
            LESS_MEMORY,
        )
        .of_kind(ErrorKind::OutOfDeviceMemory)
    }
}
