//! Materials against values computed by hand: reflectance and transmittance of glass, the highlight
//! of Phong, bump maps, shading normals; on device and oracle.

mod alpha;
mod glass;
mod leaning;
mod mirrored;
mod mirrored_sky;
mod oren_nayar;
mod phong;
mod phong_sky;
mod physical;
mod relief;
mod scales;
mod specular;
mod transmission;

use std::path::Path;

use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};

/// A float texture of `width` × `height` RGBA texels.
fn floats(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f32; 4]) -> TextureData {
    let texels: Vec<[f32; 4]> = (0..width * height).map(|i| texel(i % width, i / width)).collect();
    TextureData {
        name: "floats".into(),
        dimension: Dimension::Two,
        width,
        height,
        depth: 1,
        format: TexelFormat::RgbaFloat,
        color_space: ColorSpace::Linear,
        file_channels: 4,
        texels: bytemuck::cast_slice(&texels).to_vec(),
        stored_levels: Vec::new(),
    }
}

/// A scene of parallel rays down the z axis from `eye`, or of a given camera, all of whose pixels see the same.
fn scene(text: &str, textures: Vec<TextureData>) -> PackedScene {
    let mut scene = parse(Path::new("materials.toml"), text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    prune(&mut scene);
    pack::pack(&scene, textures, None).unwrap()
}
