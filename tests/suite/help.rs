//! The help on a screen of 80 columns and 24 lines: the list of commands whole, each group of options whole, each option in
//! two lines, with the words that it takes. In: what `-h` prints. Out: what does not fit.

use crate::docs::cli::{command_names, help};
use crate::support::moire;

const COLUMNS: usize = 80;
const LINES: usize = 24;
/// The most lines of an option, its spelling included.
const OPTION_LINES: usize = 2;

fn short(arguments: &[&str]) -> String {
    let output = moire().args(arguments).arg("-h").output().unwrap();
    assert!(output.status.success(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn commands() -> Vec<String> {
    command_names(&help(&[]))
}

/// Returns the lines of each option or argument of a short help.
fn options(help: &str) -> Vec<Vec<&str>> {
    let mut found: Vec<Vec<&str>> = Vec::new();
    let mut is_option = false;
    for line in help.lines() {
        let text = line.trim_start();
        let indent = line.len() - text.len();
        if (1..=6).contains(&indent) && text.starts_with(['-', '<', '[']) {
            found.push(vec![line]);
            is_option = true;
        } else if indent > 6 && is_option {
            found.last_mut().unwrap().push(line);
        } else {
            is_option = false;
        }
    }
    found
}

/// Returns what of a short help does not fit.
fn too_large(help: &str) -> Vec<String> {
    let wide = help.lines().filter(|line| line.chars().count() > COLUMNS).map(String::from);
    let groups = help.trim_end().split("\n\n").filter(|group| group.lines().count() > LINES);
    let long = options(help).into_iter().filter(|lines| lines.len() > OPTION_LINES);
    wide.chain(groups.map(String::from)).chain(long.map(|lines| lines.join("\n"))).collect()
}

#[test]
fn the_list_of_commands_fits_a_screen() {
    let help = short(&[]);
    // One line is for what is typed next.
    assert!(help.lines().count() < LINES, "{help}");
    assert!(help.lines().all(|line| line.chars().count() <= COLUMNS), "{help}");
}

#[test]
fn each_command_stands_in_one_group_with_what_it_does() {
    let mut listed = commands();
    // The long manual lists what the parser knows.
    let output = moire().arg("man").output().unwrap();
    let manual = String::from_utf8(output.stdout).unwrap();
    let known = manual.lines().filter_map(|line| line.strip_prefix("moire\\-")?.strip_suffix("(1)"));
    let mut known: Vec<String> = known.map(String::from).collect();
    listed.sort();
    known.sort();
    assert_eq!(listed, known);
    let help = short(&[]);
    let lines = help.lines().filter(|line| line.starts_with("  "));
    assert!(lines.clone().all(|line| line.trim().split_once("  ").is_some()), "{help}");
}

#[test]
fn each_group_of_options_fits_a_screen_and_each_option_two_lines() {
    for command in commands() {
        let help = short(&[&command]);
        let found = too_large(&help);
        assert!(found.is_empty(), "moire {command} -h:\n{}", found.join("\n"));
        assert!(options(&help).len() > 1, "no options were found in: {help}");
    }
}

#[test]
fn words_are_listed_by_the_short_help_unless_they_are_many() {
    let words = |help: &str| {
        let entries = crate::docs::cli::entries(help);
        let listed = entries.into_iter().filter_map(|entry| {
            let list = entry.split_once("[possible values: ")?.1.split(']').next()?.to_owned();
            Some((entry.split_whitespace().find(|word| word.starts_with("--"))?.to_owned(), list))
        });
        listed.collect::<Vec<_>>()
    };
    for command in commands() {
        let short = short(&[&command]);
        for (option, list) in words(&help(&[&command])) {
            let own = options(&short).into_iter().find(|lines| lines[0].contains(&option)).unwrap();
            let own = own.iter().map(|line| line.trim()).collect::<Vec<_>>().join(" ");
            assert!(own.contains(&list) || own.contains("see --help"), "moire {command} {option}: {own}");
        }
    }
}

#[test]
fn planted_faults_of_help_are_found() {
    let right = "Usage: x\n\nOptions:\n  -o, --out <OUT>  Where\n                   it goes\n      --json       As JSON\n";
    assert_eq!(too_large(right), [""; 0]);
    let wide = right.replace("As JSON", &"wide ".repeat(16));
    let tall = right.replace("      --json       As JSON\n", &"      --json       As JSON\n".repeat(24));
    let long = right.replace("it goes\n", "it\n                   goes\n");
    for wrong in [wide, tall, long] {
        assert_eq!(too_large(&wrong).len(), 1, "{wrong}");
    }
}
