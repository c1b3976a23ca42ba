//! The report of a verification: rows with a verdict for each tally, as plain data that `--json`
//! prints.

use serde::{Serialize, Serializer};

use super::known::known_fault;
use super::run::Tally;
use super::variants::{Scale, Variant};
use super::weights::WeightBits;
use crate::core::named::named_enum;
use crate::gpu::DeviceInfo;

named_enum! {
    /// The verdicts in ascending order of severity.
    pub enum Verdict {
        Within = "within",
        KnownFault = "known fault",
        Outside = "outside",
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// One variant of sampler, texture and texel format.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    #[serde(skip)]
    pub variant: Variant,
    pub name: String,
    pub reader: &'static str,
    pub dimension: &'static str,
    /// The address modes of the texture's axes; empty for a cube.
    pub address: Vec<&'static str>,
    pub mag: &'static str,
    pub min: &'static str,
    pub mip: &'static str,
    /// The levels that were read: level 0 by one of the two filters, all levels, or long
    /// footprints.
    pub scale: &'static str,
    pub class: &'static str,
    pub format: &'static str,
    pub size: [u32; 3],
    pub max_anisotropy: Option<u32>,
    pub look_ups: usize,
    pub wrong: usize,
    /// The errors as in `judge::Judgement`; null for an answer that is NaN or infinity or should
    /// have been constant.
    pub worst_error: f64,
    pub worst_beyond: f64,
    pub weights: Option<WeightBits>,
    /// The weight bits of the blend of two levels.
    pub level_weights: Option<WeightBits>,
    /// The largest anisotropy that was resolved, in footprint widths.
    pub anisotropy: Option<f64>,
    pub verdict: Verdict,
    pub fault: Option<&'static str>,
    pub example: Option<String>,
}

impl Row {
    pub fn new(device: &DeviceInfo, variant: &Variant, tally: Tally) -> Row {
        let limits = &device.limits;
        let coarse = tally.weights.is_some_and(|w| w.bits < limits.sub_texel_bits)
            || tally.level_weights.is_some_and(|w| w.bits < limits.mip_bits);
        let known = known_fault(device, variant).filter(|f| tally.beyond <= f.beyond);
        let (verdict, fault) = match known {
            _ if tally.wrong == 0 && !coarse => (Verdict::Within, None),
            Some(fault) if !coarse => (Verdict::KnownFault, Some(fault.name)),
            _ => (Verdict::Outside, None),
        };
        let spec = &variant.spec;
        Row {
            variant: *variant,
            name: variant.label(),
            reader: variant.reader.name(),
            dimension: variant.dimension.name(),
            address: variant.addresses().iter().map(|a| a.name()).collect(),
            mag: spec.mag.name(),
            min: spec.min.name(),
            mip: spec.mip.name(),
            scale: variant.scale.name(),
            class: variant.class.name(),
            format: variant.format.name(),
            size: variant.size,
            max_anisotropy: (variant.scale == Scale::Anisotropic).then_some(spec.max_anisotropy),
            look_ups: tally.look_ups,
            wrong: tally.wrong,
            worst_error: tally.error,
            worst_beyond: tally.beyond,
            weights: tally.weights,
            level_weights: tally.level_weights,
            anisotropy: tally.anisotropy,
            verdict,
            fault,
            example: tally.example,
        }
    }
}

/// The device's declared sampler precision.
#[derive(Clone, Debug, Serialize)]
pub struct Limits {
    pub sub_texel_bits: u32,
    pub mip_bits: u32,
    pub max_anisotropy: f32,
    pub mirror_clamp_to_edge: bool,
    pub custom_border_color: bool,
}

#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Summary {
    pub variants: usize,
    pub look_ups: usize,
    pub within: usize,
    pub known_faults: usize,
    pub outside: usize,
    pub not_offered: usize,
}

#[derive(Clone, Debug, Serialize)]
pub struct ConformanceReport {
    pub device: String,
    pub driver: String,
    pub api_version: String,
    pub limits: Limits,
    pub summary: Summary,
    pub seconds: f64,
    pub rows: Vec<Row>,
    /// Variants that the device does not support: an optional address mode, or a format without
    /// linear filtering.
    pub not_offered: Vec<String>,
}

impl ConformanceReport {
    pub fn new(device: &DeviceInfo, rows: Vec<Row>, missing: &[Variant], seconds: f64) -> ConformanceReport {
        let limits = &device.limits;
        let count = |verdict| rows.iter().filter(|r| r.verdict == verdict).count();
        ConformanceReport {
            device: device.name.clone(),
            driver: device.driver.clone(),
            api_version: device.api_version.clone(),
            limits: Limits {
                sub_texel_bits: limits.sub_texel_bits,
                mip_bits: limits.mip_bits,
                max_anisotropy: limits.max_anisotropy,
                mirror_clamp_to_edge: limits.mirror_clamp_to_edge,
                custom_border_color: limits.custom_border_color,
            },
            summary: Summary {
                variants: rows.len(),
                look_ups: rows.iter().map(|r| r.look_ups).sum(),
                within: count(Verdict::Within),
                known_faults: count(Verdict::KnownFault),
                outside: count(Verdict::Outside),
                not_offered: missing.len(),
            },
            seconds,
            rows,
            not_offered: missing.iter().map(Variant::label).collect(),
        }
    }

    /// Returns true if no variant is out of bounds and, with `strict`, there is no known fault
    /// either.
    pub fn passes(&self, strict: bool) -> bool {
        self.summary.outside == 0 && (!strict || self.summary.known_faults == 0)
    }
}
