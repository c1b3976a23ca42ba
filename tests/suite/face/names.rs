//! The public names: those at the crate's root, no more, and the hidden ones.

use std::fs;

use crate::layering::source_root;
use crate::sources::tokens;

/// Every name at the root, as the documentation lists them.
const NAMES: [&str; 16] = [
    "Comparison",
    "Error",
    "ErrorKind",
    "Film",
    "Gamut",
    "Progress",
    "RenderOptions",
    "RenderReport",
    "Renderer",
    "Result",
    "SaveOptions",
    "Scene",
    "SceneBuilder",
    "ToneMap",
    "internal",
    "model",
];

/// Returns the names that `pub mod` and `pub use` of a file declare.
fn public_names(text: &str) -> Vec<String> {
    let tokens = tokens(text).unwrap();
    let words: Vec<&str> = tokens.iter().map(|token| token.text.as_str()).collect();
    let mut names = Vec::new();
    for at in (1..words.len())
        .filter(|&at| words[at - 1] == "pub" && ["mod", "use", "fn", "struct"].contains(&words[at]))
    {
        let end =
            words[at..].iter().position(|word| [";", "("].contains(word)).map_or(words.len(), |n| at + n);
        let path = &words[at + 1..end];
        // The last name of each path: the text before a comma, a closing brace or the end.
        for (i, word) in path.iter().enumerate() {
            let ends = path.get(i + 1).is_none_or(|next| [",", "}"].contains(next));
            if ends && word.starts_with(|c: char| c.is_alphabetic()) {
                names.push((*word).to_owned());
            }
        }
    }
    names.sort();
    names
}

#[test]
fn the_root_has_few_names() {
    let Some(root) = source_root() else { return };
    let text = fs::read_to_string(root.join("src/lib.rs")).unwrap();
    assert_eq!(public_names(&text), NAMES);
    assert!(text.contains("#![deny(missing_docs)]"));
    assert!(text.contains("#[doc(hidden)]\npub mod internal;"), "what is internal is in the documentation");
    for room in ["core", "face", "scene", "texture"] {
        let declared = format!("\nmod {room};");
        let at = text.find(&declared).unwrap_or_else(|| panic!("no room {room}"));
        assert!(!text[..at].ends_with("]"), "what of {room} is public needs its documentation");
    }
}

#[test]
fn names_of_groups_are_found() {
    let names = public_names(
        "mod a;\npub mod b;\npub use crate::c::{d::E, F, G};\npub use h::I;\nuse j::K;\n// pub mod l;\n",
    );
    assert_eq!(names, ["E", "F", "G", "I", "b"]);
}
