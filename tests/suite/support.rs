//! What several test modules share.

use std::path::PathBuf;

/// The data folder: `MOIRE_DATA`, else `data` in the current folder or beside an ancestor of the
/// test binary, so that the binary also runs on a machine that has no checkout at build paths.
pub fn data() -> PathBuf {
    if let Some(folder) = std::env::var_os("MOIRE_DATA") {
        return folder.into();
    }
    let here = std::env::current_dir().unwrap();
    let binary = std::env::current_exe().unwrap();
    std::iter::once(here.as_path())
        .chain(binary.ancestors())
        .map(|folder| folder.join("data"))
        .find(|folder| folder.join("scenes").is_dir())
        .expect("no folder data/ here or above the test binary; set MOIRE_DATA")
}
