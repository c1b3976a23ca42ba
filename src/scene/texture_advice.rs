//! Warnings about textures that are valid but hardly intended: display pictures read as linear values, normal maps
//! without normals. Input: a scene and its decoded textures.

use std::collections::HashSet;

use super::model::{BumpMap, Material, Scene};
use crate::texture::data::{ColorSpace, Component, Dimension, TextureData};
use crate::texture::source::{TextureContent, TextureSource};

/// Returns one message for each kind of warning. `textures` are those of the scene, in its order.
pub fn of_textures(scene: &Scene, textures: &[TextureData]) -> Vec<String> {
    let all = || scene.textures.iter().zip(textures).enumerate();
    let named = |keep: &dyn Fn(usize, &TextureSource, &TextureData) -> bool| -> Vec<&str> {
        all().filter(|(i, (s, t))| keep(*i, s, t)).map(|(_, (s, _))| s.name.as_str()).collect()
    };
    let normals = |i: usize| scene.materials.iter().filter_map(|m| m.bump).any(|r| is_normals(r, i));
    let encoded = named(&|i, _, t| normals(i) && t.color_space == ColorSpace::Srgb);
    let grey = named(&|i, _, t| normals(i) && is_grey(t));
    let colors = colors(scene);
    let pale = named(&|i, s, t| colors.contains(&i) && may_be_pale(s, t));
    let mut told = Vec::new();
    if !encoded.is_empty() {
        told.push(format!(
            "{} declared color_space = \"srgb\", which bends the normals: they are directions, not colours; \
             set color_space = \"linear\"",
            subject("normal map", &encoded)
        ));
    }
    if !grey.is_empty() {
        told.push(format!(
            "{} grey, red equal to green and blue in every texel: those are no normals; heights belong in \
             bump_map",
            subject("normal map", &grey)
        ));
    }
    if !pale.is_empty() {
        told.push(format!(
            "{} read as linear light, as color_space is not stated; 8-bit pictures are mostly sRGB and look pale \
             so: set color_space = \"srgb\", or \"linear\" where that is meant",
            subject("texture", &pale)
        ));
    }
    told
}

fn is_normals(bump: BumpMap, texture: usize) -> bool {
    bump.kind.is_normal_map() && bump.texture == texture
}

/// Returns the textures that are read as colours.
fn colors(scene: &Scene) -> HashSet<usize> {
    let environment = scene.background.environment.map(|e| e.texture);
    let of = |m: &Material| {
        let maps = [m.emission_map, m.specular_tint_map].map(|map| map.map(|map| map.texture));
        [m.texture, maps[0], maps[1]]
    };
    scene.materials.iter().flat_map(of).chain([environment]).flatten().collect()
}

/// Returns true for an 8-bit picture whose encoding the scene does not state. Blacks and whites are the same in either
/// encoding.
fn may_be_pale(source: &TextureSource, texture: &TextureData) -> bool {
    let is_picture = match source.content {
        TextureContent::File(_) => source.dimension != Dimension::Three,
        TextureContent::CubeFile(..)
        | TextureContent::Faces(_)
        | TextureContent::Tiles(_)
        | TextureContent::Slices(_) => true,
        _ => false,
    };
    let stated = source.color_space_stated || texture.color_space == ColorSpace::Srgb;
    if !is_picture || stated || texture.format.component() != Component::Unorm8 {
        return false;
    }
    let channels = texture.format.channels();
    let colors = if channels == 2 { 1 } else { channels.min(3) };
    texture.texels.chunks_exact(channels).any(|t| t[..colors].iter().any(|&v| v != 0 && v != u8::MAX))
}

/// Returns true if red, green and blue are equal everywhere, as in a file of one colour channel.
fn is_grey(texture: &TextureData) -> bool {
    let size = texture.format.component().bytes();
    let equal = |t: &[u8]| t[..size] == t[size..2 * size] && t[..size] == t[2 * size..3 * size];
    texture.format.channels() < 3 || texture.texels.chunks_exact(4 * size).all(equal)
}

/// Returns the names with their verb: `texture "a" is`, `textures "a", "b" are`.
fn subject(what: &str, names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    let (plural, verb) = if names.len() == 1 { ("", "is") } else { ("s", "are") };
    format!("{what}{plural} {} {verb}", quoted.join(", "))
}
