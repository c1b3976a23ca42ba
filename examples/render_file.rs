//! Renders a scene file: `cargo run --release --example render_file -- SCENE OUT [DEVICE]`. The ending of OUT chooses
//! the format; DEVICE is an index, a part of a name, `cpu`, `gpu` or `oracle`.

use std::env;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU32, Ordering};

use moire::{Error, ErrorKind, Progress, RenderOptions, Renderer, Scene};

/// Prints a dot for each tenth of the work.
struct Dots(AtomicU32);

impl Progress for Dots {
    fn advance(&self, done: f64) {
        let tenths = (done * 10.0) as u32;
        if self.0.fetch_max(tenths, Ordering::Relaxed) < tenths {
            eprint!(".");
        }
    }

    fn cancelled(&self) -> bool {
        false
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let (scene, out, device) = match &arguments[..] {
        [scene, out] => (scene, out, None),
        [scene, out, device] => (scene, out, Some(device.as_str())),
        _ => {
            eprintln!("use: render_file SCENE OUT [DEVICE]");
            return ExitCode::from(2);
        }
    };
    match render(scene, out, device) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            if let Some(help) = error.help() {
                eprintln!("{help}");
            }
            ExitCode::from(2)
        }
    }
}

/// Renders once, and once more on a CPU driver where the device fails in a way that may pass.
pub fn render(scene: &str, out: &str, device: Option<&str>) -> Result<(), Error> {
    let scene = Scene::from_file(scene)?;
    let mut options = RenderOptions::new();
    if let Some(device) = device {
        options = options.device(device);
    }
    let dots = Dots(AtomicU32::new(0));
    let rendered = Renderer::new(options.clone())
        .and_then(|renderer| renderer.render_with(&scene, &dots))
        .or_else(|error| match error.kind() {
            ErrorKind::DeviceLost | ErrorKind::OutOfDeviceMemory => {
                Renderer::new(options.device("cpu"))?.render_with(&scene, &dots)
            }
            _ => Err(error),
        });
    let (film, report) = rendered?;
    eprintln!(
        "\n{}×{} pixels of {} samples in {:.2} s on {}",
        film.width, film.height, report.samples, report.seconds, report.device
    );
    report.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
    film.save(out)
}
