//! A page on the loopback address that renders a scene while one looks: two settings side by side, refined sample by
//! sample, and what each pixel is made of. Input: a scene file and the device. Output: an address, and answers until it
//! is stopped.

mod choices;
mod device;
mod files;
mod http;
mod inspector;
mod means;
mod own_value;
mod pixel;
mod queue;
mod refinement;
mod routes;
mod settings;
mod shown;
mod tabs;
mod texel;
mod textures;
mod window;

use std::fmt::Write;
use std::sync::{Arc, mpsc};
use std::thread::JoinHandle;

pub use http::Stop;
pub use routes::{Recorded, Recorder};
pub use settings::{Settings, Source};

use crate::core::error::{Error, ErrorKind, Result};
use crate::render::On;
use http::Server;
use queue::Queue;
use routes::Routes;
use tabs::Tabs;
use textures::Textures;

/// Samples a pixel up to which a picture refines, unless the scene or the page names more.
const SAMPLES: u32 = 256;
/// Bytes of the secret part of the address.
const TOKEN_BYTES: usize = 16;

/// A page that is served.
pub struct Page {
    /// Where a browser finds it.
    pub address: String,
    queue: Arc<Queue>,
    device: JoinHandle<()>,
}

impl Page {
    /// Serves a scene; `port` 0 is a free one. Fails if the scene, the device or the port cannot be had.
    pub fn open(source: Source, first: Settings, on: &On, port: u16, recorder: Recorder) -> Result<Page> {
        // Refuses what is wrong before the device starts; the menus then say what the scene has without these options.
        first.load(&source, false)?;
        first.display()?;
        let scene = Settings { set: first.set.clone(), ..Settings::default() }.load(&source, false)?;
        let server = Server::open(port).map_err(|error| {
            let what = format!("port {port} of 127.0.0.1: {error}");
            Error::with_help(what, "choose another one with --port, or leave it out for a free one")
                .of_kind(ErrorKind::Unsupported)
        })?;
        let queue = Arc::new(Queue::default());
        let tabs = Arc::new(Tabs::new(source, first, queue.clone()));
        let textures = Arc::new(Textures::default());
        let (sender, opened) = mpsc::channel();
        let work = {
            let (queue, tabs, textures, on) = (queue.clone(), tabs.clone(), textures.clone(), on.clone());
            move || device::work(&on, &queue, &textures, &sender, &|| tabs.notify())
        };
        let failed = |error: std::io::Error| Error::new(format!("a thread cannot be started: {error}"));
        let device = std::thread::Builder::new().name("device".into()).spawn(work).map_err(failed)?;
        let names = opened.recv().unwrap_or_else(|_| Err(Error::new("the device's thread has ended")))?;
        let token = token()?;
        let address = format!("http://127.0.0.1:{}/{token}/", server.port());
        let routes = Routes { tabs, token, names, scene, textures, recorder };
        server.run(Arc::new(move |request| routes.answer(request))).map_err(failed)?;
        Ok(Page { address, queue, device })
    }

    /// Ends rendering, after the slice that the device works at.
    pub fn close(self) {
        self.queue.stop();
        // A panic there was told when it happened.
        let _ = self.device.join();
    }
}

/// Returns a number that nobody guesses, as hexadecimal digits.
fn token() -> Result<String> {
    let mut bytes = [0; TOKEN_BYTES];
    getrandom::fill(&mut bytes)
        .map_err(|error| Error::new(format!("the system has no random numbers: {error}")))?;
    let mut text = String::new();
    for byte in bytes {
        // Text takes all that is written.
        let _ = write!(text, "{byte:02x}");
    }
    Ok(text)
}
