//! Helpers for pictures of cases: scenes as TOML text with textures in memory, packed, rendered on
//! the device or by the oracle, and the difference of two pictures.

use std::path::Path;

use super::case::Bench;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::range::Rect;
use crate::oracle;
use crate::oracle::rng::pcg2d;
use crate::pack::{self, PackedScene};
use crate::render::{self, Tuning};
use crate::scene::model::Scene;
use crate::texture::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};

/// A square of side 2 that fills a picture of any width and height, seen along −z: u and v are 0 to
/// 1 from its upper left. `MATERIAL` is to follow.
pub const SCREEN: &str = r#"
[camera]
eye = [0.0, 0.0, 1.0]
look_at = [0.0, 0.0, 0.0]
orthographic_height = 1.0
"#;

pub fn parse(text: &str) -> Result<Scene> {
    crate::scene::parse(Path::new("stability.toml"), text)
}

pub fn packed(text: &str, textures: Vec<TextureData>, crop: Option<Rect>) -> Result<PackedScene> {
    pack::pack(&parse(text)?, textures, crop)
}

pub fn on_device(bench: &Bench<'_>, scene: &PackedScene) -> Result<Film> {
    bench.check_cancelled()?;
    let mut scene = scene.clone();
    if bench.rounded {
        scene.round_reals();
    }
    Ok(render::render(bench.gpu, scene, false, &Tuning::default(), bench.progress)?.0)
}

pub fn in_oracle(bench: &Bench<'_>, scene: &PackedScene) -> Result<Film> {
    bench.check_cancelled()?;
    oracle::backend::render(scene, bench.progress)
}

/// Returns float texels of three channels and an alpha of 1, with `value` as a function of the
/// channel's index in the texture.
pub fn texture(dimension: Dimension, size: [u32; 3], value: impl Fn(u32) -> f32) -> TextureData {
    let [width, height, depth] = size;
    let channel = |i: u32| if i % 4 == 3 { 1.0 } else { value(i) };
    TextureData {
        name: "t".into(),
        dimension,
        width,
        height,
        depth,
        format: TexelFormat::new(4, Component::Float32),
        color_space: ColorSpace::Linear,
        file_channels: 4,
        texels: (0..4 * width * height * depth).flat_map(|i| channel(i).to_ne_bytes()).collect(),
        stored_levels: Vec::new(),
    }
}

/// Returns a hashed number in [0, 1).
pub fn hashed_unit(i: u32, seed: u32) -> f64 {
    f64::from(pcg2d([i, seed])[0]) / f64::from(u32::MAX).next_up()
}
