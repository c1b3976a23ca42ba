//! Accepts connections on the loopback address and answers each in a thread of its own, up to a number; one that says
//! nothing holds up no other, and makes room where there are too many. Input: what answers requests. Ends when it is told
//! to.

use std::io::{self, Read, Write};
use std::net::{Ipv4Addr, Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::request::Request;
use super::response::{Response, begin_events};
use crate::core::error::Result;
use crate::core::panics;

/// Connections that are open at once. Of more, the one that has waited longest without a request is closed; where all have
/// made theirs, the new one is answered that there are too many.
const MAX_CONNECTIONS: usize = 256;
/// After the system has refused a connection, as when files are short.
const PAUSE: Duration = Duration::from_millis(50);
/// The time in which what a refused client still sends is read away: an answer is lost if data is left unread.
const FAREWELL: Duration = Duration::from_millis(500);

/// The answer to a request.
pub enum Answer {
    Whole(Response),
    /// Events, each a line of text, for as long as there are any; an empty one only asks whether the client is there.
    Events(Box<dyn Iterator<Item = String>>),
}

/// Whether the program is to end, and who waits for it.
#[derive(Default)]
pub struct Stop {
    stopped: Mutex<bool>,
    wake: Condvar,
}

impl Stop {
    /// Ends all that waits.
    pub fn stop(&self) {
        *self.stopped.lock().unwrap_or_else(PoisonError::into_inner) = true;
        self.wake.notify_all();
    }

    /// Waits for the end.
    pub fn wait(&self) {
        let mut stopped = self.stopped.lock().unwrap_or_else(PoisonError::into_inner);
        while !*stopped {
            stopped = self.wake.wait(stopped).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// A socket that listens.
pub struct Server {
    listener: TcpListener,
    port: u16,
}

impl Server {
    /// Listens on a port of the loopback address; 0 is a free one.
    pub fn open(port: u16) -> io::Result<Server> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))?;
        let port = listener.local_addr()?.port();
        Ok(Server { listener, port })
    }

    pub fn port(&self) -> u16 {
        self.port
    }

    /// Answers connections from a thread of its own, until the process ends.
    pub fn run(self, answer: Arc<dyn Fn(&Request) -> Answer + Send + Sync>) -> io::Result<()> {
        let accept = move || {
            let open = Arc::new(Connections::default());
            for (number, stream) in (0..).zip(self.listener.incoming()) {
                match stream {
                    Ok(stream) => admit(stream, number, &open, &answer),
                    Err(_) => std::thread::sleep(PAUSE),
                }
            }
        };
        std::thread::Builder::new().name("accept".into()).spawn(accept).map(drop)
    }
}

/// Connections that are open, and those of them whose request is not there yet, in the order in which they came.
#[derive(Default)]
struct Connections {
    count: AtomicUsize,
    waiting: Mutex<Vec<(u64, TcpStream)>>,
}

impl Connections {
    fn waiting(&self) -> MutexGuard<'_, Vec<(u64, TcpStream)>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Closes the one that has waited longest; returns false if none waits.
    fn make_room(&self) -> bool {
        let mut waiting = self.waiting();
        if waiting.is_empty() {
            return false;
        }
        // Its thread then reads the end.
        let _ = waiting.remove(0).1.shutdown(Shutdown::Both);
        true
    }

    /// Notes that a connection waits no longer.
    fn heard(&self, number: u64) {
        self.waiting().retain(|(own, _)| *own != number);
    }
}

/// Counts an open connection until it is dropped.
struct Place {
    number: u64,
    open: Arc<Connections>,
}

impl Drop for Place {
    fn drop(&mut self) {
        self.open.heard(self.number);
        self.open.count.fetch_sub(1, Ordering::AcqRel);
    }
}

fn admit(
    mut stream: TcpStream,
    number: u64,
    open: &Arc<Connections>,
    answer: &Arc<dyn Fn(&Request) -> Answer + Send + Sync>,
) {
    let before = open.count.fetch_add(1, Ordering::AcqRel);
    let place = Place { number, open: open.clone() };
    if before >= MAX_CONNECTIONS && !open.make_room() {
        // The client may be gone already.
        let _ = Response::of_status(503).send(&mut stream, true);
        return;
    }
    if let Ok(own) = stream.try_clone() {
        open.waiting().push((number, own));
    }
    let answer = answer.clone();
    let serve = move || {
        // A client that is gone needs no answer.
        let _ = serve(&mut stream, &place, &*answer);
    };
    // Without a thread the connection is closed.
    let _ = std::thread::Builder::new().name("connection".into()).spawn(serve);
}

fn serve(
    stream: &mut TcpStream,
    place: &Place,
    answer: &(dyn Fn(&Request) -> Answer + Send + Sync),
) -> io::Result<()> {
    let request = Request::read(stream);
    place.open.heard(place.number);
    let has_body = !request.as_ref().is_ok_and(|request| request.method == "HEAD");
    let response = match request {
        Ok(request) => {
            let answered: Result<Answer> = panics::contain(&"answering a request", || Ok(answer(&request)));
            match answered {
                Ok(Answer::Whole(response)) => response,
                Ok(Answer::Events(_)) if !has_body => return begin_events(stream),
                Ok(Answer::Events(events)) => return send_events(stream, events),
                Err(error) => Response::refusal(500, &error.to_string()),
            }
        }
        Err(Some(status)) => Response::of_status(status),
        Err(None) => return Ok(()),
    };
    response.send(stream, has_body)?;
    if response.status >= 400 {
        farewell(stream)?;
    }
    Ok(())
}

/// Lets a client that still sends read its answer.
fn farewell(stream: &mut TcpStream) -> io::Result<()> {
    stream.shutdown(Shutdown::Write)?;
    let deadline = Instant::now() + FAREWELL;
    let mut piece = [0; 4096];
    loop {
        let left = deadline.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(());
        }
        stream.set_read_timeout(Some(left))?;
        if stream.read(&mut piece)? == 0 {
            return Ok(());
        }
    }
}

fn send_events(stream: &mut TcpStream, events: Box<dyn Iterator<Item = String>>) -> io::Result<()> {
    begin_events(stream)?;
    // A client that has closed its side has ended.
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(Duration::from_millis(1)))?;
    for event in events {
        if matches!(stream.read(&mut [0; 64]), Ok(0)) {
            return Ok(());
        }
        let text = if event.is_empty() { ": here\n\n".into() } else { format!("data: {event}\n\n") };
        stream.write_all(text.as_bytes())?;
    }
    Ok(())
}
