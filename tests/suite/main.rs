//! One test binary: library modules are tested through their public interface, the program through
//! its command line.

mod decode;
mod decode_errors;
mod metrics;
mod output;
mod support;
