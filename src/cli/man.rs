//! `moire man`: the manual in the format of man(7). In: the whole command line. Out: its first page on stdout, or a page
//! for each command in a folder.

use std::iter;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Args, Command};
use clap_mangen::Man;

use super::inputs::Inputs;
use super::{OUTPUT, interrupt};
use crate::core::error::{Error, Result};
use crate::output::write_file;

/// The program and its version, at the foot of pages.
const SOURCE: &str = concat!("moire ", env!("CARGO_PKG_VERSION"));

/// Print the manual, or write a page for each command
#[derive(Args, Debug)]
pub struct ManArgs {
    /// Folder for a page of each command: moire.1, moire-render.1, …
    ///
    /// Its last component is created if it is missing.
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    out: Option<PathBuf>,
}

pub fn run(args: &ManArgs, mut command: Command) -> Result<ExitCode> {
    // Gives each command its full name, such as moire-render.
    command = command.disable_help_subcommand(true);
    command.build();
    interrupt::ends_at_once()?;
    let Some(folder) = &args.out else {
        super::print_bytes(&page(&command)?)?;
        return Ok(ExitCode::SUCCESS);
    };
    let commands: Vec<&Command> = iter::once(&command).chain(command.get_subcommands()).collect();
    let file = |command: &Command| format!("{}.1", command.get_display_name().unwrap_or(command.get_name()));
    let _folder = Inputs::default().prepare_folder(folder, &file(&command), [])?;
    commands.into_iter().try_for_each(|own| write_file(&folder.join(file(own)), &page(own)?))?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the page of a command.
fn page(command: &Command) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let page = Man::new(command.clone()).source(SOURCE).render(&mut bytes);
    page.map_err(|error| Error::new(format!("the manual: {error}")))?;
    Ok(tidy(&plain(&String::from_utf8_lossy(&bytes))).into_bytes())
}

/// Returns a text of roff in ASCII: some formatters take other bytes for Latin-1.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        if c.is_ascii() {
            plain.push(c);
        } else {
            plain += &format!("\\[u{:04X}]", u32::from(c));
        }
    }
    plain
}

/// Returns a page whose title has an empty date in its place, which the source would take otherwise, and blank lines as
/// requests.
fn tidy(page: &str) -> String {
    let titled = page.lines().map(|line| match line.strip_prefix(".TH ") {
        Some(title) => format!(".TH {}\n", title.replacen(" 1  \"", " 1 \"\" \"", 1).trim_end()),
        None => format!("{line}\n"),
    });
    titled.collect::<String>().replace("\n.br\n\n.br\n", "\n.sp\n")
}
