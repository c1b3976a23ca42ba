//! Records within Radiance HDR: comments of the header. Lines are kept short, as readers have room for about 2000 bytes
//! of one; a record is all lines with our beginning, joined.

use std::io::{self, BufRead, BufReader, Read};

use super::{KEY, MAX_BYTES};

const LINE_BYTES: usize = 1000;

/// Returns the lines of a record.
pub(in crate::output) fn lines(record: &str) -> Vec<u8> {
    let lines = record.as_bytes().chunks(LINE_BYTES);
    lines.flat_map(|line| [format!("# {KEY} ").as_bytes(), line, b"\n"].concat()).collect()
}

pub(super) fn find(file: &mut BufReader<impl Read>) -> io::Result<Option<Vec<u8>>> {
    let start = format!("# {KEY} ");
    let mut record = Vec::new();
    // The header of a record is hardly longer than the record.
    let mut header = file.take(2 * MAX_BYTES as u64);
    loop {
        let mut line = Vec::new();
        header.read_until(b'\n', &mut line)?;
        if !line.ends_with(b"\n") {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        line.pop();
        if line.is_empty() {
            return Ok((!record.is_empty()).then_some(record));
        }
        record.extend(line.strip_prefix(start.as_bytes()).unwrap_or_default());
    }
}
