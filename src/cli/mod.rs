//! One file a subcommand.

pub mod devices;
