//! Properties, limits and features of a physical device as plain data, for listings, for device
//! selection and for size checks.

use ash::vk;
use serde::{Serialize, Serializer, ser::SerializeStruct};

use super::convert;
use super::instance::API_VERSION;
use crate::core::named::named_enum;

named_enum! {
    /// The device types in order of preference.
    pub enum DeviceKind {
        Discrete = "discrete",
        Integrated = "integrated",
        Virtual = "virtual",
        Cpu = "cpu",
        Other = "other",
    }
}

impl Serialize for DeviceKind {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

#[derive(Clone, Debug, Serialize)]
pub struct DeviceInfo {
    /// The index in the listing, as given to `--device INDEX`.
    pub index: usize,
    pub name: String,
    pub kind: DeviceKind,
    /// The driver's name and version as the driver reports them.
    pub driver: String,
    pub api_version: String,
    /// The device UUID in hexadecimal; absent before Vulkan 1.1.
    pub uuid: Option<String>,
    pub limits: DeviceLimits,
    /// The reason why the device cannot be used, if any. Serialized as `{"ok": …, "reason": …}`.
    #[serde(serialize_with = "serialize_suitable")]
    pub suitable: Result<(), String>,
}

/// The limits and optional features that are used (`VkPhysicalDeviceLimits` and feature
/// structures).
#[derive(Clone, Debug, Default, Serialize)]
pub struct DeviceLimits {
    pub max_image_2d: u32,
    pub max_image_3d: u32,
    pub max_image_cube: u32,
    /// In bytes.
    pub max_storage_buffer_range: u64,
    /// In bytes.
    pub max_uniform_buffer_range: u64,
    pub max_texel_buffer_elements: u64,
    /// In bytes.
    pub max_push_constants: u32,
    pub max_workgroup_invocations: u32,
    pub max_workgroup_count: [u32; 3],
    /// Fraction bits of texel coordinates in linear filtering.
    pub sub_texel_bits: u32,
    /// Fraction bits of the level in mip selection.
    pub mip_bits: u32,
    /// The largest sampler anisotropy; 1 if anisotropic filtering is not supported.
    pub max_anisotropy: f32,
    /// True if shaders may compute in f64.
    pub float64: bool,
    pub timestamp_period_ns: f64,
    /// Valid bits of the compute queue's timestamps; 0 if it has none.
    pub timestamp_valid_bits: u32,
    pub max_storage_buffers_per_stage: u32,
    pub max_sampled_images_per_stage: u32,
    pub max_samplers_per_stage: u32,
    /// The subgroup size; 0 before Vulkan 1.1.
    pub subgroup_size: u32,
    /// The size of the largest device-local heap.
    pub heap_bytes: u64,
    /// True if any border colour is supported, not only the three standard ones.
    pub custom_border_color: bool,
    pub mirror_clamp_to_edge: bool,
}

fn serialize_suitable<S: Serializer>(suitable: &Result<(), String>, s: S) -> Result<S::Ok, S::Error> {
    let mut out = s.serialize_struct("Suitable", 2)?;
    out.serialize_field("ok", &suitable.is_ok())?;
    out.serialize_field("reason", &suitable.as_ref().err())?;
    out.end()
}

/// Returns the queue family for all work: one with compute and, if any such family has them,
/// timestamps.
pub(super) fn compute_queue(instance: &ash::Instance, device: vk::PhysicalDevice) -> Option<(u32, u32)> {
    // SAFETY: `device` is of this live instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
    (0u32..)
        .zip(&families)
        .filter(|(_, family)| family.queue_flags.contains(vk::QueueFlags::COMPUTE))
        .map(|(index, family)| (index, family.timestamp_valid_bits))
        .reduce(|best, next| if best.1 == 0 && next.1 > 0 { next } else { best })
}

pub(super) fn describe(instance: &ash::Instance, device: vk::PhysicalDevice, index: usize) -> DeviceInfo {
    // SAFETY: `device` is of this live instance.
    let basic = unsafe { instance.get_physical_device_properties(device) };
    let queue = compute_queue(instance, device);
    let mut limits = basic_limits(&basic);
    limits.timestamp_valid_bits = queue.map_or(0, |(_, bits)| bits);
    limits.heap_bytes = largest_heap(instance, device);

    let modern = basic.api_version >= API_VERSION;
    let mut driver = format!("driver {:#x}", basic.driver_version);
    let mut uuid = None;
    if modern {
        (driver, uuid) = identify(instance, device, &mut limits);
        query_features(instance, device, &mut limits);
    }
    let version = version_text(basic.api_version);
    let suitable = if !modern {
        Err(format!("it offers Vulkan {version}, and 1.2 is needed"))
    } else if queue.is_none() {
        Err("it has no compute queue".into())
    } else if limits.max_workgroup_invocations < 64 {
        Err(format!(
            "its workgroups hold {} invocations, and 64 are needed",
            limits.max_workgroup_invocations
        ))
    } else {
        Ok(())
    };
    DeviceInfo {
        index,
        name: basic.device_name_as_c_str().unwrap_or_default().to_string_lossy().into_owned(),
        kind: convert::kind(basic.device_type),
        driver,
        api_version: version,
        uuid,
        limits,
        suitable,
    }
}

fn version_text(version: u32) -> String {
    let (major, minor) = (vk::api_version_major(version), vk::api_version_minor(version));
    format!("{major}.{minor}.{}", vk::api_version_patch(version))
}

fn basic_limits(properties: &vk::PhysicalDeviceProperties) -> DeviceLimits {
    let limits = &properties.limits;
    DeviceLimits {
        max_image_2d: limits.max_image_dimension2_d,
        max_image_3d: limits.max_image_dimension3_d,
        max_image_cube: limits.max_image_dimension_cube,
        max_storage_buffer_range: u64::from(limits.max_storage_buffer_range),
        max_uniform_buffer_range: u64::from(limits.max_uniform_buffer_range),
        max_texel_buffer_elements: u64::from(limits.max_texel_buffer_elements),
        max_push_constants: limits.max_push_constants_size,
        max_workgroup_invocations: limits.max_compute_work_group_invocations,
        max_workgroup_count: limits.max_compute_work_group_count,
        sub_texel_bits: limits.sub_texel_precision_bits,
        mip_bits: limits.mipmap_precision_bits,
        max_anisotropy: limits.max_sampler_anisotropy,
        float64: false,
        timestamp_period_ns: f64::from(limits.timestamp_period),
        max_storage_buffers_per_stage: limits.max_per_stage_descriptor_storage_buffers,
        max_sampled_images_per_stage: limits.max_per_stage_descriptor_sampled_images,
        max_samplers_per_stage: limits.max_per_stage_descriptor_samplers,
        ..DeviceLimits::default()
    }
}

fn largest_heap(instance: &ash::Instance, device: vk::PhysicalDevice) -> u64 {
    // SAFETY: `device` is of this live instance.
    let memory = unsafe { instance.get_physical_device_memory_properties(device) };
    let heaps = memory.memory_heaps_as_slice().iter();
    heaps
        .filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL))
        .map(|heap| heap.size)
        .max()
        .unwrap_or(0)
}

/// Returns driver text and UUID, and fills in the subgroup size.
fn identify(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
    limits: &mut DeviceLimits,
) -> (String, Option<String>) {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut id = vk::PhysicalDeviceIDProperties::default();
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default()
        .push_next(&mut driver)
        .push_next(&mut id)
        .push_next(&mut subgroup);
    // SAFETY: the chained structures are core in the Vulkan 1.2 that this device offers.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    limits.subgroup_size = subgroup.subgroup_size;
    let words = [driver.driver_name_as_c_str(), driver.driver_info_as_c_str()]
        .map(|text| text.unwrap_or_default().to_string_lossy().into_owned());
    (words.join(" ").trim().to_string(), Some(id.device_uuid.iter().map(|b| format!("{b:02x}")).collect()))
}

fn query_features(instance: &ash::Instance, device: vk::PhysicalDevice, limits: &mut DeviceLimits) {
    // SAFETY: `device` is of this live instance. A device that cannot list extensions has none.
    let extensions = unsafe { instance.enumerate_device_extension_properties(device) }.unwrap_or_default();
    let border_extension =
        extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::ext::custom_border_color::NAME));
    let mut core12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut border = vk::PhysicalDeviceCustomBorderColorFeaturesEXT::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut core12);
    if border_extension {
        features = features.push_next(&mut border);
    }
    // SAFETY: the chained structures are of Vulkan 1.2 and of an extension that the device lists.
    unsafe { instance.get_physical_device_features2(device, &mut features) };
    let anisotropy = features.features.sampler_anisotropy == vk::TRUE;
    limits.float64 = features.features.shader_float64 == vk::TRUE;
    limits.mirror_clamp_to_edge = core12.sampler_mirror_clamp_to_edge == vk::TRUE;
    limits.custom_border_color =
        border.custom_border_colors == vk::TRUE && border.custom_border_color_without_format == vk::TRUE;
    if !anisotropy {
        limits.max_anisotropy = 1.0;
    }
}
