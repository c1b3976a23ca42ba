//! `moire completions`: a script by which a shell completes commands, options and their values, in bash, zsh and fish also the
//! scenes of the program and the keys of `--set`. In: the shell, and the whole command line. Out: the script on stdout.

use std::process::ExitCode;

use clap::{Args, Command};
use clap_complete::Shell;

use crate::core::error::Result;
use crate::scene::{BuiltIn, setting_keys};

/// Print a script by which a shell completes commands and values
#[derive(Args, Debug)]
pub struct CompletionsArgs {
    /// Shell that shall complete
    #[arg(value_enum)]
    shell: Shell,
}

/// Stands around the generated function: bash takes `=` for the end of a word, so that the option is the word before it; of
/// a list the last element is completed.
const BASH: &str = r#"
_moire_words() {
    local cur="$2" prev="$3" at=$COMP_CWORD begun=""
    if [[ "${COMP_WORDS[at]}" == "=" ]]; then
        cur="" prev="${COMP_WORDS[at-1]}"
    elif [[ "$prev" == "=" && $at -ge 2 ]]; then
        prev="${COMP_WORDS[at-2]}"
    fi
    local IFS=$'\n'
    if [[ "$cur" == @* ]]; then
        COMPREPLY=($(compgen -W "SCENES" -- "$cur"))
        return
    fi
    if [[ "$prev" == --set ]]; then
        COMPREPLY=($(set -f; compgen -S = -W "KEYS" -- "$cur"))
        compopt -o nospace 2>/dev/null
        return
    fi
    if [[ "$prev" == --aov && "$cur" == *,* ]]; then
        begun="${cur%,*}," cur="${cur##*,}"
    fi
    IFS=$' \t\n'
    _moire "$1" "$cur" "$prev"
    if [[ -n "$begun" ]]; then
        COMPREPLY=("${COMPREPLY[@]/#/$begun}")
    fi
}
complete -F _moire_words -o nosort -o bashdefault -o default moire 2>/dev/null ||
    complete -F _moire_words -o bashdefault -o default moire
"#;

/// Files and the scenes of the program; keys.
const ZSH: &str = r#"
(( $+functions[_moire_scenes] )) ||
_moire_scenes() {
    if [[ "$PREFIX" == @* ]]; then
        local -a scenes=(SCENES)
        compadd -- $scenes
    else
        _files
    fi
}

(( $+functions[_moire_keys] )) ||
_moire_keys() {
    local -a keys=(KEYS)
    compadd -S = -- $keys
}
"#;

/// The commands that read a scene.
const READERS: &str = "render new view study sheet inspect";

pub fn run(args: &CompletionsArgs, mut command: Command) -> Result<ExitCode> {
    let mut script = Vec::new();
    let name = command.get_name().to_owned();
    clap_complete::generate(args.shell, &mut command, name, &mut script);
    let script = String::from_utf8_lossy(&script);
    super::print_bytes(with_words(args.shell, &script).as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the script with scenes and keys.
fn with_words(shell: Shell, script: &str) -> String {
    let scenes: Vec<String> = BuiltIn::all().iter().map(|scene| scene.shown()).collect();
    let keys: Vec<String> = setting_keys().collect();
    let quoted =
        |words: &[String]| words.iter().map(|word| format!("'{word}'")).collect::<Vec<_>>().join(" ");
    match shell {
        Shell::Bash => {
            format!(
                "{script}{}",
                BASH.replace("SCENES", &scenes.join("\n")).replace("KEYS", &keys.join("\n"))
            )
        }
        Shell::Zsh => {
            let own = ZSH.replace("SCENES", &quoted(&scenes)).replace("KEYS", &quoted(&keys));
            let lines = script.lines().map(|line| zsh_line(line) + "\n").collect::<String>();
            // Functions stand before the line that calls the first one.
            lines.replacen("\n_moire() {", &format!("{own}\n_moire() {{"), 1)
        }
        Shell::Fish => {
            let seen = format!("complete -c moire -n '__fish_seen_subcommand_from {READERS}'");
            let scenes = scenes.join(" ");
            let keys: String = keys.iter().map(|key| format!("{}= ", key.replace('*', "\\*"))).collect();
            format!(
                "{script}{seen} -n 'string match -q \"@*\" -- (commandline -ct)' -a '{scenes}'\n{seen} -l set -x -a '{}'\n",
                keys.trim_end()
            )
        }
        _ => script.to_owned(),
    }
}

/// Returns a line of the script for zsh that completes scenes and keys where it completed files.
fn zsh_line(line: &str) -> String {
    let line = line.replace(":KEY=VALUE:_default'", ":KEY=VALUE:_moire_keys'");
    let is_scene = [":scene -- ", "::scene -- ", "::what -- "].iter().any(|start| line.contains(start));
    if is_scene { line.replace(":_files'", ":_moire_scenes'") } else { line }
}
