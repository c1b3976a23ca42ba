//! The README's commands work as written: every `moire` line of its shell blocks runs, in order, in
//! a folder that has `data` beside it. Lines for a specific device are left to that device.

use std::fs;
use std::process::Command;

use crate::support::{data, program, untested};

/// `moire …` lines of ```sh blocks, without comments and without the file that takes the output.
fn commands(readme: &str) -> Vec<String> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in readme.lines() {
        if line.starts_with("```") {
            inside = line == "```sh";
        } else if inside && line.starts_with("moire ") {
            let command = line.split(" #").next().unwrap_or(line);
            found.push(command.split(" > ").next().unwrap_or(command).trim().to_string());
        }
    }
    found
}

/// Another device than the one under test or the oracle.
fn needs_another_device(command: &str, device: &str) -> bool {
    let named = command.split_once("--device ").and_then(|(_, rest)| rest.split(' ').next());
    named.is_some_and(|n| n != device && n != "oracle")
}

#[test]
fn every_command_of_the_readme_works() {
    let path = data().join("../README.md");
    let Ok(readme) = fs::read_to_string(&path) else {
        untested("the commands of README.md: it is not beside the data");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let scenes = fs::canonicalize(data()).unwrap();
    std::os::unix::fs::symlink(scenes, folder.path().join("data")).unwrap();
    let commands = commands(&readme);
    assert!(commands.len() >= 12, "only {} commands found", commands.len());
    let device = std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into());
    for command in commands.iter().filter(|c| !needs_another_device(c, &device)) {
        let mut arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        if ["render", "study"].contains(&arguments[0]) && !arguments.contains(&"--device") {
            arguments.extend(["--device", &device]);
        }
        let output = Command::new(program()).args(&arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{command}\n{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn pictures_of_the_readme_exist() {
    let Ok(readme) = fs::read_to_string(data().join("../README.md")) else { return };
    let links: Vec<&str> =
        readme.split("](data/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(!links.is_empty());
    for link in links {
        assert!(data().join(link).is_file(), "data/{link} is missing");
    }
}
