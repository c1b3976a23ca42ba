//! What is told of a render beside its picture: warnings, the record that files carry, the report. In: the options of
//! `moire render`, the scene as they change it, and the picture. For `moire render`, and for the module of Python, whose
//! renders have the same options.

use std::ffi::OsString;
use std::path::Path;

use clap::{ArgMatches, Args, Command as CommandLine, FromArgMatches};
use serde_json::Value;

use super::checksums::Checksums;
use super::record::{Record, Renderer};
use super::render_args::RenderArgs;
use super::{replay, report};
use crate::core::error::{Error, Result};
use crate::lab::verify::known::anisotropy_fault;
use crate::render::Picture;
use crate::scene::model::{Algorithm, Scene};
use crate::scene::{SceneFile, advice};

/// Returns the record and the report of a picture that was rendered with these words of a command line, and adds to its
/// warnings those of `moire render`. `file`: that of the scene, read from `path`.
pub fn of_words(
    words: &[String],
    path: &Path,
    file: SceneFile,
    scene: &Scene,
    ran: &mut Picture,
) -> Result<(Record, Value)> {
    let matches = parse(words, path)?;
    let args = RenderArgs::from_arg_matches(&matches).map_err(failed)?;
    add_warnings(&args, scene, ran);
    let files = Checksums::begin(scene).finish();
    ran.report.warnings.extend(files.warnings());
    let report = report::json(ran, scene, replay::settings_of(&args, scene), &[], args.allow_nonfinite);
    let by = Renderer::of(ran);
    Ok((replay::record_of(&args, &matches, (path, file), files.named(&[]), scene, &by), report))
}

/// Returns the record of a picture that is written with more options: those of its display.
pub fn with_words(mut record: Record, words: &[String]) -> Result<Record> {
    let all = [&record.options[..], words].concat();
    let matches = parse(&all, Path::new(&record.scene.path))?;
    record.options = replay::recorded_options(&matches);
    RenderArgs::from_arg_matches(&matches).map_err(failed)?.files.report(&mut record.settings);
    Ok(record)
}

fn parse(words: &[String], path: &Path) -> Result<ArgMatches> {
    let command = RenderArgs::augment_args(CommandLine::new("moire render"));
    let line = ["moire render".into()].into_iter().chain(words.iter().map(OsString::from));
    command.try_get_matches_from(line.chain(["--".into(), path.as_os_str().to_owned()])).map_err(failed)
}

fn failed(error: clap::Error) -> Error {
    Error::new(format!("options of moire render: {error}"))
}

/// Adds the warnings about a scene and the options with which it was rendered.
pub(super) fn add_warnings(args: &RenderArgs, scene: &Scene, ran: &mut Picture) {
    let warnings = &mut ran.report.warnings;
    let samples_anisotropically = advice::samples_anisotropically(scene);
    for fault in ran.devices.iter().filter(|_| samples_anisotropically).filter_map(anisotropy_fault) {
        warnings.push(format!("{fault}; --method shader reads the right ones"));
    }
    warnings.splice(..0, advice::of_scene(scene));
    warnings.extend(args.overrides.idle_spp().map(String::from));
    let counts_follow_neighbours = matches!(scene.sampling.algorithm, Algorithm::Adaptive | Algorithm::Auto);
    if args.crop.is_some() && counts_follow_neighbours {
        warnings.push(
            "--crop with algorithm adaptive or auto: samples go where this part errs most, so its pixels differ \
             from those of the full picture within their noise; with --algorithm samples they are equal"
                .into(),
        );
    }
}
