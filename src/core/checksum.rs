//! The length and the checksum of a file, by which it is known again. In: its bytes, or its path. Out: both numbers.

use std::io::{self, Read};
use std::path::Path;

use flate2::Crc;
use serde::{Deserialize, Serialize};

use super::built_in::Opened;

/// Bytes that are read at once.
const PART: usize = 256 << 10;

/// The length and the checksum of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Checksum {
    /// The number of bytes.
    pub bytes: u64,
    /// The CRC-32 of them, as gzip has it.
    pub crc32: u32,
}

impl Checksum {
    /// Returns the checksum of bytes.
    pub fn of(bytes: &[u8]) -> Checksum {
        let mut crc = Crc::new();
        crc.update(bytes);
        Checksum { bytes: bytes.len() as u64, crc32: crc.sum() }
    }

    /// Reads a file of the disk or of the program, part by part.
    pub fn of_file(path: &Path) -> io::Result<Checksum> {
        let mut file = Opened::new(path)?;
        let (mut crc, mut bytes, mut part) = (Crc::new(), 0, vec![0; PART]);
        loop {
            match file.read(&mut part)? {
                0 => return Ok(Checksum { bytes, crc32: crc.sum() }),
                count => {
                    crc.update(&part[..count]);
                    bytes += count as u64;
                }
            }
        }
    }

    /// Returns true if a regular file of the disk has this length and this checksum. Files of other lengths are not read.
    pub fn is_of_file(self, path: &Path) -> bool {
        let is_candidate = path.metadata().is_ok_and(|known| known.is_file() && known.len() == self.bytes);
        is_candidate && Checksum::of_file(path).is_ok_and(|found| found == self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check value of the catalogue of CRCs.
    #[test]
    fn the_checksum_is_that_of_gzip_and_counts_all_parts() {
        assert_eq!(Checksum::of(b"123456789"), Checksum { bytes: 9, crc32: 0xCBF4_3926 });
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let long: Vec<u8> = (0..2 * PART + 7).map(|i| (i % 251) as u8).collect();
        std::fs::write(&path, &long).unwrap();
        assert_eq!(Checksum::of_file(&path).unwrap(), Checksum::of(&long));
        assert!(Checksum::of(&long).is_of_file(&path) && !Checksum::of(&long[1..]).is_of_file(&path));
        assert!(!Checksum::of(b"").is_of_file(folder.path()));
    }
}
