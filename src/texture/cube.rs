//! Cube textures: joins six pictures, or cuts one that holds all faces, into the six faces in the
//! order +x −x +y −y +z −z. Each face is oriented as in Vulkan's table (Vulkan 1.3, "Cube Map Face
//! Selection": +z has x to the right and y upwards), also in the pictures:
//!
//! ```text
//! horizontal-cross 4:3        vertical-cross 3:4     horizontal-strip 6:1
//!
//!      ┌────┐                      ┌────┐            ┌────┬────┬────┬────┬────┬────┐
//!      │ +y │                      │ +y │            │ +x │ −x │ +y │ −y │ +z │ −z │
//! ┌────┼────┼────┬────┐       ┌────┼────┼────┐       └────┴────┴────┴────┴────┴────┘
//! │ −x │ +z │ +x │ −z │       │ −x │ +z │ +x │
//! └────┼────┼────┴────┘       └────┼────┼────┘       vertical-strip 1:6: the same
//!      │ −y │                      │ −y │            order from top to bottom
//!      └────┘                      ├────┤
//!                                  │ −z │ turned by 180°
//!                                  └────┘
//!
//! grid 3:2
//! ┌────┬────┬────┐
//! │ +x │ −x │ +y │      right, left, up; down, front, back: the order of ffmpeg's layout `c3x2`
//! ├────┼────┼────┤
//! │ −y │ +z │ −z │
//! └────┴────┴────┘
//! ```
//!
//! Neighbours in a cross therefore share the edge they share on the cube. The cells beside a cross
//! are ignored.

use std::path::{Path, PathBuf};

use super::data::{ColorSpace, Dimension};
use super::decode::AllowedFloats;
use super::read_file::{self, Picture, Texels};
use super::source::{CubeLayout, ReadOptions};
use super::stack;
use crate::core::error::{Error, Result};

impl CubeLayout {
    /// Returns the numbers of cells side by side and one above the other.
    fn cells(self) -> [u32; 2] {
        match self {
            CubeLayout::HorizontalCross => [4, 3],
            CubeLayout::VerticalCross => [3, 4],
            CubeLayout::HorizontalStrip => [6, 1],
            CubeLayout::VerticalStrip => [1, 6],
            CubeLayout::Grid => [3, 2],
        }
    }

    /// Returns the column and row of each face's cell.
    fn cell_positions(self) -> [[usize; 2]; 6] {
        match self {
            CubeLayout::HorizontalCross => [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [3, 1]],
            CubeLayout::VerticalCross => [[2, 1], [0, 1], [1, 0], [1, 2], [1, 1], [1, 3]],
            CubeLayout::HorizontalStrip => [0, 1, 2, 3, 4, 5].map(|i| [i, 0]),
            CubeLayout::VerticalStrip => [0, 1, 2, 3, 4, 5].map(|i| [0, i]),
            CubeLayout::Grid => [0, 1, 2, 3, 4, 5].map(|i| [i % 3, i / 3]),
        }
    }

    fn fits(self, width: u32, height: u32) -> bool {
        let [columns, rows] = self.cells().map(u64::from);
        u64::from(width) * rows == u64::from(height) * columns && u64::from(width) % columns == 0
    }
}

pub(super) fn join(
    files: &[PathBuf; 6],
    reading: &ReadOptions,
    space: ColorSpace,
    values: AllowedFloats,
) -> Result<Picture> {
    let picture = stack::read(files, reading, space, values, "face")?;
    let faces = &picture.texels;
    if faces.width == faces.height {
        return Ok(picture);
    }
    Err(Error::with_help(
        format!(
            "{}: {}×{} texels, and the faces of a cube are square",
            files[0].display(),
            faces.width,
            faces.height
        ),
        "cut or scale the six pictures to squares of one size",
    ))
}

/// Returns true if a file is known to hold six faces, which need no cutting. A file that cannot be opened is not.
pub(super) fn is_whole(path: &Path, reading: &ReadOptions) -> Result<bool> {
    Ok(read_file::is_container(path)
        && read_file::read_any(path, reading)?.facts.dimension == Dimension::Cube)
}

pub(super) fn cut(picture: &Texels, layout: Option<CubeLayout>, path: &Path) -> Result<Texels> {
    let layout = match layout {
        Some(layout) if layout.fits(picture.width, picture.height) => layout,
        Some(layout) => return Err(misfit(picture, layout, path)),
        None => {
            let mut layouts = CubeLayout::ALL.iter().copied();
            let fitting = layouts.find(|layout| layout.fits(picture.width, picture.height));
            fitting.ok_or_else(|| no_layout(picture, path))?
        }
    };
    let side = (picture.width / layout.cells()[0]) as usize;
    let texel = picture.format.bytes_per_texel();
    let (row, cell) = (picture.width as usize * texel, side * texel);
    let mut bytes = Vec::with_capacity(6 * side * cell);
    for (face, [column, line]) in layout.cell_positions().into_iter().enumerate() {
        let turned = layout == CubeLayout::VerticalCross && face == 5;
        for y in 0..side {
            let y = if turned { side - 1 - y } else { y };
            let start = (line * side + y) * row + column * cell;
            let texels = &picture.bytes[start..start + cell];
            if turned {
                texels.rchunks_exact(texel).for_each(|t| bytes.extend_from_slice(t));
            } else {
                bytes.extend_from_slice(texels);
            }
        }
    }
    let side = side as u32;
    let (format, file_channels) = (picture.format, picture.file_channels);
    Ok(Texels { width: side, height: side, format, file_channels, bytes })
}

fn misfit(picture: &Texels, layout: CubeLayout, path: &Path) -> Error {
    let [columns, rows] = layout.cells();
    let Texels { width, height, .. } = picture;
    Error::with_help(
        format!(
            "{}: {width}×{height} texels, and layout \"{layout}\" has {columns}×{rows} square faces",
            path.display()
        ),
        "name the layout that the picture has, or leave layout out: the shape of the picture tells it",
    )
}

fn no_layout(picture: &Texels, path: &Path) -> Error {
    Error::with_help(
        format!(
            "{}: {}×{} texels are no cube: crosses have 4:3 or 3:4, strips 6:1 or 1:6, grids 3:2",
            path.display(),
            picture.width,
            picture.height
        ),
        "give such a picture, or six with faces = [+x, -x, +y, -y, +z, -z]",
    )
}
