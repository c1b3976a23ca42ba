//! A batch of variants: one scene whose lookups one pipeline answers, with a tally for each
//! variant.

use rayon::prelude::*;

use super::queries::{noise, pairs_over, query};
use super::run::Tally;
use super::variants::{FormatClass, Reader, Variant};
use crate::core::error::Result;
use crate::gpu::Gpu;
use crate::lab::probe::{LookupQuery, lookups};
use crate::pack::PackedScene;
use crate::scene::model::Footprint;
use crate::texture::data::{Dimension, TextureData};
use crate::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec, TexelCenter};

/// Variants that one pipeline reads, each with its texture and with both texel centres.
pub struct Batch<'a> {
    pub scene: PackedScene,
    pub reader: Reader,
    pub variants: Vec<&'a Variant>,
    /// The pair of texture and sampler that each variant reads.
    pair_of: Vec<usize>,
}

impl<'a> Batch<'a> {
    /// Creates a batch. Its samplers have three parts with one entry per variant: those bound on
    /// the device, those that the oracle evaluates, and the latter with integer texel centres.
    pub fn new(variants: Vec<&'a Variant>, texture: impl Fn(&Variant) -> TextureData) -> Result<Batch<'a>> {
        let reader = variants.first().map_or(Reader::Sampler, |v| v.reader);
        let filtered = variants.iter().any(|v| v.is_filtered());
        // Textures get all their levels, whichever the sampler reads.
        let mip = |v: &Variant| if filtered { MipMode::Linear } else { v.spec.mip };
        let bound = variants.iter().map(|v| SamplerSpec { mip: mip(v), ..v.device_sampler() });
        let half = variants.iter().map(|v| v.asked_sampler());
        let integer = half.clone().map(|s| SamplerSpec { texel_center: TexelCenter::Integer, ..s });
        let mut samplers: Vec<SamplerSpec> = bound.chain(half).chain(integer).collect();
        let mut textures: Vec<TextureData> = Vec::new();
        let mut list: Vec<(usize, usize)> = Vec::new();
        let mut pair_of = Vec::new();
        for (i, variant) in variants.iter().enumerate() {
            let same_texture = |p: &(usize, usize)| {
                let other = variants[p.1];
                (other.class, other.format, other.size) == (variant.class, variant.format, variant.size)
            };
            // The shader's lookups share one slot per texture, whatever the sampler.
            let known = (reader != Reader::Sampler).then(|| list.iter().position(same_texture)).flatten();
            pair_of.push(known.unwrap_or_else(|| {
                textures.push(texture(variant));
                list.push((textures.len() - 1, i));
                list.len() - 1
            }));
        }
        if reader == Reader::Sampler {
            let dimension = variants.first().map_or(Dimension::Two, |v| v.dimension);
            textures.extend(unread_textures(dimension));
            samplers.extend(unread_samplers(filtered));
        }
        let footprint = if filtered { Footprint::Differentials } else { Footprint::None };
        let mut scene = pairs_over(footprint, textures, &samplers, &list)?;
        for (spec, variant) in scene.sampler_specs.iter_mut().zip(&variants) {
            *spec = variant.device_sampler();
        }
        Ok(Batch { scene, reader, variants, pair_of })
    }

    /// Returns the lookup of variant `i` at (u, v).
    pub fn query(&self, i: usize, center: TexelCenter, uv: [f32; 2]) -> LookupQuery {
        let part = if center == TexelCenter::Integer { 2 } else { 1 };
        let sampler = part * self.variants.len() + i;
        LookupQuery { sampler: sampler as u32, ..query(&self.scene, self.pair_of[i], uv) }
    }

    /// Returns one tally per variant, each for its own list of lookups.
    pub fn tallies(
        &self,
        gpu: &Gpu,
        queries: Vec<Vec<LookupQuery>>,
        tally: impl Fn(&Variant, &[LookupQuery], &[[f32; 4]]) -> Tally + Sync,
    ) -> Result<Vec<Tally>> {
        let answers =
            lookups(gpu, &self.scene, self.reader != Reader::ShaderBuffer, false, &queries.concat())?;
        let mut rest = &answers[..];
        let mut lists = Vec::with_capacity(queries.len());
        for (variant, queries) in self.variants.iter().zip(&queries) {
            let (own, others) = rest.split_at(queries.len());
            lists.push((variant, queries, own));
            rest = others;
        }
        Ok(lists
            .into_par_iter()
            .map(|(variant, queries, answers)| tally(variant, queries, answers))
            .collect())
    }
}

/// Returns textures that nothing reads: with them all batches need the same shader variant and
/// share a pipeline.
fn unread_textures(dimension: Dimension) -> Vec<TextureData> {
    let size = |n: u32| match dimension {
        Dimension::One => [n, 1, 1],
        Dimension::Two => [n, n, 1],
        Dimension::Three => [n, n, n],
        Dimension::Cube => [n, n, 6],
    };
    let formats = FormatClass::ALL.iter().flat_map(|c| c.formats().map(|f| (f, c.color_space())));
    let of = |(i, (format, space))| noise(dimension, size(2 + i as u32 % 2), format, space, i as u64);
    formats.enumerate().map(of).collect()
}

/// Returns samplers that nothing reads, for the same purpose.
fn unread_samplers(filtered: bool) -> Vec<SamplerSpec> {
    let of = |(i, &address): (usize, &Address)| SamplerSpec {
        address: [address; 2],
        address_w: address,
        mag: [Filter::Nearest, Filter::Linear][i % 2],
        min: [Filter::Linear, Filter::Nearest][i % 2],
        mip: if filtered { MipMode::ALL[i % 3] } else { MipMode::None },
        method: Method::Hardware,
        ..Default::default()
    };
    Address::ALL.iter().enumerate().map(of).collect()
}
