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
