//! Known faults of drivers: the driver, the affected variants and the bounds of the errors. A
//! variant that errs within these bounds is listed, but fails a report only with `strict`.

use super::variants::{FormatClass, Reader, Scale, Variant};
use crate::gpu::DeviceInfo;
use crate::texture::sampler_spec::{Address, Filter, MipMode};

pub struct KnownFault {
    pub name: &'static str,
    /// Part of the driver's name.
    driver: &'static str,
    applies: fn(&Variant) -> bool,
    /// The largest distance of a value from the device's declared precision, as a fraction of the
    /// texels' range.
    pub beyond: f64,
}

const FAULTS: &[KnownFault] = &[
    KnownFault {
        // Mesa's gallivm, lp_bld_sample_aos.c: interpolation in integers of 8 bits, rounded after
        // each axis.
        name: "lavapipe filters 8-bit texels with 8-bit arithmetic where all axes repeat or clamp to the edge",
        driver: "llvmpipe",
        applies: |v| {
            let simple = |a: &Address| matches!(a, Address::Repeat | Address::ClampToEdge);
            let mixes = match v.scale {
                Scale::Levels => {
                    [v.spec.mag, v.spec.min].contains(&Filter::Linear) || v.spec.mip == MipMode::Linear
                }
                _ => v.filter() == Filter::Linear,
            };
            v.reader == Reader::Sampler
                && v.class == FormatClass::Unorm8
                && mixes
                && v.addresses().iter().all(simple)
        },
        beyond: 1.0 / 255.0, // half a step of 255 an axis
    },
    ANISOTROPY,
];

const ANISOTROPY: KnownFault = KnownFault {
    name: "lavapipe reads levels that are not the footprint's where a sampler is anisotropic",
    driver: "llvmpipe",
    applies: |v| v.reader == Reader::Sampler && v.scale == Scale::Anisotropic,
    beyond: 1.0, // any level for any other
};

/// Returns the known fault of this device's anisotropic filtering, if there is one.
pub fn anisotropy_fault(device: &DeviceInfo) -> Option<&'static str> {
    let fault = &ANISOTROPY;
    device.driver.contains(fault.driver).then_some(fault.name)
}

/// Returns the known fault of this device in this variant, if there is one.
pub fn known_fault(device: &DeviceInfo, variant: &Variant) -> Option<&'static KnownFault> {
    FAULTS.iter().find(|f| device.driver.contains(f.driver) && (f.applies)(variant))
}
