//! Command line options that override values of the scene file, validated by the same rules.

use clap::Args;
use serde_json::{Value, json};

use crate::core::error::{Error, Result};
use crate::core::range::Rect;
use crate::integrators::adaptive::Goal;
use crate::scene::cone;
use crate::scene::model::{
    Algorithm, Footprint, Pattern, PixelFilter, PixelFilterKind, Precision, Sampling, Scene,
};
use crate::scene::{MAX_RADIUS, both_filters, check_filters, check_shared, check_spp};
use crate::texture::sampler_spec::{Filter, Method, MipMode};

use super::{DEVICE, OUTPUT, SAMPLING, TEXTURES, named_parser};

#[derive(Args, Debug)]
pub struct Overrides {
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size, help_heading = OUTPUT)]
    size: Option<[u32; 2]>,
    /// Samples per pixel
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = SAMPLING)]
    spp: Option<u32>,
    /// Algorithm
    #[arg(long, value_name = "A", value_parser = named_parser(Algorithm::NAMES, Algorithm::from_name), help_heading = SAMPLING)]
    algorithm: Option<Algorithm>,
    /// Render for this long and then stop, with --algorithm auto unless another is named
    #[arg(long, value_name = "SECONDS", value_parser = positive, conflicts_with = "target_error", help_heading = SAMPLING)]
    budget: Option<f64>,
    /// Render until the picture's RMSE is estimated to be this
    #[arg(long, value_name = "RMSE", value_parser = positive, help_heading = SAMPLING)]
    target_error: Option<f64>,
    /// Sampling pattern
    #[arg(long, value_name = "P", value_parser = named_parser(Pattern::NAMES, Pattern::from_name), help_heading = SAMPLING)]
    pattern: Option<Pattern>,
    /// Seed of the sampling pattern
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = SAMPLING)]
    seed: Option<u32>,
    /// Look-up method of every sampler
    #[arg(long, value_name = "M", value_parser = named_parser(Method::NAMES, Method::from_name), help_heading = TEXTURES)]
    method: Option<Method>,
    /// Filter of every sampler
    #[arg(long, value_name = "F", value_parser = named_parser(Filter::NAMES, Filter::from_name), help_heading = TEXTURES)]
    filter: Option<Filter>,
    /// Footprint of a sample
    #[arg(long, value_name = "F", value_parser = named_parser(Footprint::NAMES, Footprint::from_name), help_heading = TEXTURES)]
    footprint: Option<Footprint>,
    /// Numbers of geometry
    #[arg(long, value_name = "P", value_parser = named_parser(Precision::NAMES, Precision::from_name), help_heading = DEVICE)]
    precision: Option<Precision>,
    /// Levels that every sampler reads
    #[arg(long, value_name = "M", value_parser = named_parser(MipMode::NAMES, MipMode::from_name), help_heading = TEXTURES)]
    mip: Option<MipMode>,
    /// Pixel filter
    #[arg(long, value_name = "NAME", value_parser = named_parser(PixelFilterKind::NAMES, PixelFilterKind::from_name), help_heading = SAMPLING)]
    pixel_filter: Option<PixelFilterKind>,
    /// Pixels that the pixel filter reaches to each side [default: by filter]
    #[arg(long, value_name = "R", value_parser = radius, allow_negative_numbers = true, help_heading = SAMPLING)]
    pixel_filter_radius: Option<f64>,
    /// Whether all pixels share their displacements
    #[arg(long, value_name = "BOOL", help_heading = SAMPLING)]
    shared: Option<bool>,
}

impl Overrides {
    /// Applies the options to the scene and returns a description of settings that were chosen
    /// implicitly.
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
        let wanted = if self.goal().is_some() { Algorithm::Auto } else { sampling.algorithm };
        sampling.algorithm = self.algorithm.unwrap_or(wanted);
        // The algorithm with the smallest error among those that can stop at any sample.
        let wanted =
            if sampling.algorithm == Algorithm::Auto { Pattern::SobolOwen } else { sampling.pattern };
        sampling.pattern = self.pattern.unwrap_or(wanted);
        sampling.seed = self.seed.unwrap_or(sampling.seed);
        // The bias of a prefilter does not decrease with the samples as noise does.
        let free = if sampling.algorithm == Algorithm::Auto { Footprint::None } else { sampling.footprint };
        sampling.footprint = self.footprint.unwrap_or(free);
        sampling.shared = self.shared.unwrap_or(sampling.shared);
        sampling.precision = self.precision.unwrap_or(sampling.precision);
        self.adapt_for_adaptive(sampling)?;
        check_shared(sampling.pattern, sampling.shared).map_err(Error::new)?;
        check_spp(sampling.pattern, sampling.spp).map_err(|m| Error::new(format!("--spp: {m}")))?;
        for sampler in &mut scene.samplers {
            sampler.mip = self.mip.unwrap_or(sampler.mip);
            sampler.method = self.method.unwrap_or(sampler.method);
            if let Some(filter) = self.filter {
                (sampler.mag, sampler.min) = both_filters(filter);
            }
        }
        // Explicit options of the command line take precedence.
        let free = self.filter.is_none() && self.mip.is_none();
        let chosen = if free { cone::adapt_for_cone(scene) } else { None };
        cone::adapt_footprint(scene);
        check_filters(scene)?;
        Ok(chosen)
    }

    /// Returns the goal that ends the sampling, unless that is a number of samples.
    pub fn goal(&self) -> Option<Goal> {
        self.budget.map(Goal::Seconds).or(self.target_error.map(Goal::Error))
    }

    /// Adapts the pattern: sampling that differs from pixel to pixel needs a sequence that can be
    /// truncated anywhere.
    fn adapt_for_adaptive(&self, sampling: &mut Sampling) -> Result<()> {
        if !sampling.algorithm.is_adaptive() {
            if self.goal().is_some() {
                let fixed = match sampling.algorithm {
                    Algorithm::Cone => "\"cone\" takes none",
                    _ => "\"samples\" takes --spp",
                };
                return Err(Error::with_help(
                    format!(
                        "--budget and --target-error need an algorithm that may choose its samples; {fixed}"
                    ),
                    "leave --algorithm away, or use --algorithm adaptive",
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
                "--pattern {pattern}: algorithm \"{}\" stops each pixel at another count, which pattern \"{pattern}\" cannot; use one of {}",
                sampling.algorithm,
                able.join(", ")
            )));
        }
        sampling.pattern = Pattern::SobolOwen;
        Ok(())
    }

    /// Returns the settings that the render used, overridden or not.
    pub fn report(&self, scene: &Scene, crop: Option<Rect>, keep_everything: bool) -> Value {
        let s = &scene.sampling;
        let methods: Vec<&str> = scene.samplers.iter().map(|x| x.method.name()).collect();
        json!({
            "scene": scene.path.display().to_string(),
            "size": [scene.width, scene.height],
            "crop": crop.map(|c| [c.x, c.y, c.width, c.height]),
            "pixel_filter": scene.pixel_filter.kind.name(),
            "pixel_filter_radius": scene.pixel_filter.radius,
            "algorithm": s.algorithm.name(),
            "pattern": s.pattern.name(),
            "spp": s.spp,
            "shared": s.shared,
            "seed": s.seed,
            "max_depth": s.max_depth,
            "footprint": s.footprint.name(),
            "precision": s.precision.name(),
            "methods": methods,
            "keep_everything": keep_everything,
        })
    }
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if f64::is_finite(value) && value > 0.0 => Ok(value),
        _ => Err("expected a number above 0".into()),
    }
}

fn radius(text: &str) -> Result<f64, String> {
    let value = positive(text).ok().filter(|value| (1e-30..=MAX_RADIUS).contains(value));
    value.ok_or_else(|| format!("expected a number above 0 and at most {MAX_RADIUS} (pixels)"))
}

pub(super) fn parse_size(text: &str) -> Result<[u32; 2], String> {
    let limit = crate::scene::MAX_SIZE;
    let parsed = text.split_once(['x', '×']).and_then(|(w, h)| Some([w.parse().ok()?, h.parse().ok()?]));
    match parsed {
        Some([w, h]) if (1..=limit).contains(&w) && (1..=limit).contains(&h) => Ok([w, h]),
        _ => Err(format!("expected WIDTHxHEIGHT, each from 1 to {limit}, such as 512x512")),
    }
}
