//! The options of a render. In: a dictionary by the names of the program's options, with `_` for `-`. Out: a scene as they
//! change it, without what it has no use for, the options beside it, and both as words of a command line.

use std::fmt::Display;

use moire::internal::cli::quantity;
use moire::internal::core::range::Rect;
use moire::internal::integrators::adaptive::Goal;
use moire::internal::render::Options;
use moire::internal::scene::changes::Changes;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Precision, Scene};
use moire::internal::scene::prune::prune;
use moire::internal::scene::{MAX_RADIUS, MAX_SIZE, suggestion};
use moire::internal::texture::sampler_spec::{Filter, LevelUse, Method};
use moire::{Error, Result};
use pyo3::conversion::FromPyObjectOwned;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::exception;

/// Options that were read, and errors about them.
pub struct Given<'a, 'py>(pub &'a Bound<'py, PyDict>);

impl<'py> Given<'_, 'py> {
    /// Returns a value, nothing if it is missing or `None`.
    pub fn value<T: FromPyObjectOwned<'py>>(&self, key: &str, what: &str) -> PyResult<Option<T>> {
        let Some(value) = self.0.get_item(key)?.filter(|value| !value.is_none()) else { return Ok(None) };
        let wrong = || {
            format!("{key}: expected {what}, found {}", value.repr().map_or("?".into(), |r| r.to_string()))
        };
        value.extract().map(Some).map_err(|_| exception(self.0.py(), &Error::new(wrong())))
    }

    /// Returns the value of a vocabulary, of which `names` are all.
    pub fn named<T>(
        &self,
        key: &str,
        names: &[&'static str],
        from_name: impl Fn(&str) -> Option<T>,
    ) -> PyResult<Option<T>> {
        let Some(name) = self.value::<String>(key, "a name")? else { return Ok(None) };
        from_name(&name).map(Some).ok_or_else(|| exception(self.0.py(), &unknown(key, &name, names)))
    }

    /// Returns a number above 0.
    pub fn positive(&self, key: &str, most: f64) -> PyResult<Option<f64>> {
        let number = self.value::<f64>(key, "a number")?;
        match number.filter(|x| !(x.is_finite() && *x > 0.0 && *x <= most)) {
            None => Ok(number),
            Some(x) => {
                let bound = if most.is_finite() { format!(" and at most {most}") } else { String::new() };
                let told = format!("{key}: expected a number above 0{bound}, found {x}");
                Err(exception(self.0.py(), &Error::new(told)))
            }
        }
    }

    /// Returns a time above 0: a number of seconds, or a text with a unit.
    pub fn seconds(&self, key: &str) -> PyResult<Option<f64>> {
        let text = self.0.get_item(key)?.and_then(|value| value.extract::<String>().ok());
        let Some(text) = text else { return self.positive(key, f64::INFINITY) };
        let told = |what| exception(self.0.py(), &Error::new(format!("{key}: found {text:?}: {what}")));
        quantity::seconds(&text).map(Some).map_err(told)
    }

    /// Returns the size of a picture.
    pub fn size(&self) -> PyResult<Option<[u32; 2]>> {
        let size = self.value::<[u32; 2]>("size", "(width, height)")?;
        match size.filter(|size| size.iter().any(|side| !(1..=MAX_SIZE).contains(side))) {
            None => Ok(size),
            Some([width, height]) => {
                let told = format!("size: expected 1 to {MAX_SIZE} pixels each way, found {width}×{height}");
                Err(exception(self.0.py(), &Error::new(told)))
            }
        }
    }
}

/// Returns the error of a word that a vocabulary has not.
pub fn unknown(key: &str, name: &str, names: &[&'static str]) -> Error {
    let near = suggestion(name, names.iter().copied());
    Error::new(format!("{key}: {name:?} is not known{near}; known are {}", names.join(", ")))
}

/// Returns the options that are given as words of a command line.
pub fn words(options: &[(&str, Option<String>)]) -> Vec<String> {
    options.iter().filter_map(|(name, value)| Some(format!("--{name}={}", value.as_ref()?))).collect()
}

/// The options of a render, read.
pub struct Wanted {
    changes: Changes,
    pub options: Options,
}

impl Wanted {
    /// Reads the options.
    pub fn read(given: &Bound<'_, PyDict>) -> PyResult<Wanted> {
        let py = given.py();
        let given = Given(given);
        let count = "a whole number of at least 0";
        let budget = given.seconds("budget")?.map(Goal::Seconds);
        let error = given.positive("target_error", f64::INFINITY)?.map(Goal::Error);
        if budget.is_some() && error.is_some() {
            let told = "budget and target_error are both given; a render ends at one of them";
            return Err(exception(py, &Error::new(told)));
        }
        let goal = budget.or(error);
        let crop = given.value::<[u32; 4]>("crop", "(x, y, width, height)")?;
        let changes = Changes {
            size: given.size()?,
            spp: given.value("spp", count)?,
            algorithm: given.named("algorithm", Algorithm::NAMES, Algorithm::from_name)?,
            has_goal: goal.is_some(),
            pattern: given.named("pattern", Pattern::NAMES, Pattern::from_name)?,
            seed: given.value("seed", count)?,
            method: given.named("method", Method::NAMES, Method::from_name)?,
            filter: given.named("filter", Filter::NAMES, Filter::from_name)?,
            mip: given.named("mip", LevelUse::NAMES, LevelUse::from_name)?,
            footprint: given.named("footprint", Footprint::NAMES, Footprint::from_name)?,
            precision: given.named("precision", Precision::NAMES, Precision::from_name)?,
            pixel_filter: given.named("pixel_filter", PixelFilterKind::NAMES, PixelFilterKind::from_name)?,
            pixel_filter_radius: given.positive("pixel_filter_radius", MAX_RADIUS)?,
            shared: given.value("shared", "True or False")?,
        };
        let options = Options {
            crop: crop.map(|[x, y, width, height]| Rect { x, y, width, height }),
            goal,
            allow_nonfinite: given.value("allow_nonfinite", "True or False")?.unwrap_or(false),
            ..Options::default()
        };
        Ok(Wanted { changes, options })
    }

    /// Returns the options as words of the command line of `moire render`.
    pub fn words(&self) -> Vec<String> {
        fn word<T: Display>(value: Option<T>) -> Option<String> {
            value.map(|value| value.to_string())
        }
        let (changes, options) = (&self.changes, &self.options);
        let goal = |found: fn(&Goal) -> Option<f64>| word(options.goal.as_ref().and_then(found));
        let given = words(&[
            ("size", changes.size.map(|[width, height]| format!("{width}x{height}"))),
            ("crop", options.crop.map(|Rect { x, y, width, height }| format!("{x},{y},{width},{height}"))),
            ("spp", word(changes.spp)),
            ("algorithm", word(changes.algorithm)),
            ("budget", goal(|goal| if let Goal::Seconds(seconds) = goal { Some(*seconds) } else { None })),
            ("target-error", goal(|goal| if let Goal::Error(rmse) = goal { Some(*rmse) } else { None })),
            ("pattern", word(changes.pattern)),
            ("seed", word(changes.seed)),
            ("method", word(changes.method)),
            ("filter", word(changes.filter)),
            ("mip", word(changes.mip)),
            ("footprint", word(changes.footprint)),
            ("precision", word(changes.precision)),
            ("pixel-filter", word(changes.pixel_filter)),
            ("pixel-filter-radius", word(changes.pixel_filter_radius)),
            ("shared", word(changes.shared)),
        ]);
        let flag = options.allow_nonfinite.then(|| "--allow-nonfinite".to_owned());
        given.into_iter().chain(flag).collect()
    }

    /// Returns the scene as the options change it.
    pub fn apply(&self, scene: &Scene) -> Result<Scene> {
        let mut scene = scene.clone();
        self.changes.apply(&mut scene)?;
        self.options.crop.map_or(Ok(()), |crop| crop.check_within([scene.width, scene.height]))?;
        prune(&mut scene);
        Ok(scene)
    }
}
