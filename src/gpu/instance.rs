//! The Vulkan loader and instance, with or without validation; devices are listed and opened from
//! it.

use ash::vk;

use super::debug::{MessageLog, Messenger, VALIDATION_LAYER, layer_present};
use super::info::{self, DeviceInfo};
use super::result::{INSTALL, WithOperation, failed};
use crate::core::error::{Error, ErrorKind, Result};

pub(super) const API_VERSION: u32 = vk::API_VERSION_1_2;
/// The same in words.
pub const API_VERSION_TEXT: &str = "1.2";

/// Returns every Vulkan device of this machine in the loader's order, including unsuitable ones.
pub fn list_devices() -> Result<Vec<DeviceInfo>> {
    Ok(Instance::new(false)?.devices()?.into_iter().map(|(_, info)| info).collect())
}

/// Loads the system's Vulkan loader, or the one that `MOIRE_VULKAN_LIBRARY` names.
pub(super) fn load() -> Result<ash::Entry> {
    let Some(path) = std::env::var_os("MOIRE_VULKAN_LIBRARY") else {
        // SAFETY: this runs the initialisers of the system's Vulkan loader, a library that is made
        // to be loaded so; nothing is unloaded before `Entry` is dropped, which owners do last.
        return unsafe { ash::Entry::load() }
            .map_err(|error| no_driver(format!("no Vulkan loader was found ({error})"), INSTALL));
    };
    // SAFETY: as above; the user vouches that the named library is a Vulkan loader.
    unsafe { ash::Entry::load_from(&path) }.map_err(|error| {
        no_driver(
            format!("no Vulkan loader was found at MOIRE_VULKAN_LIBRARY = {} ({error})", path.display()),
            &format!("unset it to use the system's loader. {INSTALL}"),
        )
    })
}

/// The instance, dropped last of all objects in the order messenger, instance, loader. Destroying
/// the instance can still add to the log.
pub(super) struct Instance {
    messenger: Option<Messenger>,
    log: Option<MessageLog>,
    pub(super) raw: ash::Instance,
    _entry: ash::Entry,
}

impl Instance {
    pub(super) fn new(validation: bool) -> Result<Instance> {
        let entry = load()?;
        let log = (validation && layer_present(&entry)).then(MessageLog::default);
        let raw = create(&entry, log.as_ref())?;
        let mut instance = Instance { messenger: None, log, raw, _entry: entry };
        if let Some(log) = &instance.log {
            instance.messenger = Some(Messenger::new(&instance._entry, &instance.raw, log)?);
        }
        Ok(instance)
    }

    /// Returns the validation messages, or `None` if the layer is not loaded.
    pub(super) fn messages(&self) -> Option<&MessageLog> {
        self.log.as_ref()
    }

    /// Returns all physical devices; an empty list is an error.
    pub(super) fn devices(&self) -> Result<Vec<(vk::PhysicalDevice, DeviceInfo)>> {
        // SAFETY: the instance is live.
        let found = unsafe { self.raw.enumerate_physical_devices() };
        let handles = match found {
            // A loader without a driver returns one or the other.
            Ok(handles) if handles.is_empty() => return Err(no_device()),
            Err(vk::Result::ERROR_INITIALIZATION_FAILED) => return Err(no_device()),
            other => other.during(|| "listing Vulkan devices".into())?,
        };
        let describe = |(index, handle)| (handle, info::describe(&self.raw, handle, index));
        Ok(handles.into_iter().enumerate().map(describe).collect())
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        if let Some(messenger) = &self.messenger {
            messenger.destroy();
        }
        // SAFETY: the device core, which owns this, has destroyed everything made from it.
        unsafe { self.raw.destroy_instance(None) };
    }
}

fn no_driver(message: String, help: &str) -> Error {
    Error::with_help(message, help).of_kind(ErrorKind::NoDevice)
}

fn no_device() -> Error {
    no_driver("no Vulkan device was found: the loader has no working driver".into(), INSTALL)
}

fn create(entry: &ash::Entry, log: Option<&MessageLog>) -> Result<ash::Instance> {
    let application = vk::ApplicationInfo::default().application_name(c"moire").api_version(API_VERSION);
    let mut create_info = vk::InstanceCreateInfo::default().application_info(&application);

    let layers = [VALIDATION_LAYER.as_ptr()];
    let mut extensions = vec![ash::ext::debug_utils::NAME.as_ptr()];
    let enabled = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
    let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&enabled);
    let mut messenger = log.map(MessageLog::messenger_info).unwrap_or_default();
    if log.is_some() {
        if layer_has_features(entry) {
            extensions.push(ash::ext::validation_features::NAME.as_ptr());
            create_info = create_info.push_next(&mut features);
        }
        create_info = create_info
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions)
            .push_next(&mut messenger);
    }
    // SAFETY: all that `create_info` points to lives until the end of this function.
    match unsafe { entry.create_instance(&create_info, None) } {
        Ok(instance) => Ok(instance),
        Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => Err(no_device()),
        Err(code) => Err(failed("starting Vulkan", code)),
    }
}

fn layer_has_features(entry: &ash::Entry) -> bool {
    // SAFETY: a global command; the layer's name is a terminated string.
    let extensions =
        unsafe { entry.enumerate_instance_extension_properties(Some(VALIDATION_LAYER)) }.unwrap_or_default();
    extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::ext::validation_features::NAME))
}
