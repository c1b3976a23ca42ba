//! `moire pattern`: its numbers, its picture, and its errors.

use moire::internal::scene::model::Pattern;
use serde_json::Value;
use tempfile::tempdir;

use crate::support::moire;

fn report(arguments: &[&str]) -> Value {
    let output = moire().arg("pattern").args(arguments).arg("--json").output().unwrap();
    assert_eq!((output.status.code(), &*String::from_utf8_lossy(&output.stderr)), (Some(0), ""));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn refused(arguments: &[&str], words: &[&str]) {
    let output = moire().arg("pattern").args(arguments).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {told}");
    // Messages are wrapped.
    let flat: String = told.split_whitespace().filter(|w| *w != "│").collect::<Vec<_>>().join(" ");
    for word in words {
        assert!(flat.contains(word), "{arguments:?}: no {word:?} in {told}");
    }
}

#[test]
fn every_pattern_is_described() {
    for &pattern in Pattern::ALL {
        let told = report(&[pattern.name(), "--spp", "16"]);
        let count = if pattern == Pattern::Center { 1 } else { 16 };
        assert_eq!((told["pattern"].as_str(), told["points"].as_u64()), (Some(pattern.name()), Some(count)));
        assert!(told["radial_mean"].as_array().unwrap().len() >= 64);
        assert!(told["out"].is_null());
        let discrepancy = told["star_discrepancy"].as_f64().unwrap();
        assert!((1.0 / 32.0..1.0).contains(&discrepancy), "{pattern}: {discrepancy}");
    }
}

#[test]
fn numbers_are_those_of_the_pattern() {
    let grid = report(&["grid", "--spp", "16"]);
    assert_eq!(grid["mean_nearest_distance"], 0.25);
    // The box up to the last column and row, less the area beyond both: 1 - (7/8)².
    assert_eq!(grid["star_discrepancy"], 1.0 - 0.875 * 0.875);
    assert_eq!((&grid["strata"]["occupied"], &grid["strata"]["occupied_of_n_rows"]), (&16.into(), &4.into()));
    let sobol = report(&["sobol-owen", "--spp", "256", "--pair", "3", "--seed", "9"]);
    assert_eq!(sobol["strata"]["occupied"], 256);
    assert_eq!(sobol["strata"]["occupied_of_n_columns"], 256);
    assert_ne!(sobol["star_discrepancy"], report(&["sobol-owen", "--spp", "256"])["star_discrepancy"]);
    assert!(sobol["radial_mean"][0].as_f64().unwrap() < 0.05);
}

#[test]
fn the_picture_shows_points_and_spectrum() {
    let folder = tempdir().unwrap();
    for name in ["p.png", "p.jpg", "p.exr"] {
        let path = folder.path().join(name);
        let path = path.to_str().unwrap();
        let output = moire().args(["pattern", "stratified", "--out", path]).output().unwrap();
        assert!(output.status.success());
        assert!(String::from_utf8_lossy(&output.stdout).contains(path));
    }
    let picture = image::open(folder.path().join("p.png")).unwrap().to_rgb8();
    let film = moire::internal::lab::metrics::read_picture(&folder.path().join("p.exr")).unwrap();
    assert_eq!(picture.dimensions(), (film.width, film.height));
    // The centre of the spectrum is dark, its corners are grey.
    let mean = |x: u32, y: u32| {
        let values = (0..20).flat_map(|v| (0..20).map(move |u| (x + u, y + v)));
        values.map(|(u, v)| u32::from(picture.get_pixel(u, v)[0])).sum::<u32>() / 400
    };
    let (left, top) = (284, 8);
    assert!(mean(left + 119, top + 119) < 80 && (110..145).contains(&mean(left + 5, top + 5)));
}

#[test]
fn what_makes_no_sense_is_refused() {
    refused(&["stratified", "--spp", "15"], &["--spp: spp = 15 is no square; use 9 or 16"]);
    refused(&["blue-noise", "--spp", "48"], &["no power of two; use 32 or 64"]);
    refused(&["halton", "--spp", "5000"], &["5000 points", "use 1 to 4096"]);
    refused(&["halton", "--spp", "0"], &["out of range"]);
    refused(&["sobol", "--spp", "4"], &["sobol-owen"]);
    refused(&["sobol-owen", "--pair", "16"], &["16", "0..16"]);
    refused(&["sobol-owen", "--out", "x.gif"], &[".gif is unknown", ".png"]);
    refused(&["sobol-owen", "--out", "no/such/folder/x.png"], &["no/such/folder"]);
}
