//! The addresses of the page: its own files, which are parts of the program, and what the scene's pictures say. No file
//! of the machine is served. Input: a request. Output: the answer, or the status that refuses it.

use std::hint::black_box;
use std::net::IpAddr;
use std::sync::Arc;

use serde_json::{Value, json};

use super::choices::described;
use super::device::{Names, told};
use super::http::{Answer, Request, Response};
use super::pixel::pixel;
use super::settings::Settings;
use super::shown::Shown;
use super::tabs::{Side, Tabs};
use super::textures::Textures;
use crate::core::error::{Error, Result};
use crate::scene::model::Scene;

/// The files of the page: path, type, content.
const PAGE: [(&str, &str, &str); 11] = [
    ("", "text/html; charset=utf-8", include_str!("page/index.html")),
    ("style.css", "text/css; charset=utf-8", include_str!("page/style.css")),
    ("main.js", SCRIPT, include_str!("page/main.js")),
    ("dom.js", SCRIPT, include_str!("page/dom.js")),
    ("commands.js", SCRIPT, include_str!("page/commands.js")),
    ("menus.js", SCRIPT, include_str!("page/menus.js")),
    ("picture.js", SCRIPT, include_str!("page/picture.js")),
    ("pictures.js", SCRIPT, include_str!("page/pictures.js")),
    ("pointer.js", SCRIPT, include_str!("page/pointer.js")),
    ("pixel.js", SCRIPT, include_str!("page/pixel.js")),
    ("chart.js", SCRIPT, include_str!("page/chart.js")),
];
const SCRIPT: &str = "text/javascript; charset=utf-8";

/// What a record says of a picture.
pub struct Recorded<'a> {
    /// The arguments of `moire render` that make it.
    pub arguments: Vec<String>,
    pub device: &'a str,
    pub driver: &'a str,
    /// Samples a pixel.
    pub samples: u32,
}

/// Returns the record of a picture.
pub type Recorder = Box<dyn Fn(&Recorded<'_>) -> Result<String> + Send + Sync>;

/// What answers requests.
pub struct Routes {
    pub tabs: Arc<Tabs>,
    /// The secret part of the address.
    pub token: String,
    /// What renders.
    pub names: Names,
    /// The scene as its file has it, with the program's own settings.
    pub scene: Scene,
    pub textures: Arc<Textures>,
    pub recorder: Recorder,
}

impl Routes {
    pub fn answer(&self, request: &Request) -> Answer {
        self.answered(request).unwrap_or_else(|status| {
            Answer::Whole(match status {
                403 => {
                    Response::refusal(403, "open the whole address that moire view printed, with its token")
                }
                421 => Response::refusal(421, "moire view answers to the loopback address only"),
                status => Response::of_status(status),
            })
        })
    }

    fn answered(&self, request: &Request) -> std::result::Result<Answer, u16> {
        // A page of another site may have a name of its own lead to this machine.
        if !request.host.as_deref().is_some_and(is_loopback) {
            return Err(421);
        }
        let own_origin = |origin: &str| origin.strip_prefix("http://").is_some_and(is_loopback);
        if !request.origin.as_deref().is_none_or(own_origin) {
            return Err(403);
        }
        let rest = request.path.strip_prefix('/').unwrap_or_default();
        let (token, path) = rest.split_once('/').ok_or(403u16)?;
        if !is_same(token.as_bytes(), self.token.as_bytes()) {
            return Err(403);
        }
        let whole = |response| Ok(Answer::Whole(response));
        // An answer to HEAD is sent without its body.
        let method = if request.method == "HEAD" { "GET" } else { request.method.as_str() };
        match (method, path) {
            ("POST", "set") => whole(self.set(request)),
            ("POST", "swap") => whole(self.swap(request)),
            ("GET", "set" | "swap") | ("POST", _) => Err(405),
            ("GET", "page") => whole(self.page()),
            ("GET", "events") => self.events(request),
            ("GET", "picture") => whole(self.picture(request)?),
            ("GET", "pixel") => whole(self.pixel(request)?),
            ("GET", path) => {
                let (_, kind, text) = PAGE.iter().find(|(own, ..)| *own == path).ok_or(404u16)?;
                whole(Response::new(kind, *text))
            }
            _ => Err(405),
        }
    }

    /// Returns what all tabs show alike.
    fn page(&self) -> Response {
        let source = self.tabs.source();
        let first = self.tabs.first();
        Response::json(&json!({
            "scene": source.path.display().to_string(),
            "device": self.names.device,
            "version": env!("CARGO_PKG_VERSION"),
            "choices": described(&self.scene),
            "first": { "options": first.options, "set": first.set },
        }))
    }

    fn events(&self, request: &Request) -> std::result::Result<Answer, u16> {
        match self.tabs.open(request.value("tab").unwrap_or_default()) {
            Ok(events) => Ok(Answer::Events(Box::new(events))),
            Err(error) => Ok(Answer::Whole(Response::refusal(503, &told(&error)))),
        }
    }

    fn side(&self, request: &Request) -> std::result::Result<Side, u16> {
        let side = side_of(request).ok_or(400u16)?;
        self.tabs.side(request.value("tab").ok_or(400u16)?, side).ok_or(404)
    }

    /// Changes a side's settings. What is wrong with them is an answer, as it is nothing that a browser should report.
    fn set(&self, request: &Request) -> Response {
        let set = || -> Result<u64> {
            let value: Value = serde_json::from_slice(&request.body)
                .map_err(|error| Error::new(format!("the settings are not JSON: {error}")))?;
            let side = side_of(request).ok_or_else(|| Error::new("expected side=a or side=b"))?;
            self.tabs.set(request.value("tab").unwrap_or_default(), side, Settings::from_json(&value)?)
        };
        match set() {
            Ok(number) => Response::json(&json!({ "error": null, "number": number })),
            Err(error) => Response::json(&json!({ "error": told(&error) })),
        }
    }

    /// Exchanges the sides, with their films.
    fn swap(&self, request: &Request) -> Response {
        let swapped = self.tabs.swap(request.value("tab").unwrap_or_default());
        Response::json(&json!({ "error": swapped.err().map(|error| told(&error)) }))
    }

    /// Returns a side's newest picture; nothing while there is none, as after a setting that the page does not know yet.
    fn picture(&self, request: &Request) -> std::result::Result<Response, u16> {
        let side = self.side(request)?;
        let Some(shown) = side.refinement.shown() else { return Ok(Response::nothing()) };
        let png = match request.value("file") {
            Some(_) => shown.file(&side.display, self.record(&side, &shown).as_deref()),
            None => shown.png(&side.display).map(|png| png.to_vec()),
        };
        Ok(match png {
            Ok(png) => Response::new("image/png", png),
            Err(error) => Response::refusal(500, &told(&error)),
        })
    }

    /// Returns the record of a side's picture; none if the scene file has changed since, or cannot be read.
    fn record(&self, side: &Side, shown: &Shown) -> Option<String> {
        let source = self.tabs.source();
        let is_same = side.refinement.stamp == source.stamp();
        let recorded = Recorded {
            arguments: side.arguments(source, shown.count),
            device: &self.names.device,
            driver: &self.names.driver,
            samples: shown.film.samples,
        };
        is_same.then(|| (self.recorder)(&recorded))?.ok()
    }

    fn pixel(&self, request: &Request) -> std::result::Result<Response, u16> {
        let side = self.side(request)?;
        let place = [request.number("x"), request.number("y")];
        let [Some(x), Some(y)] = place else { return Err(400) };
        if x >= side.refinement.scene.width || y >= side.refinement.scene.height {
            return Err(404);
        }
        Ok(Response::json(&match pixel(&side, self.tabs.source(), &self.textures, [x, y]) {
            Ok(value) => value,
            Err(error) => json!({ "error": told(&error) }),
        }))
    }
}

fn side_of(request: &Request) -> Option<usize> {
    ["a", "b"].iter().position(|name| request.value("side") == Some(name))
}

/// Returns true for a host, with a port or without, that is this machine by its loopback address.
fn is_loopback(host: &str) -> bool {
    let (name, port) = match host.rsplit_once(':') {
        Some((name, port)) if !name.is_empty() && !port.ends_with(']') => (name, port),
        _ => (host, "0"),
    };
    let name = name.strip_prefix('[').and_then(|name| name.strip_suffix(']')).unwrap_or(name);
    let is_own = name.eq_ignore_ascii_case("localhost")
        || name.parse::<IpAddr>().is_ok_and(|address| address.is_loopback());
    is_own && port.parse::<u16>().is_ok()
}

/// Compares in a time that does not tell where the two differ.
fn is_same(a: &[u8], b: &[u8]) -> bool {
    let differing = a.iter().zip(b).fold(0, |bits, (a, b)| black_box(bits | (a ^ b)));
    a.len() == b.len() && black_box(differing) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hosts_of_this_machine_are_told_from_others() {
        for host in
            ["localhost", "localhost:80", "LOCALHOST:1", "127.0.0.1:5000", "127.9.9.9", "[::1]:8", "[::1]"]
        {
            assert!(is_loopback(host), "{host}");
        }
        let others =
            ["", ":80", "evil.example", "127.0.0.1.evil.example:80", "localhost.evil.example", "0.0.0.0"];
        for host in others.into_iter().chain(["192.168.0.1:80", "localhost:x", "127.0.0.1@evil", "[::2]:1"]) {
            assert!(!is_loopback(host), "{host}");
        }
    }

    #[test]
    fn secrets_are_compared_whole() {
        assert!(is_same(b"abc", b"abc"));
        assert!(!is_same(b"abc", b"abd") && !is_same(b"abc", b"ab") && !is_same(b"", b"a"));
    }
}
