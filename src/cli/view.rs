//! `moire view SCENE`: serves a page on the loopback address that renders the scene while one looks. All invalid input is
//! refused before the device starts.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use clap::FromArgMatches;

use super::checksums::Checksums;
use super::display::DisplayArgs;
use super::overrides::Overrides;
use super::record::Renderer;
use super::render_args::RenderArgs;
use super::replay;
use super::{DEVICE, REPORT};
use crate::core::error::{Error, Result};
use crate::gpu::DeviceSelect;
use crate::lab::view::{Page, Recorded, Settings, Source, Stop};
use crate::render::On;
use crate::scene::prune::prune;
use crate::scene::{self, is_standard_input};

/// Heading of the options of the server.
const SERVE: &str = "Serve the page";

/// Show a scene in a browser, refined while one looks
///
/// Prints the address of a page that only this machine can open, and serves it until Ctrl-C. The page shows the picture
/// as it refines, menus for all options, two settings with a wipe between them, what single pixels are made of, error
/// against time, and the command that renders the same picture. From another machine: ssh -L 8000:127.0.0.1:8000.
#[derive(clap::Args, Debug)]
pub struct ViewArgs {
    /// Scene file or model
    scene: PathBuf,
    /// Port of 127.0.0.1 at which the page is served [default: a free one]
    #[arg(long, value_name = "PORT", default_value = "0", hide_default_value = true, help_heading = SERVE)]
    port: u16,
    #[command(flatten)]
    overrides: Overrides,
    #[command(flatten)]
    display: DisplayArgs,
    /// Device: index, part of its name, cpu, gpu or oracle [default: discrete GPU, else integrated, else CPU]
    ///
    /// `moire devices` lists them; oracle is float64 on the CPU.
    #[arg(long, value_name = "SEL", help_heading = DEVICE)]
    device: Option<String>,
    /// Print nothing but the address and errors
    #[arg(short, long, help_heading = REPORT)]
    quiet: bool,
}

pub fn run(args: &ViewArgs) -> Result<ExitCode> {
    if is_standard_input(&args.scene) {
        return Err(Error::with_help(
            "a view needs a scene file: it is read again for every setting",
            "write the scene to a file first",
        ));
    }
    if args.overrides.goal().is_some() {
        return Err(Error::with_help(
            "a view refines until it is stopped: it takes no --budget and no --target-error",
            "leave them out; the page shows the error against time",
        ));
    }
    let on = match &args.device {
        Some(text) => On::parse(text)?,
        None => On::Device(DeviceSelect::Default),
    };
    let stop = Arc::new(Stop::default());
    let stopping = stop.clone();
    ctrlc::set_handler(move || stopping.stop())
        .map_err(|e| Error::new(format!("cannot listen to Ctrl-C: {e}")))?;
    let camera = args.overrides.camera();
    let source = Source { path: args.scene.clone(), camera, device: args.device.clone() };
    let display = args.display.given().into_iter().map(|(name, value)| (name.to_owned(), value));
    let options = args.overrides.options().chain(display).collect();
    let first = Settings { options, set: args.overrides.settings() };
    let page = Page::open(source, first, &on, args.port, Box::new(record))?;
    super::print(&page.address)?;
    if !args.quiet {
        super::notify("open it in a browser of this machine; Ctrl-C ends it");
    }
    stop.wait();
    page.close();
    Ok(ExitCode::from(130))
}

/// Returns the record that `moire render` writes of a picture with those arguments.
fn record(recorded: &Recorded<'_>) -> Result<String> {
    let failed = |error: clap::Error| Error::new(error.to_string());
    let words = ["moire render"].into_iter().chain(recorded.arguments.iter().map(String::as_str));
    let matches = replay::command().try_get_matches_from(words).map_err(failed)?;
    let args = RenderArgs::from_arg_matches(&matches).map_err(failed)?;
    let path = args.scene.clone().unwrap_or_default();
    let (mut scene, file) = scene::load_recorded(&path, &args.overrides.reading(false))?;
    args.overrides.apply(&mut scene)?;
    prune(&mut scene);
    let files = Checksums::begin(&scene).finish().named(&[]);
    let Recorded { device, driver, samples, .. } = *recorded;
    let by = Renderer { device, driver, samples, outcome: None };
    Ok(replay::record_of(&args, &matches, (&path, file), files, &scene, &by).text())
}
