//! `moire render`: renders a scene file with options into pictures and, with `--json`, one JSON
//! object of statistics. All invalid input is refused before the device starts.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::ArgMatches;

use super::account;
use super::checksums::{Checksums, Files};
use super::inputs::Inputs;
use super::layers::Wanted;
use super::outputs::{Outputs, check_distinct, default_name};
use super::progress::Bar;
use super::record::Renderer;
pub use super::render_args::RenderArgs;
use super::replay::{self, Recorded, Replay};
use super::report;
use super::watch;
use crate::core::error::{Error, Result};
use crate::core::film::{Film, Placement};
use crate::core::progress::Progress;
use crate::gpu::DeviceSelect;
use crate::output::WriteOptions;
use crate::render::{self, Kept, On, Options, Picture, Tuning};
use crate::scene::model::Scene;
use crate::scene::prune::prune;
use crate::scene::{self, SceneFile};
use crate::texture::color_profile::ColorProfile;
use crate::texture::data::ColorSpace;
use crate::texture::read_file::{color_profile, is_turned};
use crate::texture::source::{OrientationUse, ProfileUse, TextureSource};

/// Renders. `matches`: the arguments as they were typed.
pub fn run(args: &RenderArgs, matches: &ArgMatches) -> Result<ExitCode> {
    let Some(picture) = &args.from else {
        if let Some(name) = args.without.first() {
            let what =
                format!("--without {name}: it leaves out options of a record, and no picture is named");
            return Err(Error::with_help(what, "name a picture with --from PICTURE in place of the scene"));
        }
        return start(Job::new(args, matches, None)?);
    };
    let mut replay = Replay::open(picture)?;
    let (args, matches) = replay.arguments(matches, &args.without)?;
    let made = Job::new(&args, &matches, Some(&replay)).and_then(start);
    made.map_err(|error| replay.told(error))
}

fn start(job: Job<'_>) -> Result<ExitCode> {
    let bar = Bar::new(job.args.quiet)?;
    if job.args.watch {
        return watch::run(&job, &bar);
    }
    let (kept, progress) =
        (&mut Kept::default(), Show { progress: &bar, bar: &bar, is_preview: false, told: None });
    job.render(job.stage()?, kept, &progress, job.begun).map(|()| ExitCode::SUCCESS)
}

/// The options of a render, checked.
pub(super) struct Job<'a> {
    pub args: &'a RenderArgs,
    /// The same as they were typed, for the record.
    matches: &'a ArgMatches,
    replay: Option<&'a Replay<'a>>,
    /// The scene's file.
    pub path: &'a Path,
    pub outputs: Outputs,
    on: Vec<On>,
    begun: Instant,
}

/// A scene as the options change it, with what is asked of it.
pub(super) struct Stage {
    pub scene: Scene,
    /// What pictures record of the scene's file.
    file: SceneFile,
    /// Files with the names that they have in records, where these are others.
    names: Vec<(PathBuf, PathBuf)>,
    wanted: Wanted,
    /// Settings that were chosen implicitly, and what the scene has no use for.
    chosen: Option<&'static str>,
    dropped: Vec<String>,
}

/// How a render tells what it does.
pub(super) struct Show<'a> {
    pub progress: &'a dyn Progress,
    pub bar: &'a Bar,
    /// The picture is followed by a better one, of which alone is spoken.
    pub is_preview: bool,
    /// The warnings of the picture before, where there are several; they are not told again.
    pub told: Option<&'a RefCell<Vec<String>>>,
}

impl<'a> Job<'a> {
    fn new(args: &'a RenderArgs, matches: &'a ArgMatches, replay: Option<&'a Replay<'a>>) -> Result<Job<'a>> {
        let begun = Instant::now();
        let mut on = args.device.iter().map(|text| On::parse(text)).collect::<Result<Vec<On>>>()?;
        if on.is_empty() {
            on.push(On::Device(DeviceSelect::Default));
        }
        // Either of them is there, as the parser sees to.
        let path = args.scene.as_deref().or(replay.map(Replay::scene_path)).unwrap_or(Path::new("-"));
        let default = replay.map_or_else(|| default_name(path), Replay::output);
        let outputs = Outputs::new(default, &args.output, args.format, args.json)?;
        Ok(Job { args, matches, replay, path, outputs, on, begun })
    }

    /// Returns true unless layers are written alone.
    pub fn has_picture(&self) -> bool {
        self.args.layers.has_beauty()
    }

    /// Returns true if a time or an error ends the render.
    pub fn has_goal(&self) -> bool {
        self.args.overrides.goal().is_some()
    }

    /// Reads the scene and checks what is asked of it.
    pub fn stage(&self) -> Result<Stage> {
        let args = self.args;
        let reading = args.overrides.reading(args.layers.numbers_meshes());
        let with_option = |error| args.overrides.with_option(error);
        let Recorded { mut scene, file, names } = match self.replay {
            Some(replay) => replay.load(&reading).map_err(with_option)?,
            None => {
                let (scene, file) = scene::load_recorded(self.path, &reading).map_err(with_option)?;
                Recorded { scene, file, names: Vec::new() }
            }
        };
        let chosen = args.overrides.apply(&mut scene)?;
        args.crop.map_or(Ok(()), |crop| crop.check_within([scene.width, scene.height]))?;
        let inputs = args
            .from
            .iter()
            .fold(Inputs::of_scene(&scene), |inputs, from| inputs.and(from, "the picture of --from"));
        self.outputs.files.iter().try_for_each(|path| inputs.check_picture(path))?;
        let wanted = Wanted::new(&args.layers, &self.outputs, &scene)?;
        wanted.paths().try_for_each(|path| inputs.check_picture(path))?;
        check_distinct(self.outputs.files.iter().map(PathBuf::as_path).chain(wanted.paths()))?;
        let dropped = prune(&mut scene);
        Ok(Stage { scene, file, names, wanted, chosen, dropped })
    }

    /// Renders and writes all outputs. `start`: when the work on this picture began.
    pub fn render(&self, stage: Stage, kept: &mut Kept, show: &Show<'_>, start: Instant) -> Result<()> {
        let (args, on, outputs) = (self.args, &self.on[..], &self.outputs);
        let Stage { scene, file, names, wanted, chosen, dropped } = stage;
        let is_told = args.verbose && !show.is_preview;
        if let (Some(chosen), true) = (chosen, is_told) {
            super::notify(chosen);
        }
        let options = self.options(&wanted, show.is_preview);
        let placement =
            args.crop.map(|c| Placement { corner: [c.x, c.y], full: [scene.width, scene.height] });
        let write = WriteOptions { placement, ..args.files.write_options() };
        if !wanted.has_beauty {
            let layers = wanted.render(&scene, &options, on, None, show.progress)?;
            show.bar.finish();
            let size = args.crop.map_or([scene.width, scene.height], |crop| [crop.width, crop.height]);
            return wanted.write(outputs, &Film::new(size[0], size[1], 1), &layers, &scene, &write);
        }
        let loaded = start.elapsed().as_secs_f64();
        let has_record = !args.no_metadata && !show.is_preview;
        let checksums = has_record.then(|| Checksums::begin(&scene));
        let mut ran = render::render_kept(&scene, &options, on, kept, show.progress)?;
        // From the start of the process: reading the scene file is part of loading.
        ran.report.seconds.load += loaded;
        if show.is_preview {
            return wanted.without_layers().write(outputs, &ran.film, &[], &scene, &write);
        }
        if is_told {
            say_textures(&scene, &ran.texture_lines);
        }
        for message in &ran.messages {
            super::notify(format_args!("validation: {message}"));
        }
        ran.report.left_out.extend(dropped);
        self.add_warnings(&scene, &mut ran);
        let files = checksums.map(Checksums::finish);
        ran.report.warnings.extend(files.iter().flat_map(Files::warnings));
        if let Some(told) = show.told {
            let all = ran.report.warnings.clone();
            ran.report.warnings.retain(|warning| !told.borrow().contains(warning));
            told.replace(all);
        }
        let layers = wanted.render(&scene, &options, on, Some(&ran), show.progress)?;
        show.bar.finish();

        let clock = Instant::now();
        let settings = replay::settings_of(args, &scene);
        let record = files.map(|files| {
            let files = files.named(&names);
            let by = Renderer::of(&ran);
            replay::record_of(args, self.matches, (self.path, file), files, &scene, &by).text()
        });
        let write = WriteOptions { record: record.as_deref(), ..write };
        wanted.write(outputs, &ran.film, &layers, &scene, &write)?;
        ran.report.seconds.write = clock.elapsed().as_secs_f64();
        ran.report.seconds.total = start.elapsed().as_secs_f64();
        let outputs = [outputs.names(), wanted.names()].concat();
        if args.json {
            let report = report::json(&ran, &scene, settings, &outputs, args.allow_nonfinite);
            super::print(&format!("{report:#}"))?;
        }
        if !args.quiet {
            report::say(&ran, &outputs, args.verbose);
        }
        Ok(())
    }

    fn options(&self, wanted: &Wanted, is_preview: bool) -> Options {
        let args = self.args;
        Options {
            crop: args.crop,
            goal: args.overrides.goal().filter(|_| !is_preview),
            tells_pixels: wanted.needs_pixels() && !is_preview,
            allow_nonfinite: args.allow_nonfinite,
            keep_everything: args.keep_everything,
            diagnosed: (args.guards || args.verbose) && !is_preview,
            mips: args.mips,
            tuning: Tuning {
                texels: args.texels,
                group: args.workgroup,
                estimates: args.estimates,
                ..Tuning::default()
            },
        }
    }

    fn add_warnings(&self, scene: &Scene, ran: &mut Picture) {
        account::add_warnings(self.args, scene, ran);
        let idle = self.args.files.without_effect(&self.outputs, self.args.layers.has_beauty());
        ran.report.warnings.extend(idle);
        if let Some(replay) = self.replay {
            let told = [replay.difference(&ran.device, &ran.driver), replay.unknown_files(scene)];
            ran.report.warnings.extend(told.into_iter().flatten());
        }
    }
}

/// Prints how each texture is stored, and what was changed as its files say: orientation and colours.
fn say_textures(scene: &Scene, lines: &[String]) {
    for line in lines {
        super::notify(format_args!("texture {line}"));
    }
    for texture in scene.textures.iter().filter(|t| t.reading.orientation == OrientationUse::Apply) {
        for file in texture.content.files().into_iter().filter(|file| is_turned(file)) {
            let (name, file) = (&texture.name, file.display());
            super::notify(format_args!("texture \"{name}\": {file} was turned as its orientation says"));
        }
    }
    let is_managed = |t: &&TextureSource| {
        t.color_space == ColorSpace::Srgb && t.reading.color_profile == ProfileUse::Apply
    };
    for texture in scene.textures.iter().filter(is_managed) {
        for file in texture.content.files() {
            if let Some(profile) = color_profile(file).filter(ColorProfile::is_converted) {
                let (texture, file, name) = (&texture.name, file.display(), &profile.name);
                super::notify(format_args!(
                    "texture \"{texture}\": the colours of {file} were converted from {name} to sRGB"
                ));
            }
        }
    }
}
