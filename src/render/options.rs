//! What a caller chooses for a render that is not part of the scene: the backends that take the samples, the part of the
//! picture, and how a device is used.

use super::{MipChoice, Tuning};
use crate::core::error::Result;
use crate::core::range::Rect;
use crate::gpu::DeviceSelect;
use crate::integrators::adaptive::Goal;

/// A backend that takes samples.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum On {
    Device(DeviceSelect),
    /// The float64 renderer on the CPU.
    Oracle,
}

impl On {
    /// Parses `oracle`, or the syntax of [`DeviceSelect::parse`].
    pub fn parse(text: &str) -> Result<On> {
        if text == "oracle" { Ok(On::Oracle) } else { DeviceSelect::parse(text).map(On::Device) }
    }
}

/// Rendering options that are not part of the scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// The part of the picture that is rendered; `None` is the whole.
    pub crop: Option<Rect>,
    /// The end of adaptive sampling; `None` is the scene's number of samples.
    pub goal: Option<Goal>,
    /// Tells the samples and errors of single pixels, of adaptive sampling.
    pub tells_pixels: bool,
    /// Accepts textures with NaN and infinite texels.
    pub allow_nonfinite: bool,
    /// Keeps all features in the pipelines.
    pub keep_everything: bool,
    /// Counts on the device how often limits are exceeded.
    pub diagnosed: bool,
    pub mips: MipChoice,
    pub tuning: Tuning,
}

impl Default for Options {
    /// Renders the whole picture with the choices that measure best.
    fn default() -> Options {
        Options {
            crop: None,
            goal: None,
            tells_pixels: true,
            allow_nonfinite: false,
            keep_everything: false,
            diagnosed: false,
            mips: MipChoice::Auto,
            tuning: Tuning::default(),
        }
    }
}
