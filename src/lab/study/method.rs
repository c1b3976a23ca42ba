//! A method of antialiasing and its name: `pattern`, `pattern+footprint`,
//! `pattern+footprint+filter`, each prefixed with an algorithm other than `samples`. Parses names,
//! lists the methods that a scene allows, applies a method to a scene, and returns the equivalent
//! options of `moire render`.

use crate::core::error::{Error, Result};
use crate::scene::cone;
use crate::scene::model::{Algorithm, Footprint, Pattern, Scene};
use crate::scene::synonyms::absent;
use crate::scene::{check_filters, check_shared, check_spp, nearest};
use crate::texture::sampler_spec::{Filter, MipMode, SamplerSpec};

use super::label;
use super::record::MethodRecord;

/// A method. A footprint with a filter makes every sampler read mip levels linearly: `linear` is
/// trilinear.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Method {
    pub algorithm: Algorithm,
    /// The sampling pattern; `None` for the scene's.
    pub pattern: Option<Pattern>,
    pub footprint: Footprint,
    /// The filter; `None` for the scene's samplers unchanged.
    pub filter: Option<Filter>,
}

/// The filters to try if the scene has textures.
const FILTERS: [Filter; 3] = [Filter::Linear, Filter::Anisotropic, Filter::Ewa];

impl Method {
    /// Returns the method of one cone or beam per pixel; the pattern is the scene's, for pixels
    /// that beams cannot resolve.
    const fn of_algorithm(algorithm: Algorithm) -> Method {
        Method { algorithm, pattern: None, footprint: Footprint::None, filter: None }
    }

    pub const fn of_pattern(pattern: Pattern) -> Method {
        Method {
            algorithm: Algorithm::Samples,
            pattern: Some(pattern),
            footprint: Footprint::None,
            filter: None,
        }
    }

    /// Returns all methods to try in this scene, and notes on those that were left out.
    pub fn all_for(scene: &Scene) -> (Vec<Method>, Vec<String>) {
        let (mut methods, mut notes) = (Vec::new(), Vec::new());
        for &algorithm in Algorithm::ALL {
            match algorithm {
                Algorithm::Samples => {
                    methods.extend(Pattern::ALL.iter().map(|&p| Method::of_pattern(p)));
                    methods.extend(filtered(scene, &mut notes));
                }
                Algorithm::Adaptive => {
                    methods.push(Method { algorithm, ..Method::of_pattern(Pattern::SobolOwen) });
                }
                Algorithm::Beam | Algorithm::Cone => methods.push(Method::of_algorithm(algorithm)),
                // `auto` chooses by a goal, not by a number of samples.
                Algorithm::Auto => {}
            }
        }
        (methods, notes)
    }

    /// Parses a name: the first word may be an algorithm, then follow pattern, footprint and
    /// filter.
    pub fn parse(text: &str) -> Result<Method, String> {
        let mut words = text.split('+').peekable();
        let mut take = |known: &dyn Fn(&str) -> bool| words.next_if(|word| known(word));
        let algorithm = take(&|w| Algorithm::from_name(w).is_some()).and_then(Algorithm::from_name);
        let pattern = take(&|w| Pattern::from_name(w).is_some()).and_then(Pattern::from_name);
        let started = algorithm.is_some() || pattern.is_some();
        let footprint =
            take(&|w| started && Footprint::from_name(w).is_some()).and_then(Footprint::from_name);
        let filter =
            take(&|w| footprint.is_some_and(|f| f != Footprint::None) && Filter::from_name(w).is_some())
                .and_then(Filter::from_name);
        match words.next() {
            Some(word) => Err(unknown(word)),
            None => Ok(Method {
                algorithm: algorithm.unwrap_or(Algorithm::Samples),
                pattern,
                footprint: footprint.unwrap_or(Footprint::None),
                filter,
            }),
        }
    }

    pub fn name(&self) -> String {
        let algorithm = (self.algorithm != Algorithm::Samples).then_some(self.algorithm.name());
        let footprint = (self.footprint != Footprint::None).then_some(self.footprint.name());
        let words = [algorithm, self.pattern.map(Pattern::name), footprint, self.filter.map(Filter::name)];
        let named: Vec<&str> = words.into_iter().flatten().collect();
        if named.is_empty() { self.algorithm.name().to_owned() } else { named.join("+") }
    }

    /// Returns the name as a person calls it, in scenes of this pattern, which is not said beside a filter:
    /// `stratified+cone+linear` is "trilinear, cone footprint".
    pub fn label(&self, pattern_of_scene: Pattern) -> String {
        let pattern = self.pattern.unwrap_or(pattern_of_scene);
        let prefilters = self.footprint != Footprint::None;
        let is_said = match self.algorithm {
            Algorithm::Samples => !prefilters || pattern != pattern_of_scene,
            Algorithm::Adaptive | Algorithm::Auto => pattern != Pattern::SobolOwen,
            Algorithm::Beam | Algorithm::Cone => pattern != pattern_of_scene,
        };
        let words = [
            label::algorithm(self.algorithm),
            self.filter.map(label::filter),
            prefilters.then(|| label::footprint(self.footprint)),
            is_said.then(|| label::pattern(pattern)),
        ];
        words.into_iter().flatten().collect::<Vec<_>>().join(", ")
    }

    pub fn pattern_in(&self, scene: &Scene) -> Pattern {
        self.pattern.unwrap_or(scene.sampling.pattern)
    }

    pub fn describe(&self, scene: &Scene) -> MethodRecord {
        MethodRecord {
            name: self.name(),
            label: self.label(scene.sampling.pattern),
            algorithm: self.algorithm.name().to_owned(),
            pattern: self.pattern_in(scene).name().to_owned(),
            footprint: self.footprint.name().to_owned(),
            filter: self.filter.map(|f| f.name().to_owned()),
        }
    }

    /// Returns `base` rendered by this method.
    pub fn apply(&self, base: &Scene, spp: u32) -> Result<Scene> {
        let mut scene = base.clone();
        let sampling = &mut scene.sampling;
        sampling.algorithm = self.algorithm;
        sampling.pattern = self.pattern_in(base);
        sampling.shared = self.shares(base);
        sampling.spp = spp;
        sampling.footprint = self.footprint;
        check_shared(sampling.pattern, sampling.shared).map_err(Error::new)?;
        check_spp(sampling.pattern, sampling.spp).map_err(Error::new)?;
        if let Some(filter) = self.filter {
            scene.samplers.iter_mut().for_each(|sampler| with_filter(sampler, filter));
        }
        if self.filter.is_none() {
            cone::adapt_for_cone(&mut scene);
        }
        cone::adapt_footprint(&mut scene);
        check_filters(&scene)?;
        Ok(scene)
    }

    /// Returns a count that the pattern takes.
    fn least_count(&self, scene: &Scene) -> u32 {
        let pattern = self.pattern_in(scene);
        (1..=scene.sampling.spp).find(|&spp| check_spp(pattern, spp).is_ok()).unwrap_or(scene.sampling.spp)
    }

    /// Returns true if this method reads textures of `base` as `other` does, which is `base` by another method.
    fn reads_alike(&self, base: &Scene, other: &Scene) -> bool {
        self.apply(base, self.least_count(base)).is_ok_and(|own| {
            own.samplers == other.samplers && own.sampling.footprint == other.sampling.footprint
        })
    }

    /// Only jittered strata can be the same in all pixels.
    fn shares(&self, base: &Scene) -> bool {
        base.sampling.shared && self.pattern_in(base) == Pattern::Stratified
    }

    /// Returns the options of `moire render` that turn `base` into the scene of [`Method::apply`].
    pub fn arguments(&self, base: &Scene, spp: u32) -> Vec<String> {
        let count = spp.to_string();
        let mut options = vec!["--pattern", self.pattern_in(base).name(), "--spp", &count];
        if self.algorithm != base.sampling.algorithm {
            options.extend(["--algorithm", self.algorithm.name()]);
        }
        if self.footprint != base.sampling.footprint {
            options.extend(["--footprint", self.footprint.name()]);
        }
        if let Some(filter) = self.filter {
            options.extend(["--filter", filter.name(), "--mip", MipMode::Linear.name()]);
        }
        if self.shares(base) != base.sampling.shared {
            options.extend(["--shared", "false"]);
        }
        options.into_iter().map(str::to_owned).collect()
    }
}

fn with_filter(sampler: &mut SamplerSpec, filter: Filter) {
    (sampler.mag, sampler.min) = filter.both();
    sampler.mip = MipMode::Linear;
}

/// Returns the scene's pattern, and one sample in the centre, with each filter, and with the scene's own filter and
/// footprint if it has one. What is the same picture twice is there once, by the name of its filter.
fn filtered(scene: &Scene, notes: &mut Vec<String>) -> Vec<Method> {
    let procedural = scene.textures.iter().any(|t| t.content.procedural().is_some());
    let stored = scene.textures.iter().any(|t| t.content.procedural().is_none());
    let own = match scene.sampling.footprint {
        Footprint::None => (procedural && !stored).then_some(Footprint::Cone),
        footprint => Some(footprint),
    };
    let magnifies_otherwise = scene.samplers.iter().any(|s| s.mag != Filter::Linear);
    if stored && magnifies_otherwise {
        notes.push(
            "filters were left out: --filter would also change how textures are magnified, which the scene does otherwise than linearly"
                .into(),
        );
    }
    let mut methods: Vec<Method> = Vec::new();
    for pattern in [scene.sampling.pattern, Pattern::Center] {
        let base = Method::of_pattern(pattern);
        let unchanged = own.map(|footprint| Method { footprint, ..base.clone() });
        let filters = FILTERS.iter().filter(|_| stored && !magnifies_otherwise);
        let filters = filters.map(|filter| Method {
            footprint: Footprint::Cone,
            filter: Some(*filter),
            ..base.clone()
        });
        let mut found: Vec<Method> = Vec::new();
        for method in filters.chain(unchanged) {
            match method.apply(scene, method.least_count(scene)) {
                Ok(applied) if found.iter().any(|other| other.reads_alike(scene, &applied)) => {}
                Ok(_) => found.push(method),
                // The other pattern is refused for the same reason.
                Err(why) if pattern == scene.sampling.pattern => {
                    notes.push(format!("{} was left out: {why}", method.name()));
                }
                Err(_) => {}
            }
        }
        methods.extend(found.into_iter().filter(|method| !methods.contains(method)).collect::<Vec<_>>());
    }
    methods
}

fn unknown(word: &str) -> String {
    let list = |names: &[&str]| names.join(", ");
    format!(
        "\"{word}\" has no meaning there{} A method is PATTERN, PATTERN+FOOTPRINT or PATTERN+FOOTPRINT+FILTER, \
         with an algorithm before it or alone, or best; patterns: {}; footprints: {}; filters: {}; algorithms: {}",
        likely(word),
        list(Pattern::NAMES),
        list(Footprint::NAMES),
        list(Filter::NAMES),
        list(Algorithm::NAMES)
    )
}

/// Returns a question for the method that a word most likely means. Footprints and filters stand behind a pattern.
fn likely(word: &str) -> String {
    let near = |names: &[&'static str]| nearest(word, names.iter().copied()).map(|(name, _)| name);
    let behind = |pattern: &str, name: &str| format!("{pattern}+{name}");
    let found = if Filter::NAMES.contains(&word) {
        Some(behind("stratified+cone", word))
    } else if Footprint::NAMES.contains(&word) {
        Some(behind("stratified", word))
    } else {
        let whole = near(&["best"]).or_else(|| near(Pattern::NAMES)).or_else(|| near(Algorithm::NAMES));
        let filter = || near(Filter::NAMES).map(|name| behind("stratified+cone", name));
        let footprint = || near(Footprint::NAMES).map(|name| behind("stratified", name));
        whole.map(String::from).or_else(filter).or_else(footprint)
    };
    match (found, absent(word)) {
        (Some(name), _) => format!("; did you mean {name}?"),
        (None, Some(instead)) => format!("; {instead}."),
        (None, None) => ".".into(),
    }
}
