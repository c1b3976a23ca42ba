//! Textures of UDIM tiles: pictures of equal size whose numbers say which unit square of the texture plane they cover,
//! 1001 + u + 10 v with v upwards. Takes a name with `<UDIM>`; returns the files that there are, and their texels as one
//! picture with the highest row of tiles on top. Squares without a file are black and transparent.

use std::fs;
use std::path::{Path, PathBuf};

use super::data::ColorSpace;
use super::decode::AllowedFloats;
use super::read_file::{FileFacts, Picture, Texels, check_memory, check_size};
use super::source::ReadOptions;
use super::stack;
use crate::core::error::{Error, Result};

/// What stands for the number in a name.
pub const MARK: &str = "<UDIM>";
const FIRST: u32 = 1001;
const COLUMNS: u32 = 10;
const LAST: u32 = 9999;

/// The tiles of a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct TileSet {
    /// The name with the mark.
    pub pattern: PathBuf,
    /// The tiles that there are, by number.
    pub tiles: Vec<Tile>,
}

/// One file, and the square that it covers.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    /// 1001 + u + 10 v.
    pub number: u32,
    /// The file.
    pub file: PathBuf,
}

impl Tile {
    fn column(&self) -> u32 {
        (self.number - FIRST) % COLUMNS
    }

    fn row(&self) -> u32 {
        (self.number - FIRST) / COLUMNS
    }
}

impl TileSet {
    /// Returns the tiles of a name, if it has the mark; its folder is listed, and no file is opened.
    pub fn of_name(pattern: &Path) -> Option<TileSet> {
        let name = pattern.file_name()?.to_str()?;
        let (start, end) = name.split_once(MARK)?;
        let folder = pattern.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let number = |name: &str| {
            let digits = name.strip_prefix(start)?.strip_suffix(end)?;
            let number = digits.parse().ok().filter(|_| digits.len() == 4);
            number.filter(|number| (FIRST..=LAST).contains(number))
        };
        let names = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
        let tile = |name: std::ffi::OsString| {
            let name = name.to_str()?;
            Some(Tile { number: number(name)?, file: pattern.with_file_name(name) })
        };
        let mut tiles: Vec<Tile> = names.filter_map(tile).collect();
        tiles.sort_by_key(|tile| tile.number);
        Some(TileSet { pattern: pattern.to_owned(), tiles })
    }

    /// Returns how many squares the picture of all tiles has along u and v, at least one.
    pub fn grid(&self) -> [u32; 2] {
        let count = |of: fn(&Tile) -> u32| self.tiles.iter().map(of).max().unwrap_or(0) + 1;
        [count(Tile::column), count(Tile::row)]
    }
}

/// Reads all tiles as one picture.
pub(super) fn read(
    set: &TileSet,
    reading: &ReadOptions,
    space: ColorSpace,
    values: AllowedFloats,
) -> Result<Picture> {
    if set.tiles.is_empty() {
        return Err(Error::with_help(
            format!("{}: there is no file of this name with the number of a tile", set.pattern.display()),
            "tiles are numbered 1001 + u + 10 v: 1001 is the first, 1002 beside it, 1011 above it",
        ));
    }
    let files: Vec<PathBuf> = set.tiles.iter().map(|tile| tile.file.clone()).collect();
    let joined = stack::read(&files, reading, space, values, "tile")?;
    let [columns, rows] = set.grid();
    let Texels { width, height, format, file_channels, bytes: stored } = joined.texels;
    let (tile_row, texel) = (width as usize * format.bytes_per_texel(), format.bytes_per_texel());
    let [whole_width, whole_height] =
        [u64::from(width) * u64::from(columns), u64::from(height) * u64::from(rows)];
    check_size(&set.pattern, whole_width, whole_height, texel)?;
    let whole_row = tile_row * columns as usize;
    let bytes_of_all = whole_row * whole_height as usize;
    check_memory(&set.pattern, bytes_of_all)?;
    let mut bytes = vec![0; bytes_of_all];
    for (tile, texels) in set.tiles.iter().zip(stored.chunks_exact(tile_row * height as usize)) {
        let first_row = (rows - 1 - tile.row()) as usize * height as usize;
        for (y, row) in texels.chunks_exact(tile_row).enumerate() {
            let start = (first_row + y) * whole_row + tile.column() as usize * tile_row;
            bytes[start..start + tile_row].copy_from_slice(row);
        }
    }
    let texels =
        Texels { width: whole_width as u32, height: whole_height as u32, format, file_channels, bytes };
    let facts = FileFacts { color_space: joined.facts.color_space, ..FileFacts::default() };
    let mut notes = joined.notes;
    let missing = (columns * rows) as usize - set.tiles.len();
    if missing > 0 {
        let what = format!("{missing} of {columns}×{rows} tiles have no file, and are black and transparent");
        notes.push(format!("{}: {what}", set.pattern.display()));
    }
    Ok(Picture { facts, ..Picture::noted(texels, notes) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_say_column_and_row() {
        let tile = |number| Tile { number, file: PathBuf::new() };
        assert_eq!(
            [tile(1001), tile(1010), tile(1011)].map(|t| [t.column(), t.row()]),
            [[0, 0], [9, 0], [0, 1]]
        );
        let set = TileSet { pattern: PathBuf::new(), tiles: vec![tile(1002), tile(1021)] };
        assert_eq!(set.grid(), [2, 3]);
        assert_eq!(TileSet::of_name(Path::new("a.1001.png")), None);
    }
}
