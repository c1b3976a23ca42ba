//! Helpers of cases with texture lookups: decades of a parameter, textures of one channel,
//! coordinates that f32 represents exactly, and the largest difference between a device's answers
//! and exact ones.

use super::case::Point;
use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::lab::probe::{LookupQuery, lookups};
use crate::lab::verify::queries::{Rng, pairs_over, place_of, query, texture};
use crate::oracle::filter::sample_texture;
use crate::oracle::rng::pcg2d;
use crate::pack::PackedScene;
use crate::scene::model::Footprint;
use crate::texture::data::{ColorSpace, TexelFormat, TextureData};
use crate::texture::sampler_spec::SamplerSpec;

/// The relative rounding error of f32: half the spacing of numbers at 1.
pub const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// Returns powers of ten and, with `each` above 1, that many values per decade.
pub fn decades(from: i32, to: i32, each: i32) -> impl Iterator<Item = f64> {
    (from * each..=to * each).map(move |k| 10f64.powf(f64::from(k) / f64::from(each)))
}

/// Returns grey floats as a function of column and row.
pub fn grey(width: u32, height: u32, value: impl Fn(u32, u32) -> f32) -> TextureData {
    let blank = texture(width, height, TexelFormat::GreyFloat, ColorSpace::Linear, 1);
    blank.with_floats(1, |x, y, _| value(x, y))
}

/// Returns random grey floats in [-2, 6].
pub fn noise(width: u32, height: u32) -> TextureData {
    texture(width, height, TexelFormat::GreyFloat, ColorSpace::Linear, 5)
}

/// Returns a scene in which material i reads the texture through sampler i, over footprints.
pub fn scene(texture: TextureData, specs: &[SamplerSpec]) -> Result<PackedScene> {
    let pairs: Vec<(usize, usize)> = (0..specs.len()).map(|i| (0, i)).collect();
    pairs_over(Footprint::Differentials, vec![texture], specs, &pairs)
}

/// Returns random coordinates of the unit square on a grid of 2^12, which f32 represents exactly,
/// as it does the filter weights on a texture of up to 2^12 texels.
pub fn coordinates(rng: &mut Rng, count: usize) -> Vec<[f32; 2]> {
    let mut number = || (rng.bits() % 4096) as f32 / 4096.0;
    (0..count).map(|_| [number(), number()]).collect()
}

/// Returns a lookup through sampler `sampler` at a coordinate over the footprint spanned by two
/// vectors in texture coordinates.
pub fn over(scene: &PackedScene, sampler: usize, uv: [f32; 2], [dx, dy]: [[f64; 2]; 2]) -> LookupQuery {
    let narrow = |[x, y]: [f64; 2]| [x as f32, y as f32, 0.0, 0.0];
    LookupQuery { dx: narrow(dx), dy: narrow(dy), ..query(scene, sampler, uv) }
}

/// Returns the oracle's answer to query number `index` of a list.
pub fn oracle(scene: &PackedScene, index: usize, query: &LookupQuery) -> f64 {
    let (image, how) =
        (&scene.records.textures[query.texture as usize], &scene.records.samplers[query.sampler as usize]);
    sample_texture(scene, image, how, &place_of(query), pcg2d([index as u32, query.seed])).x
}

/// Returns the largest difference of the first channel, in units, between the device's answers and
/// `exact`.
pub fn worst(
    gpu: &Gpu,
    scene: &PackedScene,
    parameter: f64,
    unit: f64,
    queries: &[LookupQuery],
    exact: impl Fn(usize, &LookupQuery) -> f64,
) -> Result<Point> {
    let answers = lookups(gpu, scene, false, false, queries)?;
    Ok(worst_of(scene, parameter, unit, queries, &answers, exact))
}

pub fn worst_of(
    scene: &PackedScene,
    parameter: f64,
    unit: f64,
    queries: &[LookupQuery],
    answers: &[[f32; 4]],
    exact: impl Fn(usize, &LookupQuery) -> f64,
) -> Point {
    let errors = queries.iter().zip(answers).enumerate().map(|(i, (query, answer))| {
        let error = (f64::from(answer[0]) - exact(i, query)).abs() / unit;
        (error, described(scene, query))
    });
    Point::worst(parameter, errors)
}

pub fn described(scene: &PackedScene, query: &LookupQuery) -> String {
    let spec = &scene.sampler_specs[query.sampler as usize];
    let [u, v, w, _] = query.uv;
    format!("{} at ({u}, {v}, {w})", spec.label())
}
