//! The whole command line: its commands by name. In: the arguments, of which the first is the name of the program. Out: what
//! the command prints, and the number of its exit code. 0: success; 1: a comparison failed; 2: an error, including a fault of the program
//! itself; 130: interrupted by Ctrl-C.

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};

use super::{
    compare, completions, devices, help, inspect, man, new, pattern, render, sheet, stability, study,
    texture, verify, version, view, words,
};
use crate::core::error::Result;
use crate::core::panics;

/// Renders textured scenes with Vulkan compute, with or without a GPU
#[derive(Parser)]
#[command(name = "moire", version, long_version = version::long())]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// The options that end a render, by their identifiers.
const GOALS: [&str; 2] = ["budget", "target_error"];

#[derive(Subcommand)]
enum Command {
    Render(Box<render::RenderArgs>),
    New(new::NewArgs),
    View(Box<view::ViewArgs>),
    Study(study::StudyArgs),
    Sheet(Box<sheet::SheetArgs>),
    Inspect(Box<inspect::InspectArgs>),
    Compare(compare::CompareArgs),
    Devices(devices::DevicesArgs),
    Texture(texture::TextureArgs),
    Pattern(pattern::PatternArgs),
    Verify(verify::VerifyArgs),
    Stability(stability::StabilityArgs),
    Completions(completions::CompletionsArgs),
    Man(man::ManArgs),
}

/// Returns the whole command line.
fn command_line() -> clap::Command {
    // A view is refused a goal: its help does not offer one.
    let hidden =
        |view: clap::Command| GOALS.iter().fold(view, |view, id| view.mut_arg(id, |goal| goal.hide(true)));
    Cli::command().mut_subcommand("view", hidden)
}

/// Runs the command that the arguments name and prints its error. Returns the exit code as a number, of which programs in
/// other languages make their own.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    super::prepare_process();
    panics::record();
    let code = super::exit_code(panics::contain(&"moire", || {
        let matches = matches(arguments.into_iter().collect());
        let command = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit()).command;
        let own = matches.subcommand().map(|(_, own)| own);
        panics::contain(&format_args!("moire {}", command.name()), || command.run(own.unwrap_or(&matches)))
    }));
    number(code)
}

/// Returns the number of an exit code, which can be compared and not read.
fn number(code: ExitCode) -> u8 {
    (0..=u8::MAX).find(|number| ExitCode::from(*number) == code).unwrap_or(2)
}

/// Parses the arguments. Answers and errors of the parser end the program.
fn matches(arguments: Vec<OsString>) -> ArgMatches {
    let command = help::arrange(command_line());
    command.clone().try_get_matches_from(&arguments).unwrap_or_else(|error| {
        let words: Vec<String> =
            arguments.iter().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
        words::advised(error, &command, &words).exit()
    })
}

impl Command {
    fn name(&self) -> &'static str {
        match self {
            Command::Render(_) => "render",
            Command::New(_) => "new",
            Command::View(_) => "view",
            Command::Study(_) => "study",
            Command::Sheet(_) => "sheet",
            Command::Inspect(_) => "inspect",
            Command::Compare(_) => "compare",
            Command::Devices(_) => "devices",
            Command::Texture(_) => "texture",
            Command::Pattern(_) => "pattern",
            Command::Verify(_) => "verify",
            Command::Stability(_) => "stability",
            Command::Completions(_) => "completions",
            Command::Man(_) => "man",
        }
    }

    /// Runs the command. `matches`: its own arguments as they were typed.
    fn run(self, matches: &ArgMatches) -> Result<ExitCode> {
        match self {
            Command::Render(args) => render::run(&args, matches),
            Command::New(args) => new::run(&args),
            Command::View(args) => view::run(&args),
            Command::Study(args) => study::run(&args),
            Command::Sheet(args) => sheet::run(&args),
            Command::Inspect(args) => inspect::run(&args),
            Command::Compare(args) => compare::run(&args),
            Command::Devices(args) => devices::run(&args),
            Command::Texture(args) => texture::run(&args),
            Command::Pattern(args) => pattern::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Stability(args) => stability::run(&args),
            Command::Completions(args) => completions::run(&args, command_line()),
            Command::Man(args) => man::run(&args, command_line()),
        }
    }
}
