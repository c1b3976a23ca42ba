//! Vulkan's result codes as errors: one sentence states which operation on which object failed and
//! why, another operation the user can do about it.

use ash::vk;

use crate::core::error::{Error, ErrorKind, Result};

/// Adds to a failed Vulkan call the operation that failed: `creating buffer `film``.
pub(super) trait WithOperation<T> {
    fn during(self, operation: impl FnOnce() -> String) -> Result<T>;
}

impl<T> WithOperation<T> for Result<T, vk::Result> {
    fn during(self, operation: impl FnOnce() -> String) -> Result<T> {
        self.map_err(|code| failed(&operation(), code))
    }
}

pub(super) const LESS_MEMORY: &str =
    "Use smaller textures or a smaller picture (size, crop), or another device (`moire devices` lists them).";

pub(super) const INSTALL: &str =
    "Run ./setup.sh, or install the loader and a driver: apt install libvulkan1 mesa-vulkan-drivers";

pub(super) fn failed(operation: &str, code: vk::Result) -> Error {
    let error = |what: &str, help: &str, kind: ErrorKind| {
        Error::with_help(format!("{operation}: {what}"), help).of_kind(kind)
    };
    match code {
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            error("out of device memory", LESS_MEMORY, ErrorKind::OutOfDeviceMemory)
        }
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => error(
            "out of host memory",
            "Close other programs, or use smaller textures or a smaller picture.",
            ErrorKind::OutOfHostMemory,
        ),
        vk::Result::ERROR_DEVICE_LOST => device_lost(&format!("{operation}: the device was lost")),
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => {
            error("no usable Vulkan driver is installed", INSTALL, ErrorKind::NoDevice)
        }
        vk::Result::ERROR_INITIALIZATION_FAILED => error(
            "the driver failed to initialize",
            "Check the driver's installation, or choose another device: `moire devices` lists them.",
            ErrorKind::NoDevice,
        ),
        vk::Result::ERROR_TOO_MANY_OBJECTS => {
            error("the device has too many objects of this kind", LESS_MEMORY, ErrorKind::Unsupported)
        }
        other => Error::new(format!("{operation}: Vulkan reports {other:?}")).of_kind(ErrorKind::Internal),
    }
}

pub(super) fn device_lost(message: &str) -> Error {
    Error::with_help(
        message,
        "The driver crashed or a watchdog reset the device. Try again with fewer samples or a smaller \
         picture, or with --device cpu.",
    )
    .of_kind(ErrorKind::DeviceLost)
}

/// Formats a size in binary units: `4.0 MiB`.
pub(super) fn size_text(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    if bytes < 1024 {
        return format!("{bytes} bytes");
    }
    let mut value = bytes as f64 / 1024.0;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    format!("{value:.1} {}", UNITS[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_errors_name_the_object_and_help_and_have_kinds() {
        use ErrorKind::{DeviceLost, OutOfDeviceMemory, OutOfHostMemory};
        for (code, word, kind) in [
            (vk::Result::ERROR_OUT_OF_DEVICE_MEMORY, "out of device memory", OutOfDeviceMemory),
            (vk::Result::ERROR_OUT_OF_HOST_MEMORY, "out of host memory", OutOfHostMemory),
            (vk::Result::ERROR_DEVICE_LOST, "device was lost", DeviceLost),
        ] {
            let error = failed("creating buffer `film`", code);
            let message = error.to_string();
            assert!(message.contains("`film`") && message.contains(word), "{message}");
            assert!(error.help().is_some(), "{message} has no help");
            assert!(error.kind() == kind && kind.is_transient(), "{message}: {:?}", error.kind());
        }
        let other = failed("creating buffer `film`", vk::Result::ERROR_UNKNOWN).kind();
        assert!(other == ErrorKind::Internal && !other.is_transient());
    }

    #[test]
    fn sizes_read_well() {
        assert_eq!(size_text(17), "17 bytes");
        assert_eq!(size_text(4 << 20), "4.0 MiB");
        assert_eq!(size_text(3 << 29), "1.5 GiB");
    }
}
