//! Records within OpenEXR: a string attribute of our key in the first header.

use std::io::{self, Read, Seek};

use super::{KEY, array, bytes};

/// The longest name of an attribute or a type.
const MAX_NAME: usize = 255;

pub(super) fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<Vec<u8>>> {
    let _version: [u8; 4] = array(file)?;
    loop {
        let name = name(file)?;
        if name.is_empty() {
            return Ok(None);
        }
        let kind = self::name(file)?;
        let size = u32::from_le_bytes(array(file)?);
        if name == KEY.as_bytes() && kind == b"string" {
            return bytes(file, size as usize).map(Some);
        }
        file.seek_relative(size.into())?;
    }
}

/// Reads a text up to its 0.
fn name(file: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut name = Vec::new();
    loop {
        match array(file)? {
            [0] => return Ok(name),
            [byte] if name.len() < MAX_NAME => name.push(byte),
            _ => return Err(io::Error::other("it is damaged: the name of an attribute has no end")),
        }
    }
}
