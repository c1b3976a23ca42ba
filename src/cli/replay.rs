//! `moire render --from`: a picture again from its record. In: the picture, and what the command line says beside it. Out:
//! the arguments of the render and its scene. A record may come from anyone: of its options those count that decide
//! pixels, and none that names a file to write.

use std::path::{Path, PathBuf};

use clap::{ArgAction, ArgMatches, Args, Command as CommandLine, FromArgMatches};

use super::display::FileArgs;
use super::overrides::Overrides;
use super::record::Record;
use super::render_args::RenderArgs;
use super::typed::{self, Typed};
use crate::core::error::{Error, ErrorKind, Result};
use crate::output::record;
use crate::scene::model::Scene;
use crate::scene::{self, BuiltIn, Reading, SceneFile, is_standard_input};
use crate::texture::open_file::hint;

/// Options of `moire render` that decide pixels, beside those that override the scene or belong to the display.
const OWN: &[&str] =
    &["device", "crop", "keep_everything", "allow_nonfinite", "texels", "mips", "estimates", "workgroup"];

/// A picture whose record is used.
pub struct Replay<'a> {
    picture: &'a Path,
    pub record: Record,
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

/// Returns the record of a render. `matches`: its arguments as they were typed; `scene`: as it is rendered, of a file.
pub fn record_of(
    args: &RenderArgs,
    matches: &ArgMatches,
    (path, file): (&Path, SceneFile),
    scene: &Scene,
    device: &str,
) -> Record {
    let settings = args.overrides.report(scene, args.crop, args.keep_everything);
    Record::new(&path.to_string_lossy(), file, recorded_options(matches), device, settings)
}

/// Returns the options of a command line that a record holds.
pub fn recorded_options(matches: &ArgMatches) -> Vec<String> {
    let typed = typed::options(&command(), matches).into_iter();
    typed.filter(|option| decides_pixels(&option.id)).map(|option| option.word).collect()
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
        Ok(Replay { picture, record: Record::parse(&text, &shown)? })
    }

    /// Returns the arguments: what the record says, unless the command line says otherwise.
    pub fn arguments(&self, matches: &ArgMatches) -> Result<(RenderArgs, ArgMatches)> {
        let command = command();
        let typed = typed::options(&command, matches);
        let recorded = self.options(&command)?;
        let kept = recorded.into_iter().filter(|option| !gives_way(&command, option, &typed));
        let words = kept.chain(typed.iter().cloned()).map(|option| option.word);
        let failed = |error: clap::Error| {
            let text = error.to_string();
            let what = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            self.refused(&format!("with the options of its record: {what}"))
        };
        let matches = command.clone().try_get_matches_from(["moire render".into()].into_iter().chain(words));
        let matches = matches.map_err(failed)?;
        Ok((RenderArgs::from_arg_matches(&matches).map_err(failed)?, matches))
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

    /// Reads the scene: its text as recorded, or the file where only that is known.
    pub fn load(&self, reading: &Reading<'_>) -> Result<(Scene, SceneFile)> {
        let path = self.scene_path();
        if let [name, ..] = &self.record.scene.arrays[..] {
            let what = format!(
                "its texture {name:?} was an array of the program that rendered it, which no record holds"
            );
            return Err(self.refused(&what).of_kind(ErrorKind::File));
        }
        match &self.record.scene.text {
            Some(text) => {
                Ok((self.scene_of_text(text, path, reading)?, SceneFile::of_bytes(text.as_bytes())))
            }
            None => self.scene_of_file(path, reading),
        }
    }

    /// Returns the folder of the picture.
    fn beside(&self) -> &Path {
        self.picture.parent().unwrap_or(Path::new(""))
    }

    /// Reads the scene's text. Its files are those in the folder where the scene lay, else those beside the picture.
    fn scene_of_text(&self, text: &str, path: &Path, reading: &Reading<'_>) -> Result<Scene> {
        let shown = if is_standard_input(path) { Path::new(scene::STANDARD_INPUT) } else { path };
        // The files of a scene of the program are its own.
        if let Ok(Some(built_in)) = BuiltIn::named(path) {
            let mut scene = scene::parse_as(&built_in.path(), text, reading)?;
            scene.path = path.into();
            return Ok(scene);
        }
        let here = self.beside().join(shown.file_name().unwrap_or_default());
        let there = scene::parse_as(shown, text, reading);
        if there.as_ref().is_ok_and(|scene| missing(scene).is_empty()) {
            return there;
        }
        if let Ok(mut scene) = scene::parse_as(&here, text, reading)
            && missing(&scene).is_empty()
        {
            scene.path = shown.into();
            return Ok(scene);
        }
        let (lay, beside) = (folder(shown), folder(&here));
        let help =
            format!("the scene lay in {lay}, and this picture in {beside}: its files are looked for in both");
        let mut scene = there.map_err(|error| match error.help() {
            None => error.and_help(Some(help.clone())),
            Some(_) => error,
        })?;
        self.take_from_beside(&mut scene, shown.parent().unwrap_or(Path::new("")));
        let names = missing(&scene);
        if names.is_empty() {
            return Ok(scene);
        }
        let verb = if names.len() == 1 { "is" } else { "are" };
        let what =
            format!("{}: {} {verb} missing, which its scene reads", self.picture.display(), names.join(", "));
        Err(Error::with_help(what, help).of_kind(ErrorKind::File))
    }

    /// Lets missing textures be files beside the picture, in the same folder there or in none.
    fn take_from_beside(&self, scene: &mut Scene, own: &Path) {
        for texture in &mut scene.textures {
            for file in texture.content.files_mut().into_iter().filter(|file| !file.exists()) {
                let inside = file.strip_prefix(own).unwrap_or(file);
                let name = Path::new(file.file_name().unwrap_or_default());
                let places = [inside, name].map(|name| self.beside().join(name));
                if let Some(found) = places.into_iter().find(|place| place.exists()) {
                    *file = found;
                }
            }
        }
    }

    /// Reads the scene's file, which must be the one that was recorded.
    fn scene_of_file(&self, path: &Path, reading: &Reading<'_>) -> Result<(Scene, SceneFile)> {
        let note = self.record.scene.note.as_deref().unwrap_or("the record does not hold the scene");
        let here = self.beside().join(path.file_name().unwrap_or_default());
        let found = [path, &here].into_iter().find(|place| !is_standard_input(place) && place.is_file());
        let Some(found) = found else {
            let what = format!("{} is missing: {note}", path.display());
            return Err(self.refused(&what).of_kind(ErrorKind::File));
        };
        let (scene, file) = scene::load_recorded(found, reading)?;
        let recorded = &self.record.scene;
        if (file.bytes, file.crc32) != (recorded.bytes, recorded.crc32) {
            let what =
                format!("{} is not the file that was rendered: it has changed; {note}", found.display());
            return Err(self.refused(&what).of_kind(ErrorKind::File));
        }
        Ok((scene, file))
    }

    /// Returns why the picture may differ from the recorded one although all options are the same.
    pub fn difference(&self, device: &str) -> Option<String> {
        let Record { device: then, version, .. } = &self.record;
        let now = env!("CARGO_PKG_VERSION");
        if (then.as_str(), version.as_str()) == (device, now) {
            return None;
        }
        Some(format!(
            "the picture was rendered on {then} by moire {version}, now it is {device} and moire {now}: pixels may differ"
        ))
    }
}

/// Returns true if a recorded option is not to be used beside the typed ones: it is typed, or excluded by one of them. Of
/// overrides that may be given several times those of both count.
fn gives_way(command: &CommandLine, recorded: &Typed, typed: &[Typed]) -> bool {
    let arg = |id: &str| command.get_arguments().find(|arg| arg.get_id() == id);
    let excludes = |a: &str, b: &str| {
        arg(a).is_some_and(|a| command.get_arg_conflicts_with(a).iter().any(|other| other.get_id() == b))
    };
    typed.iter().any(|option| {
        if option.id == recorded.id {
            let adds = |arg: &clap::Arg| matches!(arg.get_action(), ArgAction::Append);
            return !(overrides(&option.id) && arg(&option.id).is_some_and(adds));
        }
        excludes(&option.id, &recorded.id) || excludes(&recorded.id, &option.id)
    })
}

/// Returns the files of textures that are not there.
fn missing(scene: &Scene) -> Vec<String> {
    let files = scene.textures.iter().flat_map(|texture| texture.content.files());
    files.filter(|file| !file.exists()).map(|file| file.display().to_string()).collect()
}

/// Returns the name of a file's folder.
fn folder(file: &Path) -> String {
    match file.parent() {
        Some(folder) if folder != Path::new("") => folder.display().to_string(),
        _ => "the current folder".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Options that decide no pixels of the picture: what is written, where to and what is said.
    const OTHERS: &[&str] = &[
        "scene",
        "from",
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
