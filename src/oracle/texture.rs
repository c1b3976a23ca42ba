//! (texture, sampler, u, v) → linear RGBA in f64, from the packed bytes. Follows Vulkan 1.3, "Image
//! Sample Operations". Twin of `glsl/shared/texture.glsl`.

use glam::{DVec2, DVec4};

use super::math::vec4;
use crate::color::srgb_to_linear;
use crate::layout::{Sampler, Texture};
use crate::pack::PackedScene;
use crate::texture::data::{ColorSpace, Component, TexelFormat};
use crate::texture::sampler_spec::{Address, Filter, TexelCenter};

/// One texel; grey is replicated, missing alpha is 1, sRGB decoded.
pub fn fetch_texel(scene: &PackedScene, image: &Texture, x: i64, y: i64) -> DVec4 {
    let [first_word, width, _, format] = image.place;
    let format = TexelFormat::ALL[format as usize];
    let texel = y as usize * width as usize + x as usize;
    let start = first_word as usize * 4 + texel * format.bytes_per_texel();
    let bytes = &scene.texels[start..start + format.bytes_per_texel()];
    let channel = |i: usize| match format.component() {
        Component::Unorm8 => f64::from(bytes[i]) / 255.0,
        Component::Unorm16 => f64::from(u16::from_ne_bytes([bytes[2 * i], bytes[2 * i + 1]])) / 65535.0,
        Component::Float32 => {
            let b = &bytes[4 * i..4 * i + 4];
            f64::from(f32::from_ne_bytes([b[0], b[1], b[2], b[3]]))
        }
    };
    let srgb = image.link[0] == ColorSpace::Srgb as u32;
    let light = |i: usize| if srgb { srgb_to_linear(channel(i)) } else { channel(i) };
    match format.channels() {
        1 => DVec4::new(light(0), light(0), light(0), 1.0),
        2 => DVec4::new(light(0), light(0), light(0), channel(1)),
        _ => DVec4::new(light(0), light(1), light(2), channel(3)),
    }
}

/// The coordinate in texels, brought near the texture without changing what it reads. What is not
/// finite reads as 0 in the periodic modes; in the others NaN reads as the lower end.
pub fn reduced_coordinate(mode: Address, u: f64, size: f64) -> f64 {
    let reduced = match mode {
        Address::Repeat => u - u.floor(),
        Address::MirroredRepeat => u - 2.0 * (0.5 * u).floor(),
        _ if u >= -2.0 => u.min(3.0),
        _ => -2.0,
    };
    if reduced.is_finite() { reduced * size } else { 0.0 }
}

/// Vulkan 1.3, "Wrapping Operation", for every i; `None` asks for the border colour.
pub fn addressed_texel(mode: Address, i: i64, size: i64) -> Option<i64> {
    let mirror = |n: i64| if n >= 0 { n } else { -1 - n };
    match mode {
        Address::Repeat => Some(i.rem_euclid(size)),
        Address::MirroredRepeat => Some(size - 1 - mirror(i.rem_euclid(2 * size) - size)),
        Address::ClampToEdge => Some(i.clamp(0, size - 1)),
        Address::ClampToBorder => (0..size).contains(&i).then_some(i),
        Address::MirrorClampToEdge => Some(mirror(i).clamp(0, size - 1)),
    }
}

/// The texel at addressed (x, y), or the border colour where either is `None`.
pub fn fetch_or_border(
    scene: &PackedScene,
    image: &Texture,
    how: &Sampler,
    at: (Option<i64>, Option<i64>),
) -> DVec4 {
    match at {
        (Some(x), Some(y)) => fetch_texel(scene, image, x, y),
        _ => vec4(how.border),
    }
}

pub fn look_up(scene: &PackedScene, image: &Texture, how: &Sampler, uv: DVec2) -> DVec4 {
    let [u, v] = [how.modes[0], how.modes[1]].map(|mode| Address::ALL[mode as usize]);
    let (width, height) = (image.place[1], image.place[2]);
    // Texel i is centred at i + ½, or at i: half a texel is then added before addressing.
    let integer_centers = how.modes[3] == TexelCenter::Integer as u32;
    let shift = if integer_centers { 0.5 } else { 0.0 };
    let x = reduced_coordinate(u, uv.x, f64::from(width)) + shift;
    let y = reduced_coordinate(v, uv.y, f64::from(height)) + shift;
    let texel = |i: f64, j: f64| {
        let at =
            (addressed_texel(u, i as i64, i64::from(width)), addressed_texel(v, j as i64, i64::from(height)));
        fetch_or_border(scene, image, how, at)
    };
    if how.modes[2] == Filter::Nearest as u32 {
        return texel(x.floor(), y.floor());
    }
    let (x, y) = (x - 0.5, y - 0.5);
    let (i, j) = (x.floor(), y.floor());
    let (a, b) = (x - i, y - j);
    let top = texel(i, j) * (1.0 - a) + texel(i + 1.0, j) * a;
    let bottom = texel(i, j + 1.0) * (1.0 - a) + texel(i + 1.0, j + 1.0) * a;
    top * (1.0 - b) + bottom * b
}
