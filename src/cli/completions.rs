//! `moire completions`: a script by which a shell completes commands, options and their values. In: the shell, and the
//! whole command line. Out: the script on stdout.

use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::Shell;

use crate::core::error::Result;

/// Print a script by which a shell completes commands and values
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// Shell that shall complete
    #[arg(value_enum)]
    shell: Shell,
}

pub fn run(args: &CompletionsArgs, mut command: Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    super::print_bytes(&script)?;
    Ok(ExitCode::SUCCESS)
}
