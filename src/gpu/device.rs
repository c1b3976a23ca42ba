//! The device core that every object shares: instance, device, queue and allocator. Opens a device
//! from a selection; the device is destroyed when the last object drops its reference.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::vk;

use super::OpenOptions;
use super::convert;
use super::debug::Names;
use super::image::ImageFormat;
use super::info::{DeviceInfo, compute_queue};
use super::instance::Instance;
use super::memory::Memory;
use super::result::WithOperation;
use super::select::DeviceSelect;
use crate::core::error::{Error, Result};

/// Locks a mutex even if a thread panicked while holding it: these locks guard complete operations,
/// so that the data is consistent.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

pub(super) struct Core {
    pub(super) memory: Memory,
    pub(super) device: ash::Device,
    pub(super) queue: vk::Queue,
    pub(super) queue_family: u32,
    pub(super) info: DeviceInfo,
    physical: vk::PhysicalDevice,
    names: Option<Names>,
    hung: AtomicBool,
    pub(super) instance: Instance,
}

impl Core {
    pub(super) fn open(select: &DeviceSelect, options: OpenOptions) -> Result<Arc<Core>> {
        let instance = Instance::new(options.validation)?;
        let mut devices = instance.devices()?;
        let infos: Vec<DeviceInfo> = devices.iter().map(|(_, info)| info.clone()).collect();
        let (physical, info) = devices.swap_remove(select.choose(&infos)?);
        let (queue_family, _) = compute_queue(&instance.raw, physical)
            .ok_or_else(|| Error::new(format!("{} has no compute queue", info.name)))?;

        let device = create(&instance.raw, physical, queue_family, &info)?;
        let names = instance.messages().is_some().then(|| Names::new(&instance.raw, &device));
        let memory = match Memory::new(&instance.raw, &device, physical, info.limits.heap_bytes) {
            Ok(memory) => memory,
            Err(error) => {
                // SAFETY: nothing was made from the device yet.
                unsafe { device.destroy_device(None) };
                return Err(error);
            }
        };
        // SAFETY: the device was created with one queue of this family.
        let queue = unsafe { device.get_device_queue(queue_family, 0) };
        let hung = AtomicBool::new(false);
        Ok(Arc::new(Core { memory, device, queue, queue_family, info, physical, names, hung, instance }))
    }

    /// Names an object. `name` is evaluated only if debug names are in use.
    pub(super) fn set_name<H: vk::Handle>(&self, handle: H, name: impl FnOnce() -> String) {
        if let Some(names) = &self.names {
            names.set(handle, &name());
        }
    }

    pub(super) fn supports(&self, format: ImageFormat, linear_filter: bool) -> bool {
        // SAFETY: `physical` is of this live instance.
        let properties = unsafe {
            self.instance.raw.get_physical_device_format_properties(self.physical, convert::format(format))
        };
        let mut needed = vk::FormatFeatureFlags::SAMPLED_IMAGE | vk::FormatFeatureFlags::TRANSFER_DST;
        if linear_filter {
            needed |= vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        }
        properties.optimal_tiling_features.contains(needed)
    }

    pub(super) fn is_hung(&self) -> bool {
        self.hung.load(Ordering::Relaxed)
    }

    /// Marks the device as hung. Its work may then touch any object at any time, so that no object
    /// may be destroyed any more: the core is leaked, and [`Core::release`] does nothing.
    pub(super) fn set_hung(self: &Arc<Core>) {
        if !self.hung.swap(true, Ordering::Relaxed) {
            std::mem::forget(Arc::clone(self));
        }
    }

    /// Runs `destroy` unless the device is hung. Every object's drop calls it.
    pub(super) fn release(&self, destroy: impl FnOnce(&ash::Device)) {
        if !self.is_hung() {
            destroy(&self.device);
        }
    }
}

impl Drop for Core {
    fn drop(&mut self) {
        self.memory.close();
        // SAFETY: every object of the device holds an `Arc` of this core, so that none is left;
        // all submitted work was waited for; a hung device's core is never dropped.
        unsafe { self.device.destroy_device(None) };
    }
}

fn create(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    queue_family: u32,
    info: &DeviceInfo,
) -> Result<ash::Device> {
    let queues =
        [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
    let mut core12 = vk::PhysicalDeviceVulkan12Features::default()
        .sampler_mirror_clamp_to_edge(info.limits.mirror_clamp_to_edge);
    let mut border = vk::PhysicalDeviceCustomBorderColorFeaturesEXT::default()
        .custom_border_colors(true)
        .custom_border_color_without_format(true);
    let extensions = [ash::ext::custom_border_color::NAME.as_ptr()];
    let features = vk::PhysicalDeviceFeatures::default()
        .sampler_anisotropy(info.limits.max_anisotropy > 1.0)
        .shader_float64(info.limits.float64);
    let mut create_info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_features(&features)
        .push_next(&mut core12);
    if info.limits.custom_border_color {
        create_info = create_info.enabled_extension_names(&extensions).push_next(&mut border);
    }
    // SAFETY: the features and the extension are ones that the device lists.
    unsafe { instance.create_device(physical, &create_info, None) }
        .during(|| format!("opening Vulkan device {} ({})", info.index, info.name))
}
