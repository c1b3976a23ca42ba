//! The driver's shader cache if its default folder cannot be written: it is in a temporary folder
//! of the user, and nothing is printed.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};

use nix::unistd::getuid;
use tempfile::tempdir;

use crate::stage::{device_name, path};
use crate::support::moire;

const NAMES: [&str; 5] = [
    "MESA_SHADER_CACHE_DISABLE",
    "MESA_GLSL_CACHE_DISABLE",
    "MESA_SHADER_CACHE_DIR",
    "MESA_GLSL_CACHE_DIR",
    "XDG_CACHE_HOME",
];

/// Renders with these variables and this temporary folder, and expects no output.
fn render_with(variables: &[(&str, &Path)], temporary: &Path) {
    let mut command = moire();
    for name in NAMES {
        command.env_remove(name);
    }
    let out = tempdir().unwrap();
    command.envs(variables.iter().copied()).env("TMPDIR", temporary).arg("render").arg(path("s1a"));
    command.args(["--size", "8x8", "-q", "--device", &device_name(), "-o"]).arg(out.path().join("out.png"));
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), told.as_ref()), (Some(0), ""), "{variables:?}");
}

/// A folder, and a path in it at which nobody can create another, not even root.
fn closed() -> (tempfile::TempDir, PathBuf) {
    let folder = tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    (folder, file.join("cache"))
}

fn own(temporary: &Path) -> PathBuf {
    temporary.join(format!("moire-{}", getuid()))
}

/// Returns true if Mesa stores anything in this folder, which other drivers do not.
fn is_used(folder: &Path) -> bool {
    folder.join("mesa_shader_cache").is_dir() || device_name() != "cpu"
}

#[test]
fn a_cache_that_cannot_be_written_is_a_temporary_one() {
    let (_folder, closed) = closed();
    let nowhere = Path::new("");
    for (name, folder) in [
        ("XDG_CACHE_HOME", closed.as_path()),
        ("MESA_SHADER_CACHE_DIR", &closed),
        ("XDG_CACHE_HOME", nowhere),
    ] {
        let temporary = tempdir().unwrap();
        for _ in 0..2 {
            render_with(&[(name, folder)], temporary.path());
            assert!(is_used(&own(temporary.path())), "{name}");
        }
        let mode = fs::metadata(own(temporary.path())).unwrap().permissions().mode();
        assert_eq!(mode & 0o777, 0o700, "{name}");
    }
}

#[test]
fn a_cache_that_can_be_written_stays_where_it_is() {
    for name in ["XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR"] {
        let (folder, temporary) = (tempdir().unwrap(), tempdir().unwrap());
        // Made by the driver.
        let wanted = folder.path().join("cache");
        render_with(&[(name, &wanted)], temporary.path());
        assert!(is_used(&wanted), "{name}");
        assert!(!own(temporary.path()).exists(), "{name}");
    }
}

#[test]
fn without_any_folder_there_is_no_cache() {
    let ((_folder, closed), (_other, temporary)) = (closed(), closed());
    render_with(&[("XDG_CACHE_HOME", &closed)], &temporary);
}

/// Code is executed from there.
#[test]
fn a_temporary_cache_that_others_can_write_is_not_used() {
    let (_folder, closed) = closed();
    let open = |folder: &Path| fs::set_permissions(folder, fs::Permissions::from_mode(0o777)).unwrap();
    let (linked, target) = (tempdir().unwrap(), tempdir().unwrap());
    symlink(target.path(), own(linked.path())).unwrap();
    let writable = tempdir().unwrap();
    fs::create_dir(own(writable.path())).unwrap();
    open(&own(writable.path()));
    for temporary in [&linked, &writable] {
        render_with(&[("XDG_CACHE_HOME", &closed)], temporary.path());
        assert_eq!(fs::read_dir(own(temporary.path())).unwrap().count(), 0);
    }
}
