//! How films are shown: exposure, white balance, tone maps and primaries vary as other settings do, and cost no render.

use serde_json::Value;
use tempfile::tempdir;

use super::picture::{CORNER, at, rendered};
use super::{cells, record};
use moire::internal::lab::metrics::read_picture;

const SIZE: [&str; 4] = ["--size", "220x40", "--repeats", "1"];

#[test]
fn cells_show_what_render_shows_with_their_options() {
    let folder = tempdir().unwrap();
    let vary = ["--vary", "exposure=-1,1.5", "--vary", "tone-map=none,agx", "--vary", "white-balance=3000"];
    let options = ["--reference", "none", "-o", "s.png"];
    let made = record(folder.path(), &[&SIZE[..], &vary, &options].concat());
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    // Two rows of two columns below the head of a block, with heads of rows beside.
    let corner = |i: usize| {
        let head = [CORNER[0], 24 + 20 + 20 + 26 + 20];
        let first = (head[0]..).find(|x| at(&sheet, *x, head[1] + 39) != [1.0; 3] && *x > 100).unwrap();
        [first + (i % 2) as u32 * 240, head[1] + (i / 2) as u32 * (40 + 6 + 20 + 20)]
    };
    for (i, cell) in cells(&made).iter().enumerate() {
        let shown = |name: &str| format!("--{name}={}", cell["settings"][name].as_str().unwrap());
        let words = [shown("exposure"), shown("tone-map"), shown("white-balance")];
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let own = rendered(folder.path(), &[&SIZE[..2], &words].concat());
        let [left, top] = corner(i);
        for (x, y) in (0..40).flat_map(|y| (0..220).map(move |x| (x, y))) {
            assert_eq!(at(&sheet, left + x, top + y), at(&own, x, y), "{words:?} at ({x}, {y})");
        }
        let command = cell["command"].as_str().unwrap();
        for name in ["exposure", "tone-map", "white-balance"] {
            assert!(command.contains(&format!("--{name} ")), "{command}");
        }
    }
}

#[test]
fn cells_that_differ_only_in_how_they_are_shown_are_rendered_once() {
    let folder = tempdir().unwrap();
    let vary = ["--vary", "tone-map=none,aces", "--vary", "spp=1,4", "--reference-spp", "256"];
    let made = record(folder.path(), &[&SIZE[..], &vary].concat());
    let films: Vec<&Value> = cells(&made).iter().map(|cell| &cell["film_of"]).collect();
    assert_eq!(films, [&Value::Null, &0.into(), &Value::Null, &2.into()]);
    for key in ["rmse", "flip", "device_seconds", "samples", "reference"] {
        let of = |i: usize| &cells(&made)[i][key];
        assert!(of(0) == of(1) && of(2) == of(3), "{key} is not that of the one film");
    }
    assert_ne!(cells(&made)[0]["rmse"], cells(&made)[2]["rmse"]);
    assert_eq!(cells(&made)[1]["label"], "tone map: aces, 1 sample");
    // Errors are those of the film, however it is shown.
    let plain = ["--vary", "spp=1,4", "--reference-spp", "256", "--exposure", "-3"];
    let plain = record(folder.path(), &[&SIZE[..], &plain].concat());
    assert_eq!(cells(&plain)[0]["rmse"], cells(&made)[0]["rmse"]);
}

#[test]
fn differences_are_those_of_what_is_shown() {
    let folder = tempdir().unwrap();
    let largest = |exposure: &str| {
        let options = ["--vary", "seed=1", "--diff", "--reference-spp", "256", "--exposure", exposure];
        let made = record(folder.path(), &[&SIZE[..], &options].concat());
        made["difference_scale"].as_f64().unwrap()
    };
    let [plain, brighter] = [largest("0"), largest("2")];
    assert!((brighter / plain - 4.0).abs() < 1e-5, "{brighter} for {plain}, two stops more");
}

#[test]
fn primaries_are_those_of_the_widest_cell() {
    let folder = tempdir().unwrap();
    let options = ["--vary", "gamut=srgb,display-p3", "--reference", "none", "-o", "s.png", "-o", "s.html"];
    record(folder.path(), &[&SIZE[..], &options].concat());
    let bytes = std::fs::read(folder.path().join("s.png")).unwrap();
    let own = rendered(folder.path(), &["--size", "220x40", "--gamut", "display-p3"]);
    let sheet = read_picture(&folder.path().join("s.png")).unwrap();
    for (x, y) in (0..40).flat_map(|y| (0..220).map(move |x| (x, y))) {
        assert_eq!(at(&sheet, CORNER[0] + 240 + x, CORNER[1] + y), at(&own, x, y), "({x}, {y})");
    }
    let tagged = std::fs::read(folder.path().join("own.png")).unwrap();
    let tags = |bytes: &[u8]| ["iCCP", "cICP"].map(|tag| bytes.windows(4).any(|w| w == tag.as_bytes()));
    assert_eq!(tags(&bytes), tags(&tagged), "the sheet is tagged as the picture is");
    assert!(tags(&bytes).contains(&true));
}
