//! Parses the command line, calls the library, prints the error: exit 0 ok, 1 a comparison failed,
//! 2 an error.

use std::process::ExitCode;

use clap::{Parser, Subcommand};
use moire::cli::compare;

#[derive(Parser)]
#[command(name = "moire", version, about)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Compare(compare::CompareArgs),
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Compare(args) => compare::run(&args),
    };
    result.unwrap_or_else(|error| {
        eprintln!("{:?}", miette::Report::new(error));
        ExitCode::from(2)
    })
}
