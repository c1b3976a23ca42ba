//! Vulkan's result codes as errors: one sentence states which operation on which object failed and
//! why, another operation the user can do about it.

use ash::vk;

use crate::core::error::{Error, Result};

/// Adds to a failed Vulkan call the operation that failed: `creating buffer `film``.
pub(super) trait WithOperation<T> {
    fn during(self, operation: impl FnOnce() -> String) -> Result<T>;
}

impl<T> WithOperation<T> for Result<T, vk::Result> {
    fn during(self, operation: impl FnOnce() -> String) -> Result<T> {
        self.map_err(|code| failed(&operation(), code))
    }
}

pub(super) const LESS_MEMORY: &str = "Use smaller textures or a smaller picture (--size, --crop), or another device (`moire devices` lists them).";

pub(super) const INSTALL: &str =
    "Run ./setup.sh, or install the loader and a driver: apt install libvulkan1 mesa-vulkan-drivers";

pub(super) fn failed(operation: &str, code: vk::Result) -> Error {
    match code {
        vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => {
            Error::with_help(format!("{operation}: out of device memory"), LESS_MEMORY)
        }
        vk::Result::ERROR_OUT_OF_HOST_MEMORY => Error::with_help(
            format!("{operation}: out of host memory"),
            "Close other programs, or use smaller textures or a smaller picture.",
        ),
        vk::Result::ERROR_DEVICE_LOST => device_lost(&format!("{operation}: the device was lost")),
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => {
            Error::with_help(format!("{operation}: no usable Vulkan driver is installed"), INSTALL)
        }
        vk::Result::ERROR_INITIALIZATION_FAILED => Error::with_help(
            format!("{operation}: the driver failed to initialize"),
            "Check the driver's installation, or choose another device: `moire devices` lists them.",
        ),
        vk::Result::ERROR_TOO_MANY_OBJECTS => Error::with_help(
            format!("{operation}: the device has too many objects of this kind"),
            LESS_MEMORY,
        ),
        other => Error::new(format!("{operation}: Vulkan reports {other:?}")),
    }
}

pub(super) fn device_lost(message: &str) -> Error {
    Error::with_help(
        message,
        "The driver crashed or a watchdog reset the device. Try again with fewer samples or a smaller \
         picture, or with --device cpu.",
    )
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
    fn memory_errors_name_the_object_and_help() {
        for (code, word) in [
            (vk::Result::ERROR_OUT_OF_DEVICE_MEMORY, "out of device memory"),
            (vk::Result::ERROR_OUT_OF_HOST_MEMORY, "out of host memory"),
            (vk::Result::ERROR_DEVICE_LOST, "device was lost"),
        ] {
            let Error::Plain { message, help, .. } = failed("creating buffer `film`", code) else {
                panic!("not a plain error");
            };
            assert!(message.contains("`film`") && message.contains(word), "{message}");
            assert!(help.is_some(), "{message} has no help");
        }
    }

    #[test]
    fn sizes_read_well() {
        assert_eq!(size_text(17), "17 bytes");
        assert_eq!(size_text(4 << 20), "4.0 MiB");
        assert_eq!(size_text(3 << 29), "1.5 GiB");
    }
}
