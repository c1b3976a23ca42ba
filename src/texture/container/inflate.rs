//! Levels of KTX2 files that are compressed once more, by Zstandard or zlib. Takes the compressed bytes and how many they
//! must become; returns these. Memory grows with what comes out, never by what a header says.

use std::io::Read;

use flate2::read::ZlibDecoder;
use ruzstd::decoding::StreamingDecoder;

use crate::texture::decoder::Fault;

/// The most bytes that one of Zstandard becomes: a block of 128 KiB of one byte takes 4.
const MAX_ZSTD_RATIO: u64 = 1 << 15;
/// Bytes of a Zstandard frame before the first block, at least.
const MAX_SLACK: u64 = 1 << 17;

/// Returns `bytes` bytes of a frame of Zstandard.
pub(super) fn zstd(compressed: &[u8], bytes: u64) -> Result<Vec<u8>, Fault> {
    if bytes > MAX_SLACK + MAX_ZSTD_RATIO.saturating_mul(compressed.len() as u64) {
        return Err(Fault::Damaged(format!("{} bytes cannot become {bytes}", compressed.len())));
    }
    let decoder = StreamingDecoder::new(compressed).map_err(|e| Fault::Damaged(e.to_string()))?;
    whole(decoder, bytes)
}

/// Returns `bytes` bytes of a zlib stream.
pub(super) fn zlib(compressed: &[u8], bytes: u64) -> Result<Vec<u8>, Fault> {
    whole(ZlibDecoder::new(compressed), bytes)
}

fn whole(decoder: impl Read, bytes: u64) -> Result<Vec<u8>, Fault> {
    let mut inflated = Vec::new();
    let read = decoder.take(bytes + 1).read_to_end(&mut inflated);
    read.map_err(|e| Fault::Damaged(e.to_string()))?;
    match (inflated.len() as u64).cmp(&bytes) {
        std::cmp::Ordering::Equal => Ok(inflated),
        order => Err(Fault::Damaged(format!(
            "a level becomes {} than {bytes} bytes",
            if order.is_lt() { "fewer" } else { "more" }
        ))),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::*;

    #[test]
    fn zlib_and_zstd_give_exactly_the_bytes_that_are_due() {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
        encoder.write_all(&[7; 100]).expect("memory takes all");
        let packed = encoder.finish().expect("memory takes all");
        assert_eq!(zlib(&packed, 100).expect("it is whole"), [7; 100]);
        // One frame of one raw block (RFC 8878): magic, single segment of one byte of size, last block of 3 bytes.
        let frame = b"\x28\xb5\x2f\xfd\x20\x03\x19\0\0abc";
        assert_eq!(zstd(frame, 3).expect("it is whole"), b"abc");
        for bytes in [2, 4] {
            assert!(zstd(frame, bytes).is_err() && zlib(&packed, 99 + bytes / 4 * 2).is_err(), "{bytes}");
        }
        assert!(zstd(frame, u64::MAX / 2).is_err() && zstd(b"", 1).is_err() && zlib(b"\x78", 1).is_err());
    }
}
