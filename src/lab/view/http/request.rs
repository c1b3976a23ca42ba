//! Reads one request from a connection. Input: bytes, in any number of pieces. Output: the request, or the status that
//! refuses it: too long, too slow, or not HTTP.

use std::io::{ErrorKind, Read};
use std::net::TcpStream;
use std::time::{Duration, Instant};

/// Bytes of the request line and all headers.
const MAX_HEAD: usize = 16 << 10;
const MAX_HEADERS: usize = 64;
/// Bytes of the request line's target.
const MAX_TARGET: usize = 4 << 10;
/// Bytes of a body: settings, which are some hundred.
const MAX_BODY: usize = 64 << 10;
/// The time in which all of a request has to be there.
const PATIENCE: Duration = Duration::from_secs(10);

/// A request of HTTP/1.0 or 1.1.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Request {
    pub method: String,
    /// The target before the question mark, as it was sent.
    pub path: String,
    /// The target behind it.
    pub query: String,
    pub host: Option<String>,
    pub origin: Option<String>,
    pub body: Vec<u8>,
}

/// What a head says of the request behind it.
struct Head {
    request: Request,
    /// Bytes of the head itself.
    length: usize,
    body: usize,
}

impl Request {
    /// Reads a request; the error is the status to answer with, or none if the connection ended.
    pub fn read(stream: &mut TcpStream) -> Result<Request, Option<u16>> {
        let deadline = Instant::now() + PATIENCE;
        let mut bytes = Vec::new();
        let Head { mut request, length, body } = loop {
            if let Some(head) = parse(&bytes).map_err(Some)? {
                break head;
            }
            more(stream, &mut bytes, deadline)?;
        };
        while bytes.len() < length + body {
            more(stream, &mut bytes, deadline)?;
        }
        request.body = bytes[length..length + body].to_vec();
        Ok(request)
    }

    /// Returns the value of a key of the query, as it was sent.
    pub fn value(&self, key: &str) -> Option<&str> {
        let pairs = self.query.split('&').filter_map(|pair| pair.split_once('='));
        pairs.into_iter().find(|(own, _)| *own == key).map(|(_, value)| value)
    }

    /// Returns a value of the query as a number.
    pub fn number(&self, key: &str) -> Option<u32> {
        self.value(key)?.parse().ok()
    }
}

/// Reads what has arrived, waiting until the deadline at most.
fn more(stream: &mut TcpStream, bytes: &mut Vec<u8>, deadline: Instant) -> Result<(), Option<u16>> {
    let left = deadline.saturating_duration_since(Instant::now());
    if left.is_zero() || stream.set_read_timeout(Some(left)).is_err() {
        return Err(Some(408));
    }
    let mut piece = [0; 4096];
    match stream.read(&mut piece) {
        Ok(0) => Err(None),
        Ok(count) => {
            bytes.extend_from_slice(&piece[..count]);
            Ok(())
        }
        Err(error) if error.kind() == ErrorKind::Interrupted => Ok(()),
        Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => Err(Some(408)),
        Err(_) => Err(None),
    }
}

/// Returns the head that the bytes begin with; `None` if it is not complete yet.
fn parse(bytes: &[u8]) -> Result<Option<Head>, u16> {
    let mut headers = [httparse::EMPTY_HEADER; MAX_HEADERS];
    let mut parsed = httparse::Request::new(&mut headers);
    let length = match parsed.parse(&bytes[..bytes.len().min(MAX_HEAD)]) {
        Ok(httparse::Status::Complete(length)) => length,
        Ok(httparse::Status::Partial) if bytes.len() >= MAX_HEAD => return Err(431),
        Ok(httparse::Status::Partial) => return Ok(None),
        Err(httparse::Error::TooManyHeaders) => return Err(431),
        Err(httparse::Error::Version) => return Err(505),
        Err(_) => return Err(400),
    };
    let target = parsed.path.unwrap_or_default();
    if target.len() > MAX_TARGET {
        return Err(414);
    }
    let one = |name: &str| -> Result<Option<String>, u16> {
        let mut values = parsed.headers.iter().filter(|header| header.name.eq_ignore_ascii_case(name));
        let value = values.next().map(|header| String::from_utf8(header.value.to_vec()).map_err(|_| 400));
        // What two parties may read differently is refused.
        if values.next().is_some() { Err(400) } else { value.transpose() }
    };
    let (host, origin) = (one("host")?, one("origin")?);
    if one("transfer-encoding")?.is_some() {
        return Err(501);
    }
    let method = parsed.method.unwrap_or_default().to_owned();
    let body = match one("content-length")? {
        Some(text) if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) => return Err(400),
        Some(text) => text.parse().unwrap_or(usize::MAX),
        None if method == "POST" => return Err(411),
        None => 0,
    };
    if body > MAX_BODY {
        return Err(413);
    }
    let (path, query) = target.split_once('?').unwrap_or((target, ""));
    let (path, query) = (path.to_owned(), query.to_owned());
    Ok(Some(Head { request: Request { method, path, query, host, origin, body: Vec::new() }, length, body }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status(text: &str) -> u16 {
        parse(text.as_bytes()).err().expect("it is refused")
    }

    #[test]
    fn a_head_is_read_once_it_is_complete() {
        let text = "POST /a/set?tab=1f&side=b HTTP/1.1\r\nHost: localhost:1\r\ncontent-length: 3\r\n\r\nabc";
        for end in 0..text.len() - 3 {
            assert!(parse(&text.as_bytes()[..end]).unwrap().is_none(), "{end}");
        }
        let Head { request, length, body } = parse(text.as_bytes()).unwrap().unwrap();
        assert_eq!((request.path.as_str(), body), ("/a/set", 3));
        assert_eq!(&text[length..], "abc");
        assert_eq!(
            (request.value("side"), request.value("sid"), request.number("tab")),
            (Some("b"), None, None)
        );
        assert_eq!(request.host.as_deref(), Some("localhost:1"));
    }

    #[test]
    fn what_is_too_long_or_ambiguous_is_refused() {
        let long = "a".repeat(MAX_HEAD);
        assert_eq!(status(&format!("GET / HTTP/1.1\r\nx: {long}")), 431);
        assert_eq!(status(&format!("GET /{long}")), 431);
        assert_eq!(status(&format!("GET /{} HTTP/1.1\r\n\r\n", "a".repeat(MAX_TARGET))), 414);
        assert_eq!(status(&format!("GET / HTTP/1.1\r\n{}\r\n", "x: y\r\n".repeat(MAX_HEADERS + 1))), 431);
        assert_eq!(status("GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"), 400);
        assert_eq!(status("POST / HTTP/1.1\r\nContent-Length: 1\r\nContent-Length: 1\r\n\r\n"), 400);
        assert_eq!(status("POST / HTTP/1.1\r\nContent-Length: +1\r\n\r\n"), 400);
        assert_eq!(status("POST / HTTP/1.1\r\nContent-Length: 99999999999999999999999\r\n\r\n"), 413);
        assert_eq!(status("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 501);
        assert_eq!(status("POST / HTTP/1.1\r\n\r\n"), 411);
        assert_eq!(status("GET / HTTP/7.1\r\n\r\n"), 505);
        assert_eq!(status("\u{0}\u{1}\r\n\r\n"), 400);
        assert_eq!(status("GET / HTTP/1.1\r\n no name\r\n\r\n"), 400);
    }
}
