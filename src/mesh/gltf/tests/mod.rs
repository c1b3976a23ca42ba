//! Tests of the glTF reader. Input: small files built in code. Each is read whole, and what comes out is compared to
//! values by hand, or the fault to its place.
#![allow(clippy::unwrap_used)]

mod accessors;
mod build;
mod container;
mod fuzz;
mod geometry;
mod graph;
mod materials;
mod paths;
mod stage;
