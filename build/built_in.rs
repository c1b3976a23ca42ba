//! Lists the files of the repository's scenes, which the program has in itself. Input: `data`. Output: Rust text, an array
//! of paths below `data` with the bytes.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

use super::AnyError;

/// Folders below `data`, each without those within it; what only measurements and tests read is left out.
pub const FOLDERS: [&str; 6] =
    ["scenes", "scenes/start", "textures", "textures/cube", "textures/slices", "models"];

pub fn list() -> Result<String, AnyError> {
    let data = Path::new(&env::var("CARGO_MANIFEST_DIR")?).join("data");
    let mut text = String::from("&[\n");
    for folder in FOLDERS {
        let mut names = Vec::new();
        for entry in fs::read_dir(data.join(folder)).map_err(|error| format!("data/{folder}: {error}"))? {
            let entry = entry?;
            if entry.file_type()?.is_file() {
                names.push(entry.file_name().into_string().map_err(|name| format!("{name:?}: not UTF-8"))?);
            }
        }
        names.sort();
        for name in names {
            let path = data.join(folder).join(&name);
            writeln!(text, "    (\"{folder}/{name}\", include_bytes!({path:?})),")?;
        }
    }
    text.push(']');
    Ok(text)
}
