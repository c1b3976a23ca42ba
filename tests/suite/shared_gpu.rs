//! One device for all tests that only compute with it (`MOIRE_DEVICE`, else `cpu`), opened with the
//! validation layer. A lease fails its test if the layer has reported anything by the end of it.

use std::ops::Deref;
use std::sync::OnceLock;

use moire::internal::gpu::{DeviceSelect, Gpu, OpenOptions, validation_available};

use crate::support::untested;

/// The shared device, for the length of one test.
pub struct Lease(&'static Gpu);

pub fn gpu() -> Lease {
    static SHARED: OnceLock<Gpu> = OnceLock::new();
    Lease(SHARED.get_or_init(|| {
        let name = std::env::var("MOIRE_DEVICE").unwrap_or_else(|_| "cpu".into());
        let select = DeviceSelect::parse(&name).unwrap();
        let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
        assert_eq!(gpu.validation_active(), validation_available());
        if !gpu.validation_active() {
            untested("what the validation layer would say: it is not installed");
        }
        gpu
    }))
}

impl Deref for Lease {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.0
    }
}

impl Drop for Lease {
    fn drop(&mut self) {
        let messages = self.0.messages();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "validation: {messages:#?}");
        }
    }
}
