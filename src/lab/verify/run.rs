//! Runs the variants' lookups on the device in batches of one pipeline and returns a tally per
//! variant: the number of answers wrong by the declared precision, the largest error, and the
//! resolution of the weights.

use super::batch::Batch;
use super::judge::{Judge, Judgement, Precision};
use super::queries::{Axis, Rng, coordinates, noise, place_of, ramp, ramp_texture};
use super::sweeps::{level_ramp, level_sweep, long_footprints, paint_levels};
use super::variants::{Reader, Scale, Variant};
use super::weights::{RAMP_STEPS, WeightBits, weight_bits};
use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::lab::probe::LookupQuery;
use crate::texture::data::{Dimension, TextureData};
use crate::texture::sampler_spec::{MipMode, TexelCenter};

/// The number of random coordinates per variant, in addition to the edges.
const RANDOM: usize = 60;

/// The stride of the checked steps of a ramp; prime, so that all parts of a weight's step are
/// checked.
const CHECK_STRIDE: usize = 31;

/// The results of one variant.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub look_ups: usize,
    pub wrong: usize,
    pub error: f64,
    pub beyond: f64,
    pub weights: Option<WeightBits>,
    /// The weight bits of the blend of two levels.
    pub level_weights: Option<WeightBits>,
    /// The largest anisotropy that was resolved, in footprint widths.
    pub anisotropy: Option<f64>,
    /// The first wrong answer, with the allowed values.
    pub example: Option<String>,
}

impl Tally {
    pub fn add(&mut self, found: Judgement) {
        self.look_ups += 1;
        self.wrong += usize::from(!found.right);
        self.error = self.error.max(found.error);
        self.beyond = self.beyond.max(found.beyond);
    }

    /// Checks one lookup, and keeps the first wrong one.
    fn check(&mut self, judge: &Judge<'_>, query: &LookupQuery, answer: [f32; 4]) {
        let found = judge.judge(query, answer);
        self.add(found);
        if !found.right && self.example.is_none() {
            self.example = Some(judge.message(query, answer));
        }
    }

    /// Adds the results of another run of the same variant.
    pub fn merge(&mut self, other: Tally) {
        self.look_ups += other.look_ups;
        self.wrong += other.wrong;
        self.error = self.error.max(other.error);
        self.beyond = self.beyond.max(other.beyond);
        self.weights = self.weights.into_iter().chain(other.weights).min();
        self.level_weights = self.level_weights.into_iter().chain(other.level_weights).min();
        self.anisotropy = self.anisotropy.into_iter().chain(other.anisotropy).reduce(f64::max);
        self.example = self.example.take().or(other.example);
    }
}

/// Returns the texture of a variant in this batch.
fn noise_of(seed: u64) -> impl Fn(&Variant) -> TextureData {
    move |v| noise(v.dimension, v.size, v.format, v.class.color_space(), seed * 1000 + v.format as u64)
}

fn judged(judge: &Judge<'_>, queries: &[LookupQuery], answers: &[[f32; 4]]) -> Tally {
    let mut tally = Tally::default();
    for (query, answer) in queries.iter().zip(answers) {
        tally.check(judge, query, *answer);
    }
    tally
}

/// Checks random and error-prone coordinates at level 0.
pub fn check_lookups(
    gpu: &Gpu,
    variants: Vec<&Variant>,
    precision: Precision,
    seed: u64,
) -> Result<Vec<Tally>> {
    let batch = Batch::new(variants, noise_of(seed))?;
    let mut rng = Rng::new(seed);
    let far = batch.reader != Reader::Sampler;
    let list = |(i, v): (usize, &&Variant)| {
        let places = coordinates(&mut rng, [v.size[0], v.size[1]], RANDOM, far).into_iter();
        places
            .flat_map(|uv| TexelCenter::ALL.iter().map(move |&c| (c, uv)))
            .map(|(center, uv)| batch.query(i, center, uv))
            .collect()
    };
    let queries: Vec<Vec<LookupQuery>> = batch.variants.iter().enumerate().map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(gpu, queries, |_, queries, answers| judged(&judge, queries, answers))
}

/// Checks all levels over footprints of all lengths, and measures the lengths that the device
/// resolved itself.
pub fn sweeps(gpu: &Gpu, variants: Vec<&Variant>, precision: Precision, seed: u64) -> Result<Vec<Tally>> {
    let mut batch = Batch::new(variants, noise_of(seed))?;
    for i in 0..batch.variants.len() {
        if batch.variants[i].scale == Scale::Anisotropic {
            let texture = batch.query(i, TexelCenter::Half, [0.0; 2]).texture as usize;
            paint_levels(&mut batch.scene, texture);
        }
    }
    let mut rng = Rng::new(seed);
    let list = |(i, v): (usize, &&Variant)| {
        let base = batch.query(i, TexelCenter::Half, [0.0; 2]);
        if v.scale == Scale::Anisotropic {
            long_footprints(&mut rng, v, &base)
        } else {
            level_sweep(&mut rng, v, &base)
        }
    };
    let queries: Vec<Vec<LookupQuery>> = batch.variants.iter().enumerate().map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(gpu, queries, |variant, queries, answers| {
        let mut tally = judged(&judge, queries, answers);
        if variant.scale == Scale::Anisotropic && variant.spec.mip == MipMode::Linear {
            let pairs = queries.iter().zip(answers);
            tally.anisotropy = pairs.filter_map(|(q, a)| followed(variant, q, *a)).reduce(f64::max);
        }
        tally
    })
}

/// Returns the resolved length of a footprint along an axis, in widths of the level that was read;
/// the colours of levels range from 0 to 1.
fn followed(variant: &Variant, query: &LookupQuery, answer: [f32; 4]) -> Option<f64> {
    let last = f64::from(variant.size[0].ilog2());
    let level = f64::from(answer[0]) * last;
    let [x, y] = place_of(query).change.map(|d| d.abs() * f64::from(variant.size[0]));
    let along_axis = x.min_element() == 0.0 && x.x * y.x == 0.0 && x.y * y.y == 0.0;
    // Other levels are clamped to levels 0 and last.
    let inside = level > 0.1 && level < last - 0.1;
    (along_axis && inside).then(|| x.max_element().max(y.max_element()) / level.exp2())
}

/// Checks ramps between two texels at intervals, and counts the bits of their weights.
pub fn ramps(gpu: &Gpu, variants: Vec<&Variant>, precision: Precision, axis: Axis) -> Result<Vec<Tally>> {
    let batch = Batch::new(variants, |v| ramp_texture(axis, v.format, v.class.color_space()))?;
    let list = |i| ramp(axis, RAMP_STEPS).map(|uv| batch.query(i, TexelCenter::Half, uv)).collect();
    let queries: Vec<Vec<LookupQuery>> = (0..batch.variants.len()).map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(gpu, queries, |_, queries, answers| Tally {
        weights: Some(bits(answers)),
        ..judged_here_and_there(&judge, queries, answers)
    })
}

/// Checks the same between two levels, the first 0 in every channel and the second 1.
pub fn level_ramps(gpu: &Gpu, variants: Vec<&Variant>, precision: Precision) -> Result<Vec<Tally>> {
    let mut batch =
        Batch::new(variants, |v| noise(Dimension::Two, [2, 2, 1], v.format, v.class.color_space(), 1))?;
    for i in 0..batch.variants.len() {
        let texture = batch.query(i, TexelCenter::Half, [0.0; 2]).texture as usize;
        paint_levels(&mut batch.scene, texture);
    }
    let list = |i| level_ramp(&batch.query(i, TexelCenter::Half, [0.5; 2]), RAMP_STEPS).collect();
    let queries: Vec<Vec<LookupQuery>> = (0..batch.variants.len()).map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(gpu, queries, |_, queries, answers| Tally {
        level_weights: Some(bits(answers)),
        ..judged_here_and_there(&judge, queries, answers)
    })
}

fn bits(answers: &[[f32; 4]]) -> WeightBits {
    weight_bits(answers.iter().map(|rgba| rgba[0]))
}

fn judged_here_and_there(judge: &Judge<'_>, queries: &[LookupQuery], answers: &[[f32; 4]]) -> Tally {
    let mut tally = Tally::default();
    for (query, answer) in queries.iter().zip(answers).step_by(CHECK_STRIDE) {
        tally.check(judge, query, *answer);
    }
    tally
}
