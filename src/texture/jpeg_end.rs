//! Is a JPEG file all there? The decoder fills what a truncated file lacks with grey and reports
//! success, so the end-of-image marker is looked for first (ISO/IEC 10918-1, B.1.1 markers and
//! B.1.1.5 byte stuffing).

use std::io::{self, BufRead, ErrorKind, Read};

const END_OF_IMAGE: u8 = 0xd9;

/// Walks the marker segments from the start of the file. Entropy-coded data is skipped byte by
/// byte; it holds 0xff only before 0x00 or a restart marker, neither of which has a length.
pub fn is_complete(jpeg: &mut impl BufRead) -> io::Result<bool> {
    match walk(jpeg) {
        Ok(()) => Ok(true),
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => Ok(false),
        Err(e) => Err(e),
    }
}

fn walk(jpeg: &mut impl BufRead) -> io::Result<()> {
    loop {
        jpeg.skip_until(0xff)?;
        let mut marker = read_byte(jpeg)?;
        while marker == 0xff {
            marker = read_byte(jpeg)?;
        }
        match marker {
            END_OF_IMAGE => return Ok(()),
            // Stuffed zero, TEM, restart markers, start of image: no segment follows.
            0x00 | 0x01 | 0xd0..=0xd8 => {}
            _ => {
                let length = u16::from_be_bytes([read_byte(jpeg)?, read_byte(jpeg)?]);
                let payload = u64::from(length.saturating_sub(2));
                io::copy(&mut jpeg.by_ref().take(payload), &mut io::sink())?;
            }
        }
    }
}

/// `UnexpectedEof` at the end of the file.
fn read_byte(reader: &mut impl Read) -> io::Result<u8> {
    let mut byte = [0];
    reader.read_exact(&mut byte)?;
    Ok(byte[0])
}
