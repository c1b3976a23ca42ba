//! Paths by which a file names others beside it. Input: the path as written, with `/` between folders. Output: its normal
//! form; one that is absolute or leaves the folder is refused, so that a model reads nothing but what came with it.

/// Returns a relative path in normal form, or what is wrong with it.
pub fn inside(path: &str) -> Result<String, &'static str> {
    if path.contains(':') {
        return Err("has a colon; only relative paths are read");
    }
    if path.contains(char::is_control) {
        return Err("has a control character");
    }
    if path.starts_with('/') {
        return Err("is an absolute path; it has to be relative");
    }
    let mut folders = Vec::new();
    for part in path.split('/') {
        match part {
            "" | "." => {}
            ".." if folders.pop().is_none() => return Err("leaves the folder of the file"),
            ".." => {}
            name => folders.push(name),
        }
    }
    if folders.is_empty() { Err("names no file") } else { Ok(folders.join("/")) }
}
