//! Variants → look-ups on the device in batches of one pipeline → a tally a variant: how many answers
//! are wrong by the declared precision, how far the worst is off, and how fine the weights are.

use rayon::prelude::*;

use super::judge::{Judge, Judgement, Precision};
use super::queries::{Dice, coordinates, pairs, query, ramp, ramp_texture, texture};
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
}

/// Variants that one pipeline reads: each with its texture and with both texel centres.
struct Batch<'a> {
    scene: PackedScene,
    reader: Reader,
    variants: Vec<&'a Variant>,
    /// Index of each variant's texture, which is also its pair's.
    texture_of: Vec<usize>,
}

impl<'a> Batch<'a> {
    fn new(variants: Vec<&'a Variant>, texture: impl Fn(&Variant) -> TextureData) -> Result<Batch<'a>> {
        let reader = variants.first().map_or(Reader::Sampler, |v| v.reader);
        let mut samplers: Vec<SamplerSpec> = variants.iter().map(|v| v.spec).collect();
        samplers
            .extend(variants.iter().map(|v| SamplerSpec { texel_center: TexelCenter::Integer, ..v.spec }));
        let mut textures: Vec<TextureData> = Vec::new();
        let mut list: Vec<(usize, usize)> = Vec::new();
        let mut texture_of = Vec::new();
        for (i, variant) in variants.iter().enumerate() {
            let of_shader = |p: &(usize, usize)| {
                let other = variants[p.1];
                (other.class, other.format, other.size) == (variant.class, variant.format, variant.size)
            };
            // The shader's look-ups share one slot a texture, whatever the sampler.
            let known = (reader != Reader::Sampler).then(|| list.iter().position(of_shader)).flatten();
            texture_of.push(known.unwrap_or_else(|| {
                textures.push(texture(variant));
                list.push((textures.len() - 1, i));
                list.len() - 1
            }));
        }
        Ok(Batch { scene: pairs(textures, &samplers, &list)?, reader, variants, texture_of })
    }

    /// The look-up of variant `i` at (u, v).
    fn query(&self, i: usize, center: TexelCenter, uv: [f32; 2]) -> LookUp {
        let sampler = i + if center == TexelCenter::Integer { self.variants.len() } else { 0 };
        LookUp { sampler: sampler as u32, ..query(&self.scene, self.texture_of[i], uv) }
    }

    fn answers(&self, gpu: &Gpu, queries: &[LookUp]) -> Result<Vec<[f32; 4]>> {
        // One pipeline for all modes of the shader; the device's samplers need none of its code.
        let everything = self.reader != Reader::Sampler;
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
            let found = judge.judge(query, *answer);
            tally.add(found);
            if !found.right && tally.example.is_none() {
                tally.example = Some(judge.complaint(query, *answer));
            }
        }
        tally
    };
    Ok((0..ends.len()).into_par_iter().map(tally).collect())
}

/// Bits of the weights of filters, each along a ramp.
pub fn weights(gpu: &Gpu, variants: Vec<&Variant>) -> Result<Vec<WeightBits>> {
    let batch = Batch::new(variants, |v| ramp_texture(v.format, v.class.color_space()))?;
    let of = |i| ramp(RAMP_STEPS).map(move |uv| (i, uv));
    let queries: Vec<LookUp> =
        (0..batch.variants.len()).flat_map(of).map(|(i, uv)| batch.query(i, TexelCenter::Half, uv)).collect();
    let answers = batch.answers(gpu, &queries)?;
    let ramps = answers.par_chunks(RAMP_STEPS as usize + 1);
    Ok(ramps.map(|ramp| weight_bits(ramp.iter().map(|rgba| rgba[0]))).collect())
}
