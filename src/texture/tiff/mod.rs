//! Reads the first picture of a TIFF or BigTIFF file (TIFF 6.0 with Adobe's supplements).
//! `directory` reads the tags; `layout` and `color` check them and refuse unsupported variants by
//! name; `decompress` and `predictor` return the bytes of a strip or tile, `samples` its numbers,
//! `picture` the texels.

mod color;
mod decompress;
mod directory;
mod layout;
mod picture;
mod predictor;
mod samples;

use std::path::Path;

use super::read_file::{Picture, Texels, check_memory, check_size, damaged, out_of_memory};
use crate::core::error::{Error, Result};
use directory::{Directory, tag};
use layout::Layout;

/// The reason why a file cannot be read.
#[derive(Debug)]
enum Fault {
    Damaged(String),
    /// An unsupported variant; completes "… is not read".
    Unsupported(String),
    Memory,
}

impl Fault {
    fn damaged(what: impl Into<String>) -> Fault {
        Fault::Damaged(what.into())
    }

    fn unsupported(what: impl Into<String>) -> Fault {
        Fault::Unsupported(what.into())
    }

    fn in_file(self, path: &Path) -> Error {
        match self {
            Fault::Damaged(what) => damaged(path, "TIFF", &what),
            Fault::Unsupported(what) => Error::with_help(
                format!("{}: this TIFF file has {what}, which is not read", path.display()),
                "convert it to grey, RGB or a palette of 8 or 16 bits or floats, without compression or with \
                 LZW, Deflate, PackBits or JPEG",
            ),
            Fault::Memory => out_of_memory(path),
        }
    }
}

pub(super) fn read(file: &[u8], path: &Path) -> Result<Picture> {
    let named = |fault: Fault| fault.in_file(path);
    let tags = Directory::first(file).map_err(named)?;
    let layout = Layout::of(&tags).map_err(named)?;
    let format = picture::format(&layout);
    check_size(path, layout.width.into(), layout.height.into(), format.bytes_per_texel())?;
    picture::check_bytes(&layout, file.len()).map_err(named)?;
    let jpeg_tables = tags.bytes(tag::JPEG_TABLES).map_err(named)?;
    check_memory(path, layout.width as usize * layout.height as usize * format.bytes_per_texel())?;
    let texels = picture::decode(file, &layout, jpeg_tables).map_err(named)?;
    let mut notes = notes(&tags, path);
    if layout.alpha.is_some_and(|alpha| alpha.associated) && !is_opaque(&texels) {
        let shown = path.display();
        notes.push(format!(
            "{shown}: the colours are multiplied by alpha (associated); they are used as stored"
        ));
    }
    Ok(Picture::noted(texels, notes))
}

/// Returns the value of the orientation tag, of a TIFF file or of Exif data, which has the same
/// structure.
pub(super) fn orientation(file: &[u8]) -> Option<u16> {
    let value = Directory::first(file).ok()?.number(tag::ORIENTATION).ok()??;
    u16::try_from(value).ok()
}

/// Returns the ICC profile.
pub(super) fn color_profile(file: &[u8]) -> Option<&[u8]> {
    Directory::first(file).ok()?.bytes(tag::ICC_PROFILE).ok()?
}

/// Returns true if alpha, the last channel, is 1 everywhere.
fn is_opaque(texels: &Texels) -> bool {
    let component = texels.format.component();
    let one = &component.one()[..component.bytes()];
    texels.bytes.chunks_exact(texels.format.bytes_per_texel()).all(|texel| texel.ends_with(one))
}

fn notes(tags: &Directory<'_>, path: &Path) -> Vec<String> {
    let mut notes = Vec::new();
    if tags.pages > 1 {
        notes.push(format!("{}: the first of {} pictures of the file is read", path.display(), tags.pages));
    }
    if tags.is_reduced() {
        notes.push(format!(
            "{}: what is read is a smaller copy or a mask of another picture in it",
            path.display()
        ));
    }
    notes
}
