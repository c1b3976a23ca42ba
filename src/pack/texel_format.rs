//! The format in which the texels of a texture are packed, where it is not that of its file: grey for colours that are all
//! grey, floats for an encoding that drivers do not decode. Input: a texture. Output: the same in its format.

use super::texture_readers::readers;
use crate::core::error::Result;
use crate::scene::model::Scene;
use crate::texture::data::{ColorSpace, Component, TexelFormat, TextureData};
use crate::texture::room::check_room;
use crate::texture::sampler_spec::Method;

/// Stores a colour texture whose texels are all opaque grey, in all its levels, as grey: a quarter of the memory, and of
/// the arithmetic of a look-up. The first coloured texel ends the search.
pub(super) fn without_equal_channels(texture: TextureData) -> Result<TextureData> {
    if texture.format.channels() != 4 {
        return Ok(texture);
    }
    let component = texture.format.component();
    let greys = |level: &TextureData| match component {
        Component::Unorm8 => opaque_greys::<1>(&level.texels, component.one()),
        Component::Unorm16 => opaque_greys::<2>(&level.texels, component.one()),
        Component::Float32 => opaque_greys::<4>(&level.texels, component.one()),
    };
    check_room(&texture, "its texels", texture.texels.len() / 4)?;
    let Some(first) = greys(&texture) else { return Ok(texture) };
    let Some(levels) = texture.stored_levels.iter().map(greys).collect::<Option<Vec<_>>>() else {
        return Ok(texture);
    };
    let grey =
        |level: TextureData, texels| TextureData { texels, format: TexelFormat::new(1, component), ..level };
    let mut texture = grey(texture, first);
    let stored = std::mem::take(&mut texture.stored_levels);
    texture.stored_levels =
        stored.into_iter().zip(levels).map(|(level, texels)| grey(level, texels)).collect();
    Ok(texture)
}

/// Returns the first of four channels of `WIDTH` bytes each, if the next two equal it and the last is `one`.
fn opaque_greys<const WIDTH: usize>(texels: &[u8], one: [u8; 4]) -> Option<Vec<u8>> {
    let (pixels, _) = texels.as_chunks::<WIDTH>().0.as_chunks::<4>();
    let grey = |p: &[[u8; WIDTH]; 4]| p[0] == p[1] && p[0] == p[2] && p[3][..] == one[..WIDTH];
    pixels.iter().all(grey).then(|| pixels.iter().flat_map(|p| p[0]).collect())
}

/// Returns true if the texture must be decoded on the host, as drivers support sRGB with 8 bits only.
pub(super) fn needs_linear_floats(texture: &TextureData, scene: &Scene, index: usize) -> bool {
    texture.color_space == ColorSpace::Srgb
        && texture.format.component() == Component::Unorm16
        && readers(scene, index).any(|sampler| sampler.method == Method::Hardware)
}

pub(super) fn linear_floats(texture: &TextureData) -> Result<TextureData> {
    check_room(texture, "its linear light", 2 * texture.texels.len())?;
    let floats =
        texture.with_floats(texture.format.channels(), |x, y, c| texture.linear_value(x, y, c) as f32);
    let stored_levels = texture.stored_levels.iter().map(linear_floats).collect::<Result<_>>()?;
    Ok(TextureData { stored_levels, ..floats })
}
