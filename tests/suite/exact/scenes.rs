//! Scenes of a few lines, packed in double precision, so that the oracle reads f64 as they were written.

use std::path::Path;

use glam::DVec3;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::model::Scene;
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};

/// Looks along −z from the origin.
pub const AHEAD: &str = "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\nvertical_fov = 90\n";
/// A material `m` whose texture is irrelevant.
pub const TEXTURED: &str = "[[texture]]\nname = 't'\nfile = 'none.png'\n[[sampler]]\nname = 's'\n";

/// Formats as TOML with every bit.
pub fn list(p: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", p.x, p.y, p.z)
}

/// Looks from `eye` along −z, at a point whose distance is an integer number of units in the last place.
pub fn from(eye: DVec3) -> String {
    let step = eye.abs().max_element().max(1.0);
    format!(
        "[camera]\neye = {}\nlook_at = {}\nvertical_fov = 90\n",
        list(eye),
        list(eye - DVec3::new(0.0, 0.0, step))
    )
}

/// Of a text with neither picture nor sampling; its textures are two by two texels.
pub fn packed(text: &str) -> (Scene, PackedScene) {
    packed_as(text, "[image]\nwidth = 8\nheight = 8\n[sampling]\nprecision = 'double'\n")
}

pub fn packed_as(text: &str, rest: &str) -> (Scene, PackedScene) {
    let text = format!("{text}{rest}");
    let scene = parse(Path::new("exact.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let textures = scene.textures.iter().map(|source| match source.content.procedural() {
        Some(_) => grey(Dimension::Two, [1, 1, 1], &[0.0]),
        None => match source.dimension {
            Dimension::Cube => grey(Dimension::Cube, [2, 2, 6], &[0.5; 24]),
            dimension => grey(dimension, [2, 2, 1], &[0.0, 1.0, 2.0, 3.0]),
        },
    });
    let packed = pack::pack(&scene, textures.collect(), None).unwrap();
    assert!(packed.double, "the oracle reads rounded numbers");
    (scene, packed)
}

/// Texels of one channel.
pub fn grey(dimension: Dimension, [width, height, depth]: [u32; 3], texels: &[f32]) -> TextureData {
    assert_eq!(texels.len() as u32, width * height * depth);
    TextureData {
        name: "grey".into(),
        dimension,
        width,
        height,
        depth,
        format: TexelFormat::GreyFloat,
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: texels.iter().flat_map(|t| t.to_ne_bytes()).collect(),
        stored_levels: Vec::new(),
    }
}
