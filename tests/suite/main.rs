//! The one test binary; each module is a field of behaviour, named so that a failing name is the
//! diagnosis.

// A failed step of a test is a failed test; clippy's own exemption covers #[test] functions alone,
// not the helpers they share.
#![allow(clippy::unwrap_used)]

mod data;
mod decode;
mod decode_errors;
mod device;
mod device_shaders;
mod layering;
mod layout;
mod lecture;
mod lookup;
mod metrics;
mod output;
mod rays;
mod scene;
mod shared_gpu;
mod strata;
mod support;
