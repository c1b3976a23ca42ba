//! `moire devices`: lists the Vulkan devices of this machine, their capabilities, and the default
//! one.

use std::fmt::Write as _;
use std::process::ExitCode;

use serde::Serialize;

use crate::core::error::{Error, Result};
use crate::gpu::{DeviceInfo, DeviceSelect, list_devices};

/// List the Vulkan devices
#[derive(clap::Args, Clone, Debug)]
pub struct DevicesArgs {
    /// Print one JSON array instead of text
    #[arg(long)]
    pub json: bool,
}

pub fn run(args: &DevicesArgs) -> Result<ExitCode> {
    let devices = list_devices()?;
    let default = DeviceSelect::Default.choose(&devices).ok();
    let text = if args.json { json(&devices, default)? } else { listing(&devices, default) };
    super::print(text.trim_end())?;
    Ok(ExitCode::SUCCESS)
}

#[derive(Serialize)]
struct Row<'a> {
    default: bool,
    #[serde(flatten)]
    device: &'a DeviceInfo,
}

fn json(devices: &[DeviceInfo], default: Option<usize>) -> Result<String> {
    let rows: Vec<Row<'_>> =
        devices.iter().enumerate().map(|(i, device)| Row { default: default == Some(i), device }).collect();
    serde_json::to_string_pretty(&rows).map_err(|error| Error::new(format!("writing JSON: {error}")))
}

fn listing(devices: &[DeviceInfo], default: Option<usize>) -> String {
    let mut out = String::new();
    for (i, device) in devices.iter().enumerate() {
        let mark = if default == Some(i) { ", default" } else { "" };
        let _ = writeln!(out, "{}  {} ({}{mark})", device.index, device.name, device.kind);
        for (label, value) in facts(device) {
            let _ = writeln!(out, "     {label:<12} {value}");
        }
    }
    out
}

fn facts(device: &DeviceInfo) -> Vec<(&'static str, String)> {
    let limits = &device.limits;
    let mib = |bytes: u64| format!("{} MiB", bytes >> 20);
    let mut missing = Vec::new();
    if !limits.mirror_clamp_to_edge {
        missing.push("address mode mirror-clamp-to-edge");
    }
    if !limits.custom_border_color {
        missing.push("free border colors");
    }
    if limits.timestamp_valid_bits == 0 {
        missing.push("timestamps");
    }
    let usable = match &device.suitable {
        Ok(()) if missing.is_empty() => "yes".into(),
        Ok(()) => format!("yes; in hardware it has no {}", missing.join(", no ")),
        Err(reason) => format!("no: {reason}"),
    };
    vec![
        ("driver", format!("{}, Vulkan {}", device.driver, device.api_version)),
        (
            "filtering",
            format!(
                "{} sub-texel bits, {} mip bits, anisotropy {}",
                limits.sub_texel_bits, limits.mip_bits, limits.max_anisotropy
            ),
        ),
        (
            "images",
            format!(
                "{0}×{0} texels, {1} a shader",
                limits.max_image_2d,
                limits.max_samplers_per_stage.min(limits.max_sampled_images_per_stage)
            ),
        ),
        (
            "buffers",
            format!(
                "storage {}, {} texels",
                mib(limits.max_storage_buffer_range),
                limits.max_texel_buffer_elements
            ),
        ),
        ("memory", mib(limits.heap_bytes)),
        ("usable", usable),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::DeviceKind;

    fn device(suitable: std::result::Result<(), String>) -> DeviceInfo {
        DeviceInfo {
            index: 3,
            name: "Big RTX".into(),
            kind: DeviceKind::Discrete,
            driver: "driver 1".into(),
            api_version: "1.3.7".into(),
            uuid: None,
            limits: Default::default(),
            suitable,
        }
    }

    #[test]
    fn the_listing_marks_the_default_and_says_why_not() {
        let text = listing(&[device(Ok(())), device(Err("it has no compute queue".into()))], Some(0));
        assert!(text.contains("3  Big RTX (discrete, default)"), "{text}");
        assert!(text.contains("no: it has no compute queue"), "{text}");
        assert!(text.contains("no address mode mirror-clamp-to-edge"), "{text}");
    }

    #[test]
    fn json_is_one_array_with_reasons() {
        let text = json(&[device(Err("too old".into()))], None).unwrap();
        let value: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(value[0]["suitable"]["reason"], "too old");
        assert_eq!(value[0]["default"], false);
        assert_eq!(value[0]["kind"], "discrete");
    }
}
