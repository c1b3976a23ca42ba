//! Removes from a scene the parts that do not affect the picture: materials of no shape, textures and samplers of no
//! material, lights if nothing reflects them; and merges textures that read the same texels. Indices are updated.

use std::collections::HashMap;
use std::path::Path;

use super::model::{Scene, TextureContent, TextureSource};
use crate::core::counted::{counted, verb};

/// Prunes a scene; returns what was removed, for `-v`.
pub fn prune(scene: &mut Scene) -> Vec<String> {
    let mut dropped = Vec::new();
    let used: Vec<usize> = scene.shapes.iter().map(|shape| shape.material()).collect();
    let materials = keep(&mut scene.materials, &used);
    for shape in scene.shapes.iter_mut() {
        *shape.material_mut() = materials[shape.material()];
    }
    note(&mut dropped, "material", &materials);

    let mapped = || scene.materials.iter().filter(|m| m.is_mapped());
    let environment = scene.background.environment;
    let of = mapped().flat_map(|m| m.textures());
    let used: Vec<usize> = of.map(|used| used.texture).chain(environment.map(|e| e.texture)).collect();
    let of = mapped().flat_map(|m| m.textures().map(|used| used.sampler).chain([m.sampler]));
    let samplers_used: Vec<usize> = of.chain(environment.map(|e| e.sampler)).collect();
    let textures = keep(&mut scene.textures, &used);
    let samplers = keep(&mut scene.samplers, &samplers_used);
    for material in &mut scene.materials {
        if material.is_mapped() {
            material.sampler_indices_mut().for_each(|index| *index = samplers[*index]);
        } else {
            material.sampler = 0;
        }
    }
    if let Some(environment) = &mut scene.background.environment {
        environment.sampler = samplers[environment.sampler];
    }
    point_to_textures(scene, &textures);
    note(&mut dropped, "texture", &textures);
    note(&mut dropped, "sampler", &samplers);
    merge_textures(scene, &mut dropped);

    let is_lit = scene.materials.iter().any(|m| m.model.is_lit()) || scene.is_lit_by_environment();
    if !scene.lights.is_empty() && !is_lit {
        let count = scene.lights.len();
        dropped.push(format!(
            "{} that {} on nothing",
            counted(count, "light"),
            verb(count, "shines", "shine")
        ));
        scene.lights.clear();
    }
    dropped
}

/// Replaces textures that read the same texels by the first of them, which is decoded and stored on devices once.
fn merge_textures(scene: &mut Scene, dropped: &mut Vec<String>) {
    let identities: Vec<TextureSource> = scene.textures.iter().map(TextureSource::identity).collect();
    // Only sources of the same files are compared.
    let mut of_files: HashMap<Vec<&Path>, Vec<usize>> = HashMap::new();
    let first = |i: usize| {
        let alike = of_files.entry(files(&identities[i].content)).or_default();
        let known = alike.iter().copied().find(|&other| identities[other] == identities[i]);
        known.unwrap_or_else(|| {
            alike.push(i);
            i
        })
    };
    let firsts: Vec<usize> = (0..identities.len()).map(first).collect();
    for (i, &first) in firsts.iter().enumerate().filter(|(i, first)| i != *first) {
        let [this, other] = [i, first].map(|index| &scene.textures[index].name);
        dropped.push(format!("texture \"{this}\", which reads the texels of \"{other}\""));
    }
    let kept = keep(&mut scene.textures, &firsts);
    let merged: Vec<usize> = firsts.iter().map(|&first| kept[first]).collect();
    point_to_textures(scene, &merged);
}

/// Returns the files of a texture, or the name of one that is within another.
fn files(content: &TextureContent) -> Vec<&Path> {
    match content {
        TextureContent::Embedded(name, _) => vec![name],
        _ => content.files(),
    }
}

/// Updates the indices of textures; `textures` maps old to new.
fn point_to_textures(scene: &mut Scene, textures: &[usize]) {
    for material in &mut scene.materials {
        material.texture_indices_mut().for_each(|index| *index = textures[*index]);
    }
    if let Some(environment) = &mut scene.background.environment {
        environment.texture = textures[environment.texture];
    }
}

const GONE: usize = usize::MAX;

/// Keeps the items whose index is in `used`; returns old index → new index.
fn keep<T>(items: &mut Vec<T>, used: &[usize]) -> Vec<usize> {
    let mut map = vec![GONE; items.len()];
    for &index in used {
        map[index] = 0;
    }
    for (next, new) in map.iter_mut().filter(|new| **new != GONE).enumerate() {
        *new = next;
    }
    let mut index = 0;
    items.retain(|_| {
        index += 1;
        map[index - 1] != GONE
    });
    map
}

fn note(dropped: &mut Vec<String>, what: &str, map: &[usize]) {
    match map.iter().filter(|&&new| new == GONE).count() {
        0 => {}
        1 => dropped.push(format!("1 {what} that no shape shows")),
        n => dropped.push(format!("{n} {what}s that no shape shows")),
    }
}
