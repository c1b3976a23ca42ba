//! Decompresses one strip or tile to exactly the number of bytes that its area needs. A stream may
//! be longer or lack its end code; one that yields fewer bytes is damaged.

use std::borrow::Cow;
use std::io::Read;

use fax::decoder::{DecodeStatus, Group4Decoder};
use flate2::read::ZlibDecoder;
use weezl::{BitOrder, LzwStatus, decode::Decoder};

use super::Fault;
use super::color::Color;
use super::layout::{Compression, Layout};
use crate::texture::decoder;
use crate::texture::jpeg_data::JpegData;

/// Returns the largest number of decompressed bytes per stored byte. LZW: a code of 12 bits for a
/// string of 3838 bytes. JPEG: a block of 8×8 texels takes a bit of each channel, and chroma may
/// cover four blocks. Group 4: a row takes a bit and has at most 65535 texels.
pub(super) fn greatest_ratio(compression: Compression) -> u64 {
    match compression {
        Compression::None => 1,
        Compression::PackBits => 64,
        Compression::Deflate => 1032,
        Compression::Jpeg => 1536,
        Compression::Lzw => 2560,
        Compression::Group4 => 65_536,
    }
}

/// Decompresses a chunk of `rows` rows to `wanted` bytes.
pub(super) fn decompress(
    stored: &[u8],
    layout: &Layout,
    jpeg_tables: Option<&[u8]>,
    rows: u32,
    wanted: usize,
) -> Result<Vec<u8>, Fault> {
    let stored = match layout.bits_reversed && layout.compression != Compression::Jpeg {
        true => Cow::Owned(stored.iter().map(|b| b.reverse_bits()).collect::<Vec<u8>>()),
        false => Cow::Borrowed(stored),
    };
    let most = (stored.len() as u64).saturating_mul(greatest_ratio(layout.compression));
    if wanted as u64 > most {
        return Err(short(most, wanted));
    }
    let mut plain = Vec::new();
    plain.try_reserve_exact(wanted).map_err(|_| Fault::Memory)?;
    match layout.compression {
        Compression::None => plain.extend_from_slice(&stored[..wanted]),
        Compression::PackBits => unpack_bits(&stored, wanted, &mut plain),
        Compression::Lzw => {
            plain.resize(wanted, 0);
            let written = expand_lzw(&stored, &mut plain)?;
            plain.truncate(written);
        }
        Compression::Deflate => {
            let mut stream = ZlibDecoder::new(&*stored).take(wanted as u64);
            stream.read_to_end(&mut plain).map_err(|e| Fault::damaged(format!("Deflate data: {e}")))?;
        }
        Compression::Jpeg => expand_jpeg(&stored, layout, jpeg_tables, rows, wanted, &mut plain)?,
        Compression::Group4 => expand_group4(&stored, layout.chunks.width, rows, &mut plain)?,
    }
    match plain.len() < wanted {
        true => Err(short(plain.len() as u64, wanted)),
        false => Ok(plain),
    }
}

fn short(found: u64, wanted: usize) -> Fault {
    Fault::damaged(format!("a strip or tile gives at most {found} of {wanted} bytes"))
}

/// Decodes PackBits (TIFF 6.0, section 9).
fn unpack_bits(mut stored: &[u8], wanted: usize, plain: &mut Vec<u8>) {
    while let (true, [head, rest @ ..]) = (plain.len() < wanted, stored) {
        let room = wanted - plain.len();
        stored = match (*head as i8, rest) {
            (-128, _) => rest,
            (n @ 0.., _) => {
                let (literal, after) = rest.split_at(rest.len().min(n as usize + 1));
                plain.extend(literal.iter().take(room));
                after
            }
            (n, [value, after @ ..]) => {
                plain.extend(std::iter::repeat_n(*value, room.min(1 + usize::from(n.unsigned_abs()))));
                after
            }
            (_, []) => rest,
        };
    }
}

/// Decodes LZW (TIFF 6.0, section 13): codes from the highest bit on, one bit longer a code early.
fn expand_lzw(stored: &[u8], plain: &mut [u8]) -> Result<usize, Fault> {
    // The variant before TIFF 5.0 begins with the clear code from the lowest bit on.
    if let [0, second, ..] = stored
        && second & 1 == 1
    {
        return Err(Fault::unsupported("old LZW compression, of before 1988"));
    }
    let mut decoder = Decoder::with_tiff_size_switch(BitOrder::Msb, 8);
    let (mut read, mut written) = (0, 0);
    while written < plain.len() {
        let step = decoder.decode_bytes(&stored[read..], &mut plain[written..]);
        (read, written) = (read + step.consumed_in, written + step.consumed_out);
        match step.status {
            Ok(LzwStatus::Ok) if step.consumed_in + step.consumed_out > 0 => {}
            Ok(_) => break,
            Err(e) => return Err(Fault::damaged(format!("LZW data: {e}"))),
        }
    }
    Ok(written)
}

/// Decodes JPEG. Tables shared by all chunks are stored in a tag (TIFF Technical Note 2); they are
/// prepended to the chunk's own data, after Adobe's marker, which states whether the channels are
/// YCbCr.
fn expand_jpeg(
    stored: &[u8],
    layout: &Layout,
    tables: Option<&[u8]>,
    rows: u32,
    wanted: usize,
    plain: &mut Vec<u8>,
) -> Result<(), Fault> {
    const START: &[u8] = &[0xff, 0xd8];
    const END: &[u8] = &[0xff, 0xd9];
    let body =
        stored.strip_prefix(START).ok_or_else(|| Fault::damaged("JPEG data without its first marker"))?;
    let tables =
        tables.and_then(|t| t.strip_prefix(START)).map_or(&[][..], |t| t.strip_suffix(END).unwrap_or(t));
    let is_ycbcr = matches!(layout.color, Color::YCbCr);
    let adobe = [&b"\xff\xee\0\x0eAdobe\0\x64\0\0\0\0"[..], &[u8::from(is_ycbcr)]].concat();
    let jpeg = [START, &adobe, tables, body].concat();
    if let Some(name) = super::super::read_jpeg::unsupported(&jpeg) {
        return Err(Fault::unsupported(format!("{name} within a TIFF file")));
    }
    let data = JpegData::new(&jpeg).map_err(within_tiff)?;
    let decoder::Header { width, height, channels, .. } = data.header;
    if width != layout.chunks.width || height < rows || channels != layout.samples_in_chunk() {
        return Err(Fault::damaged(format!(
            "JPEG data of {width}×{height} texels with {channels} channels, in a place of {}×{rows} with {}",
            layout.chunks.width,
            layout.samples_in_chunk()
        )));
    }
    let bytes = width as usize * height as usize * channels;
    if bytes > wanted.saturating_mul(2).max(1 << 20) {
        return Err(Fault::damaged(format!("JPEG data of {height} rows, in a place of {rows}")));
    }
    plain.try_reserve_exact(bytes).map_err(|_| Fault::Memory)?;
    plain.resize(bytes, 0);
    data.read(plain).map_err(within_tiff)?;
    plain.truncate(wanted);
    Ok(())
}

fn within_tiff(fault: decoder::Fault) -> Fault {
    match fault {
        decoder::Fault::Damaged(what) => Fault::damaged(format!("JPEG data: {what}")),
        decoder::Fault::Unsupported(what) => Fault::unsupported(format!("JPEG data of {what}")),
        decoder::Fault::Memory => Fault::Memory,
        decoder::Fault::ZeroSize => Fault::damaged("JPEG data of zero size"),
    }
}

/// Decodes Group 4 (ITU-T T.6): runs of white, which is 0, and of black.
fn expand_group4(stored: &[u8], width: u32, rows: u32, plain: &mut Vec<u8>) -> Result<(), Fault> {
    let width = u16::try_from(width).map_err(|_| Fault::unsupported("CCITT data wider than 65535 texels"))?;
    let failed = || Fault::damaged("CCITT group 4 data");
    let bytes = stored.iter().map(|b| Ok::<u8, std::convert::Infallible>(*b));
    let mut decoder = Group4Decoder::new(bytes, width).map_err(|_| failed())?;
    for _ in 0..rows {
        if decoder.advance().map_err(|_| failed())? == DecodeStatus::End {
            break;
        }
        let mut texels = fax::decoder::pels(decoder.transition(), width);
        for _ in 0..width.div_ceil(8) {
            let bit = |i| texels.next().map_or(0, |color| u8::from(color == fax::Color::Black) << (7 - i));
            plain.push((0..8).map(bit).sum());
        }
    }
    // Trailing rows that are entirely white may be omitted.
    plain.resize(usize::from(width).div_ceil(8) * rows as usize, 0);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packed_bits_are_those_of_the_specifications_example() {
        // Decodes PackBits (TIFF 6.0, section 9).
        let packed = b"\xfe\xaa\x02\x80\x00\x2a\xfd\xaa\x03\x80\x00\x2a\x22\xf7\xaa";
        let plain = b"\xaa\xaa\xaa\x80\x00\x2a\xaa\xaa\xaa\xaa\x80\x00\x2a\x22\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa\xaa";
        for wanted in [plain.len(), 5, 0] {
            let mut found = Vec::new();
            unpack_bits(packed, wanted, &mut found);
            assert_eq!(found, plain[..wanted]);
        }
        let mut found = Vec::new();
        unpack_bits(&[0x80, 0x81, 7, 3, 1], 1000, &mut found);
        assert_eq!(found, [&[7; 128][..], &[1]].concat());
    }

    #[test]
    fn lzw_is_that_of_the_specifications_example() {
        // TIFF 6.0, section 13: 7 7 7 8 8 7 7 6 6 as the codes 256 7 258 8 8 258 6 6 257 of 9 bits.
        let codes = [256u16, 7, 258, 8, 8, 258, 6, 6, 257];
        let bits: Vec<u8> =
            codes.iter().flat_map(|c| (0..9).rev().map(move |i| (c >> i & 1) as u8)).collect();
        let bytes: Vec<u8> =
            bits.chunks(8).map(|b| b.iter().enumerate().map(|(i, bit)| bit << (7 - i)).sum()).collect();
        for without_end in [0, 2] {
            let mut plain = [0; 9];
            assert_eq!(expand_lzw(&bytes[..bytes.len() - without_end], &mut plain).unwrap_or(0), 9);
            assert_eq!(plain, [7, 7, 7, 8, 8, 7, 7, 6, 6]);
        }
    }
}
