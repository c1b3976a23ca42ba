//! Reads JPEG files (ISO/IEC 10918-1). Its markers are checked first for the kind of JPEG and for
//! completeness: the decoder does not identify some kinds, and fills missing data of a truncated
//! file with grey.

use std::path::Path;

use super::decoder;
use super::jpeg_data::JpegData;
use super::read_file::{Picture, Texels, damaged, unsupported_kind};
use crate::core::error::Result;

const START_OF_IMAGE: u8 = 0xd8;
const END_OF_IMAGE: u8 = 0xd9;
const START_OF_SCAN: u8 = 0xda;

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    if let Some(name) = unsupported(file) {
        return Err(unsupported_kind(path, name));
    }
    let decode = |file: &[u8]| decode(file, path);
    if ends(file) {
        return decode(file).map(Picture::from);
    }
    let cut = || damaged(path, "JPEG", &"the file ends before the end-of-image marker");
    if !scans_are_complete(file) {
        return Err(cut());
    }
    // The file is complete if any continuation would not change the picture.
    let body = file.strip_suffix(&[0xff]).unwrap_or(file);
    let followed_by = |tail: &[u8]| decode(&[body, tail, &[0xff, END_OF_IMAGE]].concat());
    let texels = followed_by(&[]).map_err(|_| cut())?;
    for tail in [[0xaa; 64], [0x55; 64]] {
        if followed_by(&tail).map_err(|_| cut())?.bytes != texels.bytes {
            return Err(cut());
        }
    }
    let note = format!("{}: the JPEG data has no end-of-image marker; all texels are there", path.display());
    Ok(Picture::noted(texels, vec![note]))
}

fn decode(file: &[u8], path: &Path) -> Result<Texels> {
    let data = JpegData::new(file).map_err(|fault| fault.in_file(path, "JPEG"))?;
    decoder::texels(data.header, "JPEG", file.len(), path, |texels| data.read(texels))
}

/// Returns the name of an unsupported kind of JPEG (table B.1 and B.2.2: the start-of-frame
/// markers, precision).
pub(super) fn unsupported(jpeg: &[u8]) -> Option<&'static str> {
    let (marker, frame) = segments(jpeg).find(|(marker, _)| is_frame(*marker))?;
    let precision = frame.first().copied().unwrap_or(0);
    match marker {
        0xc3 => Some("lossless JPEG"),
        0xc5..=0xc7 => Some("hierarchical JPEG"),
        0xc9 | 0xca => Some("JPEG with arithmetic coding"),
        0xcb | 0xcd..=0xcf => Some("lossless or hierarchical JPEG with arithmetic coding"),
        0xf7 => Some("JPEG-LS"),
        _ if precision == 12 => Some("JPEG with 12 bits a channel"),
        _ => None,
    }
}

/// Returns the Exif data before the first scan, without its identifier.
pub(super) fn exif(jpeg: &[u8]) -> Option<&[u8]> {
    const APP1: u8 = 0xe1;
    let before_scans = segments(jpeg).take_while(|(marker, _)| *marker != START_OF_SCAN);
    before_scans
        .filter(|(marker, _)| *marker == APP1)
        .find_map(|(_, segment)| segment.strip_prefix(b"Exif\0\0"))
}

/// Returns the ICC profile, whose parts are numbered from 1 (ICC.1:2022, B.4); `None` if parts are missing.
pub(super) fn color_profile(jpeg: &[u8]) -> Option<Vec<u8>> {
    const APP2: u8 = 0xe2;
    let before_scans = segments(jpeg).take_while(|(marker, _)| *marker != START_OF_SCAN);
    let mut parts: Vec<(u8, u8, &[u8])> = before_scans
        .filter(|(marker, _)| *marker == APP2)
        .filter_map(|(_, segment)| match segment.strip_prefix(b"ICC_PROFILE\0")? {
            [number, of, part @ ..] => Some((*number, *of, part)),
            _ => None,
        })
        .collect();
    parts.sort_unstable_by_key(|(number, ..)| *number);
    let whole = parts
        .iter()
        .enumerate()
        .all(|(i, (number, of, _))| (usize::from(*number), usize::from(*of)) == (i + 1, parts.len()));
    (whole && !parts.is_empty()).then(|| parts.iter().flat_map(|(.., part)| *part).copied().collect())
}

fn is_frame(marker: u8) -> bool {
    // c4, c8 and cc define tables or are reserved; f7 is that of ISO/IEC 14495.
    matches!(marker, 0xc0..=0xcf | 0xf7) && !matches!(marker, 0xc4 | 0xc8 | 0xcc)
}

fn ends(jpeg: &[u8]) -> bool {
    segments(jpeg).any(|(marker, _)| marker == END_OF_IMAGE)
}

/// Returns true if the scans that begin in the file define all channels completely. A progressive
/// file truncated between two scans is coarse but otherwise valid. For each channel the number of
/// frequencies known to the last bit is tracked.
fn scans_are_complete(jpeg: &[u8]) -> bool {
    let Some((_, frame)) = segments(jpeg).find(|(marker, _)| is_frame(*marker)) else { return false };
    let ids = frame.get(6..).unwrap_or(&[]).chunks_exact(3).map(|channel| channel[0]);
    let scans: Vec<_> = segments(jpeg).filter(|(marker, _)| *marker == START_OF_SCAN).collect();
    ids.into_iter().all(|id| {
        (0..64).all(|frequency| {
            scans.iter().any(|(_, scan)| {
                match scan.split_first().and_then(|(n, s)| s.split_at_checked(2 * usize::from(*n))) {
                    Some((channels, [first, last, bits, ..])) => {
                        let of_channel = channels.chunks_exact(2).any(|channel| channel[0] == id);
                        of_channel && (*first..=*last).contains(&frequency) && bits & 0xf == 0
                    }
                    _ => false,
                }
            })
        })
    })
}

/// Iterates over markers with their segments. Entropy-coded data is skipped: there 0xff is followed
/// only by 0x00 or a restart marker (B.1.1.5).
fn segments(jpeg: &[u8]) -> impl Iterator<Item = (u8, &[u8])> {
    let mut rest = jpeg;
    std::iter::from_fn(move || {
        loop {
            let at = rest.iter().position(|b| *b == 0xff)?;
            rest = &rest[at..];
            let fill = rest.iter().position(|b| *b != 0xff)?;
            let marker = rest[fill];
            rest = &rest[fill + 1..];
            match marker {
                // Stuffed zero, TEM, restart markers and start of image have no segment.
                0x00 | 0x01 | 0xd0..=START_OF_IMAGE => {}
                END_OF_IMAGE => return Some((marker, &[][..])),
                _ => {
                    let (length, _) = rest.split_first_chunk::<2>()?;
                    let length = usize::from(u16::from_be_bytes(*length)).max(2);
                    let segment = rest.get(2..length)?;
                    rest = &rest[length..];
                    return Some((marker, segment));
                }
            }
        }
    })
}
