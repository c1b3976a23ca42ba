//! The output folder of a command: `--out DIR`. In: its path. Out: the folder, which is removed again where it was created
//! and no file came into it.

use std::fs;
use std::path::{Path, PathBuf};

use super::check_file_writable;
use super::unfinished::{self, Unfinished};
use crate::core::error::{Error, Result};

/// A folder for results, for as long as they are made.
#[must_use = "a new folder without files is removed with it"]
pub struct OutputFolder {
    /// The path, if the folder was created.
    created: Option<(PathBuf, Unfinished)>,
}

impl OutputFolder {
    /// Creates the folder if only its last component is missing. Returns an error if `file` cannot be
    /// created in it.
    pub fn prepare(folder: &Path, file: &str) -> Result<OutputFolder> {
        let shown = folder.display();
        let mut own = OutputFolder { created: None };
        if !folder.exists() {
            let create = || fs::create_dir(folder).map(|()| folder.to_owned());
            own.created = Some(unfinished::create(create, PathBuf::as_path).map_err(|e| {
                Error::with_help(
                    format!("{shown}: the folder cannot be created: {e}"),
                    "name a folder, or a new one in a folder that exists and may be written to",
                )
            })?);
        }
        if !folder.is_dir() {
            return Err(Error::with_help(
                format!("{shown}: this is not a folder"),
                "the results are several files: name a folder for them",
            ));
        }
        check_file_writable(&folder.join(file))?;
        Ok(own)
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        if let Some((path, _)) = &self.created {
            // Fails if there are files in it, which are the results.
            let _ = fs::remove_dir(path);
        }
    }
}
