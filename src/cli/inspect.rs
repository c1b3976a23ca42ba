//! `moire inspect SCENE`: every layer of a view as a picture, all of them in one EXR file, and a page on what
//! the view reads of its textures. All invalid input is refused before the device starts.

use std::path::PathBuf;
use std::process::ExitCode;

use super::inputs::Inputs;
use super::outputs::folder_or_default;
use super::overrides::Overrides;
use super::progress::Bar;
use super::{DEVICE, OUTPUT, REPORT};
use crate::core::counted::counted;
use crate::core::error::Result;
use crate::gpu::DeviceSelect;
use crate::lab::inspect::{self, EXR, PAGE};
use crate::render::{On, Options};
use crate::scene::prune::prune;

/// What the default name of the folder has behind the scene's.
const FOLDER: &str = "inspect";

/// Show what a view needs of its textures, and settings for it
///
/// Writes every layer of `moire render --aov` as a false-colour picture, layers.exr with all of them as numbers, and
/// index.html, which says for each texture how densely it is seen, which levels and texels are read, whether it is larger
/// or smaller than needed and whether its charts bleed, and recommends filter, footprint and samples.
#[derive(clap::Args, Debug)]
pub struct InspectArgs {
    /// Scene file or model
    scene: PathBuf,
    /// Folder for the results [default: the scene's name with -inspect, in the current folder]
    ///
    /// Its last component is created if it is missing.
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    out: Option<PathBuf>,
    #[command(flatten)]
    overrides: Overrides,
    /// Device: index, part of its name, cpu, gpu or oracle [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them; oracle is float64 on the CPU.
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    device: Option<String>,
    /// Print nothing but errors
    #[arg(short, long, help_heading = REPORT)]
    quiet: bool,
}

pub fn run(args: &InspectArgs) -> Result<ExitCode> {
    let bar = Bar::new(args.quiet)?;
    let on = match &args.device {
        Some(text) => On::parse(text)?,
        None => On::Device(DeviceSelect::Default),
    };
    let out = folder_or_default(args.out.as_deref(), &args.scene, FOLDER, &[EXR])?;
    let mut scene = args.overrides.load(&args.scene, true)?;
    args.overrides.apply(&mut scene)?;
    let files = inspect::files();
    let _folder = Inputs::of_scene(&scene).prepare_folder(&out, PAGE, files.iter().map(String::as_str))?;
    prune(&mut scene);
    let options = Options { goal: args.overrides.goal(), ..Options::default() };
    let inspection = inspect::inspect(&scene, &options, &[on], &bar)?;
    bar.finish();
    let files = inspect::write(&out, &scene, &inspection, &args.overrides.view())?;
    if !args.quiet {
        inspection.left_out.iter().for_each(|why| super::notify(format_args!("left out: {why}")));
        super::notify(format_args!(
            "{} in {}, the page is {PAGE}",
            counted(files.len(), "file"),
            out.display()
        ));
        let sizes = inspect::page::sizes(&scene, &inspection);
        super::print(&[vec![inspection.advice.sentence.clone()], sizes].concat().join("\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}
