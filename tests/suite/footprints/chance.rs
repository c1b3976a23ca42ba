//! The stochastic filter: every answer is a texel of a level in use, and the mean over many seeds
//! equals the result of the smooth filter (Fajardo et al. 2023).

use glam::DVec3;
use moire::internal::lab::probe::LookupQuery;
use moire::internal::oracle::texture::{fetch_texel, level_at};
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use super::bench::{answers, coordinate, expected, narrow, pairs_of, solid};
use crate::lookup::bench::{Rng, Vectors, query};

const SEEDS: u32 = 2048;

/// All texels of all levels, as bits.
fn texels(scene: &PackedScene, texture: usize) -> Vec<u32> {
    let image = &scene.records.textures[texture];
    let mut all = Vec::new();
    for index in 0..image.levels {
        let level = level_at(scene, image, index);
        let [w, h, d] = level.size;
        for at in (0..w * h * d).map(|i| [i % w, i / w % h, i / (w * h)]) {
            all.push((fetch_texel(scene, image, &level, at).x as f32).to_bits());
        }
    }
    all.sort_unstable();
    all
}

#[test]
fn every_answer_is_a_texel_and_their_mean_is_the_smooth_filter() {
    let base =
        SamplerSpec { address: [Address::MirroredRepeat; 2], mip: MipMode::Linear, ..Default::default() };
    let chance = SamplerSpec { mag: Filter::Stochastic, min: Filter::Stochastic, ..base };
    let textures = vec![
        solid(Dimension::Two, [16, 12, 1], TexelFormat::GreyFloat),
        solid(Dimension::Three, [8, 8, 8], TexelFormat::GreyFloat),
        solid(Dimension::Cube, [8, 8, 6], TexelFormat::GreyFloat),
    ];
    let pairs: Vec<(usize, usize)> = (0..3).flat_map(|t| [(t, 0), (t, 1)]).collect();
    let scene = pairs_of(Footprint::Differentials, textures, &[chance, base], &pairs);
    let mut rng = Rng::new(21);
    let mut queries = Vec::new();
    for i in 0..24 {
        let texture = i % 3;
        // Some less than a texel wide, the others between two levels.
        let wide = if i % 2 == 0 { 0.01 } else { 0.25 };
        let at = if texture == 2 { rng.direction() } else { rng.vector(1.5) };
        let [dx, dy] = [0, 1].map(|_| narrow(rng.direction() * wide));
        let one = LookupQuery { uv: narrow(at), dx, dy, ..query(&scene, 2 * texture, [0.0; 2]) };
        queries.extend((0..SEEDS).map(|seed| LookupQuery { seed, ..one }));
    }
    let read = answers(&scene, &queries);
    let known: Vec<Vec<u32>> = (0..3).map(|t| texels(&scene, t)).collect();
    for (queries, read) in queries.chunks(SEEDS as usize).zip(read.chunks(SEEDS as usize)) {
        let query = &queries[0];
        let values: Vec<f64> = read.iter().map(|a| a[0].into()).collect();
        for answer in read {
            let found = known[query.texture as usize].binary_search(&answer[0].to_bits());
            assert!(found.is_ok(), "{answer:?} is no texel, at {query:?}");
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (values.len() as f64 - 1.0);
        let smooth = LookupQuery { sampler: query.sampler + 1, ..*query };
        let right = expected(&scene, &smooth, 0, &coordinate(query))[0];
        let error = (variance / values.len() as f64).sqrt();
        assert!(
            (mean - right).abs() <= 5.0 * error + 1e-6, // 5 standard errors
            "mean {mean} of {SEEDS}, smooth {right}, standard error {error}, at {query:?}"
        );
    }
}

/// A direction on the border of all three faces has no fourth texel: each of the three is equally likely.
#[test]
fn at_a_corner_of_a_cube_the_three_texels_are_equally_likely() {
    let spec = SamplerSpec {
        mag: Filter::Stochastic,
        min: Filter::Stochastic,
        mip: MipMode::None,
        ..Default::default()
    };
    let cube = solid(Dimension::Cube, [4, 4, 6], TexelFormat::GreyFloat);
    let scene = pairs_of(Footprint::None, vec![cube], &[spec], &[(0, 0)]);
    let corner = LookupQuery { uv: narrow(DVec3::new(1.0, 1.0, 1.0)), ..query(&scene, 0, [0.0; 2]) };
    let count = 6000;
    let queries: Vec<LookupQuery> = (0..count).map(|seed| LookupQuery { seed, ..corner }).collect();
    let mut read: Vec<u32> = answers(&scene, &queries).iter().map(|a| a[0].to_bits()).collect();
    read.sort_unstable();
    let counts: Vec<usize> = read.chunk_by(|a, b| a == b).map(<[u32]>::len).collect();
    assert_eq!(counts.len(), 3, "{counts:?}");
    let sigma = (f64::from(count) * 2.0 / 9.0).sqrt();
    for n in counts {
        assert!((n as f64 - f64::from(count) / 3.0).abs() < 5.0 * sigma, "{n} of {count}"); // 5 sigma
    }
}
