//! The options of a render beside its scene. Input: nothing, or the options of a command line by their names. Output:
//! the overrides of the scene, the devices and the goal.

use crate::core::error::{Error, Result};
use crate::core::range::Rect;
use crate::gpu::DeviceSelect;
use crate::integrators::adaptive::Goal;
use crate::render::{On, Options};
use crate::scene::changes::Changes;
use crate::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind};
use crate::texture::sampler_spec::{Filter, MipMode};

/// The devices and settings with which scenes are rendered. Settings that are not given are the scene's own.
///
/// ```
/// use moire::RenderOptions;
/// use moire::model::Pattern;
///
/// let options = RenderOptions::new().device("cpu").pattern(Pattern::SobolOwen).samples(64);
/// ```
#[derive(Clone, Debug)]
pub struct RenderOptions {
    devices: Vec<String>,
    changes: Changes,
    pub(super) with: Options,
}

impl Default for RenderOptions {
    fn default() -> Self {
        RenderOptions::new()
    }
}

impl RenderOptions {
    /// Returns options that override nothing.
    // rustc 1.95 compiles callers wrongly that see these values: after options were passed to a function by value, the
    // next ones, in the same place, are taken for set although the function has changed them.
    #[inline(never)]
    pub fn new() -> RenderOptions {
        RenderOptions { devices: Vec::new(), changes: Changes::default(), with: Options::default() }
    }

    /// Adds a device for rendering: by its index, a part of its name, `cpu` or `gpu`; or `oracle`, which is float64 on
    /// the CPU. Several are assigned strips of the picture in turn. The default is the first discrete GPU, otherwise an
    /// integrated one, otherwise a CPU driver.
    pub fn device(mut self, select: impl Into<String>) -> Self {
        self.devices.push(select.into());
        self
    }

    /// Sets the picture's width and height in pixels.
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.changes.size = Some([width, height]);
        self
    }

    /// Renders a part of the picture only: the pixel of its top left corner, its width and height.
    pub fn crop(mut self, [x, y, width, height]: [u32; 4]) -> Self {
        self.with.crop = Some(Rect { x, y, width, height });
        self
    }

    /// Sets the samples per pixel.
    pub fn samples(mut self, samples: u32) -> Self {
        self.changes.spp = Some(samples);
        self
    }

    /// Sets the sample pattern within a pixel.
    pub fn pattern(mut self, pattern: Pattern) -> Self {
        self.changes.pattern = Some(pattern);
        self
    }

    /// Sets the seed of the samples.
    pub fn seed(mut self, seed: u32) -> Self {
        self.changes.seed = Some(seed);
        self
    }

    /// Sets the rendering algorithm.
    pub fn algorithm(mut self, algorithm: Algorithm) -> Self {
        self.changes.algorithm = Some(algorithm);
        self
    }

    /// Sets the filter of every sampler.
    pub fn filter(mut self, filter: Filter) -> Self {
        self.changes.filter = Some(filter);
        self
    }

    /// Sets the mip mode of every sampler.
    pub fn mip(mut self, mip: MipMode) -> Self {
        self.changes.mip = Some(mip.into());
        self
    }

    /// Sets the footprint over which texture look-ups are averaged.
    pub fn footprint(mut self, footprint: Footprint) -> Self {
        self.changes.footprint = Some(footprint);
        self
    }

    /// Sets the pixel filter.
    pub fn pixel_filter(mut self, filter: PixelFilterKind) -> Self {
        self.changes.pixel_filter = Some(filter);
        self
    }

    /// Renders for this number of seconds and then stops, instead of at a number of samples.
    pub fn budget(mut self, seconds: f64) -> Self {
        self.with.goal = Some(Goal::Seconds(seconds));
        self
    }

    /// Renders until the picture's RMSE is estimated to be this, instead of to a number of samples.
    pub fn target_error(mut self, rmse: f64) -> Self {
        self.with.goal = Some(Goal::Error(rmse));
        self
    }

    /// Accepts textures with NaN and infinite texels, which are otherwise errors.
    pub fn allow_nonfinite(mut self) -> Self {
        self.with.allow_nonfinite = true;
        self
    }

    /// Returns the devices.
    pub(super) fn on(&self) -> Result<Vec<On>> {
        if self.devices.is_empty() {
            return Ok(vec![On::Device(DeviceSelect::Default)]);
        }
        self.devices.iter().map(|text| On::parse(text)).collect()
    }

    /// Returns the overrides of the scene.
    pub(super) fn changes(&self) -> Result<Changes> {
        let positive = match self.with.goal {
            Some(Goal::Seconds(x) | Goal::Error(x)) => x.is_finite() && x > 0.0,
            Some(Goal::Samples(_)) | None => true,
        };
        if !positive {
            return Err(Error::new("a budget and a target error are numbers above 0"));
        }
        Ok(Changes { has_goal: self.with.goal.is_some(), ..self.changes.clone() })
    }
}
