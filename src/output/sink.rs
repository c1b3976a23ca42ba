//! Where the bytes of a file go: a writer that takes them in order, or a file that takes parts of known places from several
//! threads at once, as one thread writes a picture more slowly than many encode it.

use std::fs::File;
use std::io::{self, Write};

use rayon::prelude::*;

/// A destination of bytes.
pub trait Sink: Write {
    /// Returns the file behind it, if there is one that takes bytes at any place.
    fn file(&self) -> Option<&File> {
        None
    }
}

impl Sink for Vec<u8> {}

/// Writes parts to a file, each at the place that `encode` returns for the bytes that it makes. Returns false, and writes
/// nothing, if the system has no such writing.
#[cfg(unix)]
pub fn write_at(
    file: &File,
    parts: usize,
    encode: impl Fn(usize, &mut Vec<u8>) -> u64 + Sync,
) -> io::Result<bool> {
    use std::os::unix::fs::FileExt;
    (0..parts).into_par_iter().try_for_each_init(Vec::new, |bytes, part| {
        let place = encode(part, bytes);
        file.write_all_at(bytes, place)
    })?;
    Ok(true)
}

#[cfg(not(unix))]
pub fn write_at(_: &File, _: usize, _: impl Fn(usize, &mut Vec<u8>) -> u64 + Sync) -> io::Result<bool> {
    Ok(false)
}
