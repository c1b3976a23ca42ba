//! Volumes from files of bare texels: size, format, byte order and the place of the first texel are
//! said elsewhere, by the scene or by an NRRD header. Out come the texels in the machine's own byte
//! order.

use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::Path;

use super::data::{Component, TexelFormat};
use super::read_file::{Texels, check_memory, check_volume, open, unreadable, widen_rgb};
use super::source::{Endian, VolumeSource};
use crate::error::{Error, Result};

/// A file that is shorter or longer than the description says is most likely described wrongly.
pub(super) fn read(volume: &VolumeSource) -> Result<Texels> {
    let path = volume.file.as_path();
    check_volume(path, volume.size, volume.format.bytes_per_texel())?;
    let mut file = BufReader::new(open(path)?);
    let length = file.get_ref().metadata().map_err(|e| unreadable(path, &e))?.len();
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
    let layout =
        Bare { size: volume.size, channels: volume.format.channels(), component: volume.format.component() };
    layout.read(file, volume.endian, path)
}

/// What a stream of texels holds; three channels are expanded to four.
pub(super) struct Bare {
    pub size: [u32; 3],
    pub channels: usize,
    pub component: Component,
}

impl Bare {
    pub fn bytes(&self) -> u64 {
        let texels: u64 = self.size.iter().map(|&n| u64::from(n)).product();
        texels * (self.channels * self.component.bytes()) as u64
    }

    pub fn read(&self, mut from: impl Read, endian: Endian, path: &Path) -> Result<Texels> {
        let [width, height, depth] = self.size;
        let format = TexelFormat::new(self.channels, self.component);
        check_volume(path, self.size, format.bytes_per_texel())?;
        let held = width as usize * height as usize * depth as usize * format.bytes_per_texel();
        check_memory(path, held)?;
        let mut bytes = vec![0; held];
        let stored = &mut bytes[..self.bytes() as usize];
        from.read_exact(stored).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => short(path, self),
            _ => unreadable(path, &e),
        })?;
        let native = if cfg!(target_endian = "big") { Endian::Big } else { Endian::Little };
        if endian != native && self.component != Component::Unorm8 {
            stored.chunks_exact_mut(self.component.bytes()).for_each(<[u8]>::reverse);
        }
        if self.channels == 3 {
            widen_rgb(&mut bytes, self.component);
        }
        Ok(Texels { width, height, format, file_channels: self.channels, bytes })
    }
}

fn short(path: &Path, layout: &Bare) -> Error {
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
