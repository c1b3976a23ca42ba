//! The picture: the pixels of cells are those of `render`, enlarged or averaged as asked, and nothing lies over another.

use std::path::Path;

use moire::internal::core::film::Film;
use moire::internal::lab::metrics::read_picture;
use tempfile::tempdir;

use super::{record, scene};
use crate::stage::device_name;
use crate::support::moire;

/// Where the first picture of a sheet with one setting stands: below a margin, the title, a gap and the head.
pub(super) const CORNER: [u32; 2] = [24, 24 + 20 + 20 + 20];
const WHITE: [f32; 3] = [1.0; 3];

pub(super) fn rendered(folder: &Path, options: &[&str]) -> Film {
    let mut command = moire();
    command.current_dir(folder).arg("render").arg(scene()).args([
        "--device",
        &device_name(),
        "-o",
        "own.png",
        "-o",
        "own.exr",
    ]);
    let output = command.args(options).output().unwrap();
    assert!(output.status.success(), "{}", super::told(&output));
    read_picture(&folder.join("own.png")).unwrap()
}

pub(super) fn at(film: &Film, x: u32, y: u32) -> [f32; 3] {
    film.pixels[(y * film.width + x) as usize]
}

#[test]
fn pictures_stand_in_the_sheet_pixel_by_pixel() {
    let folder = tempdir().unwrap();
    let options = ["--size", "240x32", "--vary", "spp=1,4", "--repeats", "1", "-o", "s.png", "-o", "s.tif"];
    record(folder.path(), &[&options[..], &["--reference", "none"]].concat());
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    assert_eq!(sheet, read_picture(&folder.path().join("s.tif")).unwrap());
    for (i, spp) in ["1", "4"].iter().enumerate() {
        let own = rendered(folder.path(), &["--size", "240x32", "--spp", spp]);
        let left = CORNER[0] + i as u32 * (240 + 20);
        for (x, y) in (0..32).flat_map(|y| (0..240).map(move |x| (x, y))) {
            assert_eq!(at(&sheet, left + x, CORNER[1] + y), at(&own, x, y), "{spp} samples at ({x}, {y})");
        }
        // A planted difference of one pixel would be seen: neighbours differ.
        assert_ne!(at(&sheet, left + 1, CORNER[1] + 31), at(&own, 239, 0));
        assert_eq!(at(&sheet, left - 1, CORNER[1]), WHITE);
    }
}

#[test]
fn a_part_is_shown_with_square_pixels_and_marked_in_the_whole() {
    let folder = tempdir().unwrap();
    let options =
        ["--size", "64x48", "--vary", "seed=1", "--repeats", "1", "--reference-spp", "8", "-o", "s.png"];
    record(folder.path(), &[&options[..], &["--zoom", "20,10,8,6", "--zoom-factor", "30"]].concat());
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    let own = rendered(folder.path(), &["--size", "64x48", "--seed", "1"]);
    for (x, y) in (0..6 * 30).flat_map(|y| (0..8 * 30).map(move |x| (x, y))) {
        let shown = at(&sheet, CORNER[0] + x, CORNER[1] + y);
        assert_eq!(shown, at(&own, 20 + x / 30, 10 + y / 30), "({x}, {y})");
    }
    // Second comes the whole, with a frame: black, then white within it.
    let left = CORNER[0] + 240 + 20;
    assert_eq!(at(&sheet, left + 20, CORNER[1] + 10), [0.0; 3]);
    assert_eq!(at(&sheet, left + 21, CORNER[1] + 11), WHITE);
}

#[test]
fn wide_pictures_are_averaged_and_say_so() {
    let folder = tempdir().unwrap();
    let options = ["--size", "64x48", "--vary", "seed=1", "--repeats", "1", "--reference", "none"];
    let page = folder.path().join("s.html");
    record(folder.path(), &[&options[..], &["--cell", "32", "-o", "s.html", "-o", "s.png"]].concat());
    assert!(std::fs::read_to_string(page).unwrap().contains("shown at 1/2, averaged"));
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    assert_ne!(at(&sheet, CORNER[0] + 31, CORNER[1] + 23), WHITE);
    assert_eq!(at(&sheet, CORNER[0] + 32, CORNER[1] + 23), WHITE);
}

#[test]
fn differences_of_equal_pictures_are_dark_and_planted_ones_are_light() {
    let folder = tempdir().unwrap();
    rendered(folder.path(), &["--size", "32x24", "--seed", "1"]);
    let mut own = read_picture(&folder.path().join("own.exr")).unwrap();
    own.pixels[12 * 32 + 9] = [0.0, 1.0, 0.5];
    let name = folder.path().join("planted.exr");
    moire::internal::output::write(&own, &name, &Default::default()).unwrap();
    let options = ["--size", "32x24", "--vary", "seed=1", "--repeats", "1", "--diff", "-o", "s.png"];
    record(folder.path(), &[&options[..], &["--reference", "planted.exr"]].concat());
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    let brightness = |x: u32, y: u32| at(&sheet, CORNER[0] + x, CORNER[1] + 24 + 6 + y).iter().sum::<f32>();
    let lightest =
        (0..24 * 32).max_by(|a, b| brightness(a % 32, a / 32).total_cmp(&brightness(b % 32, b / 32)));
    assert_eq!(lightest, Some(12 * 32 + 9));
}
