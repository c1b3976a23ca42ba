//! Several views in a sheet: each has its reference and its whole picture, or its reason.

use moire::internal::lab::metrics::read_picture;
use serde_json::Value;
use tempfile::tempdir;

use super::{SIZE, cells, record};

#[test]
fn every_view_has_its_reference_and_its_whole_picture() {
    let folder = tempdir().unwrap();
    let count = |options: &[&str]| {
        let fixed = ["--repeats", "1", "--reference-spp", "8", "-o", "s.html", "-o", "s.png"];
        record(folder.path(), &[&SIZE[..], &fixed, options].concat());
        let page = std::fs::read_to_string(folder.path().join("s.html")).unwrap();
        assert!(read_picture(&folder.path().join("s.png")).unwrap().height > 100);
        ["<img ", "<b>reference, camera.eye: ", "<b>whole picture, camera.eye: "]
            .map(|text| page.matches(text).count())
    };
    let eyes = ["--vary", "camera.eye=[0,1,0],[0,2,0],[0,3,0]"];
    assert_eq!(count(&eyes), [6, 3, 0]);
    assert_eq!(count(&[&eyes[..], &["--zoom", "4,4,8,8"]].concat()), [9, 3, 3]);
    assert_eq!(count(&[&eyes[..], &["--vary", "spp=1,4", "--zoom", "4,4,8,8"]].concat()), [12, 3, 3]);
    // Without references, too, each view has its whole.
    let page = [&eyes[..], &["--zoom", "4,4,8,8", "--reference", "none", "--repeats", "1", "-o", "n.html"]];
    record(folder.path(), &[&SIZE[..], &page.concat()].concat());
    let page = std::fs::read_to_string(folder.path().join("n.html")).unwrap();
    assert_eq!(page.matches("<b>whole picture, camera.eye: ").count(), 3);
}

#[test]
fn a_texture_that_cannot_be_read_has_its_reason_in_the_cell_whatever_the_reference_is() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("bad.png"), "no picture").unwrap();
    let tiles = std::path::absolute(crate::stage::path("horizon")).unwrap();
    let tiles = tiles.parent().unwrap().join("../textures/tiles.png");
    let vary = format!("texture.0.file=bad.png,{}", tiles.display());
    super::picture::rendered(folder.path(), &SIZE);
    for reference in [&[][..], &["--reference", "none"], &["--reference", "own.exr"]] {
        let options = [&SIZE[..], &["--repeats", "1", "--vary", &vary], reference].concat();
        let made = record(folder.path(), &options);
        let errors: Vec<&Value> = cells(&made).iter().map(|cell| &cell["error"]).collect();
        let why = errors[0].as_str().unwrap_or_default();
        assert!(why.contains("bad.png: not a picture"), "{reference:?}: {made}");
        assert!(errors[1].is_null(), "{reference:?}: {made}");
    }
}
