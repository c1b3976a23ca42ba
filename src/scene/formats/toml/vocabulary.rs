//! Finds the table for a key in a wrong one. Input: the table's section and the key. Output: a related table
//! that has such a key.

use super::materials::{MAPPING, MATERIAL};
use super::samplers::{BACKGROUND, SAMPLER};
use super::sections::{CAMERA, IMAGE, SAMPLING};
use super::shapes::is_shape;
use super::textures::TEXTURE;

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
