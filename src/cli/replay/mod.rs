//! `moire render --from`: a picture again from its record. In: the picture, and what the command line says beside it. Out:
//! the arguments of the render and its scene. A record may come from anyone: of its options those count that decide
//! pixels, and none that names a file to write.

mod places;
mod precedence;
mod scene;

pub use scene::Recorded;

use std::path::{Path, PathBuf};

use clap::{ArgMatches, Args, Command as CommandLine, FromArgMatches};
use serde_json::Value;

use super::display::FileArgs;
use super::overrides::Overrides;
use super::record::{COMMIT, Record, Renderer};
use super::render_args::RenderArgs;
use super::typed::{self, Typed};
use crate::core::built_in;
use crate::core::checksum::Checksum;
use crate::core::error::{Error, ErrorKind, Result};
use crate::output::record;
use crate::scene::model::Scene;
use crate::scene::{SceneFile, suggestion};
use crate::texture::open_file::hint;

/// Options of `moire render` that decide pixels, beside those that override the scene or belong to the display.
const OWN: &[&str] =
    &["device", "crop", "keep_everything", "allow_nonfinite", "texels", "mips", "estimates", "workgroup"];

/// A picture whose record is used.
pub struct Replay<'a> {
    picture: &'a Path,
    pub record: Record,
    /// How many settings of the command line are recorded ones; they come first.
    settings: usize,
    /// True if the recorded devices are in force.
    asks_for_device: bool,
}

/// Returns the command that parses the arguments of `moire render`.
pub fn command() -> CommandLine {
    RenderArgs::augment_args(CommandLine::new("moire render"))
}

fn has(command: CommandLine, id: &str) -> bool {
    command.get_arguments().any(|arg| arg.get_id() == id)
}

fn overrides(id: &str) -> bool {
    has(Overrides::augment_args(CommandLine::new("")), id)
}

/// Returns true if an option decides pixels: those are recorded.
fn decides_pixels(id: &str) -> bool {
    OWN.contains(&id) || overrides(id) || has(FileArgs::augment_args(CommandLine::new("")), id)
}

/// Returns the settings that are in force, for reports and records.
pub fn settings_of(args: &RenderArgs, scene: &Scene) -> Value {
    let mut settings = args.overrides.report(scene, args.crop, args.keep_everything);
    args.files.report(&mut settings);
    settings
}

/// Returns the record of a render. `matches`: its arguments as they were typed; `scene`: as it is rendered, of a file;
/// `files`: those that were read, by their names.
pub fn record_of(
    args: &RenderArgs,
    matches: &ArgMatches,
    (path, file): (&Path, SceneFile),
    files: impl IntoIterator<Item = (PathBuf, Checksum)>,
    scene: &Scene,
    by: &Renderer<'_>,
) -> Record {
    Record::new(path, file, files, recorded_options(matches), by, settings_of(args, scene))
}

/// Returns the options of a command line that a record holds.
pub fn recorded_options(matches: &ArgMatches) -> Vec<String> {
    let typed = typed::options(&command(), matches).into_iter();
    typed.filter(|option| decides_pixels(&option.id)).map(|option| option.word).collect()
}

/// Returns the name of an option that records may hold, as `--without` has it.
fn recordable(text: &str) -> Result<String> {
    let command = command();
    let arguments = command.get_arguments().filter(|arg| decides_pixels(arg.get_id().as_str()));
    let names: Vec<&str> = arguments.filter_map(|arg| arg.get_long()).collect();
    let name = text.trim().trim_start_matches('-');
    if names.contains(&name) {
        return Ok(name.to_owned());
    }
    let near = suggestion(name, names.iter().copied());
    let what = format!("--without {name}: no option of this name is recorded{near}");
    Err(Error::with_help(what, format!("recorded are {}", names.join(", "))))
}

impl<'a> Replay<'a> {
    /// Reads the record of a picture.
    pub fn open(picture: &'a Path) -> Result<Replay<'a>> {
        let shown = picture.display().to_string();
        let told = |error: Error| if picture.exists() { error } else { error.and_help(hint(picture)) };
        let text = record::read(picture).map_err(told)?;
        let text = text.filter(|text| text.trim_start().starts_with('{')).ok_or_else(|| {
            Error::with_help(
                format!("{shown}: this picture does not say how it was made"),
                "pictures of `moire render` do, unless --no-metadata was given or another program has stored them again",
            )
        })?;
        Ok(Replay { picture, record: Record::parse(&text, &shown)?, settings: 0, asks_for_device: false })
    }

    /// Returns the arguments: what the record says, unless the command line says otherwise. `without`: names of recorded
    /// options that are left out.
    pub fn arguments(
        &mut self,
        matches: &ArgMatches,
        without: &[String],
    ) -> Result<(RenderArgs, ArgMatches)> {
        let without = without.iter().map(|name| recordable(name)).collect::<Result<Vec<String>>>()?;
        let command = command();
        let typed = typed::options(&command, matches);
        let merged = precedence::merged(&command, self.options(&command)?, &typed, &without);
        self.settings = merged.settings;
        let is_device = |option: &Typed| option.id == "device";
        self.asks_for_device = !typed.iter().any(is_device);
        let failed = |error: clap::Error| {
            let text = error.to_string();
            let what = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            self.refused(&format!("with the options of its record: {what}"))
        };
        let words = ["moire render".into()].into_iter().chain(merged.words);
        let matches = command.clone().try_get_matches_from(words).map_err(failed)?;
        Ok((RenderArgs::from_arg_matches(&matches).map_err(failed)?, matches))
    }

    /// Returns an error of a device as one of the record, if that asked for the device.
    pub fn told(&self, error: Error) -> Error {
        let asked = self.record.options.iter().filter(|word| word.starts_with("--device="));
        let asked: Vec<&str> = asked.map(String::as_str).collect();
        if !self.asks_for_device || asked.is_empty() || error.kind() != ErrorKind::NoDevice {
            return error;
        }
        let help = "--device beside --from names another device, or --without device takes the default one; `moire devices` \
                    lists those of this machine";
        let place = format!("{}: its record asks for {}", self.picture.display(), asked.join(" "));
        error.within(&place).and_help(Some(help.into()))
    }

    /// Returns the recorded options. One that decides no pixels is an error.
    fn options(&self, command: &CommandLine) -> Result<Vec<Typed>> {
        let known = |word: &str| {
            let name = word.strip_prefix("--")?.split('=').next()?;
            let arg = command.get_arguments().find(|arg| arg.get_long() == Some(name))?;
            let id = arg.get_id().as_str();
            decides_pixels(id).then(|| Typed { id: id.into(), word: word.into() })
        };
        let option = |word: &String| {
            known(word).ok_or_else(|| {
                let version = &self.record.version;
                self.refused(&format!(
                    "its record has the option {word:?}, which decides no pixels of this version \
                     ({}; the record is of {version:?})",
                    env!("CARGO_PKG_VERSION")
                ))
            })
        };
        self.record.options.iter().map(option).collect()
    }

    fn refused(&self, what: &str) -> Error {
        let help = "render the scene itself: moire render SCENE, with the options that you want";
        Error::with_help(format!("{}: {what}", self.picture.display()), help)
    }

    /// Returns the file that is written if none is named: that of the picture, with `-again` behind its name.
    pub fn output(&self) -> PathBuf {
        let mut name = self.picture.file_stem().unwrap_or_default().to_owned();
        name.push("-again.");
        name.push(self.picture.extension().unwrap_or("png".as_ref()));
        PathBuf::from(name)
    }

    /// Returns the scene's file as it was typed.
    pub fn scene_path(&self) -> &Path {
        Path::new(&self.record.scene.path)
    }

    /// Returns why the picture may differ from the recorded one although all options are the same.
    pub fn difference(&self, device: &str, driver: &str) -> Option<String> {
        let Record { device: then, version, commit, .. } = &self.record;
        let mut pairs = vec![(then.clone(), device.to_owned())];
        // Records of earlier versions do not know it.
        let known = self.record.driver.iter().map(|then| (then.clone(), driver.to_owned()));
        pairs.extend(known.map(|(then, now)| (format!("driver {then}"), format!("driver {now}"))));
        let named = |version: &str, commit: Option<&str>| {
            let commit = commit.map_or(String::new(), |commit| format!(" ({commit})"));
            format!("moire {version}{commit}")
        };
        let both = commit.as_deref().filter(|_| COMMIT.is_some());
        let now = named(env!("CARGO_PKG_VERSION"), COMMIT.filter(|_| both.is_some()));
        pairs.push((named(version, both), now));
        let differing = pairs.into_iter().filter(|(then, now)| then != now);
        let (then, now): (Vec<String>, Vec<String>) = differing.unzip();
        if then.is_empty() {
            return None;
        }
        Some(format!(
            "the picture was rendered by {}, now it is {}: pixels may differ",
            then.join(", "),
            now.join(", ")
        ))
    }

    /// Returns a warning if the record does not tell what the files of the scene were.
    pub fn unknown_files(&self, scene: &Scene) -> Option<String> {
        let textures = scene.textures.iter().flat_map(|texture| texture.content.files());
        let mut files = scene.sources.iter().map(PathBuf::as_path).chain(textures);
        let has_some = files.any(|file| built_in::bytes(file).is_none());
        (has_some && self.record.files.is_empty()).then(|| {
            format!(
                "{}: its record has no checksums of textures and meshes: they may be others by now",
                self.picture.display()
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Options that decide no pixels of the picture: what is written, where to and what is said.
    const OTHERS: &[&str] = &[
        "scene",
        "from",
        "without",
        "output",
        "format",
        "aov",
        "no_beauty",
        "no_metadata",
        "guards",
        "json",
        "quiet",
        "verbose",
        "watch",
    ];

    #[test]
    fn of_each_option_it_is_known_whether_it_decides_pixels() {
        for arg in command().get_arguments() {
            let id = arg.get_id().as_str();
            assert!(decides_pixels(id) != OTHERS.contains(&id), "--{id}: list it in OWN, or in OTHERS");
        }
        for id in OWN.iter().chain(OTHERS) {
            assert!(has(command(), id), "{id} is no option");
        }
    }
}
