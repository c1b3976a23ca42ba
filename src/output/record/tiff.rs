//! Records within TIFF: the description of the first picture (tag 270).

use std::io::{self, Read, Seek, SeekFrom};

use super::{array, bytes};

const DESCRIPTION: u16 = 270;
const ASCII: u16 = 2;
/// Files of a few pages have some dozens.
const MAX_ENTRIES: u16 = 4096;

pub(super) fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<Vec<u8>>> {
    search(file, u16::from_le_bytes, u32::from_le_bytes)
}

pub(super) fn find_big_endian(file: &mut (impl Read + Seek)) -> io::Result<Option<Vec<u8>>> {
    search(file, u16::from_be_bytes, u32::from_be_bytes)
}

fn search(
    file: &mut (impl Read + Seek),
    short: fn([u8; 2]) -> u16,
    long: fn([u8; 4]) -> u32,
) -> io::Result<Option<Vec<u8>>> {
    let directory = long(array(file)?);
    file.seek(SeekFrom::Start(directory.into()))?;
    for _ in 0..short(array(file)?).min(MAX_ENTRIES) {
        let (tag, kind, count) = (short(array(file)?), short(array(file)?), long(array(file)?));
        let value: [u8; 4] = array(file)?;
        // Shorter texts stand in place of the offset, and are no records.
        if (tag, kind) == (DESCRIPTION, ASCII) && count > 4 {
            file.seek(SeekFrom::Start(long(value).into()))?;
            let mut text = bytes(file, count as usize)?;
            let end = text.iter().position(|byte| *byte == 0).unwrap_or(text.len());
            text.truncate(end);
            return Ok(Some(text));
        }
    }
    Ok(None)
}
