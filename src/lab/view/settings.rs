//! The settings of one side of the page: options by name, and `KEY=VALUE` of the scene. Output: the scene as `moire
//! render` would render it with them, the counts of samples through which its picture refines, what becomes of its light
//! on a screen, and the command.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::SystemTime;

use serde_json::Value;

use super::SAMPLES;
use super::choices::{CHOICES, Kind, choice};
use crate::core::error::{Error, Result};
use crate::output::DisplayTransform;
use crate::scene::changes::Changes;
use crate::scene::model::Scene;
use crate::scene::prune::prune;
use crate::scene::{Reading, Setting, advice, check_spp, load_as};

/// Options that decide the samples of a film and nothing else of the scene.
const SAMPLES_ALONE: [&str; 4] = ["pattern", "spp", "seed", "shared"];
/// Options and settings of a side, and bytes of one.
const MAX_COUNT: usize = 64;
const MAX_BYTES: usize = 4096;

/// What the program was started with: what all sides have in common.
#[derive(Clone, Debug)]
pub struct Source {
    /// The scene file.
    pub path: PathBuf,
    pub camera: Option<String>,
    /// The device, as it was named.
    pub device: Option<String>,
}

impl Source {
    /// Returns what tells the scene file from another version of it; none where there is no file.
    pub fn stamp(&self) -> Option<(u64, SystemTime)> {
        let file = std::fs::metadata(&self.path).ok()?;
        Some((file.len(), file.modified().ok()?))
    }
}

/// The settings of a side.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// Values by the names of options.
    pub options: BTreeMap<String, String>,
    /// `KEY=VALUE`, in order.
    pub set: Vec<String>,
}

/// A scene with settings, ready to be rendered.
pub struct Resolved {
    pub scene: Scene,
    /// Samples a pixel of its pictures, rising.
    pub counts: Vec<u32>,
    /// The version of the file that was read.
    pub stamp: Option<(u64, SystemTime)>,
    pub warnings: Vec<String>,
}

impl Settings {
    /// Reads settings as the page sends them.
    pub fn from_json(value: &Value) -> Result<Settings> {
        let wrong = || Error::new("expected {\"options\": {NAME: VALUE}, \"set\": [\"KEY=VALUE\"]}");
        let text = |value: &Value| Some(value.as_str().filter(|text| text.len() <= MAX_BYTES)?.to_owned());
        let options = value["options"].as_object().ok_or_else(wrong)?;
        let set = value["set"].as_array().ok_or_else(wrong)?;
        if options.len() > MAX_COUNT || set.len() > MAX_COUNT {
            return Err(Error::new(format!("expected at most {MAX_COUNT} options and settings")));
        }
        let options = options.iter().map(|(name, value)| Some((name.clone(), text(value)?)));
        let options: Option<BTreeMap<String, String>> = options.collect();
        let set: Option<Vec<String>> = set.iter().map(text).collect();
        Ok(Settings { options: options.ok_or_else(wrong)?, set: set.ok_or_else(wrong)? })
    }

    /// Returns all that goes with `--set`: choices of the menus, then what was typed.
    fn all_set(&self) -> Vec<String> {
        let chosen = CHOICES.iter().filter(|choice| matches!(choice.kind, Kind::Set));
        let chosen =
            chosen.filter_map(|choice| Some(format!("{}={}", choice.name, self.options.get(choice.name)?)));
        chosen.chain(self.set.iter().cloned()).collect()
    }

    fn changes(&self) -> Result<Changes> {
        let mut changes = Changes::default();
        for (name, value) in &self.options {
            let known = choice(name).ok_or_else(|| Error::new(format!("there is no option {name:?}")))?;
            if let Kind::Option(set) = &known.kind {
                set(&mut changes, value).map_err(|what| wrong(name, value, &what))?;
            }
        }
        Ok(changes)
    }

    /// Returns what becomes of light on a screen.
    pub fn display(&self) -> Result<DisplayTransform> {
        let mut display = DisplayTransform::default();
        for (name, value) in &self.options {
            if let Some(Kind::Display(set)) = choice(name).map(|choice| &choice.kind) {
                set(&mut display, value).map_err(|what| wrong(name, value, &what))?;
            }
        }
        Ok(display)
    }

    /// Returns the options of the display as words: the same ones for the same picture of a film.
    pub fn display_words(&self) -> String {
        let options = self.options.iter().filter(|(name, _)| is_of_display(name));
        options.map(|(name, value)| format!("--{name} {value}")).collect::<Vec<_>>().join(" ")
    }

    /// Returns those of the settings that decide the film: all but those of the display.
    pub fn of_film(&self) -> Settings {
        let options = self.options.iter().filter(|(name, _)| !is_of_display(name));
        let options = options.map(|(name, value)| (name.clone(), value.clone())).collect();
        Settings { options, set: self.set.clone() }
    }

    /// Returns those of the settings that decide more than the samples of a film.
    pub fn without_samples(&self) -> Settings {
        let options = self.options.iter().filter(|(name, _)| !SAMPLES_ALONE.contains(&name.as_str()));
        let options = options.map(|(name, value)| (name.clone(), value.clone())).collect();
        Settings { options, set: self.set.clone() }
    }

    /// Reads the scene with these settings. `keeps_meshes`: for numbering what a pixel shows.
    pub fn load(&self, source: &Source, keeps_meshes: bool) -> Result<Scene> {
        let changes = self.changes()?;
        let settings = self.all_set().iter().map(|text| Setting::parse(text)).collect::<Result<Vec<_>>>()?;
        let reading = Reading { camera: source.camera.as_deref(), keeps_meshes, settings: &settings };
        let mut scene = load_as(&source.path, &reading)?;
        changes.apply(&mut scene)?;
        prune(&mut scene);
        Ok(scene)
    }

    /// Reads the scene with these settings and plans how its picture refines.
    pub fn resolve(&self, source: &Source) -> Result<Resolved> {
        let stamp = source.stamp();
        let mut scene = self.load(source, false)?;
        if !self.options.contains_key("spp") {
            scene.sampling.spp = scene.sampling.spp.max(SAMPLES);
        }
        let counts = counts(&scene);
        Ok(Resolved { warnings: advice::of_scene(&scene), scene, counts, stamp })
    }

    /// Returns the command that renders the picture of a number of samples, for a shell.
    pub fn command(&self, source: &Source, count: u32) -> String {
        let arguments = self.arguments(source, count);
        format!("moire render {}", arguments.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(" "))
    }

    /// Returns the arguments of `moire render` for the picture of a number of samples.
    pub fn arguments(&self, source: &Source, count: u32) -> Vec<String> {
        let mut words = vec![source.path.display().to_string()];
        let mut option = |name: &str, value: &str| words.extend([format!("--{name}"), value.to_owned()]);
        if let Some(camera) = &source.camera {
            option("camera", camera);
        }
        self.all_set().iter().for_each(|text| option("set", text));
        for Given { name, value } in self.given(count) {
            option(name, &value);
        }
        if let Some(device) = &source.device {
            option("device", device);
        }
        words
    }

    /// Returns the options of the command line, with that number of samples.
    fn given(&self, count: u32) -> Vec<Given> {
        let options = CHOICES.iter().filter(|choice| !matches!(choice.kind, Kind::Set));
        let value = |name: &str| {
            if name == "spp" { Some(count.to_string()) } else { self.options.get(name).cloned() }
        };
        options.filter_map(|choice| Some(Given { name: choice.name, value: value(choice.name)? })).collect()
    }
}

/// An option and its value.
struct Given {
    name: &'static str,
    value: String,
}

/// Returns true for an option that changes no film, but how it is shown.
fn is_of_display(name: &str) -> bool {
    choice(name).is_some_and(|choice| matches!(choice.kind, Kind::Display(_)))
}

fn wrong(name: &str, value: &str, what: &str) -> Error {
    Error::new(format!("--{name}: found {value:?}; {what}"))
}

/// Returns the counts through which a picture refines: powers of two that its pattern takes, and that of the scene.
fn counts(scene: &Scene) -> Vec<u32> {
    let sampling = &scene.sampling;
    let last = sampling.samples();
    let powers = (0..32).map(|log| 1u32 << log).take_while(|&count| count < last);
    powers.filter(|&count| check_spp(sampling.pattern, count).is_ok()).chain([last]).collect()
}

/// Returns a word as a shell reads it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}
