//! Records within PNG: a chunk of text of our key. It is written as tEXt; the compressed and the international kind, as
//! which other programs store a text again, are read too.

use std::io::{self, Read, Seek};

use flate2::read::ZlibDecoder;

use super::{KEY, MAX_BYTES, array, bytes};

pub(super) fn find(file: &mut (impl Read + Seek)) -> io::Result<Option<Vec<u8>>> {
    loop {
        let length = u32::from_be_bytes(array(file)?);
        let kind: [u8; 4] = array(file)?;
        match &kind {
            b"IEND" => return Ok(None),
            b"tEXt" | b"zTXt" | b"iTXt" if length as usize > KEY.len() => {
                let key = bytes(file, KEY.len() + 1)?;
                let rest = length - key.len() as u32;
                if key[..KEY.len()] == *KEY.as_bytes() && key.ends_with(&[0]) {
                    return text(&kind, &bytes(file, rest as usize)?).map(Some);
                }
                file.seek_relative(i64::from(rest) + 4)?;
            }
            _ => file.seek_relative(i64::from(length) + 4)?,
        }
    }
}

/// Returns the text of a chunk from what follows its key.
fn text(kind: &[u8; 4], data: &[u8]) -> io::Result<Vec<u8>> {
    let (is_compressed, text) = match kind {
        b"tEXt" => (false, data),
        b"zTXt" => (true, data.get(1..).unwrap_or_default()),
        _ => {
            // Behind flag and method, a language and a translated key, which end in 0.
            let mut ends = data.iter().enumerate().skip(2).filter(|(_, byte)| **byte == 0);
            let text = ends.nth(1).map_or(&[][..], |(end, _)| &data[end + 1..]);
            (data.first() == Some(&1), text)
        }
    };
    if !is_compressed {
        return Ok(text.to_vec());
    }
    let mut all = Vec::new();
    ZlibDecoder::new(text).take(MAX_BYTES as u64 + 1).read_to_end(&mut all)?;
    if all.len() > MAX_BYTES {
        return Err(io::Error::other(format!("its record is longer than {} MiB", MAX_BYTES >> 20)));
    }
    Ok(all)
}
