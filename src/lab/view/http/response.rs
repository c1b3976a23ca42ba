//! The answer to a request: a status, a type and a body, with headers that keep the page to itself: no other site may
//! frame it, nothing is kept, no script but its own runs.

use std::io::{self, Write};
use std::net::TcpStream;
use std::time::Duration;

/// The time in which a client has to take a piece of an answer.
const PATIENCE: Duration = Duration::from_secs(10);

/// What a page may load: its own script, style, pictures and data; pictures within data, too.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; \
                      connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A whole answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Response {
    pub status: u16,
    pub kind: &'static str,
    pub body: Vec<u8>,
}

impl Response {
    pub fn new(kind: &'static str, body: impl Into<Vec<u8>>) -> Response {
        Response { status: 200, kind, body: body.into() }
    }

    pub fn json(value: &serde_json::Value) -> Response {
        Response::new("application/json", value.to_string())
    }

    /// Returns an answer without a body.
    pub fn nothing() -> Response {
        Response { status: 204, kind: "text/plain", body: Vec::new() }
    }

    /// Returns an answer that refuses, with a sentence for a person.
    pub fn refusal(status: u16, why: &str) -> Response {
        Response { status, kind: "text/plain; charset=utf-8", body: format!("{why}\n").into_bytes() }
    }

    /// Returns the answer to what is no request that this server takes.
    pub fn of_status(status: u16) -> Response {
        Response::refusal(status, reason(status))
    }

    /// Sends the answer; `has_body` is false for what was asked by HEAD.
    pub fn send(&self, stream: &mut TcpStream, has_body: bool) -> io::Result<()> {
        let mut bytes =
            head(self.status, self.kind, (self.status != 204).then_some(self.body.len())).into_bytes();
        if has_body {
            bytes.extend_from_slice(&self.body);
        }
        stream.set_write_timeout(Some(PATIENCE))?;
        stream.write_all(&bytes)
    }
}

/// Begins an answer that goes on with events (server-sent events) until the connection ends.
pub fn begin_events(stream: &mut TcpStream) -> io::Result<()> {
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.set_nodelay(true)?;
    stream.write_all(head(200, "text/event-stream", None).as_bytes())
}

fn head(status: u16, kind: &str, length: Option<usize>) -> String {
    let length = length.map_or(String::new(), |length| format!("Content-Length: {length}\r\n"));
    let allow = if status == 405 { "Allow: GET, HEAD, POST\r\n" } else { "" };
    format!(
        "HTTP/1.1 {status} {}\r\nContent-Type: {kind}\r\n{length}{allow}Connection: close\r\nCache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\nCross-Origin-Resource-Policy: same-origin\r\n\
         Content-Security-Policy: {POLICY}\r\n\r\n",
        reason(status)
    )
}

fn reason(status: u16) -> &'static str {
    match status {
        200 => "OK",
        204 => "No Content",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        411 => "Length Required",
        413 => "Content Too Large",
        414 => "URI Too Long",
        421 => "Misdirected Request",
        431 => "Request Header Fields Too Large",
        501 => "Not Implemented",
        503 => "Service Unavailable",
        505 => "HTTP Version Not Supported",
        _ => "Internal Server Error",
    }
}
