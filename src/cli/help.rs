//! The layout of the help. In: the whole command line as its commands describe themselves. Out: the same, of which `-h` has a
//! line or two for each option, with the words that it takes, and `--help` tells all.

use clap::{Arg, Command};

/// The columns of a screen, whatever the width of this one: text stays readable through a pipe.
const WIDTH: usize = 80;

/// The commands by what a person wants to do.
const GROUPS: [(&str, &[&str]); 4] = [
    ("Make pictures", &["render", "new", "view", "sheet"]),
    ("Measure", &["study", "compare", "inspect", "texture", "pattern"]),
    ("Know the device", &["devices", "verify", "stability"]),
    ("Set up the shell", &["completions", "man"]),
];

/// The last line of the list of commands.
const FURTHER: &str = "moire COMMAND -h lists its options, --help explains them; -V, --version";

/// Returns the command line with its help laid out.
pub fn arrange(command: Command) -> Command {
    let template = template(&command);
    let arranged = command.term_width(WIDTH).help_template(template);
    arranged.mut_subcommands(|own| own.mut_args(arrange_option))
}

/// Returns the help of the program: its commands in groups, on one screen.
fn template(command: &Command) -> String {
    let mut text = String::from("{about}\n{usage-heading} moire COMMAND [OPTIONS]\n\n");
    let width = command.get_subcommands().map(|own| own.get_name().len()).max().unwrap_or(0);
    for (heading, names) in GROUPS {
        text += &format!("{heading}:\n");
        for own in names.iter().filter_map(|name| command.find_subcommand(name)) {
            let about = own.get_about().map(ToString::to_string).unwrap_or_default();
            text += &format!("  {:width$}  {about}\n", own.get_name());
        }
    }
    format!("{text}\n{FURTHER}")
}

/// Puts the words that an option takes into its short help, unless they are said to be too many, and into the long one.
fn arrange_option(option: Arg) -> Arg {
    let words = words(&option);
    let short = option.get_help().map(ToString::to_string).unwrap_or_default();
    let long = option.get_long_help().map_or_else(|| short.clone(), ToString::to_string);
    if words.is_empty() {
        return option.long_help(long);
    }
    let is_short = !option.is_hide_possible_values_set();
    let short = if is_short { with_words(&short, &words.join(", ")) } else { short };
    let long = format!("{long}\n\n[possible values: {}]", words.join(", "));
    option.hide_possible_values(true).help(short).long_help(long)
}

/// Returns the words that an option takes, without those that are hidden.
fn words(option: &Arg) -> Vec<String> {
    if !option.get_action().takes_values() {
        return Vec::new();
    }
    let values = option.get_value_parser().possible_values().into_iter().flatten();
    values.filter(|value| !value.is_hide_set()).map(|value| value.get_name().to_owned()).collect()
}

/// Returns a description with the words behind it, before what says the default.
fn with_words(short: &str, words: &str) -> String {
    match short.find(" [default:") {
        Some(at) => format!("{}: {words}{}", &short[..at], &short[at..]),
        None => format!("{short}: {words}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_stand_behind_the_description_and_before_the_default() {
        assert_eq!(with_words("Pattern", "a, b"), "Pattern: a, b");
        assert_eq!(with_words("Tone map [default: a]", "a, b"), "Tone map: a, b [default: a]");
    }

    #[test]
    fn words_are_in_both_helps_or_in_the_long_one_alone() {
        let option = Arg::new("x").long("x").value_parser(["a", "b"]).help("X");
        let both = arrange_option(option.clone());
        let text =
            |help: Option<&clap::builder::StyledStr>| help.map(ToString::to_string).unwrap_or_default();
        assert_eq!(text(both.get_help()), "X: a, b");
        assert_eq!(text(both.get_long_help()), "X\n\n[possible values: a, b]");
        let long = arrange_option(option.hide_possible_values(true));
        assert_eq!(text(long.get_help()), "X");
        assert_eq!(text(long.get_long_help()), "X\n\n[possible values: a, b]");
    }
}
