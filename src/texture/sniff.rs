//! Identifies the format of a file by its first bytes, never by the extension of its name. A file
//! that is not a supported picture gets a short description for the error message.

pub use super::formats::PictureFormat;

/// The number of bytes that suffice for every signature below and for recognising text.
pub const HEAD_BYTES: usize = 64;

#[derive(Debug, PartialEq)]
pub enum Content {
    Picture(PictureFormat),
    /// Another content, described so that it completes the sentence "the content …".
    Other(String),
}

/// Offset, signature and name.
const OTHERS: &[(usize, &[u8], &str)] = &[
    (0, b"GIF8", "is GIF"),
    (0, b"BM", "looks like BMP"),
    (0, b"8BPS", "is a Photoshop document"),
    (0, b"\xabKTX 11", "is KTX 1 (KTX2 is read)"),
    (0, b"\0\0\0\x0cjP  ", "is JPEG 2000"),
    (0, b"\xff\x0a", "is JPEG XL"),
    (0, b"\0\0\0\x0cJXL ", "is JPEG XL"),
    (4, b"ftypavif", "is AVIF"),
    (4, b"ftyphei", "is HEIF"),
    (4, b"ftypmif1", "is HEIF"),
    (0, b"\0\0\x01\0", "is a Windows icon"),
    (0, b"qoif", "is QOI"),
    (0, b"NRRD000", "is an NRRD volume (dimension \"3d\", and an ending .nrrd or .nhdr)"),
    (0, b"PK\x03\x04", "is a ZIP archive"),
    (0, b"\x1f\x8b", "is gzip-compressed"),
    (0, b"%PDF", "is PDF"),
    (0, b"gimp xcf", "is a GIMP document"),
    (0, b"version https://git-lfs", "is a Git LFS pointer, not the picture itself"),
    (0, b"<svg", "is SVG"),
    (0, b"<?xml", "is XML or SVG"),
    (0, b"<!DOCTYPE", "is a web page"),
    (0, b"<html", "is a web page"),
];

/// Identifies a file by `head`, its first [`HEAD_BYTES`] bytes, or all of a shorter file.
pub fn identify(head: &[u8]) -> Content {
    if let Some(format) = PictureFormat::of_signature(head) {
        return Content::Picture(format);
    }
    match described(head) {
        Some(what) => Content::Other(what.into()),
        None if is_tga(head) => Content::Picture(PictureFormat::Tga),
        None => Content::Other(describe(head)),
    }
}

fn described(head: &[u8]) -> Option<&'static str> {
    let known =
        |(at, magic, _): &&(usize, &[u8], &str)| head.get(*at..).is_some_and(|h| h.starts_with(magic));
    OTHERS.iter().find(known).map(|(_, _, what)| *what)
}

/// Returns true for a TGA file. TGA has no signature, but a header of 18 bytes whose fields allow
/// few values (Truevision TGA 2.0, "TGA File Header"), so that other files are unlikely to match.
fn is_tga(head: &[u8]) -> bool {
    let Some(h) = head.get(..18) else { return false };
    let (map_type, kind, map_bits, bits, flags) = (h[1], h[2], h[7], h[16], h[17]);
    let has_size = h[12] | h[13] > 0 && h[14] | h[15] > 0;
    let map_fits = match kind {
        1 | 9 => map_type == 1 && [15, 16, 24, 32].contains(&map_bits) && [8, 16].contains(&bits),
        2 | 10 => map_type <= 1 && [15, 16, 24, 32].contains(&bits),
        3 | 11 => map_type == 0 && [8, 16].contains(&bits),
        _ => false,
    };
    map_fits && has_size && flags & 0xc0 == 0
}

fn describe(head: &[u8]) -> String {
    if head.is_empty() {
        return "is empty".into();
    }
    if PictureFormat::begins_signature(head) {
        return "ends within a picture's signature (truncated)".into();
    }
    if head[0] == b'P' && head.len() > 2 && head[1].is_ascii_digit() && head[2].is_ascii_whitespace() {
        return "is a Netpbm picture".into();
    }
    if head.iter().all(|&b| b >= 0x20 || b.is_ascii_whitespace()) && looks_like_utf8(head) {
        return "looks like text".into();
    }
    let bytes: Vec<String> = head.iter().take(8).map(|b| format!("{b:02x}")).collect();
    format!("begins with the bytes {}", bytes.join(" "))
}

/// The end of the first [`HEAD_BYTES`] bytes may split one character.
fn looks_like_utf8(head: &[u8]) -> bool {
    match std::str::from_utf8(head) {
        Ok(_) => true,
        Err(e) => e.error_len().is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signatures_are_told_apart() {
        for (head, want) in [
            (&b""[..], "is empty"),
            (b"hello, world\n", "looks like text"),
            (b"\xabKTX 11\xbb", "is KTX 1 (KTX2 is read)"),
            (b"P6\n2 2\n255\n", "is a Netpbm picture"),
            (b"\x89PN", "ends within a picture's signature (truncated)"),
            (b"\x01\x02\x03", "begins with the bytes 01 02 03"),
        ] {
            assert_eq!(identify(head), Content::Other(want.into()));
        }
        let tga = b"\0\0\x02\0\0\0\0\0\0\0\0\0\x04\0\x02\0\x18\0\x01\x02\x03";
        for (head, want) in [
            (&b"II*\0rest"[..], PictureFormat::Tiff),
            (b"RIFF\x10\0\0\0WEBPVP8 ", PictureFormat::WebP),
            (b"DDS |\0\0\0", PictureFormat::Dds),
            (b"#?RGBE\n", PictureFormat::Hdr),
            (b"#?RADIANCE\n", PictureFormat::Hdr),
            (tga, PictureFormat::Tga),
        ] {
            assert_eq!(identify(head), Content::Picture(want));
        }
        assert!(!is_tga(&tga[..17]) && !is_tga(b"\0\0\x02\0\0\0\0\0\0\0\0\0\x04\0\x02\0\x07\0"));
    }
}
