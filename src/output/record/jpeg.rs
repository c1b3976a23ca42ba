//! Records within JPEG: comments, which hold 64 KiB at most, so that a record may be several, each with its number.

use std::io::{self, Read, Seek, Write};

use super::{MAX_BYTES, array, bytes};

const MARKER: u8 = 0xff;
const COMMENT: u8 = 0xfe;
/// Start of scan and end of image: no more comments.
const ENDS: [u8; 2] = [0xda, 0xd9];
/// Before each part, with its number and how many there are.
const HEAD: &str = "moire record ";
/// The text of a part, less than a segment takes with its head.
const PART_BYTES: usize = 65_000;

/// Returns the segments of a record.
pub(in crate::output) fn segments(record: &str) -> Vec<u8> {
    let parts = record.as_bytes().chunks(PART_BYTES);
    let count = parts.len();
    let mut segments = Vec::new();
    for (i, part) in parts.enumerate() {
        let head = format!("{HEAD}{} of {count}\n", i + 1);
        segments.extend([MARKER, COMMENT]);
        segments.extend(((head.len() + part.len() + 2) as u16).to_be_bytes());
        segments.extend(head.bytes());
        segments.extend(part);
    }
    segments
}

pub(super) fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<Vec<u8>>> {
    let mut record = Vec::new();
    let mut next = 1;
    loop {
        let [marker] = array(file)?;
        if marker != MARKER {
            return Err(io::Error::other("it is damaged: a segment begins without its marker"));
        }
        let mut kind = MARKER;
        while kind == MARKER {
            [kind] = array(file)?;
        }
        if ENDS.contains(&kind) {
            return Ok(None);
        }
        let length = usize::from(u16::from_be_bytes(array(file)?)).saturating_sub(2);
        if kind != COMMENT {
            file.seek_relative(length as i64)?;
            continue;
        }
        let segment = bytes(file, length)?;
        let Some((number, count, part)) = numbered(&segment) else { continue };
        if number != next || record.len() + part.len() > MAX_BYTES {
            return Err(io::Error::other(format!("part {next} of its record is missing")));
        }
        record.extend(part);
        next += 1;
        if number == count {
            return Ok(Some(record));
        }
    }
}

/// Returns the number of a part, how many there are, and its text.
fn numbered(segment: &[u8]) -> Option<(usize, usize, &[u8])> {
    let rest = segment.strip_prefix(HEAD.as_bytes())?;
    let end = rest.iter().take(32).position(|byte| *byte == b'\n')?;
    let (number, count) = std::str::from_utf8(&rest[..end]).ok()?.split_once(" of ")?;
    Some((number.parse().ok()?, count.parse().ok()?, &rest[end + 1..]))
}

/// A writer that puts bytes of its own behind the first ones, as comments follow the header of JFIF.
pub(in crate::output) struct Insert<W> {
    to: W,
    /// The bytes still to come before those that are inserted.
    before: usize,
    inserted: Vec<u8>,
}

impl<W: Write> Insert<W> {
    pub(in crate::output) fn new(to: W, before: usize, inserted: Vec<u8>) -> Insert<W> {
        Insert { to, before, inserted }
    }
}

impl<W: Write> Write for Insert<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.inserted.is_empty() {
            return self.to.write(bytes);
        }
        let written = self.to.write(&bytes[..bytes.len().min(self.before)])?;
        self.before -= written;
        if self.before == 0 {
            self.to.write_all(&std::mem::take(&mut self.inserted))?;
        }
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}
