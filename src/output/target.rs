//! The destination of a file: a temporary file in the same folder, renamed to the final name once
//! complete (rename(2) replaces atomically within one file system) and removed otherwise.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::sink::Sink;
use super::unfinished::{self, Unfinished};
use crate::core::error::{Error, Result};

/// The buffer gathers small writes, as of heads and chunks; bands of rows pass it by.
const BUFFER: usize = 64 << 10;

pub struct Target {
    /// The path as the user wrote it, for messages.
    path: PathBuf,
    /// The path with symbolic links resolved, so that a link stays a link.
    destination: PathBuf,
    file: BufWriter<NamedTempFile>,
    /// Behind the file, which it outlives.
    _unfinished: Unfinished,
}

impl Target {
    pub fn create(path: &Path) -> Result<Target> {
        let destination = check_destination(path)?;
        let folder = destination.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        check_folder(path, folder)?;
        let (file, unfinished) =
            unfinished::create(|| new_file(folder), NamedTempFile::path).map_err(|e| {
                Error::with_help(
                    format!("{}: the folder {} is not writable: {e}", path.display(), folder.display()),
                    "choose a folder where files can be created",
                )
            })?;
        Ok(Target {
            path: path.to_path_buf(),
            destination,
            file: BufWriter::with_capacity(BUFFER, file),
            _unfinished: unfinished,
        })
    }

    pub fn writer(&mut self) -> &mut dyn Sink {
        self
    }

    /// Writes all bytes to the temporary file, so that a full disk is detected before the rename.
    pub fn complete(&mut self) -> Result<()> {
        self.file.flush().map_err(|e| failed(&self.path, &e))
    }

    pub fn finish(self) -> Result<()> {
        let file = self.file.into_inner().map_err(|e| failed(&self.path, &e.into_error()))?;
        file.persist(&self.destination).map_err(|e| failed(&self.path, &e.error))?;
        Ok(())
    }
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl Sink for Target {
    fn file(&self) -> Option<&File> {
        Some(self.file.get_ref().as_file())
    }
}

fn failed(path: &Path, error: &std::io::Error) -> Error {
    Error::with_help(
        format!("{}: cannot be written: {error}", path.display()),
        "nothing was written; check the disk's free space and the folder's permissions",
    )
}

/// Creates the temporary file. Such files are private by default; a picture gets the permissions of
/// any new file, 0666 minus the umask, which the system subtracts.
fn new_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".moire-").suffix(OsStr::new(".part"));
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

/// Returns the resolved path. An existing destination must be a regular writable file: a rename
/// alone would silently replace a file that its owner has protected.
fn check_destination(path: &Path) -> Result<PathBuf> {
    let refused = |what: String, help: &str| Error::with_help(format!("{}: {what}", path.display()), help);
    if path.as_os_str().to_string_lossy().ends_with(std::path::is_separator) {
        return Err(refused("this names a folder, not a file".into(), "add a file name"));
    }
    match fs::metadata(path) {
        Ok(m) if m.is_dir() => Err(refused("this is a folder".into(), "name a file in it")),
        Ok(m) if !m.is_file() => Err(refused("this is not a regular file".into(), "choose another name")),
        Ok(_) => {
            let open: std::io::Result<File> = OpenOptions::new().write(true).open(path);
            open.and_then(|_| fs::canonicalize(path)).map_err(|e| {
                refused(format!("the file exists and cannot be replaced: {e}"), "choose another name")
            })
        }
        // A missing folder gets its own message.
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(path.to_path_buf())
        }
        Err(e) => {
            Err(refused(format!("cannot be written: {e}"), "check the name and the folder's permissions"))
        }
    }
}

fn check_folder(path: &Path, folder: &Path) -> Result<()> {
    if folder.is_dir() {
        return Ok(());
    }
    let what = if folder.exists() { "is not a folder" } else { "does not exist" };
    Err(Error::with_help(
        format!("{}: {} {what}", path.display(), folder.display()),
        "create the folder first; output folders are never created",
    ))
}
