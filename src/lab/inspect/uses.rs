//! What an image is read for: by which materials, in which of their maps, and in how many pixels. Input: a scene, and
//! counts. Output: uses, and words for them.

use std::collections::BTreeMap;

use crate::core::counted::counted;
pub use crate::oracle::quantities::Slot;
use crate::scene::model::{Material, Scene, TextureUse};

/// What an image is read for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    pub slot: Slot,
    /// Index of the material; none for the environment.
    pub material: Option<usize>,
    /// Pixels that read it.
    pub pixels: u64,
}

/// Returns what an image is read for, by its textures. `pixels`: by material and slot; materials are packed in their order,
/// the environment's last.
pub(super) fn uses(scene: &Scene, textures: &[usize], pixels: &BTreeMap<(usize, Slot), u64>) -> Vec<Use> {
    let pixels = |material: usize, slot| pixels.get(&(material, slot)).copied().unwrap_or(0);
    let mut uses = Vec::new();
    for (number, material) in scene.materials.iter().enumerate() {
        for slot in Slot::ALL {
            if use_of(material, slot).is_some_and(|own| textures.contains(&own.texture)) {
                uses.push(Use { slot, material: Some(number), pixels: pixels(number, slot) });
            }
        }
    }
    if scene.background.environment.is_some_and(|own| textures.contains(&own.texture)) {
        let pixels = pixels(scene.materials.len(), Slot::Color);
        uses.push(Use { slot: Slot::Color, material: None, pixels });
    }
    uses
}

/// Returns the name of a material, or its number from 1 where it has none.
pub fn name_of(scene: &Scene, number: usize) -> String {
    match scene.materials[number].name.as_str() {
        "" => format!("material {}", number + 1),
        name => name.to_owned(),
    }
}

/// Returns the texture that a material reads for something.
fn use_of(material: &Material, slot: Slot) -> Option<TextureUse> {
    let maps = material.maps();
    match slot {
        Slot::Color => maps.color,
        Slot::Bump => maps.bump,
        Slot::Roughness => maps.roughness,
        Slot::Emission => maps.emission,
        Slot::Occlusion => maps.occlusion,
        Slot::SpecularWeight => maps.specular_weight,
        Slot::SpecularTint => maps.specular_tint,
        Slot::Transmission => maps.transmission,
    }
}

impl Use {
    /// Returns `normal map of brick (12 pixels)`.
    pub fn words(&self, scene: &Scene) -> String {
        let material = self.material.and_then(|number| scene.materials.get(number));
        let is_normal_map = || material.and_then(|own| own.bump).is_some_and(|own| own.kind.is_normal_map());
        let slot = match self.slot {
            Slot::Color if material.is_none() => "environment",
            Slot::Color => "colour",
            Slot::Bump if is_normal_map() => "normal map",
            Slot::Bump => "bump map",
            Slot::Roughness => "roughness and metallic",
            Slot::Emission => "emission",
            Slot::Occlusion => "occlusion",
            Slot::SpecularWeight => "weight of the reflection",
            Slot::SpecularTint => "tint of the reflection",
            Slot::Transmission => "transmission",
        };
        let number = self.material.filter(|_| material.is_some());
        let by = number.map_or(String::new(), |number| format!(" of {}", name_of(scene, number)));
        format!("{slot}{by} ({})", counted(self.pixels as usize, "pixel"))
    }
}
