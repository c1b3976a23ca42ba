//! Ranges of `--vary`: all of their values, or why there is no end to them.

use tempfile::tempdir;

use super::{record, sheet, told};

#[test]
fn ranges_are_all_of_their_values() {
    let folder = tempdir().unwrap();
    for (name, list, expected) in [
        ("seed", "1..4", "1 2 3 4"),
        ("seed", "1..=4,9", "1 2 3 4 9"),
        ("spp", "1..64x4", "1 4 16 64"),
        ("spp", "1..70*4", "1 4 16 64"),
        ("exposure", "-1..1+0.5", "-1 -0.5 0 0.5 1"),
        ("exposure", "-3..-1", "-3 -2 -1"),
        ("exposure", "0..0.3+0.1", "0 0.1 0.2 0.3"),
        ("sampling.spp", "1..9x9", "1 9"),
    ] {
        let vary = format!("{name}={list}");
        let options = ["--size", "2x2", "--repeats", "1", "--reference", "none", "--vary", &vary];
        let made = record(folder.path(), &options);
        let values: Vec<&str> =
            made["cells"].as_array().unwrap().iter().map(|c| c["settings"][name].as_str().unwrap()).collect();
        assert_eq!(values.join(" "), expected, "{vary}");
    }
}

#[test]
fn ranges_without_an_end_say_how_they_are_written() {
    let folder = tempdir().unwrap();
    for (list, what) in [
        ("4..1", "ends below its start"),
        ("1..9x1", "it needs a factor above 1"),
        ("0..9x2", "and a start above 0"),
        ("1..9+0", "it needs a step above 0"),
        ("1..9x", "has no number for its steps"),
        ("1..65", "has more values than the 64 cells of a sheet"),
    ] {
        let output = sheet(folder.path(), &["--vary", &format!("seed={list}")]);
        let told = told(&output);
        assert_eq!(output.status.code(), Some(2), "{list}: {told}");
        for text in [what, &format!("seed: \"{list}\""), "ranges are 1..4 (each whole number)"] {
            assert!(told.contains(text), "{text} is not in: {told}");
        }
    }
}
