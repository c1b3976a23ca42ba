//! A small HTTP server for one person at one machine: loopback addresses only, one request a connection, and limits on
//! everything a client sends. `httparse` splits the head; there is no crate that also bounds time and size and needs no
//! asynchronous runtime.

mod request;
mod response;
mod server;

pub use request::Request;
pub use response::Response;
pub use server::{Answer, Server, Stop};
