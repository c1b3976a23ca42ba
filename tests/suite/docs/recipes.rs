//! The recipes for CI services in docs/guide/ci.md: the commands of each job of a `yaml` block run one after the other as
//! the service runs them, in a folder like a checkout, where `setup.sh` and `cargo build` do nothing but put the program
//! under test where a build puts it.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;

use super::{Page, pages};
use crate::stage::device_name;
use crate::support::{data, program};

const PAGE: &str = "docs/guide/ci.md";
/// What the recipes have to show, each by one of the words.
const SHOWN: &[&str] =
    &["./setup.sh", "cargo build --release", "moire render", "compare", "--max-flip", "verify", "--strict"];

/// Returns the `yaml` blocks of a page.
fn blocks(page: &Page) -> Vec<String> {
    let parts = page.text.split("```yaml\n").skip(1);
    parts.filter_map(|rest| rest.split("```").next()).map(String::from).collect()
}

fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}

/// Returns the commands of a block: what follows `run:` of a step, and the items of `script:` and `before_script:`, each
/// of one line or, behind `|`, of all deeper lines.
fn commands(yaml: &str) -> Vec<String> {
    let lines: Vec<&str> = yaml.lines().filter(|line| !line.trim_start().starts_with('#')).collect();
    let mut found = Vec::new();
    // The indent of the key whose items are commands.
    let mut script = None;
    let mut at = 0;
    while at < lines.len() {
        let (line, depth) = (lines[at], indent(lines[at]));
        at += 1;
        if line.trim().is_empty() {
            continue;
        }
        script = script.filter(|own| depth > *own);
        let item = line.trim_start().strip_prefix("- ");
        let text = item.unwrap_or(line.trim_start());
        let command = match (text.strip_prefix("run:"), script, item) {
            (Some(command), ..) => command.trim(),
            (None, Some(_), Some(command)) => command.trim(),
            _ => {
                if ["script:", "before_script:"].contains(&text.trim_end()) {
                    script = Some(depth);
                }
                continue;
            }
        };
        if command != "|" {
            found.push(command.to_string());
            continue;
        }
        let end = (at..lines.len()).find(|&i| !lines[i].trim().is_empty() && indent(lines[i]) <= depth);
        let block = &lines[at..end.unwrap_or(lines.len())];
        let own =
            block.iter().filter(|line| !line.trim().is_empty()).map(|line| indent(line)).min().unwrap_or(0);
        found.push(block.iter().map(|line| line.get(own..).unwrap_or("")).collect::<Vec<_>>().join("\n"));
        at = end.unwrap_or(lines.len());
    }
    found
}

fn executable(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Prepares a checkout. Its `cargo` puts a program in place that renders on the device under test.
fn stage(folder: &Path) {
    symlink(fs::canonicalize(data()).unwrap(), folder.join("data")).unwrap();
    let program = fs::canonicalize(program()).unwrap();
    let moire = format!(
        "#!/bin/sh\ncase \"$1\" in render | verify) exec '{0}' \"$@\" --device {1} ;; esac\nexec '{0}' \"$@\"\n",
        program.display(),
        device_name()
    );
    executable(&folder.join("built"), &moire);
    executable(&folder.join("setup.sh"), "#!/bin/sh\ntouch set-up\n");
    executable(
        &folder.join("bin/cargo"),
        "#!/bin/sh\ntest -e set-up && test \"$*\" = 'build --release' && mkdir -p target/release && cp built target/release/moire\n",
    );
}

/// Runs the commands of a block. Each service starts a shell that ends at the first failure: one for each step on GitHub,
/// one for all lines on GitLab.
fn run(folder: &Path, yaml: &str) -> Result<(), String> {
    let commands = commands(yaml);
    let scripts = if yaml.contains("script:") { vec![commands.join("\n")] } else { commands };
    let path = format!("{}:{}", folder.join("bin").display(), std::env::var("PATH").unwrap_or_default());
    for script in scripts {
        let output = Command::new("bash")
            .args(["--noprofile", "--norc", "-eo", "pipefail", "-c", &script])
            .current_dir(folder)
            .env("PATH", &path)
            .env("GITHUB_PATH", folder.join("github-path"))
            .env("CI_PROJECT_DIR", folder)
            .output()
            .unwrap();
        if !output.status.success() {
            return Err(format!("{script}\n{}", String::from_utf8_lossy(&output.stderr)));
        }
    }
    Ok(())
}

#[test]
fn every_recipe_works_and_shows_what_it_should() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let blocks = blocks(&page);
    assert_eq!(blocks.len(), 2, "GitHub Actions and GitLab");
    for yaml in blocks {
        let folder = tempfile::tempdir().unwrap();
        stage(folder.path());
        let all = commands(&yaml).join("\n");
        for word in SHOWN {
            assert!(all.contains(word), "{word} is not in\n{all}");
        }
        assert!(yaml.contains("target") && yaml.contains(".cache"), "what is kept between runs");
        if let Err(told) = run(folder.path(), &yaml) {
            panic!("{PAGE}: {told}");
        }
    }
}

#[test]
fn planted_faults_of_recipes_are_found() {
    let folder = tempfile::tempdir().unwrap();
    stage(folder.path());
    let steps = |run: &str| format!("steps:\n  - uses: a/b@v4\n  - run: {run}\n");
    assert_eq!(self::run(folder.path(), &steps("true")), Ok(()));
    for wrong in [
        "false",
        "|\n      false\n      true",
        "moire render none.toml",
        "cargo test",
        "cargo build --release",
    ] {
        assert!(self::run(folder.path(), &steps(wrong)).is_err(), "{wrong}");
    }
    assert!(self::run(folder.path(), "job:\n  script:\n    - false\n    - true\n").is_err());
}

#[test]
fn commands_of_yaml_are_read_as_services_read_them() {
    let github = "jobs:\n  a:\n    steps:\n      - uses: x\n        with:\n          path: |\n            target\n      - name: n\n        run: |\n          one \\\n            more\n\n          two\n      # run: never\n      - run: three\n";
    assert_eq!(commands(github), ["one \\\n  more\n\ntwo", "three"]);
    let gitlab = "a:\n  cache:\n    paths: [x]\n  before_script:\n    - one\n  script:\n    - two\n    - |\n      three\n      four\n  artifacts:\n    paths:\n      - no\n";
    assert_eq!(commands(gitlab), ["one", "two", "three\nfour"]);
}
