//! The program: gives its arguments to the command line of the library and returns its exit code.

use std::process::ExitCode;

use moire::internal::cli::program;

fn main() -> ExitCode {
    program::run(std::env::args_os()).into()
}
