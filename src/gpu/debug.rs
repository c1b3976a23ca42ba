//! The Khronos validation layer: its availability, its messages and the object names that they
//! show. Nothing of it is loaded unless validation is requested, which keeps start-up short.

use std::ffi::{CStr, CString, c_void};
use std::sync::{Arc, Mutex};

use ash::vk;

use super::device::lock;
use super::result::WithOperation;
use crate::core::error::Result;

pub(super) const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Returns true if [`OpenOptions::validation`](super::OpenOptions) can have an effect on this
/// machine.
pub fn validation_available() -> bool {
    super::instance::load().is_ok_and(|entry| layer_present(&entry))
}

pub(super) fn layer_present(entry: &ash::Entry) -> bool {
    // SAFETY: a global command without preconditions; the loader stays loaded while `entry` lives.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
    layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION_LAYER))
}

/// Warnings and errors collected so far, shared with the messenger's callback.
#[derive(Clone, Debug, Default)]
pub struct MessageLog(Arc<Mutex<Vec<String>>>);

impl MessageLog {
    pub fn to_vec(&self) -> Vec<String> {
        lock(&self.0).clone()
    }

    /// Returns the create info of a messenger. `self` must outlive that messenger.
    pub(super) fn messenger_info(&self) -> vk::DebugUtilsMessengerCreateInfoEXT<'static> {
        use vk::{DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type};
        vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR)
            .message_type(Type::GENERAL | Type::VALIDATION | Type::PERFORMANCE)
            .pfn_user_callback(Some(collect))
            .user_data(Arc::as_ptr(&self.0).cast_mut().cast::<c_void>())
    }
}

unsafe extern "system" fn collect(
    severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _types: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: `user_data` is the log's mutex, which outlives messenger and instance (see `Instance`).
    let log = unsafe { user_data.cast::<Mutex<Vec<String>>>().as_ref() };
    // SAFETY: the layer passes a valid structure for the time of the call.
    let data = unsafe { data.as_ref() };
    if let (Some(log), Some(data)) = (log, data) {
        // SAFETY: `p_message`, when set, is a terminated string that lives as long as `data`.
        let text = unsafe { data.message_as_c_str() }.map_or_else(Default::default, CStr::to_string_lossy);
        lock(log).push(format!("{severity:?}: {text}"));
    }
    vk::FALSE
}

/// A debug messenger that writes to a [`MessageLog`], which the owner must keep alive longer.
pub(super) struct Messenger {
    loader: ash::ext::debug_utils::Instance,
    handle: vk::DebugUtilsMessengerEXT,
}

impl Messenger {
    pub(super) fn new(entry: &ash::Entry, instance: &ash::Instance, log: &MessageLog) -> Result<Messenger> {
        let loader = ash::ext::debug_utils::Instance::new(entry, instance);
        // SAFETY: the instance was created with VK_EXT_debug_utils; the instance's owner keeps `log`.
        let handle = unsafe { loader.create_debug_utils_messenger(&log.messenger_info(), None) }
            .during(|| "listening to the validation layer".into())?;
        Ok(Messenger { loader, handle })
    }

    /// Destroys the messenger. Must be called once, before the instance is destroyed.
    pub(super) fn destroy(&self) {
        // SAFETY: the handle is ours, and the only owner calls this once, in its drop.
        unsafe { self.loader.destroy_debug_utils_messenger(self.handle, None) };
    }
}

/// The function that gives Vulkan objects the names shown by messages and debuggers.
pub(super) struct Names(ash::ext::debug_utils::Device);

impl Names {
    pub(super) fn new(instance: &ash::Instance, device: &ash::Device) -> Names {
        Names(ash::ext::debug_utils::Device::new(instance, device))
    }

    pub(super) fn set<H: vk::Handle>(&self, handle: H, name: &str) {
        let name = CString::new(name.replace('\0', " ")).unwrap_or_default();
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // SAFETY: the handle is a live object of this device. A name is only a convenience: a
        // failure to set it is no reason to fail.
        let _ = unsafe { self.0.set_debug_utils_object_name(&info) };
    }
}
