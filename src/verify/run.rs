//! Variants → look-ups on the device in batches of one pipeline → a tally a variant: how many answers
//! are wrong by the declared precision, how far the worst is off, and how fine the weights are.

use rayon::prelude::*;

use super::judge::{Judge, Judgement, Precision};
use super::queries::{Axis, Dice, coordinates, pairs, query, ramp, ramp_texture, texture};
use super::variants::{Reader, Variant};
use super::weights::{RAMP_STEPS, WeightBits, weight_bits};
use crate::error::Result;
use crate::gpu::Gpu;
use crate::pack::PackedScene;
use crate::probe::{self, LookUp};
use crate::texture::data::TextureData;
use crate::texture::sampler_spec::{SamplerSpec, TexelCenter};

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
    fn look_up(&mut self, judge: &Judge<'_>, query: &LookUp, answer: [f32; 4]) {
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
        self.example = self.example.take().or(other.example);
    }
}

/// Variants that one pipeline reads: each with its texture and with both texel centres.
struct Batch<'a> {
    scene: PackedScene,
    reader: Reader,
    variants: Vec<&'a Variant>,
    /// The pair of texture and sampler that each variant reads.
    pair_of: Vec<usize>,
}

impl<'a> Batch<'a> {
    /// Samplers in three parts, each with one a variant: what the device binds, what the oracle is asked
    /// about, and the same with integer texel centres.
    fn new(variants: Vec<&'a Variant>, texture: impl Fn(&Variant) -> TextureData) -> Result<Batch<'a>> {
        let reader = variants.first().map_or(Reader::Sampler, |v| v.reader);
        let bound = variants.iter().map(|v| v.device_sampler());
        let half = variants.iter().map(|v| v.level_0_sampler());
        let integer = half.clone().map(|s| SamplerSpec { texel_center: TexelCenter::Integer, ..s });
        let samplers: Vec<SamplerSpec> = bound.chain(half).chain(integer).collect();
        let mut textures: Vec<TextureData> = Vec::new();
        let mut list: Vec<(usize, usize)> = Vec::new();
        let mut pair_of = Vec::new();
        for (i, variant) in variants.iter().enumerate() {
            let same_texture = |p: &(usize, usize)| {
                let other = variants[p.1];
                (other.class, other.format, other.size) == (variant.class, variant.format, variant.size)
            };
            // The shader's look-ups share one slot a texture, whatever the sampler.
            let known = (reader != Reader::Sampler).then(|| list.iter().position(same_texture)).flatten();
            pair_of.push(known.unwrap_or_else(|| {
                textures.push(texture(variant));
                list.push((textures.len() - 1, i));
                list.len() - 1
            }));
        }
        Ok(Batch { scene: pairs(textures, &samplers, &list)?, reader, variants, pair_of })
    }

    /// The look-up of variant `i` at (u, v).
    fn query(&self, i: usize, center: TexelCenter, uv: [f32; 2]) -> LookUp {
        let part = if center == TexelCenter::Integer { 2 } else { 1 };
        let sampler = part * self.variants.len() + i;
        LookUp { sampler: sampler as u32, ..query(&self.scene, self.pair_of[i], uv) }
    }

    fn answers(&self, gpu: &Gpu, queries: &[LookUp]) -> Result<Vec<[f32; 4]>> {
        // One pipeline for all modes of the shader; the device's samplers need none of its code.
        let everything = false;
        probe::look_ups(gpu, &self.scene, self.reader != Reader::ShaderBuffer, everything, queries)
    }
}

/// Random and awkward coordinates, judged.
pub fn look_ups(gpu: &Gpu, variants: Vec<&Variant>, precision: Precision, seed: u64) -> Result<Vec<Tally>> {
    let random = |v: &Variant| {
        let salt = seed * 1000 + v.format as u64;
        texture(v.size[0], v.size[1], v.format, v.class.color_space(), salt)
    };
    let batch = Batch::new(variants, random)?;
    let mut dice = Dice::new(seed);
    let mut queries = Vec::new();
    let mut ends = Vec::new();
    for (i, variant) in batch.variants.iter().enumerate() {
        for uv in coordinates(&mut dice, variant.size, RANDOM, batch.reader != Reader::Sampler) {
            queries.extend(TexelCenter::ALL.iter().map(|&center| batch.query(i, center, uv)));
        }
        ends.push(queries.len());
    }
    let answers = batch.answers(gpu, &queries)?;
    let judge = Judge::new(&batch.scene, precision);
    let tally = |i: usize| {
        let first = if i == 0 { 0 } else { ends[i - 1] };
        let mut tally = Tally::default();
        for (query, answer) in queries[first..ends[i]].iter().zip(&answers[first..ends[i]]) {
            tally.look_up(&judge, query, *answer);
        }
        tally
    };
    Ok((0..ends.len()).into_par_iter().map(tally).collect())
}

/// Ramps between two texels, judged here and there, and the bits of the weights that they show.
pub fn ramps(gpu: &Gpu, variants: Vec<&Variant>, precision: Precision, axis: Axis) -> Result<Vec<Tally>> {
    let batch = Batch::new(variants, |v| ramp_texture(axis, v.format, v.class.color_space()))?;
    let of = |i| ramp(axis, RAMP_STEPS).map(move |uv| (i, uv));
    let queries: Vec<LookUp> =
        (0..batch.variants.len()).flat_map(of).map(|(i, uv)| batch.query(i, TexelCenter::Half, uv)).collect();
    let answers = batch.answers(gpu, &queries)?;
    let judge = Judge::new(&batch.scene, precision);
    let length = RAMP_STEPS as usize + 1;
    let tally = |(queries, answers): (&[LookUp], &[[f32; 4]])| {
        let weights = weight_bits(answers.iter().map(|rgba| rgba[0]));
        let mut tally = Tally { weights: Some(weights), ..Default::default() };
        for (query, answer) in queries.iter().zip(answers).step_by(JUDGED_EVERY) {
            tally.look_up(&judge, query, *answer);
        }
        tally
    };
    Ok(queries.par_chunks(length).zip(answers.par_chunks(length)).map(tally).collect())
}
