//! The formats of picture files: the one table of their names, signatures, endings and readers. Takes nothing; other
//! files recognise contents, read them and write messages by it. A format is added by a row and the file that reads it.

use std::path::Path;

use super::read_file::Picture;
use super::{container, read_hdr, read_jpeg, read_png, read_tga, read_webp, tiff};
use crate::core::error::Result;
use crate::core::named::named_enum;

named_enum! {
    /// A file format that is read; the name is the one in messages.
    pub enum PictureFormat {
        Png = "PNG",
        Jpeg = "JPEG",
        Tiff = "TIFF",
        Tga = "TGA",
        Hdr = "HDR",
        OpenExr = "OpenEXR",
        WebP = "WebP",
        Dds = "DDS",
        Ktx2 = "KTX2",
    }
}

/// Where a signature lies in a file, and its bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signature {
    pub offset: usize,
    pub bytes: &'static [u8],
}

/// How the texels of a file are read.
#[derive(Clone, Copy)]
pub(super) enum Reader {
    /// From all bytes of the file.
    Whole(fn(&[u8], &Path) -> Result<Picture>),
    /// From a source that is read in parts, with layers: OpenEXR.
    Layered,
}

/// The properties of a format.
pub(super) struct Format {
    pub format: PictureFormat,
    /// The name in a list of what is supported.
    pub title: &'static str,
    /// The usual endings of names; formats are recognised by content all the same.
    pub endings: &'static [&'static str],
    /// A file of the format has one of these; without any, it is recognised otherwise.
    pub signatures: &'static [Signature],
    pub reader: Reader,
    /// True if a file may hold a cube, a volume, or mip levels.
    pub is_container: bool,
}

const fn at_start(bytes: &'static [u8]) -> Signature {
    Signature { offset: 0, bytes }
}

const PLAIN: Format = Format {
    format: PictureFormat::Png,
    title: "PNG",
    endings: &["png"],
    signatures: &[at_start(b"\x89PNG\r\n\x1a\n")],
    reader: Reader::Whole(read_png::read),
    is_container: false,
};

pub(super) const FORMATS: &[Format] = &[
    PLAIN,
    Format {
        format: PictureFormat::Jpeg,
        title: "JPEG",
        endings: &["jpg", "jpeg"],
        signatures: &[at_start(b"\xff\xd8\xff")],
        reader: Reader::Whole(read_jpeg::read),
        ..PLAIN
    },
    Format {
        format: PictureFormat::Tiff,
        title: "TIFF",
        endings: &["tif", "tiff"],
        signatures: &[at_start(b"II*\0"), at_start(b"MM\0*"), at_start(b"II+\0"), at_start(b"MM\0+")],
        reader: Reader::Whole(tiff::read),
        ..PLAIN
    },
    Format {
        format: PictureFormat::Tga,
        title: "TGA",
        endings: &["tga"],
        signatures: &[],
        reader: Reader::Whole(read_tga::read),
        ..PLAIN
    },
    Format {
        format: PictureFormat::Hdr,
        title: "Radiance HDR",
        endings: &["hdr", "pic"],
        // Usually #?RADIANCE or #?RGBE: the program that wrote the first such files put its own name there.
        signatures: &[at_start(b"#?")],
        reader: Reader::Whole(read_hdr::read),
        ..PLAIN
    },
    Format {
        format: PictureFormat::OpenExr,
        title: "OpenEXR",
        endings: &["exr"],
        signatures: &[at_start(b"\x76\x2f\x31\x01")],
        reader: Reader::Layered,
        ..PLAIN
    },
    Format {
        format: PictureFormat::WebP,
        title: "WebP",
        endings: &["webp"],
        signatures: &[Signature { offset: 8, bytes: b"WEBP" }],
        reader: Reader::Whole(read_webp::read),
        ..PLAIN
    },
    Format {
        format: PictureFormat::Dds,
        title: "DDS",
        endings: &["dds"],
        signatures: &[at_start(b"DDS ")],
        reader: Reader::Whole(container::dds::read),
        is_container: true,
    },
    Format {
        format: PictureFormat::Ktx2,
        title: "KTX2",
        endings: &["ktx2"],
        signatures: &[at_start(b"\xabKTX 20\xbb\r\n\x1a\n")],
        reader: Reader::Whole(container::ktx2::read),
        is_container: true,
    },
];

/// Returns all formats as a list in a sentence.
pub fn supported() -> String {
    let titles: Vec<&str> = FORMATS.iter().map(|format| format.title).collect();
    match titles.split_last() {
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// Returns true if these bytes of a file begin as a picture does.
pub fn is_picture(bytes: &[u8]) -> bool {
    PictureFormat::of_signature(bytes).is_some()
}

/// Returns the usual endings of names of all files of texels, those of volumes too.
pub fn endings() -> impl Iterator<Item = &'static str> {
    FORMATS.iter().flat_map(|format| format.endings).copied().chain(["nrrd", "nhdr"])
}

/// Returns true if files with names like this one may hold cubes, volumes and mip levels; nothing is opened.
pub fn is_container_name(path: &Path) -> bool {
    let Some(ending) = path.extension().and_then(|ending| ending.to_str()) else { return false };
    let containers = FORMATS.iter().filter(|format| format.is_container);
    containers.flat_map(|format| format.endings).any(|known| ending.eq_ignore_ascii_case(known))
}

impl PictureFormat {
    /// Returns the properties of the format.
    pub(super) fn properties(self) -> &'static Format {
        FORMATS.iter().find(|format| format.format == self).unwrap_or(&PLAIN)
    }

    /// Returns the format whose signature a file has that begins with `head`.
    pub(super) fn of_signature(head: &[u8]) -> Option<PictureFormat> {
        let has = |s: &Signature| head.get(s.offset..).is_some_and(|rest| rest.starts_with(s.bytes));
        FORMATS.iter().find(|format| format.signatures.iter().any(has)).map(|format| format.format)
    }

    /// Returns true if `head` is the beginning of some signature.
    pub(super) fn begins_signature(head: &[u8]) -> bool {
        let begins = |s: &Signature| s.offset == 0 && s.bytes.starts_with(head);
        FORMATS.iter().any(|format| format.signatures.iter().any(begins))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_has_one_row_and_is_found_by_its_own_signature() {
        for &format in PictureFormat::ALL {
            assert_eq!(FORMATS.iter().filter(|row| row.format == format).count(), 1, "{format}");
            for signature in format.properties().signatures {
                let head = [vec![0; signature.offset], signature.bytes.to_vec()].concat();
                assert_eq!(PictureFormat::of_signature(&head), Some(format));
            }
        }
        assert!(supported().ends_with("WebP, DDS and KTX2"), "{}", supported());
        assert!(is_container_name(Path::new("a/b.DDS")) && !is_container_name(Path::new("dds.png")));
    }
}
