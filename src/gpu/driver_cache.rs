//! The shader cache folder of Mesa's drivers. Reads the environment and, if the default folder
//! cannot be written, sets it to a temporary one, so that the next start finds its shaders compiled
//! and Mesa prints no warning. Paths follow Mesa's `disk_cache_generate_cache_dir`.

use std::ffi::OsString;
use std::fs::{self, DirBuilder};
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::{env, io};

use nix::unistd::{User, getuid};

/// The subfolder that the drivers create for their cache.
const CACHE: &str = "mesa_shader_cache";

/// Sets the cache folder of this process if the default cannot be written. Does nothing once there
/// are other threads, which might read the environment at the same time.
pub fn prepare() {
    if is_alone()
        && let Some((name, value)) = advised()
    {
        // SAFETY: this is the only thread of the process.
        unsafe { env::set_var(name, value) };
    }
}

/// Returns the variable of the environment that [`prepare`] would set, for programs that set it in
/// their own way; `None` if the default suits or the user has decided.
pub fn advised() -> Option<(&'static str, OsString)> {
    let decided = ["MESA_SHADER_CACHE_DISABLE", "MESA_GLSL_CACHE_DISABLE"].map(env::var_os);
    if decided.iter().any(Option::is_some) || wanted().is_some_and(|folder| is_usable(&folder)) {
        return None;
    }
    Some(match private_folder(&env::temp_dir()) {
        Ok(folder) => ("MESA_SHADER_CACHE_DIR", folder.into_os_string()),
        Err(_) => ("MESA_SHADER_CACHE_DISABLE", "true".into()),
    })
}

/// Returns the folder in which Mesa creates its cache, or `None` for a user without a home
/// directory.
fn wanted() -> Option<PathBuf> {
    let named =
        ["MESA_SHADER_CACHE_DIR", "MESA_GLSL_CACHE_DIR", "XDG_CACHE_HOME"].into_iter().find_map(env::var_os);
    let home = || Some(User::from_uid(getuid()).ok()??.dir.join(".cache"));
    named.map(PathBuf::from).or_else(home)
}

/// Returns true if the cache in `folder` exists and is writable or can be created: of the folders
/// above it, at most one may be missing.
fn is_usable(folder: &Path) -> bool {
    if folder.as_os_str().is_empty() {
        return false;
    }
    let own = folder.join(CACHE);
    let above = folder.parent().filter(|path| !path.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let first = [&own, folder, above].into_iter().find(|path| path.symlink_metadata().is_ok());
    first.is_some_and(|path| tempfile::tempfile_in(path).is_ok())
}

/// Returns a folder with a fixed name that no other user can write to, because the drivers execute
/// the code stored there.
fn private_folder(temporary: &Path) -> io::Result<PathBuf> {
    let folder = temporary.join(format!("moire-{}", getuid()));
    match DirBuilder::new().mode(0o700).create(&folder) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => return Err(error),
        _ => {}
    }
    let found = fs::symlink_metadata(&folder)?;
    if !found.is_dir() || found.uid() != getuid().as_raw() || found.mode() & 0o022 != 0 || !is_usable(&folder)
    {
        return Err(io::ErrorKind::PermissionDenied.into());
    }
    Ok(folder)
}

fn is_alone() -> bool {
    fs::read_dir("/proc/self/task").is_ok_and(|threads| threads.count() == 1)
}
