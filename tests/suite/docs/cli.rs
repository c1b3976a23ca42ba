//! docs/cli.md against the program's own help: each command, each option with the values that it takes and what
//! it stands for when it is left out.

use super::table::correct;
use super::{judge, pages};
use crate::support::moire;

const PAGE: &str = "docs/cli.md";
/// The columns: option, values, default, meaning. The first three are generated.
const COLUMNS: usize = 4;

pub fn help(arguments: &[&str]) -> String {
    let output = moire().args(arguments).arg("--help").output().unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// Returns the commands that the help lists, in groups.
pub fn command_names(help: &str) -> Vec<String> {
    let listed = help.lines().filter_map(|line| line.strip_prefix("  "));
    let listed = listed.filter(|line| line.starts_with(|c: char| c.is_ascii_lowercase()));
    listed.filter_map(|line| line.split_whitespace().next()).map(String::from).collect()
}

/// Returns each option and argument with all that the help says of it, in one line.
pub fn entries(help: &str) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for line in help.lines().skip_while(|line| !line.starts_with("Usage:")).skip(1) {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        if indent > 0 && indent <= 6 && text.starts_with(['-', '<', '[']) {
            found.push(text.to_string());
        } else if indent > 6
            && let Some(entry) = found.last_mut()
        {
            // The first line of the description is as far from the option as in the short help.
            *entry += if entry.contains("  ") { " " } else { "  " };
            *entry += text;
        }
    }
    found.retain(|entry| !entry.contains("-h, --help") && !entry.contains("-V, --version"));
    found
}

fn between<'t>(text: &'t str, before: &str) -> Option<&'t str> {
    text.split_once(before)?.1.split(']').next()
}

/// Returns the cells of an entry: its spelling (`-o, --output OUT`), its values and its default.
fn row(entry: &str) -> Vec<String> {
    let end = entry.find("  ").or(entry.find("> ").map(|i| i + 1)).unwrap_or(entry.len());
    // An argument in brackets may be left out.
    let spelling = entry[..end].replace(['<', '>', '[', ']'], "");
    let list = between(entry, "[possible values: ").unwrap_or("");
    let values = list.split(", ").filter(|v| !v.is_empty()).map(|v| format!("`{v}`"));
    let default = between(entry, "[default: ").unwrap_or("");
    vec![format!("`{}`", spelling.trim()), values.collect::<Vec<_>>().join(", "), default.to_string()]
}

#[test]
fn every_command_and_option_stands_in_the_reference() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let (mut text, mut faults) = (page.text.clone(), Vec::new());
    let commands = command_names(&help(&[]));
    assert!(commands.len() >= 8, "{commands:?}");
    for command in &commands {
        let rows: Vec<Vec<String>> = entries(&help(&[command])).iter().map(|entry| row(entry)).collect();
        correct(&mut text, &format!("## moire {command}"), COLUMNS, &rows, &mut faults);
    }
    let headings = page.text.lines().filter_map(|line| line.strip_prefix("## moire "));
    let strange = headings.filter(|name| !commands.iter().any(|command| command == name));
    faults.extend(strange.map(|name| format!("there is no command {name}")));
    judge(PAGE, &faults, &text);
}

#[test]
fn help_is_read_as_it_is_printed() {
    let short = "Usage: x [OPTIONS] <A>\n\nArguments:\n  <A>  First\n\nOptions:\n  -o, --out <OUT>  Where, see\n                   below [default: 8] [possible values: 8, 16]\n      --json       As JSON\n  -h, --help       Print help\n";
    let long = "Usage: x [OPTIONS] <A>\n\nArguments:\n  <A>\n          First\n\nOptions:\n  -o, --out <OUT>\n          Where\n          \n          [possible values: 8,\n          16]\n          \n          [default: 8]\n\n      --json\n          As JSON\n\n  -h, --help\n          Print help\n";
    let wanted = [["`A`", "", ""], ["`-o, --out OUT`", "`8`, `16`", "8"], ["`--json`", "", ""]];
    for help in [short, long] {
        let rows: Vec<Vec<String>> = entries(help).iter().map(|entry| row(entry)).collect();
        assert_eq!(rows, wanted.map(|row| row.map(String::from).to_vec()));
    }
    assert_eq!(command_names("Usage: x\n\nA:\n  ab  Does\nB:\n  c   Does\n\nx COMMAND\n"), ["ab", "c"]);
}
