//! What a render may be asked for beside its scene. In: nothing, or the options of a command line by their names. Out:
//! the changes of the scene, the device and the goal.

use crate::adaptive::Goal;
use crate::core::error::{Error, Result};
use crate::gpu::DeviceSelect;
use crate::pack::Crop;
use crate::scene::changes::Changes;
use crate::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind};
use crate::texture::sampler_spec::{Filter, MipMode};

/// The word that selects float64 on the CPU in place of a device.
const ORACLE: &str = "oracle";

/// Where and how scenes are rendered. What is not set is the scene's own.
///
/// ```
/// use moire::RenderOptions;
/// use moire::model::Pattern;
///
/// let options = RenderOptions::new().device("cpu").pattern(Pattern::SobolOwen).samples(64);
/// ```
#[derive(Clone, Debug, Default)]
pub struct RenderOptions {
    device: Option<String>,
    pub(super) changes: Changes,
    pub(super) crop: Option<Crop>,
    pub(super) goal: Option<Goal>,
    pub(super) allow_nonfinite: bool,
}

/// What renders.
pub(super) enum Place {
    Device(DeviceSelect),
    Oracle,
}

impl RenderOptions {
    /// Returns options that set nothing.
    pub fn new() -> RenderOptions {
        RenderOptions::default()
    }

    /// Selects a device: its index, a part of its name, `cpu` or `gpu`; or `oracle`, which is float64 on the CPU. By
    /// default the first discrete GPU, else an integrated one, else a CPU driver.
    pub fn device(mut self, select: impl Into<String>) -> Self {
        self.device = Some(select.into());
        self
    }

    /// Sets the picture's width and height in pixels.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.changes.size = Some([width, height]);
        self
    }

    /// Renders a part of the picture alone: the pixel of its top left corner, its width and height.
    pub fn crop(mut self, [x, y, width, height]: [u32; 4]) -> Self {
        self.crop = Some(Crop { x, y, width, height });
        self
    }

    /// Sets the samples a pixel.
    pub fn samples(mut self, samples: u32) -> Self {
        self.changes.spp = Some(samples);
        self
    }

    /// Sets where in a pixel its samples lie.
    pub fn pattern(mut self, pattern: Pattern) -> Self {
        self.changes.pattern = Some(pattern);
        self
    }

    /// Sets the seed of the samples.
    pub fn seed(mut self, seed: u32) -> Self {
        self.changes.seed = Some(seed);
        self
    }

    /// Sets how pixels are sampled, or that none are.
    pub fn algorithm(mut self, algorithm: Algorithm) -> Self {
        self.changes.algorithm = Some(algorithm);
        self
    }

    /// Sets the filter of every sampler.
    pub fn filter(mut self, filter: Filter) -> Self {
        self.changes.filter = Some(filter);
        self
    }

    /// Sets which levels every sampler reads.
    pub fn mip(mut self, mip: MipMode) -> Self {
        self.changes.mip = Some(mip);
        self
    }

    /// Sets over what a texture look-up is averaged.
    pub fn footprint(mut self, footprint: Footprint) -> Self {
        self.changes.footprint = Some(footprint);
        self
    }

    /// Sets the pixel filter.
    pub fn pixel_filter(mut self, filter: PixelFilterKind) -> Self {
        self.changes.pixel_filter = Some(filter);
        self
    }

    /// Renders for so many seconds and then stops, instead of at a number of samples.
    pub fn budget(mut self, seconds: f64) -> Self {
        self.goal = Some(Goal::Seconds(seconds));
        self
    }

    /// Renders until the picture's RMSE is estimated to be this, instead of to a number of samples.
    pub fn target_error(mut self, rmse: f64) -> Self {
        self.goal = Some(Goal::Error(rmse));
        self
    }

    /// Lets in textures with NaN and infinite texels, which are errors else.
    pub fn allow_nonfinite(mut self) -> Self {
        self.allow_nonfinite = true;
        self
    }

    pub(super) fn place(&self) -> Result<Place> {
        Ok(match self.device.as_deref() {
            None => Place::Device(DeviceSelect::Default),
            Some(ORACLE) => Place::Oracle,
            Some(text) => Place::Device(DeviceSelect::parse(text)?),
        })
    }

    /// What replaces the scene's own values.
    pub(super) fn changes(&self) -> Result<Changes> {
        let positive = match self.goal {
            Some(Goal::Seconds(x) | Goal::Error(x)) => x.is_finite() && x > 0.0,
            Some(Goal::Samples(_)) | None => true,
        };
        if !positive {
            return Err(Error::new("a budget and a target error are numbers above 0"));
        }
        Ok(Changes { has_goal: self.goal.is_some(), ..self.changes.clone() })
    }
}
