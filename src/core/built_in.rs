//! Files that the program has in itself: the repository's scenes with what they read. Input: a path. Output: the file of
//! the disk, or that of the program where the path begins with its folder.

use std::fs::File;
use std::io::{self, Cursor, Read, Seek, SeekFrom};
use std::path::{Component, Path};

/// The folder whose files are the program's own; no folder of a disk is likely to have such a name.
const ROOT: &str = "<moire>";
/// Paths below the folder, and bytes.
const FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/built_in.rs"));

/// A file that was opened, of the disk or of the program.
pub enum Opened {
    /// A file of the disk.
    Disk(File),
    /// A file of the program.
    BuiltIn(Cursor<&'static [u8]>),
}

impl Opened {
    /// Opens a file.
    pub fn new(path: &Path) -> io::Result<Opened> {
        match bytes(path) {
            Some(bytes) => Ok(Opened::BuiltIn(Cursor::new(bytes))),
            None => File::open(path).map(Opened::Disk),
        }
    }

    /// Returns the number of its bytes; 0 for a pipe.
    pub fn length(&self) -> io::Result<u64> {
        match self {
            Opened::Disk(file) => file.metadata().map(|known| known.len()),
            Opened::BuiltIn(bytes) => Ok(bytes.get_ref().len() as u64),
        }
    }
}

impl Read for Opened {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Opened::Disk(file) => file.read(buffer),
            Opened::BuiltIn(bytes) => bytes.read(buffer),
        }
    }
}

impl Seek for Opened {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        match self {
            Opened::Disk(file) => file.seek(to),
            Opened::BuiltIn(bytes) => bytes.seek(to),
        }
    }
}

/// Returns the bytes of a file of the program; `None` for all other paths.
pub fn bytes(path: &Path) -> Option<&'static [u8]> {
    let below = path.strip_prefix(ROOT).ok()?;
    let mut parts: Vec<&str> = Vec::new();
    for component in below.components() {
        match component {
            Component::ParentDir => drop(parts.pop()?),
            Component::Normal(part) => parts.push(part.to_str()?),
            _ => {}
        }
    }
    let wanted = parts.join("/");
    FILES.iter().find(|(name, _)| *name == wanted).map(|(_, bytes)| *bytes)
}

/// Returns the path by which a file of the program is opened.
pub fn path_of(below: &str) -> std::path::PathBuf {
    Path::new(ROOT).join(below)
}

/// Returns the paths of all files below the folder.
pub fn names() -> impl Iterator<Item = &'static str> {
    FILES.iter().map(|(name, _)| *name)
}
