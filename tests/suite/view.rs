//! `moire view`: the program serves a page, and tests are its clients, by bare sockets and by a browser.

mod browser;
mod chromium;
mod display;
mod ends;
mod gestures;
mod pictures;
mod pixels;
mod requests;
mod texels;
mod windows;

use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, absolute};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::{Value, json};

use crate::child::{HANG, Running};
use crate::stage::{device_name, path};
use crate::support::program;

/// A scene that is served.
pub struct View {
    pub running: Running,
    pub port: u16,
    pub token: String,
}

/// An answer.
pub struct Reply {
    pub status: u16,
    pub head: String,
    pub body: Vec<u8>,
}

impl Reply {
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.body).into_owned()
    }

    pub fn json(&self) -> Value {
        serde_json::from_slice(&self.body).unwrap_or_else(|_| panic!("no JSON: {}", self.text()))
    }
}

impl View {
    /// Serves a scene of the repository on the device under test.
    pub fn of(scene: &str, arguments: &[&str]) -> View {
        let scene = absolute(path(scene)).unwrap();
        View::of_file(&scene, &[&["--device", &device_name()], arguments].concat())
    }

    pub fn of_file(scene: &Path, arguments: &[&str]) -> View {
        let mut command = Command::new(absolute(program()).unwrap());
        command.arg("view").arg(scene).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut running = Running::start(&mut command);
        let line = running.first_line();
        let Some((port, token)) =
            line.strip_prefix("http://127.0.0.1:").and_then(|rest| rest.split_once('/'))
        else {
            panic!("no address: {line:?}, {:?}", String::from_utf8_lossy(&running.output(HANG).stderr));
        };
        let (port, token) = (port.parse().unwrap(), token.trim_end().trim_end_matches('/').to_owned());
        View { running, port, token }
    }

    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/{}/", self.port, self.token)
    }

    pub fn connect(&self) -> TcpStream {
        let stream = TcpStream::connect(("127.0.0.1", self.port)).unwrap();
        stream.set_read_timeout(Some(HANG)).unwrap();
        stream
    }

    /// Sends bytes and reads the answer; empty and of status 0 where there is none.
    pub fn raw(&self, request: &[u8]) -> Reply {
        let mut stream = self.connect();
        // Of what is too long, the rest may be refused.
        let _ = stream.write_all(request);
        let mut bytes = Vec::new();
        let _ = stream.read_to_end(&mut bytes);
        let Some(end) = bytes.windows(4).position(|four| four == b"\r\n\r\n") else {
            return Reply { status: 0, head: String::new(), body: bytes };
        };
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        Reply { status, head, body: bytes[end + 4..].to_vec() }
    }

    /// Asks for a path behind the token.
    pub fn get(&self, path: &str) -> Reply {
        let Self { port, token, .. } = self;
        self.raw(format!("GET /{token}/{path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\n\r\n").as_bytes())
    }

    /// Gives a side of a tab settings; returns the complaint about them.
    pub fn set(&self, tab: &str, side: &str, options: Value, set: &[&str]) -> Option<String> {
        let body = json!({ "options": options, "set": set }).to_string();
        let Self { port, token, .. } = self;
        let head = format!(
            "POST /{token}/set?tab={tab}&side={side} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: {}\r\n\r\n",
            body.len()
        );
        let reply = self.raw(format!("{head}{body}").as_bytes());
        assert_eq!(reply.status, 200, "{}", reply.text());
        reply.json()["error"].as_str().map(String::from)
    }

    /// Opens a tab, which lives as long as what is returned.
    pub fn tab(&self, name: &str) -> Events {
        let mut stream = self.connect();
        let Self { port, token, .. } = self;
        let request = format!("GET /{token}/events?tab={name} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n");
        stream.write_all(request.as_bytes()).unwrap();
        let mut events = Events { stream, bytes: Vec::new(), last: Value::Null };
        events.next();
        events
    }
}

/// The events of a tab.
pub struct Events {
    stream: TcpStream,
    bytes: Vec<u8>,
    /// The newest state that was read.
    last: Value,
}

impl Events {
    /// Returns the next state.
    pub fn next(&mut self) -> Value {
        loop {
            if let Some(end) = self.bytes.windows(2).position(|two| two == b"\n\n") {
                let event: Vec<u8> = self.bytes.drain(..end + 2).collect();
                let text = String::from_utf8(event).unwrap();
                if let Some(data) = text.trim().lines().find_map(|line| line.strip_prefix("data: ")) {
                    self.last = serde_json::from_str(data).unwrap();
                    return self.last.clone();
                }
                continue;
            }
            let mut piece = [0; 4096];
            let count = self.stream.read(&mut piece).unwrap();
            assert!(count > 0, "the events end");
            self.bytes.extend_from_slice(&piece[..count]);
        }
    }

    /// Returns the first state that is as wanted.
    pub fn until(&mut self, is_wanted: impl Fn(&Value) -> bool) -> Value {
        let start = Instant::now();
        while !is_wanted(&self.last) {
            assert!(start.elapsed() < HANG, "still {}", self.last);
            self.next();
        }
        self.last.clone()
    }

    /// Returns the state in which all pictures are done.
    pub fn done(&mut self) -> Value {
        self.until(|state| state["sides"].as_array().unwrap().iter().all(is_over))
    }
}

/// Gives a side of tab `t` settings and waits for all pictures of it; returns its last state.
pub fn refined(view: &View, tab: &mut Events, side: usize, options: Value, set: &[&str]) -> Value {
    let old = tab.last["sides"][side]["number"].clone();
    assert_eq!(view.set("t", ["a", "b"][side], options, set), None);
    let state = tab.until(|state| state["sides"][side]["number"] != old && is_over(&state["sides"][side]));
    state["sides"][side].clone()
}

pub fn is_over(side: &Value) -> bool {
    side["next"].is_null()
}

/// Waits until something holds.
pub fn wait_until(mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < HANG, "nothing has happened for {HANG:?}");
        std::thread::sleep(Duration::from_millis(50));
    }
}
