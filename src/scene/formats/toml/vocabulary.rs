//! How keys of sections are related. Input: a section and a key. Output: a related table that has such a key, if it is in a
//! wrong one; or the keys that stand in its place in other scenes.

use super::materials::{MAPPING, MATERIAL};
use super::samplers::{BACKGROUND, SAMPLER};
use super::sections::{CAMERA, IMAGE, PROJECTIONS, SAMPLING};
use super::shapes::is_shape;
use super::textures::TEXTURE;
use crate::scene::synonyms::meant;

/// Keys of a section that exclude each other.
const ALTERNATIVES: [(&str, &[&str]); 6] = [
    ("camera", &PROJECTIONS),
    ("texture", &["procedural", "file", "faces", "slices", "volume", "ramp"]),
    ("material", &["normal_map", "bump_map"]),
    ("light", &["radiance", "intensity"]),
    ("image", &["size", "width"]),
    ("image", &["size", "height"]),
];

type Home = (&'static str, &'static [&'static str]);

const IN_MAPPING: Home = ("mapping = { … }", MAPPING);
const IN_MATERIAL: Home = ("its [[material]]", MATERIAL);
const IN_ITS_MAPPING: Home = ("mapping = { … } of its [[material]]", MAPPING);
const IN_SAMPLER: Home = ("a [[sampler]]", SAMPLER);
const IN_TEXTURE: Home = ("the [[texture]]", TEXTURE);
const IN_CAMERA: Home = ("[camera]", CAMERA);
const IN_IMAGE: Home = ("[image]", IMAGE);
const IN_SAMPLING: Home = ("[sampling]", SAMPLING);
const IN_BACKGROUND: Home = ("[background]", BACKGROUND);

/// Returns the tables with which a section is often confused, nearest first.
fn neighbours(section: &str) -> &'static [Home] {
    match section {
        "" => &[IN_CAMERA, IN_IMAGE, IN_SAMPLING, IN_BACKGROUND],
        "camera" => &[IN_IMAGE, IN_SAMPLING],
        "image" => &[IN_SAMPLING, IN_CAMERA],
        "sampling" => &[IN_IMAGE, IN_CAMERA],
        "background" => &[IN_SAMPLER, IN_TEXTURE],
        "material" => &[IN_MAPPING, IN_SAMPLER, IN_TEXTURE],
        "material.mapping" => &[("the [[material]] itself", MATERIAL), IN_SAMPLER],
        "texture" => {
            &[IN_SAMPLER, ("a [[material]]", MATERIAL), ("mapping = { … } of a [[material]]", MAPPING)]
        }
        "sampler" => {
            &[IN_TEXTURE, ("a [[material]]", MATERIAL), ("mapping = { … } of a [[material]]", MAPPING)]
        }
        shape if is_shape(shape) => &[IN_MATERIAL, IN_ITS_MAPPING],
        _ => &[],
    }
}

/// Describes the table in words.
pub(super) fn home_of(section: &str, key: &str) -> Option<&'static str> {
    neighbours(section).iter().find(|(_, keys)| keys.contains(&key)).map(|(home, _)| *home)
}

/// Tables, and how their keys are named beside the file.
const PATHS: [(&str, &[&str]); 7] = [
    ("camera", CAMERA),
    ("image", IMAGE),
    ("sampling", SAMPLING),
    ("sampler.*", SAMPLER),
    ("material.*", MATERIAL),
    ("material.*.mapping", MAPPING),
    ("texture.*", TEXTURE),
];

/// Returns the whole name of a key that is named without its section, such as `sampler.*.filter`.
pub fn path_of(word: &str) -> Option<String> {
    let word = word.to_lowercase().replace('-', "_");
    let is = |table: &&(&str, &[&str]), key: &str| table.1.contains(&key);
    let table = PATHS.iter().find(|table| is(table, &word));
    let found = table.map(|(path, _)| (path, word.as_str()));
    let meant = || PATHS.iter().find_map(|(path, keys)| Some((path, meant(&word, keys.iter().copied())?.0)));
    found.or_else(meant).map(|(path, key)| format!("{path}.{key}"))
}

/// Returns the keys of a section in whose place this one is given.
pub(super) fn replaced_by(section: &str, key: &str) -> impl Iterator<Item = &'static str> {
    let of_section = ALTERNATIVES.iter().filter(move |(name, keys)| *name == section && keys.contains(&key));
    of_section.flat_map(|(_, keys)| keys.iter().copied()).filter(move |other| *other != key)
}

/// Returns the keys that a setting of the command line can begin with: `camera.eye`, and of tables that may be several all
/// at once, `sampler.*.filter`.
pub fn setting_keys() -> impl Iterator<Item = String> {
    let single = [("camera", CAMERA), ("image", IMAGE), ("sampling", SAMPLING), ("background", BACKGROUND)];
    let several = [("sampler.*", SAMPLER), ("material.*", MATERIAL), ("texture.*", TEXTURE)];
    let all = single.into_iter().chain(several);
    all.flat_map(|(section, keys)| keys.iter().map(move |key| format!("{section}.{key}")))
}
