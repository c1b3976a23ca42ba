//! A JPEG stream into grey or RGB bytes, by the crate zune-jpeg: for JPEG files and for the strips and tiles of
//! TIFF files. Channels that are neither grey nor RGB (YCbCr, CMYK, YCCK) become RGB.

use zune_jpeg::JpegDecoder;
use zune_jpeg::errors::DecodeErrors;
use zune_jpeg::zune_core::bytestream::ZCursor;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use super::data::Component;
use super::decoder::{Fault, Header};

/// A stream whose header has been read.
pub(super) struct JpegData<'a> {
    decoder: JpegDecoder<ZCursor<&'a [u8]>>,
    pub header: Header,
}

impl<'a> JpegData<'a> {
    pub fn new(stream: &'a [u8]) -> Result<Self, Fault> {
        let options = DecoderOptions::default()
            .set_strict_mode(false)
            .set_max_width(usize::MAX)
            .set_max_height(usize::MAX);
        let mut decoder = JpegDecoder::new_with_options(ZCursor::new(stream), options);
        decoder.decode_headers().map_err(fault)?;
        let no_frame = || Fault::Damaged("no frame header".into());
        let (width, height) = decoder.dimensions().ok_or_else(no_frame)?;
        let (space, channels) = match decoder.input_colorspace().ok_or_else(no_frame)? {
            ColorSpace::Luma => (ColorSpace::Luma, 1),
            ColorSpace::LumaA => (ColorSpace::LumaA, 2),
            ColorSpace::RGBA => (ColorSpace::RGBA, 4),
            _ => (ColorSpace::RGB, 3),
        };
        decoder.set_options(decoder.options().jpeg_set_out_colorspace(space));
        let [width, height] = [width, height].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
        Ok(JpegData { decoder, header: Header { width, height, channels, component: Component::Unorm8 } })
    }

    /// Fills tightly packed rows.
    pub fn read(mut self, texels: &mut [u8]) -> Result<(), Fault> {
        self.decoder.decode_into(texels).map_err(fault)
    }
}

fn fault(error: DecodeErrors) -> Fault {
    match error {
        DecodeErrors::Unsupported(what) => Fault::Unsupported(format!("{what:?}")),
        DecodeErrors::LargeDimensions(_) => Fault::Memory,
        DecodeErrors::ZeroError => Fault::ZeroSize,
        error => Fault::Damaged(error.to_string()),
    }
}
