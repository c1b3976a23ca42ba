//! Choices that depend on the kind of device: where texels are read from, and the shape of a workgroup. Both can be
//! fixed for a measurement; neither changes the picture.

use super::{images, texel_buffer};
use crate::core::error::{Error, Result};
use crate::core::named::named_enum;
use crate::gpu::{DeviceInfo, DeviceKind, Gpu};
use crate::pack::{MAX_SLOTS, MipPlacement, PackedScene};
use crate::schema::layout::TILE;

named_enum! {
    /// Where look-ups of method shader read their texels.
    pub enum TexelChoice {
        Auto = "auto",
        Buffer = "buffer",
        Image = "image",
    }
}

named_enum! {
    /// Where box mip chains are generated.
    pub enum MipChoice {
        Auto = "auto",
        Host = "host",
        Device = "device",
    }
}

named_enum! {
    /// Where errors are estimated and samples distributed when sampling to a goal.
    pub enum EstimateChoice {
        Auto = "auto",
        Host = "host",
        Device = "device",
    }
}

/// Number of texels from which on the host takes longer for a mip chain than a driver for compiling its pipeline.
const LARGE: u64 = 1 << 20;

impl MipChoice {
    /// Returns where mip chains are generated. CPU devices run on the host's own cores. The buffers that mip chains
    /// pass through occupy a part of the device's memory of their own.
    pub fn mip_chains(self, device: &DeviceInfo) -> MipPlacement {
        let most_bytes = device.limits.max_storage_buffer_range.min(device.limits.heap_bytes / 8);
        match self {
            MipChoice::Auto if device.kind != DeviceKind::Cpu => {
                MipPlacement::Device { least_texels: LARGE, most_bytes }
            }
            MipChoice::Device => MipPlacement::Device { least_texels: 0, most_bytes },
            MipChoice::Auto | MipChoice::Host => MipPlacement::Host,
        }
    }
}

/// The device-dependent choices; the default leaves all of them to the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tuning {
    pub texels: TexelChoice,
    /// Width and height of a workgroup; `None` chooses by the device.
    pub group: Option<[u32; 2]>,
    pub estimates: EstimateChoice,
    /// Largest length of a texel buffer in words, if less than the device allows.
    pub texel_words: Option<u64>,
    /// Most samples of a pixel that an invocation takes at once, in place of what its loops allow.
    pub samples_at_once: Option<u32>,
}

impl Default for Tuning {
    fn default() -> Self {
        Tuning {
            texels: TexelChoice::Auto,
            group: None,
            estimates: EstimateChoice::Auto,
            texel_words: None,
            samples_at_once: None,
        }
    }
}

impl Tuning {
    /// Returns true if the device estimates errors itself. A CPU device has the host's own cores, which are faster without it.
    pub fn device_estimates(&self, device: &DeviceInfo) -> bool {
        match self.estimates {
            EstimateChoice::Auto => device.kind != DeviceKind::Cpu,
            EstimateChoice::Host => false,
            EstimateChoice::Device => true,
        }
    }

    /// Parses `64x1`: powers of two whose product is between 8 and 1024 and that divide a tile.
    pub fn parse_group(text: &str) -> Result<[u32; 2]> {
        let parsed = text.split_once('x').and_then(|(x, y)| Some([x.parse().ok()?, y.parse().ok()?]));
        let fits = |n: u32| n.is_power_of_two() && n <= TILE;
        match parsed {
            Some([x, y]) if fits(x) && fits(y) && (8..=1024).contains(&(x * y)) => Ok([x, y]),
            _ => Err(Error::new(format!(
                "workgroup \"{text}\": expected WIDTHxHEIGHT, powers of two up to {TILE} with a product of 8 to 1024, such as 64x1"
            ))),
        }
    }

    /// Returns true if texels are read from images. Only images serve the device's own samplers. Without those, GPUs
    /// read images fastest, and CPU drivers a buffer as long as a single one holds all texels; but descriptors are few
    /// and images have limits, whereas buffers hold any number of textures of any size.
    pub fn image_source(&self, gpu: &Gpu, scene: &PackedScene) -> bool {
        let one_buffer = scene.texels.len() as u64 / 4 <= self.texel_words(gpu);
        let buffer_first = gpu.info().kind == DeviceKind::Cpu && one_buffer;
        scene.uses_hardware_samplers()
            || match self.texels {
                TexelChoice::Auto => !buffer_first && images::hold(gpu, scene),
                TexelChoice::Buffer => false,
                TexelChoice::Image => scene.slots.len() <= MAX_SLOTS,
            }
    }

    /// Returns the largest length of a texel buffer in words.
    pub fn texel_words(&self, gpu: &Gpu) -> u64 {
        self.texel_words.unwrap_or(u64::MAX).min(texel_buffer::most_words(gpu))
    }

    /// Returns true if a table that threads read at scattered places is fastest in a uniform buffer: by 1.3 times on
    /// lavapipe, whereas a GPU takes 15 times as long.
    pub fn tables_in_head(device: &DeviceInfo) -> bool {
        device.kind == DeviceKind::Cpu
    }

    /// Returns true if the driver recompiles a shader at each submission when it finds conditions that depend on
    /// uniforms alone: lavapipe does, see `glsl/shared/opaque.glsl`.
    pub fn opaque_uniforms(device: &DeviceInfo) -> bool {
        device.kind == DeviceKind::Cpu
    }

    /// Returns true if a pixel's triangles are kept in registers: lavapipe reads memory lane by lane. GPUs keep them in
    /// shared memory, for workgroups that sample together; lavapipe (Mesa 22.3.6) loses samples there.
    pub fn holds_triangles(device: &DeviceInfo) -> bool {
        device.kind == DeviceKind::Cpu
    }

    /// Returns true if the driver ends all loops of a thread that together turn too often: Mesa's CPU driver does, see
    /// `glsl/shared/loops.glsl`.
    pub fn loops_end(device: &DeviceInfo) -> bool {
        device.kind == DeviceKind::Cpu
    }

    /// Returns width and height of a workgroup; fails if the device does not support that many invocations.
    pub fn group_size(&self, device: &DeviceInfo) -> Result<[u32; 2]> {
        let default = if device.kind == DeviceKind::Cpu { [64, 1] } else { [8, 8] };
        let [x, y] = self.group.unwrap_or(default);
        let most = device.limits.max_workgroup_invocations;
        if x * y > most {
            return Err(Error::new(format!(
                "workgroup {x}x{y}: {} threads, device \"{}\" takes at most {most}",
                x * y,
                device.name
            )));
        }
        Ok([x, y])
    }
}

/// Returns the number of workgroups that cover one tile.
pub fn groups_per_tile(group: [u32; 2]) -> u32 {
    (TILE / group[0]) * (TILE / group[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_workgroup_over_the_devices_threads_is_refused() {
        let mut device = DeviceInfo {
            index: 0,
            name: "small".into(),
            kind: DeviceKind::Integrated,
            driver: String::new(),
            api_version: "1.2.0".into(),
            uuid: None,
            limits: Default::default(),
            suitable: Ok(()),
        };
        device.limits.max_workgroup_invocations = 128;
        let tuning = |group| Tuning { group, ..Tuning::default() };
        assert_eq!(tuning(None).group_size(&device).unwrap(), [8, 8]);
        assert_eq!(tuning(Some([16, 8])).group_size(&device).unwrap(), [16, 8]);
        let error = tuning(Some([32, 8])).group_size(&device).unwrap_err().to_string();
        assert!(error.contains("32x8") && error.contains("128"), "{error}");
    }
}
