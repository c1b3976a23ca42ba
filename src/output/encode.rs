//! Encodes a film as the bytes of one file format. EXR and HDR keep linear light; PNG, JPEG and TIFF get values that the
//! display transform makes of it, clipped to [0, 1] and sRGB-encoded, without dithering.

use super::sink::Sink;
use super::{WriteOptions, exr, hdr, jpeg, png, tiff};
use crate::core::film::Film;
use crate::core::named::named_enum;

named_enum! {
    /// A file format; several extensions may name the same one.
    pub enum Format {
        Exr = "OpenEXR",
        Hdr = "Radiance HDR",
        Png = "PNG",
        Jpeg = "JPEG",
        Tiff = "TIFF",
    }
}

/// Encodes a film. The error states only the cause; the caller knows the file's name.
pub fn encode(film: &Film, format: Format, options: &WriteOptions, to: &mut dyn Sink) -> Result<(), String> {
    match format {
        Format::Exr => exr::write(film, options, to),
        Format::Hdr => hdr::write(film, options.record, to).map_err(|e| e.to_string()),
        Format::Png => png::write(film, options, to).map_err(|e| e.to_string()),
        Format::Jpeg => jpeg::write(film, options, to),
        Format::Tiff => tiff::write(film, options, to),
    }
}
