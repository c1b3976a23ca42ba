//! Finds the smallest share of a texture or of the view that holds much of its light. Few samples miss it, and nothing
//! in the samples taken shows that: adaptive sampling has to know it in advance.

use rayon::prelude::*;

use crate::core::color::srgb_to_linear;
use crate::scene::model::Scene;
use crate::texture::data::{ColorSpace, Component, TextureData};

/// Texels are bright if they exceed the mean by this factor,
const FAR_ABOVE: f64 = 16.0;
/// and matter if they contribute this fraction of the light.
const PART: f64 = 0.05;
/// The assumed share of the view of a shape whose emission exceeds white by `FAR_ABOVE`.
const OF_EMITTER: f64 = 1.0 / 256.0;

/// Returns the smallest share of any texture or emitter; `None` if nothing is far brighter than the rest.
pub fn share(scene: &Scene, textures: &[TextureData]) -> Option<f64> {
    let of_textures = textures.iter().filter_map(share_of_texture);
    let shines = |color: glam::DVec3| color.max_element() >= FAR_ABOVE;
    let emitters = scene.materials.iter().filter(|m| m.model.emits() && shines(m.color));
    of_textures.chain(emitters.map(|_| OF_EMITTER)).reduce(f64::min)
}

fn share_of_texture(texture: &TextureData) -> Option<f64> {
    let levels = Levels::new(texture);
    let [texels, light] = levels.above(texture, f64::NEG_INFINITY);
    let [bright, of_bright] = levels.above(texture, FAR_ABOVE * light / texels);
    (of_bright > PART * light && bright > 0.0).then(|| bright / texels)
}

/// Texels classified by the stored value of their largest colour channel.
enum Levels {
    /// The number of texels of each code.
    Codes(Vec<u64>),
    Floats,
}

impl Levels {
    fn new(texture: &TextureData) -> Levels {
        let codes = match texture.format.component() {
            Component::Unorm8 => 1 << 8,
            Component::Unorm16 => 1 << 16,
            Component::Float32 => return Levels::Floats,
        };
        let add = |mut a: Vec<u64>, b: Vec<u64>| {
            a.iter_mut().zip(b).for_each(|(a, b)| *a += b);
            a
        };
        let of_rows = |rows: &[u8]| {
            let mut counts = vec![0u64; codes];
            for texel in rows.chunks_exact(texture.format.bytes_per_texel()) {
                let code = |c: usize| match texture.format.component() {
                    Component::Unorm8 => texel[c] as usize,
                    _ => u16::from_ne_bytes([texel[2 * c], texel[2 * c + 1]]) as usize,
                };
                counts[(0..colors(texture)).map(code).max().unwrap_or(0)] += 1;
            }
            counts
        };
        let rows = texture.texels.par_chunks(rows_bytes(texture)).map(of_rows);
        Levels::Codes(rows.reduce(|| vec![0; codes], add))
    }

    /// Returns the number of texels brighter than `least`, and the sum of their light, without NaN and infinity.
    fn above(&self, texture: &TextureData, least: f64) -> [f64; 2] {
        let add = |[n, sum]: [f64; 2], [m, more]: [f64; 2]| [n + m, sum + more];
        match self {
            Levels::Codes(counts) => {
                let most = (counts.len() - 1) as f64;
                let of_code = |(code, &count): (usize, &u64)| {
                    let stored = code as f64 / most;
                    let light = match texture.color_space {
                        ColorSpace::Srgb => srgb_to_linear(stored),
                        ColorSpace::Linear => stored,
                    };
                    if light > least { [count as f64, count as f64 * light] } else { [0.0; 2] }
                };
                counts.iter().enumerate().map(of_code).fold([0.0; 2], add)
            }
            Levels::Floats => {
                let of_rows = |rows: &[u8]| {
                    let texels = rows.chunks_exact(texture.format.bytes_per_texel());
                    let lights = texels.map(|texel| {
                        let value = |c: usize| f32::from_ne_bytes([0, 1, 2, 3].map(|b| texel[4 * c + b]));
                        f64::from((0..colors(texture)).map(value).fold(0.0, f32::max))
                    });
                    let bright = lights.filter(|light| light.is_finite() && *light > least);
                    bright.map(|light| [1.0, light]).fold([0.0; 2], add)
                };
                // In order, so that sums do not depend on the number of cores.
                let sums: Vec<[f64; 2]> =
                    texture.texels.par_chunks(rows_bytes(texture)).map(of_rows).collect();
                sums.into_iter().fold([0.0; 2], add)
            }
        }
    }
}

/// Returns the number of colour channels.
fn colors(texture: &TextureData) -> usize {
    if texture.format.channels() == 4 { 3 } else { 1 }
}

/// Returns the bytes of the rows that one thread processes at once.
fn rows_bytes(texture: &TextureData) -> usize {
    let row = texture.width as usize * texture.format.bytes_per_texel();
    row * ((1 << 20) / row).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{Dimension, TexelFormat};

    fn texture(format: TexelFormat, color_space: ColorSpace, texels: Vec<u8>) -> TextureData {
        let width = (texels.len() / format.bytes_per_texel()) as u32;
        let dimension = Dimension::Two;
        TextureData {
            name: "t".into(),
            dimension,
            width,
            height: 1,
            depth: 1,
            format,
            color_space,
            file_channels: 1,
            texels,
            stored_levels: Vec::new(),
        }
    }

    #[test]
    fn a_sun_in_a_sky_has_its_share() {
        let mut sky = vec![1f32; 4 * 1000];
        sky[4 * 500] = 1e4;
        let sky = texture(TexelFormat::RgbaFloat, ColorSpace::Linear, bytemuck::cast_slice(&sky).to_vec());
        assert_eq!(share_of_texture(&sky), Some(1e-3));
    }

    #[test]
    fn stars_have_theirs_by_the_light_that_codes_stand_for() {
        let mut stars = vec![20u8; 1000];
        (0..5).for_each(|i| stars[100 * i] = 255);
        // The brightest value is 12 times the mean as linear, 100 times as sRGB.
        assert_eq!(share_of_texture(&texture(TexelFormat::Grey8, ColorSpace::Linear, stars.clone())), None);
        assert_eq!(share_of_texture(&texture(TexelFormat::Grey8, ColorSpace::Srgb, stars)), Some(5e-3));
    }

    #[test]
    fn pictures_without_anything_rare_have_none() {
        let checker: Vec<u8> = (0..1000).map(|i| 255 * (i % 2) as u8).collect();
        assert_eq!(share_of_texture(&texture(TexelFormat::Grey8, ColorSpace::Linear, checker)), None);
        let black = vec![0u8; 1000];
        assert_eq!(share_of_texture(&texture(TexelFormat::Grey8, ColorSpace::Linear, black)), None);
        let holes = [f32::NAN, 1.0, f32::INFINITY, 1.0];
        let holes =
            texture(TexelFormat::GreyFloat, ColorSpace::Linear, bytemuck::cast_slice(&holes).to_vec());
        assert_eq!(share_of_texture(&holes), None);
    }
}
