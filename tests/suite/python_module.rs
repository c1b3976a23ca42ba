//! The module of Python, as far as its sources can be held against the crate without building it: the names of options that
//! its types declare, and the versions in its manifest and lock. The checkers are tested with planted texts.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use moire::internal::scene::model::{Algorithm, Footprint, Pattern, PixelFilterKind, Precision};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::{Filter, LevelUse, Method};
use moire::{Gamut, ToneMap};

use crate::layering::source_root;

/// The types of `_options.py`, and the vocabularies that they list.
const TYPES: [(&str, &[&str]); 11] = [
    ("Algorithm", Algorithm::NAMES),
    ("ColorSpace", ColorSpace::NAMES),
    ("Filter", Filter::NAMES),
    ("Footprint", Footprint::NAMES),
    ("Gamut", Gamut::NAMES),
    ("Method", Method::NAMES),
    ("Mip", LevelUse::NAMES),
    ("Pattern", Pattern::NAMES),
    ("PixelFilter", PixelFilterKind::NAMES),
    ("Precision", Precision::NAMES),
    ("ToneMap", ToneMap::NAMES),
];

/// Returns types whose line is another one than the vocabulary asks for.
fn strange_types(source: &str) -> Vec<String> {
    let line = |(name, words): &(&str, &[&str])| {
        let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
        format!("{name} = Literal[{}]", words.join(", "))
    };
    // A formatter may have broken long lines.
    let joined = |text: &str| text.split_whitespace().collect::<String>().replace(",]", "]");
    let source = joined(source);
    TYPES.iter().map(line).filter(|line| !source.contains(&joined(line))).collect()
}

/// Returns the crates of a lock file with their versions.
fn locked(lock: &str) -> BTreeMap<String, BTreeSet<String>> {
    let lock: toml::Table = lock.parse().unwrap();
    let mut crates: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for package in lock["package"].as_array().unwrap() {
        let text = |key: &str| package[key].as_str().unwrap().to_owned();
        crates.entry(text("name")).or_default().insert(text("version"));
    }
    crates
}

/// Returns crates of `own` that `main` has in other versions only.
fn strange_versions(own: &str, main: &str) -> Vec<String> {
    let main = locked(main);
    let differs = |(name, versions): &(String, BTreeSet<String>)| {
        main.get(name).is_some_and(|known| !versions.is_subset(known))
    };
    locked(own).into_iter().filter(differs).map(|(name, versions)| format!("{name} {versions:?}")).collect()
}

#[test]
fn types_of_the_python_module_list_the_names_of_the_crate() {
    let Some(root) = source_root() else { return };
    let source = fs::read_to_string(root.join("python/package/moire/_options.py")).unwrap();
    let strange = strange_types(&source);
    assert!(
        strange.is_empty(),
        "python/package/moire/_options.py lacks these lines:\n{}",
        strange.join("\n")
    );
}

#[test]
fn the_python_module_has_the_version_and_the_dependencies_of_the_crate() {
    let Some(root) = source_root() else { return };
    let read = |name: &str| fs::read_to_string(root.join(name)).unwrap();
    let version = format!("\nversion = \"{}\"\n", env!("CARGO_PKG_VERSION"));
    assert!(read("python/Cargo.toml").contains(&version), "python/Cargo.toml has another version");
    let strange = strange_versions(&read("python/Cargo.lock"), &read("Cargo.lock"));
    let help = "cargo update --manifest-path python/Cargo.toml --precise VERSION CRATE";
    assert!(strange.is_empty(), "python/Cargo.lock differs from Cargo.lock: {strange:?}; {help}");
}

#[test]
fn planted_strangers_in_the_python_module_are_found() {
    let line = |(name, words): (&str, &[&str])| {
        format!("{name} = Literal[\n    \"{}\",\n]\n", words.join("\",\n    \""))
    };
    let right: String = TYPES.into_iter().map(line).collect();
    assert_eq!(strange_types(&right), [""; 0]);
    assert_eq!(strange_types(&right.replace("\"ewa\",", "")).len(), 1);
    let lock = |version: &str| format!("[[package]]\nname = \"a\"\nversion = \"{version}\"\n");
    assert_eq!(strange_versions(&lock("1.0.0"), &lock("1.0.0")), [""; 0]);
    assert_eq!(strange_versions(&lock("1.0.1"), &lock("1.0.0")), ["a {\"1.0.1\"}"]);
}
