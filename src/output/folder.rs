//! The output folder of a command: `--out DIR`.

use std::fs;
use std::path::Path;

use super::check_file_writable;
use crate::core::error::{Error, Result};

/// Creates the folder if only its last component is missing. Returns an error if `file` cannot be
/// created in it.
pub fn prepare_folder(folder: &Path, file: &str) -> Result<()> {
    let shown = folder.display();
    if !folder.exists() {
        fs::create_dir(folder).map_err(|e| {
            Error::with_help(
                format!("{shown}: the folder cannot be created: {e}"),
                "name a folder, or a new one in a folder that exists and may be written to",
            )
        })?;
    }
    if !folder.is_dir() {
        return Err(Error::with_help(
            format!("{shown}: this is not a folder"),
            "the results are several files: name a folder for them",
        ));
    }
    check_file_writable(&folder.join(file))
}
