//! Textures and samplers → texel bytes, records and image slots.

use crate::error::{Error, Result};
use crate::layout;
use crate::texture::data::{ColorSpace, Component, TexelFormat, TextureData};
use crate::texture::sampler_spec::{Method, SamplerSpec};

use super::PackedScene;

/// One image descriptor: a texture and the sampler it is read through. Look-ups of method shader
/// fetch texels and ignore the sampler, so all of them share one slot a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    pub texture: usize,
    pub sampler: usize,
    pub hardware: bool,
}

/// At most this many image descriptors (`SLOT_SWITCH` in `texture.glsl`).
pub const MAX_SLOTS: usize = 16;

pub fn sampler(spec: &SamplerSpec) -> layout::Sampler {
    layout::Sampler {
        border: spec.border_color,
        modes: [
            spec.address[0] as u32,
            spec.address[1] as u32,
            spec.mag as u32, // without a footprint the level is 0, which is magnification
            spec.texel_center as u32,
        ],
        link: [spec.method as u32, 0, 0, 0],
    }
}

/// Appends all texels to the pool; a single texture is moved, not copied.
pub fn pack_textures(packed: &mut PackedScene, textures: Vec<TextureData>) -> Result<()> {
    for texture in textures {
        let texture = without_equal_channels(texture);
        let texture = if needs_linear_floats(&texture) { linear_floats(&texture) } else { texture };
        let first_word = packed.texels.len() / 4;
        let first_word = u32::try_from(first_word).map_err(|_| {
            Error::with_help(
                format!("texture \"{}\": all textures together exceed 16 GiB", texture.name),
                "use smaller textures, or fewer",
            )
        })?;
        packed.textures.push(layout::Texture {
            place: [first_word, texture.width, texture.height, texture.format as u32],
            link: [texture.color_space as u32, 0, 0, 0],
        });
        packed.texture_names.push(texture.name);
        packed.file_channels.push(texture.file_channels);
        if packed.texels.is_empty() {
            packed.texels = texture.texels;
        } else {
            packed.texels.extend_from_slice(&texture.texels);
        }
        packed.texels.resize(packed.texels.len().next_multiple_of(4), 0);
    }
    Ok(())
}

/// A colour texture whose texels are all opaque grey is held as grey: a quarter of the memory, and of
/// the arithmetic of a look-up. The first coloured texel ends the search.
fn without_equal_channels(texture: TextureData) -> TextureData {
    if texture.format.channels() != 4 {
        return texture;
    }
    let component = texture.format.component();
    let greys = match component {
        Component::Unorm8 => opaque_greys::<1>(&texture.texels, component.one()),
        Component::Unorm16 => opaque_greys::<2>(&texture.texels, component.one()),
        Component::Float32 => opaque_greys::<4>(&texture.texels, component.one()),
    };
    match greys {
        Some(texels) => TextureData { texels, format: TexelFormat::new(1, component), ..texture },
        None => texture,
    }
}

/// The first of four channels of `WIDTH` bytes each, if the next two equal it and the last is `one`.
fn opaque_greys<const WIDTH: usize>(texels: &[u8], one: [u8; 4]) -> Option<Vec<u8>> {
    let (pixels, _) = texels.as_chunks::<WIDTH>().0.as_chunks::<4>();
    let grey = |p: &[[u8; WIDTH]; 4]| p[0] == p[1] && p[0] == p[2] && p[3][..] == one[..WIDTH];
    pixels.iter().all(grey).then(|| pixels.iter().flat_map(|p| p[0]).collect())
}

/// Drivers know sRGB with 8 bits only, and the shader's table has 256 entries.
pub fn needs_linear_floats(texture: &TextureData) -> bool {
    texture.color_space == ColorSpace::Srgb && texture.format.component() == Component::Unorm16
}

fn linear_floats(texture: &TextureData) -> TextureData {
    let channels = texture.format.channels();
    let texel = |x, y| (0..channels).map(move |c| texture.linear_value(x, y, c) as f32);
    let row = |y| (0..texture.width).flat_map(move |x| texel(x, y));
    let floats: Vec<f32> = (0..texture.height * texture.depth).flat_map(row).collect();
    TextureData {
        name: texture.name.clone(),
        format: TexelFormat::new(channels, Component::Float32),
        color_space: ColorSpace::Linear,
        texels: bytemuck::cast_slice(&floats).to_vec(),
        ..*texture
    }
}

/// The slot of this pair, new or shared.
pub fn slot(packed: &mut PackedScene, texture: usize, sampler: usize) -> u32 {
    let hardware = packed.sampler_specs[sampler].method == Method::Hardware;
    let known = packed
        .slots
        .iter()
        .position(|s| s.texture == texture && s.hardware == hardware && (!hardware || s.sampler == sampler));
    let index = known.unwrap_or_else(|| {
        packed.slots.push(Slot { texture, sampler, hardware });
        packed.slots.len() - 1
    });
    index as u32
}

pub fn needs_srgb_table(textures: &[layout::Texture]) -> bool {
    textures.iter().any(|t| {
        t.link[0] == ColorSpace::Srgb as u32
            && TexelFormat::ALL[t.place[3] as usize].component() == Component::Unorm8
    })
}

impl PackedScene {
    /// One line a texture: size, the file's channels, and how it is held.
    pub fn texture_lines(&self) -> Vec<String> {
        let line = |((name, record), channels): ((&String, &layout::Texture), &usize)| {
            let [_, width, height, format] = record.place;
            let format = TexelFormat::ALL[format as usize];
            let space = ColorSpace::ALL[record.link[0] as usize];
            let bytes = width as usize * height as usize * format.bytes_per_texel();
            let kib = bytes.div_ceil(1024);
            format!(
                "\"{name}\": {width}×{height}, {channels}-channel file, held as {format} ({space}), {kib} KiB"
            )
        };
        self.texture_names.iter().zip(&self.textures).zip(&self.file_channels).map(line).collect()
    }
}
