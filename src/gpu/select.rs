//! Device selection: chooses one suitable device from the list for the user's request, or returns
//! an error that lists the devices. Pure functions.

use super::info::{DeviceInfo, DeviceKind};
use crate::core::error::{Error, ErrorKind, Result};

/// A device as requested by `--device`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DeviceSelect {
    /// The first discrete GPU, else integrated, else virtual, else a CPU.
    #[default]
    Default,
    /// The index in the listing.
    Index(usize),
    /// Part of the device's name, compared without regard to case.
    Name(String),
    /// Any driver that runs on the CPU.
    Cpu,
    /// Any GPU, also a virtual one.
    Gpu,
}

/// A word that selects devices.
struct Word {
    word: &'static str,
    select: DeviceSelect,
    admits: fn(DeviceKind) -> bool,
    /// Completes "no Vulkan device is".
    request: &'static str,
}

/// Every word that `--device` understands beside indices and names.
const WORDS: [Word; 2] = [
    Word {
        word: "cpu",
        select: DeviceSelect::Cpu,
        admits: |kind| matches!(kind, DeviceKind::Cpu),
        request: "a CPU driver (lavapipe is one: apt install mesa-vulkan-drivers)",
    },
    Word {
        word: "gpu",
        select: DeviceSelect::Gpu,
        admits: |kind| !matches!(kind, DeviceKind::Cpu | DeviceKind::Other),
        request: "a GPU",
    },
];

impl DeviceSelect {
    /// Parses `cpu`, `gpu`, an index, or else part of a name.
    pub fn parse(text: &str) -> Result<DeviceSelect> {
        let text = text.trim();
        if text.is_empty() {
            let words = WORDS.map(|w| format!("`{}`", w.word)).join(" or ");
            return Err(Error::new(format!(
                "a device is chosen by an index, a part of its name, {words}; found nothing"
            )));
        }
        let word = WORDS.into_iter().find(|w| text.eq_ignore_ascii_case(w.word));
        Ok(word.map_or_else(
            || text.parse().map_or_else(|_| DeviceSelect::Name(text.into()), DeviceSelect::Index),
            |word| word.select,
        ))
    }

    /// Returns the index in `devices` of the chosen device.
    pub fn choose(&self, devices: &[DeviceInfo]) -> Result<usize> {
        let candidates: Vec<usize> = (0..devices.len()).filter(|&i| self.admits(&devices[i])).collect();
        // The minimum is stable: among equals the first in the listing wins.
        let best = candidates
            .iter()
            .copied()
            .filter(|&i| devices[i].suitable.is_ok())
            .min_by_key(|&i| devices[i].kind);
        best.ok_or_else(|| self.refusal(devices, &candidates))
    }

    fn refusal(&self, devices: &[DeviceInfo], candidates: &[usize]) -> Error {
        let error = match candidates.first() {
            None => Error::with_help(format!("no Vulkan device is {}", self.request()), listing(devices)),
            Some(&first) => {
                let device = &devices[first];
                let reason = device.suitable.as_ref().err().map_or("", String::as_str);
                Error::with_help(
                    format!("Vulkan device {} ({}) cannot be used: {reason}", device.index, device.name),
                    listing(devices),
                )
            }
        };
        error.of_kind(ErrorKind::NoDevice)
    }

    fn word(&self) -> Option<Word> {
        WORDS.into_iter().find(|word| word.select == *self)
    }

    fn admits(&self, device: &DeviceInfo) -> bool {
        match self {
            DeviceSelect::Default => true,
            DeviceSelect::Index(index) => device.index == *index,
            DeviceSelect::Name(part) => device.name.to_lowercase().contains(&part.to_lowercase()),
            DeviceSelect::Cpu | DeviceSelect::Gpu => self.word().is_some_and(|w| (w.admits)(device.kind)),
        }
    }

    fn request(&self) -> String {
        match self {
            DeviceSelect::Default => "installed".into(),
            DeviceSelect::Index(index) => format!("at index {index}"),
            DeviceSelect::Name(part) => format!("named like `{part}`"),
            DeviceSelect::Cpu | DeviceSelect::Gpu => self.word().map_or("", |w| w.request).into(),
        }
    }
}

fn listing(devices: &[DeviceInfo]) -> String {
    let line = |d: &DeviceInfo| match &d.suitable {
        Ok(()) => format!("{} {} ({})", d.index, d.name, d.kind),
        Err(reason) => format!("{} {} ({}, not usable: {reason})", d.index, d.name, d.kind),
    };
    let lines: Vec<String> = devices.iter().map(line).collect();
    let words = WORDS.map(|word| word.word).join(", ");
    let listed = if lines.is_empty() { "none".into() } else { lines.join("; ") };
    format!("Devices here: {listed}. A device is an index, a part of a name, {words}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(index: usize, name: &str, kind: DeviceKind) -> DeviceInfo {
        DeviceInfo {
            index,
            name: name.into(),
            kind,
            driver: String::new(),
            api_version: "1.3.0".into(),
            uuid: None,
            limits: Default::default(),
            suitable: Ok(()),
        }
    }

    fn machine() -> Vec<DeviceInfo> {
        vec![
            device(0, "llvmpipe (LLVM 15.0.6, 256 bits)", DeviceKind::Cpu),
            device(1, "Some UHD Graphics", DeviceKind::Integrated),
            device(2, "Big RTX One", DeviceKind::Discrete),
            device(3, "Big RTX Two", DeviceKind::Discrete),
        ]
    }

    fn chosen(text: &str, devices: &[DeviceInfo]) -> usize {
        DeviceSelect::parse(text).unwrap().choose(devices).unwrap()
    }

    #[test]
    fn default_prefers_discrete_then_integrated_then_virtual_then_cpu() {
        let mut devices = machine();
        devices.insert(1, device(4, "cloud", DeviceKind::Virtual));
        for expected in
            ["Big RTX One", "Big RTX Two", "Some UHD Graphics", "cloud", "llvmpipe (LLVM 15.0.6, 256 bits)"]
        {
            let best = DeviceSelect::Default.choose(&devices).unwrap();
            assert_eq!(devices[best].name, expected);
            devices.remove(best);
        }
    }

    #[test]
    fn words_indices_and_parts_of_names_select() {
        let devices = machine();
        assert_eq!(chosen("cpu", &devices), 0);
        assert_eq!(chosen("GPU", &devices), 2);
        assert_eq!(chosen("3", &devices), 3);
        assert_eq!(chosen("rtx two", &devices), 3);
        assert_eq!(chosen("LLVMPIPE", &devices), 0);
    }

    #[test]
    fn unsuitable_devices_are_passed_over_unless_named() {
        let mut devices = machine();
        devices[2].suitable = Err("it has no compute queue".into());
        assert_eq!(DeviceSelect::Default.choose(&devices).unwrap(), 3);
        let error = DeviceSelect::Index(2).choose(&devices).unwrap_err().to_string();
        assert!(error.contains("Big RTX One") && error.contains("no compute queue"), "{error}");
    }

    #[test]
    fn a_wish_nobody_meets_lists_what_there_is() {
        let devices = machine();
        for text in ["7", "voodoo"] {
            let error = DeviceSelect::parse(text).unwrap().choose(&devices).unwrap_err();
            let Error::Plain { message, help: Some(help), kind: ErrorKind::NoDevice } = error else {
                panic!("no help for {text}")
            };
            assert!(message.contains(text), "{message}");
            assert!(help.contains("Some UHD Graphics"), "{help}");
        }
        let only_cpu = &machine()[..1];
        assert!(DeviceSelect::Gpu.choose(only_cpu).is_err());
        assert!(DeviceSelect::parse("  ").is_err());
    }
}
