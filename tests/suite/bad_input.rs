//! Invalid input through the program itself: each mistake ends with exit code 2 and a message on
//! stderr that names the culprit, never with a panic; no file appears, not even a temporary one,
//! and an existing picture is unchanged.

mod limits;
mod machine;
mod models;
mod output;
mod scene;
mod texture;

use std::fs;
use std::path::PathBuf;

use image::{GrayImage, Luma};
use tempfile::{TempDir, tempdir};

use crate::stage::device_name;
use crate::support::moire;

const OLD: &[u8] = b"the picture that was there";

/// A folder with a scene of one textured plane, its texture, and an older picture `out.png`.
struct Case {
    folder: TempDir,
}

const SCENE: &str = r#"
[camera]
eye = [0.0, 1.0, 0.0]
look_at = [0.0, 0.2, -4.0]
vertical_fov = 60.0

[image]
width = 16
height = 12

[sampling]
spp = 4

[[texture]]
name = "tiles"
file = "tiles.png"

[[sampler]]
name = "linear"

[[material]]
name = "floor"
model = "unlit"
texture = "tiles"
sampler = "linear"

[[plane]]
origin = [0.0, 0.0, 0.0]
tangent = [1.0, 0.0, 0.0]
bitangent = [0.0, 0.0, 1.0]
material = "floor"
"#;

impl Case {
    fn new() -> Case {
        let case = Case { folder: tempdir().unwrap() };
        case.put("scene.toml", SCENE.as_bytes());
        case.put("out.png", OLD);
        case.texture(4, 4);
        case
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn put(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    /// A grey texture of this size.
    fn texture(&self, width: u32, height: u32) {
        GrayImage::from_pixel(width, height, Luma([100])).save(self.path("tiles.png")).unwrap();
    }

    /// The scene with `old` replaced by `new`, which must change it.
    fn edit(old: &str, new: &str) -> Case {
        let case = Case::new();
        let text = SCENE.replace(old, new);
        assert_ne!(text, SCENE, "{old}");
        case.put("scene.toml", text.as_bytes());
        case
    }

    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn run(&self, environment: &[(&str, &str)], args: &[&str]) -> (Option<i32>, String, String) {
        let mut command = moire();
        command.current_dir(self.folder.path()).envs(environment.iter().copied()).args(args);
        let output = command.output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        (output.status.code(), text(&output.stdout), text(&output.stderr))
    }

    /// Expects the command to fail properly, and to print each of `wanted`.
    fn fails(&self, environment: &[(&str, &str)], args: &[&str], wanted: &[&str]) {
        let before = self.files();
        let (code, stdout, stderr) = self.run(environment, args);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{args:?}: {stderr}");
        for sign in ["panicked", "RUST_BACKTRACE", "src/"] {
            assert!(!stderr.contains(sign), "{sign} in: {stderr}");
        }
        // The report wraps long lines, and marks quoted source with bars.
        let squash = |s: &str| s.replace(|c: char| c.is_whitespace() || c == '│', "");
        for part in wanted {
            assert!(squash(&stderr).contains(&squash(part)), "`{part}` not in: {stderr}");
        }
        assert_eq!(self.files(), before, "{args:?} left files");
        assert_eq!(fs::read(self.path("out.png")).unwrap(), OLD, "{args:?} touched the older picture");
    }

    /// Expects rendering the scene to the older picture to fail.
    fn refused(&self, options: &[&str], wanted: &[&str]) {
        let device = device_name();
        let fixed = ["render", "scene.toml", "-o", "out.png", "--device", &device];
        self.fails(&[], &[&fixed[..], options].concat(), wanted);
    }

    fn renders(&self, options: &[&str]) {
        let device = device_name();
        let fixed = ["render", "scene.toml", "-q", "-o", "out.png", "--device", &device];
        let (code, _, stderr) = self.run(&[], &[&fixed[..], options].concat());
        assert_eq!((code, stderr.as_str()), (Some(0), ""), "{options:?}");
        assert_ne!(fs::read(self.path("out.png")).unwrap(), OLD);
        self.put("out.png", OLD);
    }
}

#[test]
fn nothing_wrong_renders() {
    Case::new().renders(&[]);
}

/// The behaviour of `main` for a command that panics, itself or in a thread that it joins.
#[test]
fn a_panic_ends_a_command_with_exit_code_2() {
    use std::process::ExitCode;
    let exit = |command: fn() -> moire::internal::core::error::Result<ExitCode>| {
        format!(
            "{:?}",
            moire::internal::cli::exit_code(moire::internal::core::panics::contain(&"moire test", command))
        )
    };
    assert_eq!(exit(|| panic!("planted")), format!("{:?}", ExitCode::from(2)));
    assert_eq!(exit(|| std::thread::scope(|_| unreachable!("planted"))), format!("{:?}", ExitCode::from(2)));
    assert_eq!(exit(|| Ok(ExitCode::SUCCESS)), format!("{:?}", ExitCode::SUCCESS));
}
