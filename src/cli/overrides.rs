//! Command line options that override values of the scene file, validated by the same rules.

use std::path::Path;

use clap::{Args, Command as CommandLine};
use serde_json::{Value, json};

use crate::core::error::{Error, Result};
use crate::core::range::Rect;
use crate::integrators::adaptive::Goal;
use crate::scene::changes::Changes;
use crate::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Precision, Scene};
use crate::scene::{MAX_RADIUS, Reading, Setting};
use crate::texture::sampler_spec::{Filter, LevelUse, Method};

use super::quantity::{positive, samples, seconds, seed};
use super::{DEVICE, GOAL, PIXELS, SAMPLING, TEXTURES, VIEW, named_parser};

#[derive(Args, Clone, Debug)]
pub struct Overrides {
    /// Camera of a glTF file: number from 0, or name [default: the first]
    #[arg(long, value_name = "N", allow_negative_numbers = true, help_heading = VIEW)]
    camera: Option<String>,
    /// Replace a value of the scene, such as camera.eye=[0,1,4]
    ///
    /// Any key of the scene format, as SECTION.KEY=VALUE or SECTION.ITEM.KEY=VALUE, such as sampler.ground.filter=ewa;
    /// ITEM is a name, a number from 0, or * for all. May be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = str::parse::<Setting>, help_heading = VIEW)]
    set: Vec<Setting>,
    /// Picture size in pixels, such as 640x480
    #[arg(long, value_name = "WxH", value_parser = parse_size, help_heading = VIEW)]
    size: Option<[u32; 2]>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true, help_heading = SAMPLING)]
    spp: Option<u32>,
    /// Algorithm
    ///
    /// samples: the same number in each pixel; adaptive: more where they are needed; beam, cone: one a pixel, without
    /// samples; auto: of these what suits the goal.
    #[arg(long, value_name = "A", value_parser = named_parser(Algorithm::NAMES, Algorithm::from_name), help_heading = SAMPLING)]
    algorithm: Option<Algorithm>,
    /// Render the best picture of this time, such as 50ms or 2s
    ///
    /// A number alone is seconds. With --algorithm auto unless another is named.
    #[arg(long, value_name = "TIME", value_parser = seconds, conflicts_with = "target_error", help_heading = GOAL)]
    budget: Option<f64>,
    /// Render until the RMSE is estimated to be this
    #[arg(long, value_name = "RMSE", value_parser = positive, help_heading = GOAL)]
    target_error: Option<f64>,
    /// Pattern
    ///
    /// Where the samples of a pixel lie. `moire pattern NAME -o points.png` shows one.
    #[arg(long, value_name = "P", value_parser = named_parser(Pattern::NAMES, Pattern::from_name), help_heading = SAMPLING)]
    pattern: Option<Pattern>,
    /// Another set of random positions
    #[arg(long, value_name = "N", value_parser = seed, allow_negative_numbers = true, help_heading = SAMPLING)]
    seed: Option<u32>,
    /// Who filters, for all samplers
    ///
    /// The shader's own look-up, or the texture unit of the device.
    #[arg(long, value_name = "M", value_parser = named_parser(Method::NAMES, Method::from_name), help_heading = TEXTURES)]
    method: Option<Method>,
    /// Filter
    ///
    /// Of all samplers, in place of those of the scene.
    #[arg(long, value_name = "F", value_parser = named_parser(Filter::NAMES, Filter::from_name), help_heading = TEXTURES)]
    filter: Option<Filter>,
    /// Area that each look-up averages
    #[arg(long, value_name = "F", value_parser = named_parser(Footprint::NAMES, Footprint::from_name), help_heading = TEXTURES)]
    footprint: Option<Footprint>,
    /// Precision of geometry
    #[arg(long, value_name = "P", value_parser = named_parser(Precision::NAMES, Precision::from_name), help_heading = DEVICE)]
    precision: Option<Precision>,
    /// How levels are read
    ///
    /// Of all samplers. With --filter linear, --mip linear is trilinear.
    #[arg(long, value_name = "M", value_parser = named_parser(LevelUse::NAMES, LevelUse::from_name), help_heading = TEXTURES)]
    mip: Option<LevelUse>,
    /// Filter
    ///
    /// Weights of the samples around a pixel (reconstruction filter).
    #[arg(long, value_name = "NAME", value_parser = named_parser(PixelFilterKind::NAMES, PixelFilterKind::from_name), help_heading = PIXELS)]
    pixel_filter: Option<PixelFilterKind>,
    /// Its radius in pixels [default: by filter]
    #[arg(long, value_name = "R", value_parser = radius, allow_negative_numbers = true, help_heading = PIXELS)]
    pixel_filter_radius: Option<f64>,
    /// All pixels share their displacements
    #[arg(long, value_name = "BOOL", value_parser = named_parser(&["true", "false"], |word| word.parse::<bool>().ok()), help_heading = SAMPLING)]
    shared: Option<bool>,
}

impl Overrides {
    /// Reads the scene of a file, seen by the chosen camera. `keeps_meshes`: the layer `instance` numbers them.
    pub fn load(&self, path: &Path, keeps_meshes: bool) -> Result<Scene> {
        crate::scene::load_as(path, &self.reading(keeps_meshes)).map_err(|error| self.with_option(error))
    }

    /// Returns an error with the option that does what a setting without a section was to do, such as `filter=ewa`.
    pub fn with_option(&self, error: Error) -> Error {
        let Error::Scene { source_code, help: None, .. } = &error else { return error };
        let setting = self.set.iter().find(|setting| setting.text() == source_code.inner());
        let Some((name, value)) = setting.and_then(|setting| setting.text().split_once('=')) else {
            return error;
        };
        let name = name.trim().replace('_', "-");
        let command = Overrides::augment_args(CommandLine::new("moire"));
        let is_option = command.get_arguments().any(|arg| arg.get_long() == Some(name.as_str()));
        let help = is_option.then(|| format!("--{name} {} is an option of its own", value.trim()));
        error.and_help(help)
    }

    /// Returns how the scene is read: seen by the chosen camera, with the settings.
    pub fn reading(&self, keeps_meshes: bool) -> Reading<'_> {
        Reading { camera: self.camera.as_deref(), keeps_meshes, settings: &self.set }
    }

    /// Applies the options to the scene and returns a description of settings that were chosen
    /// implicitly.
    pub fn apply(&self, scene: &mut Scene) -> Result<Option<&'static str>> {
        let changes = Changes {
            size: self.size,
            spp: self.spp,
            algorithm: self.algorithm,
            has_goal: self.goal().is_some(),
            pattern: self.pattern,
            seed: self.seed,
            method: self.method,
            filter: self.filter,
            mip: self.mip,
            footprint: self.footprint,
            precision: self.precision,
            pixel_filter: self.pixel_filter,
            pixel_filter_radius: self.pixel_filter_radius,
            shared: self.shared,
        };
        changes.apply(scene)
    }

    /// Returns the camera, if one was named.
    pub fn camera(&self) -> Option<String> {
        self.camera.clone()
    }

    /// Returns what replaces values of the scene, as it was written.
    pub fn settings(&self) -> Vec<String> {
        self.set.iter().map(|setting| setting.text().to_owned()).collect()
    }

    /// Returns the other options that were given and change the scene, by name, with their values.
    pub fn options(&self) -> impl Iterator<Item = (String, String)> {
        const OTHERS: [&str; 4] = ["camera", "set", "budget", "target-error"];
        let given = self.given().into_iter().filter(|(name, _)| !OTHERS.contains(name));
        given.map(|(name, value)| (name.to_owned(), value))
    }

    /// Returns the options that were given, with their values as words.
    pub fn given(&self) -> Vec<(&'static str, String)> {
        let word = |name: Option<&str>| name.map(str::to_owned);
        let options = [
            ("camera", self.camera.clone()),
            ("size", self.size.map(|[width, height]| format!("{width}x{height}"))),
            ("pixel-filter", word(self.pixel_filter.map(PixelFilterKind::name))),
            ("pixel-filter-radius", self.pixel_filter_radius.map(|radius| radius.to_string())),
            ("spp", self.spp.map(|spp| spp.to_string())),
            ("algorithm", word(self.algorithm.map(Algorithm::name))),
            ("budget", self.budget.map(|seconds| format!("{seconds}s"))),
            ("target-error", self.target_error.map(|rmse| rmse.to_string())),
            ("pattern", word(self.pattern.map(Pattern::name))),
            ("seed", self.seed.map(|seed| seed.to_string())),
            ("method", word(self.method.map(Method::name))),
            ("filter", word(self.filter.map(Filter::name))),
            ("mip", word(self.mip.map(LevelUse::name))),
            ("footprint", word(self.footprint.map(Footprint::name))),
            ("precision", word(self.precision.map(Precision::name))),
            ("shared", self.shared.map(|shared| shared.to_string())),
        ];
        let options = options.into_iter().filter_map(|(name, value)| Some((name, value?)));
        options.chain(self.set.iter().map(|setting| ("set", setting.text().to_owned()))).collect()
    }

    /// Returns those of the options that choose what is seen, and how samples become pixels.
    pub fn view(&self) -> Vec<String> {
        const VIEW: [&str; 5] = ["camera", "size", "pixel-filter", "pixel-filter-radius", "set"];
        let given = self.given().into_iter().filter(|(name, _)| VIEW.contains(name));
        given.flat_map(|(name, value)| [format!("--{name}"), value]).collect()
    }

    /// Returns these options, and those of `base` that they do not state.
    pub fn over(self, base: &Overrides) -> Overrides {
        let has_goal = self.goal().is_some();
        Overrides {
            camera: self.camera.or_else(|| base.camera.clone()),
            set: [base.set.clone(), self.set].concat(),
            size: self.size.or(base.size),
            spp: self.spp.or(base.spp),
            algorithm: self.algorithm.or(base.algorithm),
            // One goal replaces the other.
            budget: self.budget.or(base.budget.filter(|_| !has_goal)),
            target_error: self.target_error.or(base.target_error.filter(|_| !has_goal)),
            pattern: self.pattern.or(base.pattern),
            seed: self.seed.or(base.seed),
            method: self.method.or(base.method),
            filter: self.filter.or(base.filter),
            footprint: self.footprint.or(base.footprint),
            precision: self.precision.or(base.precision),
            mip: self.mip.or(base.mip),
            pixel_filter: self.pixel_filter.or(base.pixel_filter),
            pixel_filter_radius: self.pixel_filter_radius.or(base.pixel_filter_radius),
            shared: self.shared.or(base.shared),
        }
    }

    /// Returns the options that show the same by samples without a prefilter, with the textures' filters of `base`.
    pub fn as_reference(&self, base: &Overrides, spp: u32) -> Overrides {
        Overrides {
            spp: Some(spp),
            algorithm: Some(Algorithm::Samples),
            budget: None,
            target_error: None,
            pattern: Some(Pattern::SobolOwen),
            seed: base.seed,
            method: Some(Method::Shader),
            filter: base.filter,
            footprint: Some(Footprint::None),
            precision: base.precision,
            mip: base.mip,
            shared: Some(false),
            ..self.clone()
        }
    }

    /// Returns the goal that ends the sampling, unless that is a number of samples.
    pub fn goal(&self) -> Option<Goal> {
        self.budget.map(Goal::Seconds).or(self.target_error.map(Goal::Error))
    }

    /// Returns a warning if a number of samples was named that has no effect.
    pub fn idle_spp(&self) -> Option<&'static str> {
        let is_idle = self.spp.is_some() && self.goal().is_some();
        is_idle.then_some("--spp has no effect with --budget or --target-error, which choose the samples")
    }

    /// Returns the settings that the render used, overridden or not.
    pub fn report(&self, scene: &Scene, crop: Option<Rect>, keep_everything: bool) -> Value {
        let s = &scene.sampling;
        let methods: Vec<&str> = scene.samplers.iter().map(|x| x.method.name()).collect();
        json!({
            "scene": scene.path.display().to_string(),
            "camera": self.camera,
            "set": self.set.iter().map(Setting::text).collect::<Vec<_>>(),
            "size": [scene.width, scene.height],
            "crop": crop.map(|c| [c.x, c.y, c.width, c.height]),
            "pixel_filter": scene.pixel_filter.kind.name(),
            "pixel_filter_radius": scene.pixel_filter.radius,
            "algorithm": s.algorithm.name(),
            "pattern": s.pattern.name(),
            "spp": self.goal().is_none().then_some(s.spp),
            "budget": self.budget,
            "target_error": self.target_error,
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
