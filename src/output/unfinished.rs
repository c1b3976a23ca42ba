//! What is on the disk before it is finished: temporary files, and folders that are still empty. In: their paths, from who
//! makes them. Out: nothing of it, where the program ends at a signal and no destructor runs.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn lock() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// A path that is unfinished for as long as this lives.
#[must_use = "it is forgotten when this is dropped"]
pub(super) struct Unfinished(PathBuf);

impl Drop for Unfinished {
    fn drop(&mut self) {
        lock().retain(|own| *own != self.0);
    }
}

/// Runs `create`, which puts something on the disk, and notes its path. A signal comes before or after both.
pub(super) fn create<T, E>(
    create: impl FnOnce() -> Result<T, E>,
    path: fn(&T) -> &Path,
) -> Result<(T, Unfinished), E> {
    let mut unfinished = lock();
    let created = create()?;
    let path = path(&created).to_owned();
    unfinished.push(path.clone());
    Ok((created, Unfinished(path)))
}

/// Removes all that is unfinished and ends the program by `end`. Nothing else is begun meanwhile.
pub fn discard_and_end(end: impl FnOnce()) {
    let unfinished = lock();
    for path in unfinished.iter() {
        // A file that was renamed meanwhile, or a folder that has files, stays.
        let _ = fs::remove_file(path).or_else(|_| fs::remove_dir(path));
    }
    end();
}
