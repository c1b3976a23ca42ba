//! Volumes from files of raw texels. Size, format, byte order and offset are given by the scene or
//! by an NRRD header; the texels are returned in native byte order.

use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

use super::data::TexelFormat;
use super::decoder::widen_rgb;
use super::open_file::open;
use super::read_file::{Texels, check_memory, check_volume, unreadable};
use super::scalar::Scalar;
use super::source::{Endian, VolumeSource};
use crate::core::error::{Error, Result};

/// Reads a volume. A file that is shorter or longer than its description is an error, since the
/// description is most likely wrong.
pub(super) fn read(volume: &VolumeSource) -> Result<Texels> {
    let path = volume.file.as_path();
    check_volume(path, volume.size, volume.format.bytes_per_texel())?;
    let mut file = BufReader::new(open(path)?);
    let length = file.get_ref().length().map_err(|e| unreadable(path, &e))?;
    let [width, height, depth] = volume.size;
    let needed = width as usize * height as usize * depth as usize * volume.format.bytes_per_texel();
    let end = volume.offset + needed as u64;
    if length != end {
        let (amount, word) =
            if length < end { (end - length, "missing") } else { (length - end, "left over") };
        return Err(Error::with_help(
            format!(
                "{}: {length} bytes, and {width}×{height}×{depth} texels of {} from byte {} on end at \
                 {end}: {amount} are {word}",
                path.display(),
                volume.format,
                volume.offset
            ),
            "check size, format and offset of the volume",
        ));
    }
    file.seek(SeekFrom::Start(volume.offset)).map_err(|e| unreadable(path, &e))?;
    let scalar = Scalar::of(volume.format.component());
    let layout = RawTexels { size: volume.size, channels: volume.format.channels(), scalar };
    layout.read(file, volume.endian, needed as u64, path)
}

/// The layout of a stream of texels; three channels are expanded to four.
pub(super) struct RawTexels {
    pub size: [u32; 3],
    pub channels: usize,
    /// The number type, of whole bytes.
    pub scalar: Scalar,
}

/// The numbers converted per block.
const BLOCK: usize = 1 << 16;

impl RawTexels {
    pub fn bytes(&self) -> u64 {
        let texels = self.size.iter().fold(1u64, |n, &side| n.saturating_mul(side.into()));
        texels.saturating_mul((self.channels * self.stored_bytes()) as u64)
    }

    /// Returns the bytes of one number.
    fn stored_bytes(&self) -> usize {
        self.scalar.bits as usize / 8
    }

    /// Reads from a source of at most `available` bytes, so that no more is allocated than it can
    /// fill.
    pub fn read(&self, mut from: impl Read, endian: Endian, available: u64, path: &Path) -> Result<Texels> {
        let [width, height, depth] = self.size;
        let component = self.scalar.component();
        let format = TexelFormat::new(self.channels, component);
        check_volume(path, self.size, format.bytes_per_texel())?;
        if self.bytes() > available {
            return Err(short(path, self));
        }
        let held = width as usize * height as usize * depth as usize * format.bytes_per_texel();
        check_memory(path, held)?;
        let mut bytes = vec![0; held];
        let numbers = self.bytes() as usize / self.stored_bytes();
        let mut texels = bytes[..numbers * component.bytes()].chunks_mut(BLOCK * component.bytes());
        let mut block = vec![0; BLOCK * self.stored_bytes()];
        texels.try_for_each(|texels| {
            let stored = &mut block[..texels.len() / component.bytes() * self.stored_bytes()];
            from.read_exact(stored).map_err(|e| match e.kind() {
                ErrorKind::UnexpectedEof => short(path, self),
                _ => unreadable(path, &e),
            })?;
            self.convert(stored, endian, texels);
            Ok(())
        })?;
        if self.channels == 3 {
            widen_rgb(&mut bytes, component);
        }
        Ok(Texels { width, height, format, file_channels: self.channels, bytes })
    }

    /// Converts numbers; those with a native texture component only change byte order.
    fn convert(&self, stored: &mut [u8], endian: Endian, texels: &mut [u8]) {
        let component = self.scalar.component();
        let native = if cfg!(target_endian = "big") { Endian::Big } else { Endian::Little };
        let is_kept = self.scalar == Scalar::of(component);
        if endian != if is_kept { native } else { Endian::Little } {
            stored.chunks_exact_mut(self.stored_bytes()).for_each(<[u8]>::reverse);
        }
        if is_kept {
            return texels.copy_from_slice(stored);
        }
        let texels = texels.chunks_exact_mut(component.bytes());
        for (number, texel) in stored.chunks_exact(self.stored_bytes()).zip(texels) {
            let mut code = [0; 8];
            code[..number.len()].copy_from_slice(number);
            component.store(self.scalar.fraction(self.scalar.number(u64::from_le_bytes(code))), texel);
        }
    }
}

fn short(path: &Path, layout: &RawTexels) -> Error {
    let [width, height, depth] = layout.size;
    Error::with_help(
        format!(
            "{}: the data ends early: {width}×{height}×{depth} texels take {} bytes",
            path.display(),
            layout.bytes()
        ),
        "fetch or export the volume again, or correct the sizes in its header",
    )
}
