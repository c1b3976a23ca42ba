//! One test binary: each module tests one part, named so that a failing name is the diagnosis.

// A failed unwrap in a test's helper is a failed test.
#![allow(clippy::unwrap_used)]

mod device;
mod device_shaders;
