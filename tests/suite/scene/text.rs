//! Invalid text: syntax, unknown keys, unusual characters, and mutated scenes that must never
//! panic.

use std::path::Path;

use moire::internal::scene::parse;
use proptest::prelude::*;

use super::errors::{PATH, check, check_behind_head, message};
use super::{FULL, HEAD};

#[test]
fn file_level_rules() {
    check_behind_head(&[
        (
            "section misspelt",
            "[[matrial]]\nname = 'm'",
            &[":9:3:", "\"matrial\" at the top level; did you mean \"material\""],
        ),
        (
            "section planned",
            "[[instance]]\nfile = 'm.obj'",
            &["unknown key \"instance\" at the top level", "plane, sphere, triangle"],
        ),
        ("stray key", "[image.extra]", &["unknown key \"extra\" in [image]"]),
        ("first of two", "[sampling]\nzz = 1\naa = 2", &[":10:1:", "\"zz\""]),
        ("syntax", "[sampling]\nspp = = 4", &[":10:7:", "TOML syntax"]),
        ("unclosed", "[sampling]\npattern = 'grid", &[":10:", "TOML syntax"]),
        ("duplicate key", "[sampling]\nspp = 4\nspp = 9", &[":11:1:", "duplicate key", "spp"]),
        ("unfinished at the end", "[sampling]\nspp =", &[":10:", "TOML syntax"]),
        ("line break in a key", "[sampling]\n\"a\\nb\" = 1", &["unknown key \"a\\nb\""]),
        ("long names are cut", &format!("[sampling]\n{} = 1", "k".repeat(5000)), &["kkk…\""]),
        ("inline shapes that are none", "sphere = 1", &["unknown key \"sphere\" in [image]"]),
    ]);
    let number = format!("sphere = [1]\n{HEAD}");
    check(&[("number for a shape", &number, &[":1:11:", "\"sphere\"", "headed [[sphere]]", "found 1"])]);
    let behind_multibyte = format!("{HEAD}[sampling] # ä→𝄞\n\"ä\" = 1");
    let crlf = HEAD.replace('\n', "\r\n").replace("= 64", "= 0");
    check(&[
        ("columns count characters", "[image]\nwidth = ['ä→𝄞', nan] # ä", &[":1:1:", "camera"]),
        ("multibyte key", &behind_multibyte, &[":10:1:", "unknown key \"ä\""]),
        ("carriage returns", &crlf, &[":7:9:", "image.width"]),
        ("byte order mark", "\u{feff}x = 1", &["a.toml:1:1: unknown key \"x\""]),
        ("character columns", "camera = { 'ä' = 1, eye = 2 }", &[":1:12:", "unknown key \"ä\""]),
        ("behind multibyte", "camera = { eye = 'ä', lok_at = 2 }", &[":1:23:", "did you mean \"look_at\""]),
    ]);
}

/// Pieces that turn a scene into a nearly good one.
const TOKENS: &[&str] = &[
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    "\n",
    "\r",
    ",",
    ".",
    "'",
    "\"",
    "'''",
    "#",
    "nan",
    "-inf",
    "1e999",
    "-0.0",
    "0x8000000000000000",
    "1979-05-27",
    "true",
    "é",
    "\u{feff}",
    "\u{2028}",
    "\0",
    "\\u0000",
    "[camera]",
    "[[plane]]",
    "[material.mapping]",
    "name = 'm'\n",
    "material = 'm'\n",
    "spp = 3\n",
    "99999999999999999999",
];

fn mutate(text: &str, edits: &[(usize, usize, Vec<u8>, usize)]) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for (at, cut, raw, token) in edits {
        let start = at % (bytes.len() + 1);
        let end = (start + cut).min(bytes.len());
        let piece = TOKENS.get(*token).map_or(raw.as_slice(), |token| token.as_bytes());
        bytes.splice(start..end, piece.iter().copied());
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..Default::default() })]

    #[test]
    fn mutated_scenes_never_panic_and_their_errors_stay_well_formed(
        edits in prop::collection::vec(
            (any::<usize>(), 0..12usize, prop::collection::vec(any::<u8>(), 0..6), 0..TOKENS.len() * 3 / 2),
            1..6,
        )
    ) {
        let text = mutate(FULL, &edits);
        if parse(Path::new(PATH), &text).is_err() {
            prop_assert!(message(&text).is_ok(), "{:?}", message(&text));
        }
    }
}
