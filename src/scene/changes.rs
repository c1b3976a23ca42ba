//! Options that override values of a scene, checked by the same rules: those of the command line and of
//! `RenderOptions`. Input: a scene and the overrides. Output: the scene to render.

use super::cone;
use super::limits::{check_filters, check_shared, check_spp};
use super::model::{Algorithm, Footprint, Pattern, PixelFilter, PixelFilterKind, Precision, Sampling, Scene};
use crate::core::error::{Error, Result};
use crate::texture::sampler_spec::{Filter, LevelUse, Method};

/// The overrides of a scene; none by default.
#[derive(Clone, Debug, Default)]
pub struct Changes {
    pub size: Option<[u32; 2]>,
    pub spp: Option<u32>,
    pub algorithm: Option<Algorithm>,
    /// True if sampling ends at a goal, a time or an error, instead of a number.
    pub has_goal: bool,
    pub pattern: Option<Pattern>,
    pub seed: Option<u32>,
    /// Applies to every sampler, like the filter and the levels.
    pub method: Option<Method>,
    pub filter: Option<Filter>,
    pub mip: Option<LevelUse>,
    pub footprint: Option<Footprint>,
    pub precision: Option<Precision>,
    pub pixel_filter: Option<PixelFilterKind>,
    pub pixel_filter_radius: Option<f64>,
    pub shared: Option<bool>,
}

impl Changes {
    /// Applies the overrides; returns a note on settings that were chosen automatically.
    pub fn apply(&self, scene: &mut Scene) -> Result<Option<&'static str>> {
        if let Some([width, height]) = self.size {
            (scene.width, scene.height) = (width, height);
        }
        if let Some(kind) = self.pixel_filter {
            scene.pixel_filter = PixelFilter::new(kind, None);
        }
        scene.pixel_filter.radius = self.pixel_filter_radius.unwrap_or(scene.pixel_filter.radius);
        let sampling = &mut scene.sampling;
        sampling.spp = self.spp.unwrap_or(sampling.spp);
        let wanted = if self.has_goal { Algorithm::Auto } else { sampling.algorithm };
        sampling.algorithm = self.algorithm.unwrap_or(wanted);
        // The pattern with the smallest error among those that may stop at any sample.
        let wanted =
            if sampling.algorithm == Algorithm::Auto { Pattern::SobolOwen } else { sampling.pattern };
        sampling.pattern = self.pattern.unwrap_or(wanted);
        sampling.seed = self.seed.unwrap_or(sampling.seed);
        // A prefilter's bias does not fall with the number of samples as noise does.
        let free = if sampling.algorithm == Algorithm::Auto { Footprint::None } else { sampling.footprint };
        sampling.footprint = self.footprint.unwrap_or(free);
        sampling.shared = self.shared.unwrap_or(sampling.shared);
        sampling.precision = self.precision.unwrap_or(sampling.precision);
        self.adapt_for_adaptive(sampling)?;
        check_shared(sampling.pattern, sampling.shared).map_err(Error::new)?;
        check_spp(sampling.pattern, sampling.spp).map_err(|m| Error::new(format!("--spp: {m}")))?;
        for sampler in &mut scene.samplers {
            if let Some(levels) = self.mip {
                (sampler.mip, sampler.stored_levels) = levels.parts();
            }
            sampler.method = self.method.unwrap_or(sampler.method);
            if let Some(filter) = self.filter {
                (sampler.mag, sampler.min) = filter.both();
            }
        }
        // A pattern named on the command line is intended.
        let free = self.filter.is_none() && self.mip.is_none();
        let chosen = if free { cone::adapt_for_cone(scene) } else { None };
        cone::adapt_footprint(scene);
        check_filters(scene)?;
        Ok(chosen)
    }

    /// Selects a pattern that may stop at any sample, which sampling rates that differ from pixel to pixel need.
    fn adapt_for_adaptive(&self, sampling: &mut Sampling) -> Result<()> {
        if !sampling.algorithm.is_adaptive() {
            if self.has_goal {
                let fixed = match sampling.algorithm {
                    Algorithm::Cone => "\"cone\" takes none",
                    _ => "\"samples\" takes a number of samples (spp)",
                };
                return Err(Error::with_help(
                    format!(
                        "a budget or a target error needs an algorithm that may choose its samples; {fixed}"
                    ),
                    "leave the algorithm away, or use algorithm \"adaptive\"",
                ));
            }
            return Ok(());
        }
        if sampling.pattern.stops_anywhere() {
            return Ok(());
        }
        if let Some(pattern) = self.pattern {
            let able: Vec<&str> =
                Pattern::ALL.iter().filter(|p| p.stops_anywhere()).map(|p| p.name()).collect();
            return Err(Error::new(format!(
                "algorithm \"{}\" stops each pixel at another count, which pattern \"{pattern}\" cannot; use one of {}",
                sampling.algorithm,
                able.join(", ")
            )));
        }
        sampling.pattern = Pattern::SobolOwen;
        Ok(())
    }
}
