//! The one test binary; each module is an area of behaviour, named so that the name of a failing
//! test is the diagnosis.

// A failed step of a test is a failed test; clippy's own exemption covers #[test] functions alone,
// not the helpers they share.
#![allow(clippy::unwrap_used)]

mod adaptive;
mod advice;
mod backends;
mod bad_input;
mod beams;
mod browser;
#[cfg(unix)]
mod child;
mod circles;
mod cli;
mod color_profile;
mod cone;
mod containers;
mod data;
mod decode;
mod decode_errors;
mod device;
mod device_shaders;
mod diagnostics;
mod dimensions;
mod discs;
mod display;
#[cfg(unix)]
mod docs;
mod doors;
mod double;
#[cfg(unix)]
mod driver_cache;
mod error;
mod exact;
mod exr;
mod extremes;
mod face;
mod flip;
#[cfg(unix)]
mod folders;
mod footprints;
mod gallery;
mod golden;
mod halves;
#[cfg(unix)]
mod help;
#[cfg(unix)]
mod inputs;
mod interrupt;
mod layering;
mod layers;
mod layout;
mod lean;
mod lean_features;
mod lecture;
mod limits;
mod lookup;
mod loop_budget;
mod materials;
mod meshes;
mod metrics;
mod mip_chain;
mod mips;
mod new;
mod nonfinite;
mod oracle;
mod orientation;
mod output;
mod patterns;
mod pictures;
mod pixel_filters;
mod procedural;
#[cfg(unix)]
mod programs;
mod python_module;
mod random_scenes;
mod rays;
mod replay;
mod resubmit;
mod scene;
mod sheet;
#[cfg(unix)]
mod shell;
mod slopes;
mod sources;
mod specialise;
mod spots;
mod stability;
mod stage;
mod stochastic;
mod strata;
mod streams;
mod study;
mod support;
mod texel_buffer;
mod texel_quads;
mod texture_command;
mod tile_culling;
mod tiling;
mod turned;
mod validated;
mod verify;
#[cfg(unix)]
mod view;
mod watch;
