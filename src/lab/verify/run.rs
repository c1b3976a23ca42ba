//! Variants → look-ups on the device in batches of one pipeline → a tally a variant: how many answers
//! are wrong by the declared precision, how far the worst is off, and how fine the weights are.

use super::batch::Batch;
use super::judge::{Judge, Judgement, Precision};
use super::queries::{Axis, Dice, coordinates, noise, place_of, ramp, ramp_texture};
use super::sweeps::{level_ramp, level_sweep, long_footprints, paint_levels};
use super::variants::{Reader, Scale, Variant};
use super::weights::{RAMP_STEPS, WeightBits, weight_bits};
use crate::core::error::Result;
use crate::lab::probe::{LookUp, LookUps};
use crate::texture::data::{Dimension, TextureData};
use crate::texture::sampler_spec::{MipMode, TexelCenter};

/// Random coordinates a variant, beside the edges.
const RANDOM: usize = 60;

/// Of the steps of a ramp; prime, so that all parts of a weight's step are met.
const JUDGED_EVERY: usize = 31;

/// What was found about one variant.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub look_ups: usize,
    pub wrong: usize,
    pub error: f64,
    pub beyond: f64,
    pub weights: Option<WeightBits>,
    /// Of the mix of two levels.
    pub level_weights: Option<WeightBits>,
    /// Longest footprint that was followed, in widths.
    pub anisotropy: Option<f64>,
    /// The first wrong answer, and what was allowed.
    pub example: Option<String>,
}

impl Tally {
    pub fn add(&mut self, found: Judgement) {
        self.look_ups += 1;
        self.wrong += usize::from(!found.right);
        self.error = self.error.max(found.error);
        self.beyond = self.beyond.max(found.beyond);
    }

    /// Judges one look-up, and keeps the first wrong one.
    fn sample_texture(&mut self, judge: &Judge<'_>, query: &LookUp, answer: [f32; 4]) {
        let found = judge.judge(query, answer);
        self.add(found);
        if !found.right && self.example.is_none() {
            self.example = Some(judge.complaint(query, answer));
        }
    }

    /// What another run found about the same variant.
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

/// The texture of a variant in this batch.
fn noise_of(seed: u64) -> impl Fn(&Variant) -> TextureData {
    move |v| noise(v.dimension, v.size, v.format, v.class.color_space(), seed * 1000 + v.format as u64)
}

fn judged(judge: &Judge<'_>, queries: &[LookUp], answers: &[[f32; 4]]) -> Tally {
    let mut tally = Tally::default();
    for (query, answer) in queries.iter().zip(answers) {
        tally.sample_texture(judge, query, *answer);
    }
    tally
}

/// Random and awkward coordinates at level 0, judged.
pub fn look_ups(
    probe: &mut LookUps<'_>,
    variants: Vec<&Variant>,
    precision: Precision,
    seed: u64,
) -> Result<Vec<Tally>> {
    let batch = Batch::new(variants, noise_of(seed))?;
    let mut dice = Dice::new(seed);
    let far = batch.reader != Reader::Sampler;
    let list = |(i, v): (usize, &&Variant)| {
        let places = coordinates(&mut dice, [v.size[0], v.size[1]], RANDOM, far).into_iter();
        places
            .flat_map(|uv| TexelCenter::ALL.iter().map(move |&c| (c, uv)))
            .map(|(center, uv)| batch.query(i, center, uv))
            .collect()
    };
    let queries: Vec<Vec<LookUp>> = batch.variants.iter().enumerate().map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(probe, queries, |_, queries, answers| judged(&judge, queries, answers))
}

/// All levels over footprints of all lengths, judged; and how long those were that the device followed
/// itself.
pub fn sweeps(
    probe: &mut LookUps<'_>,
    variants: Vec<&Variant>,
    precision: Precision,
    seed: u64,
) -> Result<Vec<Tally>> {
    let mut batch = Batch::new(variants, noise_of(seed))?;
    for i in 0..batch.variants.len() {
        if batch.variants[i].scale == Scale::Anisotropic {
            let texture = batch.query(i, TexelCenter::Half, [0.0; 2]).texture as usize;
            paint_levels(&mut batch.scene, texture);
        }
    }
    let mut dice = Dice::new(seed);
    let list = |(i, v): (usize, &&Variant)| {
        let base = batch.query(i, TexelCenter::Half, [0.0; 2]);
        if v.scale == Scale::Anisotropic {
            long_footprints(&mut dice, v, &base)
        } else {
            level_sweep(&mut dice, v, &base)
        }
    };
    let queries: Vec<Vec<LookUp>> = batch.variants.iter().enumerate().map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(probe, queries, |variant, queries, answers| {
        let mut tally = judged(&judge, queries, answers);
        if variant.scale == Scale::Anisotropic && variant.spec.mip == MipMode::Linear {
            let pairs = queries.iter().zip(answers);
            tally.anisotropy = pairs.filter_map(|(q, a)| followed(variant, q, *a)).reduce(f64::max);
        }
        tally
    })
}

/// How long a footprint along an axis was followed, in widths of the level that was read; the colours of
/// levels run from 0 to 1.
fn followed(variant: &Variant, query: &LookUp, answer: [f32; 4]) -> Option<f64> {
    let last = f64::from(variant.size[0].ilog2());
    let level = f64::from(answer[0]) * last;
    let [x, y] = place_of(query).change.map(|d| d.abs() * f64::from(variant.size[0]));
    let along_axis = x.min_element() == 0.0 && x.x * y.x == 0.0 && x.y * y.y == 0.0;
    // Levels 0 and last are what others are limited to.
    let inside = level > 0.1 && level < last - 0.1;
    (along_axis && inside).then(|| x.max_element().max(y.max_element()) / level.exp2())
}

/// Ramps between two texels, judged here and there, and the bits of the weights that they show.
pub fn ramps(
    probe: &mut LookUps<'_>,
    variants: Vec<&Variant>,
    precision: Precision,
    axis: Axis,
) -> Result<Vec<Tally>> {
    let batch = Batch::new(variants, |v| ramp_texture(axis, v.format, v.class.color_space()))?;
    let list = |i| ramp(axis, RAMP_STEPS).map(|uv| batch.query(i, TexelCenter::Half, uv)).collect();
    let queries: Vec<Vec<LookUp>> = (0..batch.variants.len()).map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(probe, queries, |_, queries, answers| Tally {
        weights: Some(bits(answers)),
        ..judged_here_and_there(&judge, queries, answers)
    })
}

/// The same between two levels, 0 in every channel above and 1 below.
pub fn level_ramps(
    probe: &mut LookUps<'_>,
    variants: Vec<&Variant>,
    precision: Precision,
) -> Result<Vec<Tally>> {
    let mut batch =
        Batch::new(variants, |v| noise(Dimension::Two, [2, 2, 1], v.format, v.class.color_space(), 1))?;
    for i in 0..batch.variants.len() {
        let texture = batch.query(i, TexelCenter::Half, [0.0; 2]).texture as usize;
        paint_levels(&mut batch.scene, texture);
    }
    let list = |i| level_ramp(&batch.query(i, TexelCenter::Half, [0.5; 2]), RAMP_STEPS).collect();
    let queries: Vec<Vec<LookUp>> = (0..batch.variants.len()).map(list).collect();
    let judge = Judge::new(&batch.scene, precision);
    batch.tallies(probe, queries, |_, queries, answers| Tally {
        level_weights: Some(bits(answers)),
        ..judged_here_and_there(&judge, queries, answers)
    })
}

fn bits(answers: &[[f32; 4]]) -> WeightBits {
    weight_bits(answers.iter().map(|rgba| rgba[0]))
}

fn judged_here_and_there(judge: &Judge<'_>, queries: &[LookUp], answers: &[[f32; 4]]) -> Tally {
    let mut tally = Tally::default();
    for (query, answer) in queries.iter().zip(answers).step_by(JUDGED_EVERY) {
        tally.sample_texture(judge, query, *answer);
    }
    tally
}
