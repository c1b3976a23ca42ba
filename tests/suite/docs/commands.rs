//! The commands of README.md and docs work as written: every line of their shell blocks runs, page by page, in a
//! folder that has `data` beside it; a line that stands twice runs once. Lines that need a certain device are
//! left to that device.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use super::{Page, pages, prose, spans};
use crate::stage::device_name;
use crate::support::{data, program};

/// The starts of lines that build the program, the tests or the textures; this very test runs after them.
const BUILDS: &[&str] =
    &["./setup.sh", "cargo ", "MOIRE_DEVICE=gpu cargo ", "MOIRE_SETUP_DRY_RUN=1 ./setup.sh"];

/// Adds the device under test where a line names none. Whether a command works does not depend on how much it does: a
/// line that names neither a size, nor a part of the full picture, nor another picture renders a small one, and one that
/// verifies everything verifies all address modes of some formats and sizes. A view is served, and a scene watched, until
/// Ctrl-C, which comes after some seconds; a port that a page names may be taken, so that a free one stands for it.
const WRAPPER: &str = "#!/bin/sh
case \" $* \" in
*' --size '* | *' --crop '* | *' --only '* | *' --from '*) ;;
*)
    case \"$1\" in
    render | study | sheet) set -- \"$@\" --size 64x48 ;;
    verify) set -- \"$@\" --only 'srgb 2×2' ;;
    esac
    ;;
esac
case \"$1 $* \" in
view* | *' --watch '*)
    for word; do
        shift
        [ \"$before\" = --port ] && word=0
        before=$word
        set -- \"$@\" \"$word\"
    done
    timeout --preserve-status --signal=INT 3 PROGRAM \"$@\" --device DEVICE
    [ $? = 130 ]
    exit
    ;;
esac
case \" $* \" in
*' --device '*) ;;
*) case \"$1\" in render | study | sheet | verify | stability) set -- \"$@\" --device DEVICE ;; esac ;;
esac
exec PROGRAM \"$@\"
";

/// Returns the commands of a page: lines of ```sh blocks, joined where one ends with a backslash, and commands with a
/// file of `data` within a sentence. A block that opens with `set -e` is one script.
pub fn commands(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut block: Option<Vec<&str>> = None;
    for line in text.lines() {
        match (&mut block, line) {
            (None, "```sh") => block = Some(Vec::new()),
            (Some(lines), "```") => {
                if lines.first().is_some_and(|first| first.starts_with("set -e")) {
                    found.push(lines.join("\n"));
                } else {
                    let joined = lines.join("\n").replace("\\\n", " ");
                    let lines = joined.lines().map(|l| l.split(" #").next().unwrap_or(l).trim().to_string());
                    found.extend(lines.filter(|line| !line.is_empty() && !line.starts_with('#')));
                }
                block = None;
            }
            (Some(lines), line) => lines.push(line),
            (None, _) => {}
        }
    }
    let is_command = |span: &&str| span.starts_with("moire ") && span.contains("data/");
    found.extend(prose(text).iter().flat_map(|p| spans(p)).filter(is_command).map(String::from));
    found
}

/// Tells whether a command names another device than the one under test or the oracle.
fn needs_another_device(command: &str, device: &str) -> bool {
    let named = command.split_once("--device ").and_then(|(_, rest)| rest.split_whitespace().next());
    named.is_some_and(|n| n != device && n != "oracle")
}

/// Prepares a folder with `data` and a `moire` of its own.
fn stage(folder: &Path, device: &str) {
    symlink(fs::canonicalize(data()).unwrap(), folder.join("data")).unwrap();
    let program = fs::canonicalize(program()).unwrap();
    let script = WRAPPER.replace("PROGRAM", &format!("'{}'", program.display())).replace("DEVICE", device);
    fs::create_dir(folder.join("bin")).unwrap();
    let path = folder.join("bin/moire");
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs a command in a shell, and returns what the shell says if it fails.
fn run(folder: &Path, command: &str) -> Result<(), String> {
    let path = format!("{}:{}", folder.join("bin").display(), std::env::var("PATH").unwrap_or_default());
    let output =
        Command::new("bash").args(["-c", command]).current_dir(folder).env("PATH", path).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    if output.status.success() { Ok(()) } else { Err(format!("{command}\n{told}")) }
}

/// Runs each command of the pages once, and returns how many there are and which of them fail.
fn failures(pages: &[Page]) -> (usize, Vec<String>) {
    let device = device_name();
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path(), &device);
    let mut seen = BTreeSet::new();
    let mut failed = Vec::new();
    for page in pages {
        for command in commands(&page.text) {
            let built = BUILDS.iter().any(|start| command.starts_with(start));
            if built || needs_another_device(&command, &device) || !seen.insert(command.clone()) {
                continue;
            }
            if let Err(what) = run(folder.path(), &command) {
                failed.push(format!("{}: {what}", page.name));
            }
        }
    }
    (seen.len(), failed)
}

#[test]
fn every_command_works() {
    let pages = pages();
    let (count, failed) = failures(&pages);
    assert!(pages.is_empty() || count > 60, "only {count} commands were found");
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn planted_faults_are_found() {
    let page = |text: &str| Page { name: "docs/a.md".into(), text: text.into() };
    let told = |text: &str| failures(&[page(text)]).1;
    assert_eq!(told("```sh\nmoire texture data/textures/grass.png | head -1 > a\ntest -s a\n```\n"), [""; 0]);
    for text in [
        "```sh\nmoire texture data/textures/none.png\n```\n",
        "As `moire texture data/textures/none.png` says.",
        "```sh\nset -eu\nmoire texture data/textures/none.png\ntrue\n```\n",
        "```sh\nmoire render data/scenes/quad.toml \\\n    --no-option\n```\n",
        "```sh\nrender data/scenes/quad.toml\n```\n",
    ] {
        assert_eq!(told(text).len(), 1, "{text}");
    }
}

#[test]
fn lines_are_read_as_a_person_reads_them() {
    let text = "```sh\nmoire a # why\nmoire b \\\n    c\n# only words\n```\n```toml\nmoire = 1\n```\nSee `moire d data/x` or `moire e`.\n";
    assert_eq!(commands(text), ["moire a", "moire b      c", "moire d data/x"]);
    assert!(needs_another_device("moire devices --device 1", "cpu"));
    assert!(!needs_another_device("moire render --device oracle", "cpu"));
}
