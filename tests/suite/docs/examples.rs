//! Every option of every command has an example: a command of README.md or docs, all of which run, gives it to the command,
//! or to `render` where that has the same option. In: the help and the pages. Out: the options without one.

use std::collections::{BTreeMap, BTreeSet};

use super::cli::{command_names, entries, help};
use super::commands::commands;
use super::{Page, pages, spans};

/// Returns the names of an option: `-o` and `--output` of `-o, --output <OUT>`.
fn names(entry: &str) -> Vec<String> {
    let words = entry.split_whitespace().map(|word| word.trim_end_matches(','));
    words.take_while(|word| word.starts_with('-')).map(String::from).collect()
}

/// Returns the words that each command of `moire` is given, of an option with `=` its name.
fn given(lines: &[String]) -> BTreeMap<String, BTreeSet<String>> {
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for part in lines.iter().flat_map(|line| line.split(['|', ';', '&', '\n', '('])) {
        let mut words = part.split_whitespace().skip_while(|word| *word != "moire").skip(1);
        let Some(command) = words.next() else { continue };
        let options = words.filter(|word| word.starts_with('-')).filter_map(|word| word.split('=').next());
        found.entry(command.to_owned()).or_default().extend(options.map(String::from));
    }
    found
}

/// Returns the options, each by its names, that neither the command nor `render`, which has it too, is given.
fn without_example(options: &BTreeMap<String, Vec<Vec<String>>>, lines: &[String]) -> Vec<String> {
    let given = given(lines);
    let is_given = |command: &str, names: &[String]| {
        given.get(command).is_some_and(|words| names.iter().any(|name| words.contains(name)))
    };
    let of_render = &options["render"];
    let mut missing = Vec::new();
    for (command, own) in options {
        for names in own.iter().filter(|names| !names.is_empty()) {
            let is_shared = of_render.contains(names) && is_given("render", names);
            if !is_given(command, names) && !is_shared {
                missing.push(format!("moire {command} {}", names.join(", ")));
            }
        }
    }
    missing
}

#[test]
fn every_option_has_an_example() {
    let pages = pages();
    if pages.is_empty() {
        return;
    }
    let options = |command: &String| entries(&help(&[command])).iter().map(|entry| names(entry)).collect();
    let options = command_names(&help(&[])).into_iter().map(|command| (command.clone(), options(&command)));
    let lines: Vec<String> = pages.iter().flat_map(|page| commands(&page.text)).collect();
    let missing = without_example(&options.collect(), &lines);
    assert!(missing.is_empty(), "no command of README.md or docs has:\n{}", missing.join("\n"));
}

/// Returns true if a row of a table, beside those that list values, has the value, or a command gives it to the option.
fn is_shown(option: &str, value: &str, pages: &[Page], lines: &[String]) -> bool {
    let lists = ["docs/cli.md", "docs/scene-format.md"];
    let told =
        pages.iter().filter(|page| !lists.contains(&page.name.as_str())).flat_map(|page| page.text.lines());
    let in_table = told.filter(|line| line.starts_with('|')).any(|row| spans(row).any(|span| span == value));
    let is_named =
        |word: &str| word.split(',').any(|part| part == value || part.ends_with(&format!(".{value}")));
    let given = |line: &String| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let behind = words.windows(2).any(|pair| pair[0] == option && is_named(pair[1]));
        behind || words.iter().any(|word| word.strip_prefix(&format!("{option}=")).is_some_and(is_named))
    };
    // The argument of `moire completions` has no name; the ending of `-o` is the format that `--format` names.
    let bare = |line: &String| option.starts_with('<') && line.split_whitespace().any(|word| word == value);
    let ending = |line: &String| {
        option == "--format" && line.split_whitespace().any(|word| word.ends_with(&format!(".{value}")))
    };
    in_table || lines.iter().any(|line| given(line) || bare(line) || ending(line))
}

#[test]
fn every_value_of_an_option_is_explained_or_has_an_example() {
    let pages = pages();
    if pages.is_empty() {
        return;
    }
    let lines: Vec<String> = pages.iter().flat_map(|page| commands(&page.text)).collect();
    let mut missing = BTreeSet::new();
    for command in command_names(&help(&[])) {
        for entry in entries(&help(&[&command])) {
            let Some(list) =
                entry.split_once("[possible values: ").and_then(|(_, rest)| rest.split(']').next())
            else {
                continue;
            };
            let mut words = entry.split_whitespace();
            let option = words.clone().find(|word| word.starts_with("--")).or(words.next()).unwrap_or("");
            let hidden = list.split(", ").filter(|value| !is_shown(option, value, &pages, &lines));
            missing.extend(hidden.map(|value| format!("{option} {value}")));
        }
    }
    assert!(missing.is_empty(), "no table or command of the docs has: {missing:?}");
}

#[test]
fn a_value_without_table_or_example_is_found() {
    let page = |name: &str, text: &str| Page { name: name.into(), text: text.into() };
    let pages = [
        page("docs/cli.md", "| `--mip M` | `none` |"),
        page("docs/a.md", "| `linear` | between |\nthe `stored` one"),
    ];
    let lines =
        ["moire render a --mip nearest".to_owned(), "moire render a --aov uv,level -o b.exr".to_owned()];
    let shown = |option: &str, value: &str| is_shown(option, value, &pages, &lines);
    assert!(shown("--mip", "linear") && shown("--mip", "nearest") && shown("--aov", "level"));
    assert!(shown("--format", "exr") && !shown("--format", "png"));
    assert!(!shown("--mip", "none") && !shown("--mip", "stored") && !shown("--filter", "nearest"));
}

#[test]
fn an_option_without_an_example_is_found() {
    let own = |entries: &[&str]| entries.iter().map(|entry| names(entry)).collect::<Vec<_>>();
    let options = BTreeMap::from([
        ("render".to_owned(), own(&["--size <WxH>  Size", "-q, --quiet  Errors only", "SCENE"])),
        ("view".to_owned(), own(&["--port <PORT>  Port", "--size <WxH>  Size", "-q, --quiet  Errors"])),
    ]);
    let missing =
        |lines: &[&str]| without_example(&options, &lines.iter().map(|l| l.to_string()).collect::<Vec<_>>());
    assert_eq!(missing(&["moire render a --size=4x4 -q", "cd x && moire view b --port 1"]), [""; 0]);
    assert_eq!(missing(&["moire render a --size 4x4 -q", "moire view b"]), ["moire view --port"]);
    assert_eq!(missing(&["moire render a -q | moire view --port 1 --size 4x4"]), ["moire render --size"]);
}
