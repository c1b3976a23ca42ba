//! Output paths that cannot be written.

use std::fs;
use std::path::Path;

use super::Case;

#[test]
fn outputs_that_cannot_be_written_are_refused_before_the_render() {
    let case = Case::new();
    fs::create_dir(case.path("folder.png")).unwrap();
    for (output, wanted) in [
        ("none/a.png", "does not exist"),
        ("folder.png", "is a folder"),
        ("a.gif", ".gif is unknown"),
        ("a", "no ending"),
        ("scene.toml/a.png", "is not a folder"),
        ("b.png/", "names a folder"),
    ] {
        // Rendering this first would take hours.
        case.refused(&["--size", "16384x16384", "--spp", "16777216", "-o", output], &[output, wanted]);
    }
}

#[cfg(unix)]
#[test]
fn a_device_file_is_no_place_for_a_picture() {
    let case = Case::new();
    std::os::unix::fs::symlink(Path::new("/dev/null"), case.path("null.png")).unwrap();
    case.refused(&["-o", "null.png"], &["null.png", "not a regular file"]);
}

#[test]
fn a_picture_does_not_replace_what_it_is_made_from() {
    let case = Case::new();
    case.refused(&["-o", "tiles.png"], &["tiles.png", "file of texture", "-o"]);
    fs::copy(case.path("scene.toml"), case.path("scene.png")).unwrap();
    case.fails(&[], &["render", "scene.png", "-o", "scene.png"], &["scene.png", "this is the scene file"]);
    assert_eq!(fs::read(case.path("scene.png")).unwrap(), fs::read(case.path("scene.toml")).unwrap());
}

#[test]
fn two_outputs_that_are_one_file_are_refused() {
    let case = Case::new();
    fs::create_dir(case.path("b")).unwrap();
    for (options, wanted) in [
        (&["-o", "a.png", "-o", "a.png"][..], &["a.png: two outputs have this name"][..]),
        (&["-o", "a.png", "-o", "./a.png"], &["a.png and ./a.png are one file"]),
        (&["-o", "a.png", "-o", "b/../a.png"], &["a.png and b/../a.png are one file"]),
        (&["-o", "a.png", "--aov", "level", "-o", "a.level.png"], &["a.level.png: two outputs"]),
    ] {
        case.refused(options, wanted);
    }
    let sheet = ["sheet", "scene.toml", "--vary", "spp=1,4", "-o", "s.png", "-o", "./s.png"];
    case.fails(&[], &sheet, &["s.png and ./s.png are one file"]);
}
