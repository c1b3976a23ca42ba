//! `moire render`: renders a scene file with options into pictures and, with `--json`, one JSON
//! object of statistics. All invalid input is refused before the device starts.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use clap::Args;

use super::layers::{LayerArgs, Wanted};
use super::outputs::Outputs;
use super::overrides::Overrides;
use super::progress::Bar;
use super::report;
use super::watch;
use super::{DEVICE, MEASURING, OUTPUT, TEXTURES};
use crate::core::error::Result;
use crate::core::film::{Film, Placement};
use crate::core::progress::Progress;
use crate::core::range::Rect;
use crate::gpu::DeviceSelect;
use crate::lab::verify::known::anisotropy_fault;
use crate::output::{self, ENDING_NAMES, Format, WriteOptions};
use crate::render::{self, EstimateChoice, Kept, MipChoice, On, Options, Picture, TexelChoice, Tuning};
use crate::scene::advice;
use crate::scene::model::{Algorithm, Scene};
use crate::scene::prune::prune;
use crate::texture::read_file::is_turned;
use crate::texture::source::OrientationUse;

#[derive(Args, Debug)]
pub struct RenderArgs {
    /// Scene file or model (glTF, OBJ, PLY, STL), or - for standard input
    pub(super) scene: PathBuf,
    /// Picture to write; the ending selects the format: exr hdr (linear float), png jpg tif (sRGB). May be given
    /// several times; - is standard output [default: the scene's name with .png, in the current folder]
    #[arg(short, long = "output", value_name = "OUT", help_heading = OUTPUT)]
    output: Vec<PathBuf>,
    /// Format of what -o - writes
    #[arg(long, value_name = "FORMAT", value_parser = super::named_parser(&ENDING_NAMES, output::format_named), help_heading = OUTPUT)]
    format: Option<Format>,
    #[command(flatten)]
    layers: LayerArgs,
    #[command(flatten)]
    overrides: Overrides,
    /// Device: an index or a part of the name as `moire devices` lists them, cpu, gpu, or oracle (float64 on the CPU).
    /// May be given several times, also one device: strips of the picture are assigned to them in turn [default:
    /// discrete GPU, else integrated, else CPU]
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    device: Vec<String>,
    /// Render only this part, in pixels of the full picture
    #[arg(long, value_name = "X,Y,W,H", help_heading = OUTPUT, allow_hyphen_values = true, value_parser = parse_part)]
    crop: Option<Rect>,
    /// Build the pipeline with all features, to measure the gain of leaving some out
    #[arg(long, help_heading = MEASURING)]
    keep_everything: bool,
    /// Accept textures with NaN and infinite texels, which are otherwise errors; the pixels that show them are NaN or
    /// infinite too, and counted
    #[arg(long, help_heading = TEXTURES)]
    allow_nonfinite: bool,
    /// Where look-ups of method shader read texels
    #[arg(long, value_name = "SOURCE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(TexelChoice::NAMES, TexelChoice::from_name))]
    texels: TexelChoice,
    /// Where box mip chains of textures are generated, if their lengths are powers of two
    #[arg(long, value_name = "PLACE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(MipChoice::NAMES, MipChoice::from_name))]
    mips: MipChoice,
    /// Where errors are estimated and samples distributed with --target-error, --budget and adaptive sampling
    #[arg(long, value_name = "PLACE", help_heading = MEASURING, default_value = "auto", value_parser = super::named_parser(EstimateChoice::NAMES, EstimateChoice::from_name))]
    estimates: EstimateChoice,
    /// Workgroup shape, for measurements [default: by device]
    #[arg(long, value_name = "WxH", help_heading = MEASURING, value_parser = |s: &str| Tuning::parse_group(s).map_err(|e| e.to_string()))]
    workgroup: Option<[u32; 2]>,
    /// Bits per channel of PNG files
    #[arg(long, value_name = "BITS", help_heading = OUTPUT, default_value = "8", value_parser = ["8", "16"])]
    png_bits: String,
    /// Count on the device how often limits are exceeded: coordinates that are NaN or infinite, levels, footprints,
    /// depth; -v counts too
    #[arg(long, help_heading = MEASURING)]
    guards: bool,
    /// Render again whenever the scene or one of its files changes, until Ctrl-C
    #[arg(long, conflicts_with = "json", help_heading = OUTPUT)]
    watch: bool,
    /// Print one JSON object on stdout
    #[arg(long, help_heading = OUTPUT)]
    json: bool,
    /// Print nothing but errors
    #[arg(short, long, conflicts_with = "verbose", help_heading = OUTPUT)]
    pub(super) quiet: bool,
    /// Print what was left out and how textures are stored
    #[arg(short, long, help_heading = OUTPUT)]
    verbose: bool,
}

pub fn run(args: &RenderArgs) -> Result<ExitCode> {
    let start = Instant::now();
    let bar = Bar::new(args.quiet)?;
    let job = Job::new(args)?;
    if args.watch {
        return watch::run(&job, &bar);
    }
    let (kept, progress) = (&mut Kept::default(), Show { progress: &bar, bar: &bar, is_preview: false });
    job.render(job.stage()?, kept, &progress, start).map(|()| ExitCode::SUCCESS)
}

/// The options of a render, checked.
pub(super) struct Job<'a> {
    pub args: &'a RenderArgs,
    pub outputs: Outputs,
    on: Vec<On>,
}

/// A scene as the options change it, with what is asked of it.
pub(super) struct Stage {
    pub scene: Scene,
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
}

impl<'a> Job<'a> {
    fn new(args: &'a RenderArgs) -> Result<Job<'a>> {
        let mut on = args.device.iter().map(|text| On::parse(text)).collect::<Result<Vec<On>>>()?;
        if on.is_empty() {
            on.push(On::Device(DeviceSelect::Default));
        }
        let outputs = Outputs::new(&args.scene, &args.output, args.format, args.json)?;
        Ok(Job { args, outputs, on })
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
        let mut scene = args.overrides.load(&args.scene, args.layers.numbers_meshes())?;
        let chosen = args.overrides.apply(&mut scene)?;
        args.crop.map_or(Ok(()), |crop| crop.check_within([scene.width, scene.height]))?;
        for path in &self.outputs.files {
            output::check_writable(path)?;
            check_inputs_kept(path, &scene)?;
        }
        let wanted = Wanted::new(&args.layers, &self.outputs, &scene)?;
        let dropped = prune(&mut scene);
        Ok(Stage { scene, wanted, chosen, dropped })
    }

    /// Renders and writes all outputs. `start`: when the work on this picture began.
    pub fn render(&self, stage: Stage, kept: &mut Kept, show: &Show<'_>, start: Instant) -> Result<()> {
        let (args, on, outputs) = (self.args, &self.on[..], &self.outputs);
        let Stage { scene, wanted, chosen, dropped } = stage;
        let is_told = args.verbose && !show.is_preview;
        if let (Some(chosen), true) = (chosen, is_told) {
            super::notify(chosen);
        }
        let options = self.options(&wanted, show.is_preview);
        let placement =
            args.crop.map(|c| Placement { corner: [c.x, c.y], full: [scene.width, scene.height] });
        let png_bits = if args.png_bits == "16" { 16 } else { 8 };
        let write = WriteOptions { png_bits, placement, ..WriteOptions::default() };
        if !wanted.has_beauty {
            let layers = wanted.render(&scene, &options, on, None, show.progress)?;
            show.bar.finish();
            let size = args.crop.map_or([scene.width, scene.height], |crop| [crop.width, crop.height]);
            return wanted.write(outputs, &Film::new(size[0], size[1], 1), &layers, &scene, &write);
        }
        let loaded = start.elapsed().as_secs_f64();
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
        let layers = wanted.render(&scene, &options, on, Some(&ran), show.progress)?;
        show.bar.finish();

        let clock = Instant::now();
        wanted.write(outputs, &ran.film, &layers, &scene, &write)?;
        ran.report.seconds.write = clock.elapsed().as_secs_f64();
        ran.report.seconds.total = start.elapsed().as_secs_f64();
        let outputs = [outputs.names(), wanted.names()].concat();
        if args.json {
            let options = args.overrides.report(&scene, args.crop, args.keep_everything);
            let report = report::json(&ran, &scene, options, &outputs, args.allow_nonfinite);
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
        let warnings = &mut ran.report.warnings;
        let samples_anisotropically = advice::samples_anisotropically(scene);
        for fault in ran.devices.iter().filter(|_| samples_anisotropically).filter_map(anisotropy_fault) {
            warnings.push(format!("{fault}; --method shader reads the right ones"));
        }
        warnings.splice(..0, advice::of_scene(scene));
        let counts_follow_neighbours =
            matches!(scene.sampling.algorithm, Algorithm::Adaptive | Algorithm::Auto);
        if self.args.crop.is_some() && counts_follow_neighbours {
            warnings.push(
                "--crop with algorithm adaptive or auto: samples go where this part errs most, so its pixels differ \
                 from those of the full picture within their noise; with --algorithm samples they are equal"
                    .into(),
            );
        }
    }
}

/// Refuses an output that would overwrite an input file.
pub(super) fn check_inputs_kept(output: &Path, scene: &Scene) -> Result<()> {
    super::check_input_kept(output, &scene.path, "the scene file")?;
    scene.textures.iter().try_for_each(|t| {
        let what = format!("the file of texture \"{}\"", t.name);
        t.content.files().into_iter().try_for_each(|file| super::check_input_kept(output, file, &what))
    })
}

pub(super) fn parse_part(text: &str) -> Result<Rect, String> {
    let numbers: Vec<u32> = text.split(',').map_while(|n| n.trim().parse().ok()).collect();
    match numbers[..] {
        [x, y, width, height] if text.split(',').count() == 4 && width > 0 && height > 0 => {
            Ok(Rect { x, y, width, height })
        }
        _ => Err("expected X,Y,W,H in whole pixels, with W and H at least 1".into()),
    }
}

/// Returns lines on how each texture is stored, and which were rotated.
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
}
