//! Which files the settings of a page may name: those in the scene's folder. The scene's own file, and the settings with
//! which the program was started, may name any.

use std::env::current_dir;
use std::path::{Path, PathBuf};

use super::settings::Source;
use crate::core::error::{Error, Result};
use crate::scene::Setting;

/// Refuses a setting that names something outside the scene's folder.
pub fn check_files(setting: &Setting, source: &Source) -> Result<()> {
    let folder =
        source.path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for word in setting.strings() {
        let Some(found) = existing(&word) else { continue };
        if !folder.canonicalize().is_ok_and(|folder| found.starts_with(folder)) {
            return Err(Error::with_help(
                format!(
                    "--set {}: {word:?} is outside the scene's folder, {}",
                    setting.text(),
                    folder.display()
                ),
                "a page may name files of that folder only; name others in the scene file, or with --set when moire view starts",
            ));
        }
    }
    Ok(())
}

/// Returns what a word leads to as a path: the file, or of a path the last folder that exists; `None` for a mere word.
fn existing(word: &str) -> Option<PathBuf> {
    let path = current_dir().ok()?.join(word);
    if !word.contains(['/', '\\', '<']) && !path.exists() {
        return None;
    }
    path.ancestors().find_map(|own| own.canonicalize().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_elsewhere_are_refused_and_words_are_not_files() {
        let folder = tempfile::tempdir().unwrap();
        let (inside, outside) = (folder.path().join("scenes"), folder.path().join("other.png"));
        std::fs::create_dir(&inside).unwrap();
        std::fs::write(&outside, "x").unwrap();
        std::fs::write(inside.join("own.png"), "x").unwrap();
        let source = Source { path: inside.join("a.toml"), camera: None, device: None };
        let check = |key: &str, value: &str| {
            check_files(&Setting::parse(&format!("{key}={value}")).unwrap(), &source)
        };
        let [own, other] = [inside.join("own.png"), outside].map(|path| path.display().to_string());
        for value in [
            &own,
            &format!("[{own:?}]"),
            &format!("{}/a.<UDIM>.png", inside.display()),
            "ewa",
            "\"t\"",
            "[1, 2]",
        ] {
            assert!(check("texture.t.file", value).is_ok(), "{value}");
        }
        let climbing = format!("{}/../other.png", inside.display());
        for value in [
            &other,
            &format!("[{own:?}, {other:?}]"),
            &climbing,
            "/etc/passwd",
            "../<UDIM>.png",
            "/no/such/file",
        ] {
            assert!(check("texture.t.faces", value).is_err(), "{value}");
        }
        let told = check("mesh.volume", &format!("{{ file = {other:?}, size = [1, 1, 1] }}"))
            .unwrap_err()
            .to_string();
        assert!(told.contains("outside the scene's folder"), "{told}");
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(&other, inside.join("link.png")).unwrap();
            assert!(check("texture.t.file", &inside.join("link.png").display().to_string()).is_err());
        }
    }
}
