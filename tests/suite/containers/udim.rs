//! UDIM tiles: which files of a folder are tiles, where they lie, and which a coordinate chooses, on the device and by the
//! oracle.

use std::fs;
use std::path::Path;

use image::{Rgb, RgbImage};
use moire::internal::core::error::Result;
use moire::internal::pack;
use moire::internal::scene::parse;
use moire::internal::texture::decode::AllowedFloats;
use moire::internal::texture::load::{load, load_with_notes};
use moire::internal::texture::source::TextureContent;
use tempfile::{TempDir, tempdir};

use crate::stage::{render, render_on_oracle};
use crate::support::told;

/// Colours of the tiles 1001, 1002 and 1011; 1012 is missing.
const TILES: [(u32, [u8; 3]); 3] = [(1001, [255, 0, 0]), (1002, [0, 255, 0]), (1011, [0, 0, 255])];

fn folder() -> TempDir {
    let folder = tempdir().unwrap();
    for (number, color) in TILES {
        let tile = RgbImage::from_pixel(4, 4, Rgb(color));
        tile.save(folder.path().join(format!("a.{number}.png"))).unwrap();
    }
    for other in ["a.1000.png", "a.10011.png", "a.x001.png", "b.1003.png"] {
        fs::write(folder.path().join(other), "no tile").unwrap();
    }
    folder
}

/// A wall from (0, 0) to (2, 2) of which each pixel is a square of half a tile, v upwards on the picture.
fn text(mapping: &str, texture: &str) -> String {
    format!(
        "[camera]\neye = [1, 1, 1]\nlook_at = [1, 1, 0]\northographic_height = 2\n\
         [image]\nwidth = 4\nheight = 4\n[sampling]\npattern = 'center'\n\
         [[texture]]\nname = 't'\nfile = 'a.<UDIM>.png'\n{texture}\n\
         [[sampler]]\nname = 's'\nfilter = 'nearest'\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n{mapping}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n"
    )
}

/// The pixels, row by row, by device and oracle, as the first letters of colours; `-` is black.
fn shown(folder: &Path, text: &str) -> Result<String> {
    let scene = parse(&folder.join("a.toml"), text)?;
    let textures = scene.textures.iter().map(load).collect::<Result<Vec<_>>>()?;
    let packed = pack::pack(&scene, textures, None)?;
    let letters = |pixels: &[[f32; 3]]| -> String {
        let letter = |p: &[f32; 3]| (0..3).find(|&c| p[c] > 0.5).map_or('-', |c| ['r', 'g', 'b'][c]);
        pixels.iter().map(letter).collect()
    };
    let (device, oracle) = (letters(&render(&packed).pixels), letters(&render_on_oracle(&packed).pixels));
    assert_eq!(device, oracle);
    Ok(device)
}

#[test]
fn coordinates_choose_the_tile() {
    let folder = folder();
    // With v upwards, the first tile is below, 1011 above it.
    let upwards = text("", "flip_v = true");
    assert_eq!(shown(folder.path(), &upwards).unwrap(), ["bb--", "bb--", "rrgg", "rrgg"].concat());
    // With v downwards, v from 0 to 1 is the first tile as well, and v from -1 to 0 the one above it.
    let downwards = text("mapping = { kind = 'surface', scale = [1.0, -1.0], offset = [0.0, 1.0] }", "");
    assert_eq!(shown(folder.path(), &downwards).unwrap(), ["bb--", "bb--", "rrgg", "rrgg"].concat());
}

#[test]
fn files_that_are_no_tiles_are_passed_over_and_missing_ones_are_noted() {
    let folder = folder();
    let scene = parse(&folder.path().join("a.toml"), &text("", "")).unwrap();
    let TextureContent::Tiles(set) = &scene.textures[0].content else { panic!("{:?}", scene.textures[0]) };
    assert_eq!(set.tiles.iter().map(|tile| tile.number).collect::<Vec<_>>(), [1001, 1002, 1011]);
    let (texture, notes) = load_with_notes(&scene.textures[0], AllowedFloats::Finite).unwrap();
    assert_eq!((texture.width, texture.height), (8, 8));
    assert!(notes[0].contains("1 of 2×2 tiles have no file"), "{notes:?}");
}

#[test]
fn tiles_that_do_not_fit_are_refused() {
    let folder = folder();
    let refused = |text: &str| told(shown(folder.path(), text));
    let none = text("", "").replace("a.<UDIM>", "c.<UDIM>");
    assert!(
        refused(&none).contains("there is no file of this name with the number of a tile"),
        "{}",
        refused(&none)
    );
    RgbImage::from_pixel(2, 2, Rgb([9, 9, 9])).save(folder.path().join("b.1001.png")).unwrap();
    let other = text("normal_map = 'n'", "[[texture]]\nname = 'n'\nfile = 'b.<UDIM>.png'\n");
    fs::remove_file(folder.path().join("b.1003.png")).unwrap();
    assert!(refused(&other).contains("other numbers of tiles"), "{}", refused(&other));
    RgbImage::from_pixel(2, 2, Rgb([9, 9, 9])).save(folder.path().join("a.1003.png")).unwrap();
    let turned = text("mapping = { kind = 'surface', rotate = 30.0 }", "");
    assert!(refused(&turned).contains("cannot be rotated"), "{}", refused(&turned));
    assert!(refused(&text("", "")).contains("tile 3 of 4 has 2×2 texels"), "{}", refused(&text("", "")));
}
