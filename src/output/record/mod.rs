//! The record of a picture: a line of text within its file that says how it was made. In: a picture file of any format
//! that is written here. Out: its text, if there is one. The writers of the formats put it there. It is ASCII without
//! line breaks, so that one text suits every format; what it says is up to the caller.

mod exr;
pub(super) mod hdr;
pub(super) mod jpeg;
mod png;
mod tiff;

use std::fs::File;
use std::io::{self, BufReader, ErrorKind as Io, Read, Seek, SeekFrom};
use std::path::Path;

use crate::core::error::{Error, ErrorKind, Result};

/// The key of a record where a format has keys, and the beginning of its lines where it has comments.
pub(super) const KEY: &str = "moire";
/// The program, for the fields that formats have for it.
pub(super) const SOFTWARE: &str = concat!("moire ", env!("CARGO_PKG_VERSION"));
/// The longest record that is read.
pub const MAX_BYTES: usize = 4 << 20;

/// Reads the record of a format from a file behind its first bytes.
type Find = fn(&mut BufReader<File>) -> io::Result<Option<Vec<u8>>>;

/// The first bytes of the formats.
const FORMATS: [(&[u8], Find); 6] = [
    (b"\x89PNG\r\n\x1a\n", png::find),
    (b"\xff\xd8", jpeg::find),
    (b"II*\0", tiff::find),
    (b"MM\0*", tiff::find_big_endian),
    (b"\x76\x2f\x31\x01", exr::find),
    (b"#?", hdr::find),
];

/// Returns the record of a picture file; `None` if it has none.
pub fn read(path: &Path) -> Result<Option<String>> {
    let failed = |what: &str| {
        Error::new(format!("cannot read picture {}: {what}", path.display())).of_kind(ErrorKind::File)
    };
    if path.is_dir() {
        return Err(failed("it is a folder"));
    }
    // Opening a pipe would wait for whoever writes.
    if path.metadata().is_ok_and(|known| !known.is_file()) {
        return Err(failed("it is not a regular file"));
    }
    let mut file = BufReader::new(File::open(path).map_err(|error| failed(&error.to_string()))?);
    let mut start = Vec::new();
    (&mut file).take(8).read_to_end(&mut start).map_err(|error| failed(&error.to_string()))?;
    let format = FORMATS.iter().find(|(magic, _)| start.starts_with(magic));
    let Some((magic, find)) = format else {
        return Err(failed("it is none of PNG, JPEG, TIFF, OpenEXR and Radiance HDR, which carry records"));
    };
    let found = file.seek(SeekFrom::Start(magic.len() as u64)).and_then(|_| find(&mut file));
    match found {
        Ok(Some(bytes)) => String::from_utf8(bytes).map(Some).map_err(|_| failed("its record is no text")),
        Ok(None) => Ok(None),
        Err(error) if error.kind() == Io::UnexpectedEof => Err(failed("the file ends too early")),
        Err(error) => Err(failed(&error.to_string())),
    }
}

/// Returns the text with all that is not ASCII, and control characters, as escapes of JSON: a text of JSON stays the same.
pub fn ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for c in json.chars() {
        if c.is_ascii() && !c.is_ascii_control() {
            text.push(c);
        } else {
            let mut units = [0; 2];
            c.encode_utf16(&mut units).iter().for_each(|unit| text += &format!("\\u{unit:04x}"));
        }
    }
    text
}

/// Reads this many bytes, if that is not more than a record has.
fn bytes(from: &mut impl Read, count: usize) -> io::Result<Vec<u8>> {
    if count > MAX_BYTES {
        return Err(io::Error::other(format!("its record is longer than {} MiB", MAX_BYTES >> 20)));
    }
    let mut bytes = vec![0; count];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

/// Reads a few bytes.
fn array<const N: usize>(from: &mut impl Read) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    from.read_exact(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #[test]
    fn texts_of_json_become_ascii_and_stay_the_same() {
        let text = "a\"\\\n é – 🂡\u{7f}";
        let json = serde_json::to_string(text).unwrap();
        let ascii = super::ascii(&json);
        assert!(ascii.bytes().all(|b| (32..127).contains(&b)), "{ascii}");
        assert_eq!(serde_json::from_str::<String>(&ascii).unwrap(), text);
    }
}
