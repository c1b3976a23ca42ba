//! Cubes from six files and from one: position and orientation of the faces, and pictures that are
//! not cubes.

use std::collections::HashMap;

use image::{ImageBuffer, Luma, Rgb};
use moire::internal::texture::data::Dimension;
use moire::internal::texture::source::{CubeLayout, TextureContent};
use tempfile::tempdir;

use super::{assert_says, direction, grey, read, save};
use crate::support::told;

/// Texels of a face of 2×2: hundreds of the picture are faces from +x on, units its texels row by row.
/// Drawn after the documentation, `-z` of the vertical cross upside down.
const HORIZONTAL: &str = "
    .  .  20 21 .  .  .  .
    .  .  22 23 .  .  .  .
    10 11 40 41 00 01 50 51
    12 13 42 43 02 03 52 53
    .  .  30 31 .  .  .  .
    .  .  32 33 .  .  .  .";
const VERTICAL: &str = "
    .  .  20 21 .  .
    .  .  22 23 .  .
    10 11 40 41 00 01
    12 13 42 43 02 03
    .  .  30 31 .  .
    .  .  32 33 .  .
    .  .  53 52 .  .
    .  .  51 50 .  .";
const STRIP: &str = "
    00 01 10 11 20 21 30 31 40 41 50 51
    02 03 12 13 22 23 32 33 42 43 52 53";
const UPRIGHT_STRIP: &str = "
    00 01
    02 03
    10 11
    12 13
    20 21
    22 23
    30 31
    32 33
    40 41
    42 43
    50 51
    52 53";

const GRID: &str = "
    00 01 10 11 20 21
    02 03 12 13 22 23
    30 31 40 41 50 51
    32 33 42 43 52 53";

fn picture(text: &str) -> (u32, u32, Vec<u8>) {
    let rows: Vec<Vec<u8>> = text
        .trim()
        .lines()
        .map(|line| line.split_whitespace().map(|w| w.parse().unwrap_or(255)).collect())
        .collect();
    (rows[0].len() as u32, rows.len() as u32, rows.concat())
}

fn faces() -> Vec<u8> {
    (0..6).flat_map(|face| (0..4).map(move |texel| face * 10 + texel)).collect()
}

const ALL: [(CubeLayout, &str); 5] = [
    (CubeLayout::HorizontalCross, HORIZONTAL),
    (CubeLayout::VerticalCross, VERTICAL),
    (CubeLayout::HorizontalStrip, STRIP),
    (CubeLayout::VerticalStrip, UPRIGHT_STRIP),
    (CubeLayout::Grid, GRID),
];

#[test]
fn crosses_strips_and_grids_are_cut_as_drawn() {
    let folder = tempdir().unwrap();
    for (layout, text) in ALL {
        let (width, height, texels) = picture(text);
        let file = grey(folder.path(), &format!("{layout}.png"), width, height, texels);
        for given in [Some(layout), None] {
            let t = read(Dimension::Cube, TextureContent::CubeFile(file.clone(), given)).unwrap();
            assert_eq!((t.dimension, t.width, t.height, t.depth), (Dimension::Cube, 2, 2, 6), "{layout}");
            assert_eq!(t.texels, faces(), "{layout}, layout given: {}", given.is_some());
        }
    }
}

/// Independently of the drawings: neighbours in a cross are adjacent on the cube.
#[test]
fn crosses_are_continuous() {
    let folder = tempdir().unwrap();
    let side = 8;
    for (columns, rows) in [(4, 3), (3, 4)] {
        let (width, height) = (columns * side, rows * side);
        let coded = ImageBuffer::from_fn(width, height, |x, y| Rgb([x as u8, y as u8, 0]));
        let file = save(folder.path(), "coded.png", coded);
        let t = read(Dimension::Cube, TextureContent::CubeFile(file, None)).unwrap();
        let mut at = HashMap::new();
        for (n, texel) in (0u32..).zip(t.texels.chunks_exact(4)) {
            let (face, y, x) = (n / (side * side), n / side % side, n % side);
            at.insert((texel[0], texel[1]), direction(face, x, y, side));
        }
        assert_eq!(at.len() as u32, 6 * side * side, "every texel once");
        let mut pairs = 0;
        for (&(x, y), a) in &at {
            for b in [at.get(&(x + 1, y)), at.get(&(x, y + 1))].into_iter().flatten() {
                let dot: f32 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                let length = |v: &[f32; 3]| v.iter().map(|v| v * v).sum::<f32>().sqrt();
                // Farthest apart in the middle of a face: each an eighth of the half side off its axis.
                assert!(
                    dot > 0.999 * (2.0 * 0.125f32.atan()).cos() * length(a) * length(b),
                    "({x}, {y}): {a:?}, {b:?}"
                );
                pairs += 1;
            }
        }
        // Inside the faces, and across the five edges where two faces of a cross touch.
        assert_eq!(pairs, 6 * 2 * side * (side - 1) + 5 * side);
    }
}

#[test]
fn six_files_are_the_faces_in_order() {
    let folder = tempdir().unwrap();
    let files: Vec<_> = faces()
        .chunks(4)
        .zip(0..)
        .map(|(face, i)| grey(folder.path(), &format!("{i}.png"), 2, 2, face.to_vec()))
        .collect();
    let t = read(Dimension::Cube, TextureContent::Faces(files.try_into().unwrap())).unwrap();
    assert_eq!((t.width, t.height, t.depth, t.texels), (2, 2, 6, faces()));
}

#[test]
fn faces_that_fit_no_cube_are_refused() {
    let folder = tempdir().unwrap();
    let small = grey(folder.path(), "small.png", 2, 2, vec![0; 4]);
    let wide = grey(folder.path(), "wide.png", 3, 2, vec![0; 6]);
    let float = folder.path().join("float.exr");
    ImageBuffer::<Rgb<f32>, _>::from_pixel(2, 2, Rgb([0.5f32; 3])).save(&float).unwrap();
    let missing = folder.path().join("smal.png");
    let one_other = |other: &std::path::PathBuf| {
        let mut files = [0; 6].map(|_| small.clone());
        files[3] = other.clone();
        told(read(Dimension::Cube, TextureContent::Faces(files)))
    };
    assert_says(&one_other(&wide), &["texture \"t\"", "wide.png: face 4 of 6", "3×2", "small.png", "2×2"]);
    assert_says(&one_other(&float), &["float.exr: face 4 of 6", "rgba-float", "grey8", "linear light"]);
    assert_says(&one_other(&missing), &["texture \"t\"", "smal.png", "no such file", "did you mean"]);
    let files = [0; 6].map(|_| wide.clone());
    let message = told(read(Dimension::Cube, TextureContent::Faces(files)));
    assert_says(&message, &["wide.png", "3×2", "square"]);
}

#[test]
fn pictures_that_fit_no_layout_are_refused() {
    let folder = tempdir().unwrap();
    let square = grey(folder.path(), "square.png", 4, 4, vec![0; 16]);
    let message = told(read(Dimension::Cube, TextureContent::CubeFile(square.clone(), None)));
    assert_says(&message, &["square.png", "4×4", "4:3 or 3:4", "6:1 or 1:6", "3:2", "faces ="]);
    let layout = Some(CubeLayout::VerticalCross);
    let message = told(read(Dimension::Cube, TextureContent::CubeFile(square, layout)));
    assert_says(&message, &["square.png", "4×4", "\"vertical-cross\"", "3×4"]);
    let sixteen = ImageBuffer::<Luma<u16>, _>::from_pixel(4, 3, Luma([7u16]));
    let cross = save(folder.path(), "cross.png", sixteen);
    let t = read(Dimension::Cube, TextureContent::CubeFile(cross, None)).unwrap();
    assert_eq!((t.width, t.format.name()), (1, "grey16"), "faces of one texel");
}
