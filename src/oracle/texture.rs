//! Texel fetches with addressing, converted to linear RGBA in f64, from the packed bytes. Follows Vulkan 1.3,
//! "Image Sample Operations". Twin of `glsl/shared/texture.glsl`.

use glam::DVec4;

use super::address::addressed_texel;
use crate::core::color::srgb_to_linear;
use crate::pack::{PackedScene, TextureKind};
use crate::schema::layout::{Sampler, Texture};
use crate::texture::data::{ColorSpace, Component};
use crate::texture::sampler_spec::Address;

/// One level of a mip chain.
#[derive(Clone, Copy, Debug)]
pub struct Level {
    /// Width, height and depth; 6 faces for a cube.
    pub size: [i64; 3],
    pub index: u32,
    /// First word in the texel buffer.
    pub word: u32,
}

/// Returns a level; sizes are halved and rounded down (Vulkan 1.3, "Image Miplevel Sizing").
pub fn level_at(scene: &PackedScene, image: &Texture, index: u32) -> Level {
    let [width, height, depth] = image.size.to_array();
    let halved = |n: u32| i64::from((n >> index).max(1));
    let depth = if image.kind == TextureKind::Volume { halved(depth) } else { i64::from(depth) };
    let word = scene.level_word(image.first_word, index);
    Level { size: [halved(width), halved(height), depth], index, word }
}

/// Returns one texel by column, row and slice; grey is replicated, missing alpha is 1, sRGB is decoded.
pub fn fetch_texel(scene: &PackedScene, image: &Texture, level: &Level, at: [i64; 3]) -> DVec4 {
    let format = image.format;
    let texel = ((at[2] * level.size[1] + at[1]) * level.size[0] + at[0]) as usize;
    let start = level.word as usize * 4 + texel * format.bytes_per_texel();
    let bytes = &scene.texels[start..start + format.bytes_per_texel()];
    let channel = |i: usize| match format.component() {
        Component::Unorm8 => f64::from(bytes[i]) / 255.0,
        Component::Unorm16 => f64::from(u16::from_ne_bytes([bytes[2 * i], bytes[2 * i + 1]])) / 65535.0,
        Component::Float32 => {
            let b = &bytes[4 * i..4 * i + 4];
            f64::from(f32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
        }
    };
    let srgb = image.color_space == ColorSpace::Srgb;
    let light = |i: usize| if srgb { srgb_to_linear(channel(i)) } else { channel(i) };
    match format.channels() {
        1 => DVec4::new(light(0), light(0), light(0), 1.0),
        2 => DVec4::new(light(0), light(0), light(0), channel(1)),
        _ => DVec4::new(light(0), light(1), light(2), channel(3)),
    }
}

/// Returns the address modes of u, v and w.
pub fn addresses(how: &Sampler) -> [Address; 3] {
    [how.address_u, how.address_v, how.address_w]
}

/// Returns the addressed texel, or the border colour; `axes` is the number of axes with addressing.
pub fn fetch_or_border(
    scene: &PackedScene,
    image: &Texture,
    how: &Sampler,
    level: &Level,
    at: [i64; 3],
    axes: usize,
) -> DVec4 {
    let mut place = at;
    for (axis, mode) in addresses(how).into_iter().take(axes).enumerate() {
        match addressed_texel(mode, at[axis], level.size[axis]) {
            Some(texel) => place[axis] = texel,
            None => return how.border.as_dvec4(),
        }
    }
    fetch_texel(scene, image, level, place)
}

/// Returns weight · value, but 0 for a weight of 0 even if the value is NaN or infinite.
pub fn weighted(weight: f64, value: DVec4) -> DVec4 {
    if weight == 0.0 { DVec4::ZERO } else { value * weight }
}

/// Returns sum + weight · value.
pub fn add_weighted(weight: f64, value: DVec4, sum: DVec4) -> DVec4 {
    sum + weighted(weight, value)
}

/// Returns a 2D texture's texel at (column, row), addressed.
pub fn flat_texel(scene: &PackedScene, image: &Texture, how: &Sampler, level: &Level, at: [i64; 2]) -> DVec4 {
    let [width, height, _] = level.size;
    match flat_place(how, [width, height], at) {
        Some([x, y]) => fetch_texel(scene, image, level, [x, y, 0]),
        None => how.border.as_dvec4(),
    }
}

/// Returns which of a 2D level's texels is at (column, row), addressed; none beyond a border. Across a pole of an
/// environment the same row continues, half a turn away.
pub fn flat_place(how: &Sampler, [width, height]: [i64; 2], [mut x, mut y]: [i64; 2]) -> Option<[i64; 2]> {
    let [u, v, _] = addresses(how);
    if !how.crosses_poles {
        return Some([addressed_texel(u, x, width)?, addressed_texel(v, y, height)?]);
    }
    if !(0..height).contains(&y) {
        x += width / 2;
        y = if y < 0 { -1 - y } else { 2 * height - 1 - y };
    }
    Some([addressed_texel(u, x, width).unwrap_or(0), y.clamp(0, height - 1)])
}
