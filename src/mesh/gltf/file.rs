//! The container. Input: the bytes of a .glb or .gltf file. Output: the text of its JSON and, of a .glb, the binary
//! chunk.

use crate::mesh::Fault;

/// The parts of a file.
#[derive(Debug)]
pub(super) struct File<'a> {
    /// The JSON.
    pub(super) text: &'a str,
    /// What buffer 0 of a .glb holds.
    pub(super) binary: Option<&'a [u8]>,
}

/// Finds the parts of a file.
pub(super) fn split(bytes: &[u8]) -> Result<File<'_>, Fault> {
    if bytes.starts_with(b"glTF") {
        return binary(bytes);
    }
    let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if !json.trim_ascii_start().starts_with(b"{") {
        let what = "it is no glTF file: it starts neither with \"glTF\" nor with the brace of a JSON object in UTF-8";
        return Err(Fault::new("header", what));
    }
    Ok(File { text: text(json, 0)?, binary: None })
}

/// Finds the chunks of a .glb.
fn binary(bytes: &[u8]) -> Result<File<'_>, Fault> {
    let version = word(bytes, 4)?;
    if version != 2 {
        return Err(Fault::new("header", format!("its binary container is of version {version}; 2 is read")));
    }
    let length = usize::try_from(word(bytes, 8)?).unwrap_or(usize::MAX);
    let Some(bytes) = bytes.get(..length) else {
        return Err(Fault::new("byte 8", format!("it says {length} bytes, but has {}", bytes.len())));
    };
    let (kind, json, end) = chunk(bytes, 12)?;
    if kind != b"JSON" {
        return Err(Fault::new("byte 16", "the first chunk is not JSON"));
    }
    let mut file = File { text: text(json, 20)?, binary: None };
    // Only the second chunk may be the binary one; later ones belong to extensions.
    if end < bytes.len() {
        let (kind, data, _) = chunk(bytes, end)?;
        file.binary = (kind == b"BIN\0").then_some(data);
    }
    Ok(file)
}

/// Returns the kind and the data of the chunk at a byte, and where the next one starts.
fn chunk(bytes: &[u8], at: usize) -> Result<(&[u8], &[u8], usize), Fault> {
    let length = usize::try_from(word(bytes, at)?).unwrap_or(usize::MAX);
    let kind = bytes.get(at + 4..at + 8).ok_or_else(|| cut(bytes))?;
    let end = (at + 8).saturating_add(length);
    match bytes.get(at + 8..end) {
        Some(data) => Ok((kind, data, end)),
        None => {
            let left = bytes.len().saturating_sub(at + 8);
            Err(Fault::new(format!("byte {at}"), format!("the chunk says {length} bytes; {left} are left")))
        }
    }
}

/// Returns the number at a byte.
fn word(bytes: &[u8], at: usize) -> Result<u32, Fault> {
    let word = bytes.get(at..at + 4).and_then(|four| <[u8; 4]>::try_from(four).ok());
    word.map(u32::from_le_bytes).ok_or_else(|| cut(bytes))
}

fn cut(bytes: &[u8]) -> Fault {
    Fault::new(format!("byte {}", bytes.len()), "the file is cut off")
}

/// Returns bytes as text, without the padding; `start` is where they are in the file.
fn text(bytes: &[u8], start: usize) -> Result<&str, Fault> {
    let padding = bytes.iter().rev().take_while(|byte| **byte == 0).count();
    let bytes = bytes.get(..bytes.len() - padding).unwrap_or(bytes);
    std::str::from_utf8(bytes)
        .map_err(|e| Fault::new(format!("byte {}", start + e.valid_up_to()), "its JSON is not in UTF-8"))
}
