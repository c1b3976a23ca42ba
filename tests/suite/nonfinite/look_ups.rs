//! One NaN or infinite texel on the device: a lookup is NaN or infinite where that texel has a
//! weight, and bitwise unchanged everywhere else. A texture that is 1 at the texel and 0 elsewhere
//! gives the weight.

use moire::internal::lab::probe::LookupQuery;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::texture::data::{Dimension, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Address, Filter, SamplerSpec};

use crate::footprints::bench::{answers, narrow, pairs_of, solid};
use crate::lookup::bench::{Rng, Vectors, coordinates, query};

/// Sets all channels of one texel of a float texture to a value.
fn with_texel(texture: &TextureData, at: [u32; 2], value: f32) -> TextureData {
    let channels = texture.format.channels();
    texture.with_floats(channels, |x, y, c| if [x, y] == at { value } else { texture.value(x, y, c) as f32 })
}

/// Random texels, the index of the altered one, and all filters of such textures with all address modes.
struct Bench {
    texture: TextureData,
    at: [u32; 2],
    specs: Vec<SamplerSpec>,
}

impl Bench {
    fn new(dimension: Dimension, size: [u32; 3], at: [u32; 2]) -> Bench {
        use Filter::{Anisotropic, Cubic, Ewa, Linear, Nearest, Stochastic};
        let mut filters =
            vec![(Nearest, Nearest), (Linear, Linear), (Stochastic, Stochastic), (Linear, Anisotropic)];
        if dimension == Dimension::Two {
            filters.extend([(Cubic, Cubic), (Linear, Ewa)]);
        }
        let modes = Address::ALL.iter().enumerate();
        let spec = |mag, min, k: usize, u| SamplerSpec {
            address: [u, Address::ALL[(k + 1) % Address::ALL.len()]],
            address_w: Address::ALL[(k + 3) % Address::ALL.len()],
            mag,
            min,
            ..Default::default()
        };
        let specs = filters
            .iter()
            .flat_map(|&(mag, min)| modes.clone().map(move |(k, &u)| spec(mag, min, k, u)))
            .collect();
        Bench { texture: solid(dimension, size, TexelFormat::RgbaFloat), at, specs }
    }

    fn scene(&self, texture: TextureData) -> PackedScene {
        pairs_of(Footprint::Differentials, vec![texture], &self.specs, &[(0, 0)])
    }

    /// Random coordinates, texel centres and edges; footprints of a point and of less than two texels' width, which
    /// read level 0.
    fn queries(&self, scene: &PackedScene) -> Vec<LookupQuery> {
        let mut rng = Rng::new(71);
        let (w, h) = (self.texture.width, self.texture.height);
        let mut all = Vec::new();
        for sampler in 0..self.specs.len() as u32 {
            for (i, [u, v]) in coordinates(&mut rng, [w, h], 150, false).into_iter().enumerate() {
                let uv = match self.texture.dimension {
                    Dimension::Cube => narrow(rng.direction()),
                    _ => [u, v, (rng.bits() % 9) as f32 / 8.0, 0.0],
                };
                let wide = [0.0, 1.2, 1.9][i % 3];
                let (dx, dy) = (wide / w as f32, [1.0, 2.5][i % 2] * wide / h as f32);
                let (dx, dy) = ([dx, 0.0, 0.0, 0.0], [0.3 * dx, dy, 0.0, 0.0]);
                all.push(LookupQuery { sampler, seed: i as u32, uv, dx, dy, ..query(scene, 0, [0.0; 2]) });
            }
        }
        all
    }

    /// Returns the look-ups whose results with the texel (`odd`) and without it (`plain`) contradict its weights.
    fn complaints(&self, weights: &[[f32; 4]], odd: &[[f32; 4]], plain: &[[f32; 4]]) -> Vec<usize> {
        let wrong = |&i: &usize| {
            let same = odd[i].map(f32::to_bits) == plain[i].map(f32::to_bits);
            let none = odd[i].iter().all(|v| !v.is_finite());
            if weights[i] == [0.0; 4] { !same } else { !none }
        };
        (0..odd.len()).filter(wrong).collect()
    }
}

fn benches() -> [Bench; 3] {
    [
        Bench::new(Dimension::Two, [8, 5, 1], [3, 2]),
        Bench::new(Dimension::Three, [4, 6, 4], [0, 7]),
        Bench::new(Dimension::Cube, [4, 4, 6], [3, 8]),
    ]
}

#[test]
fn a_texel_that_is_no_number_stays_in_look_ups_that_read_it() {
    for bench in benches() {
        let zero = bench.texture.with_floats(4, |_, _, _| 0.0);
        let weights = bench.scene(with_texel(&zero, bench.at, 1.0));
        let queries = bench.queries(&weights);
        let weights = answers(&weights, &queries);
        let read = weights.iter().filter(|w| **w != [0.0; 4]).count();
        assert!(read > 50 && queries.len() - read > 100, "{read} of {} prove nothing", queries.len());
        // The pipeline of its own scene: without the code for texels that are NaN or infinite.
        let plain = bench.scene(with_texel(&bench.texture, bench.at, 7.0));
        assert!(!plain.has_nonfinite());
        let plain = answers(&plain, &queries);
        for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
            let scene = bench.scene(with_texel(&bench.texture, bench.at, value));
            assert_eq!(scene.nonfinite_texels, [1]);
            let odd = answers(&scene, &queries);
            let wrong = bench.complaints(&weights, &odd, &plain);
            let first = wrong.first().map(|&i| (&queries[i], weights[i], odd[i], plain[i]));
            let kind = bench.texture.dimension;
            assert!(wrong.is_empty(), "{kind} {value}: {} of {}: {first:?}", wrong.len(), queries.len());
        }
    }
}

#[test]
fn a_pipeline_that_multiplies_such_a_texel_by_0_is_caught() {
    let [bench, ..] = benches();
    let zero = bench.texture.with_floats(4, |_, _, _| 0.0);
    let weights = bench.scene(with_texel(&zero, bench.at, 1.0));
    let queries = bench.queries(&weights);
    let weights = answers(&weights, &queries);
    let plain = answers(&bench.scene(with_texel(&bench.texture, bench.at, 7.0)), &queries);
    let mut scene = bench.scene(with_texel(&bench.texture, bench.at, f32::NAN));
    scene.nonfinite_texels = vec![0];
    let odd = answers(&scene, &queries);
    assert!(bench.complaints(&weights, &odd, &plain).len() > 10);
    // And a texel beside the altered one.
    let [x, y] = bench.at;
    let beside = answers(&bench.scene(with_texel(&bench.texture, [x + 1, y], f32::NAN)), &queries);
    assert!(bench.complaints(&weights, &beside, &plain).len() > 100);
}

/// Footprints of two texels and more read coarser levels, which are means over the other texels.
#[test]
fn coarser_levels_do_not_read_texels_that_are_no_numbers() {
    let specs = [Filter::Linear, Filter::Anisotropic].map(|min| SamplerSpec {
        min,
        mip: moire::internal::texture::sampler_spec::MipMode::Linear,
        ..Default::default()
    });
    let texture = with_texel(&solid(Dimension::Two, [16, 16, 1], TexelFormat::RgbaFloat), [5, 5], f32::NAN);
    let scene = pairs_of(Footprint::Differentials, vec![texture], &specs, &[(0, 0), (0, 1)]);
    let mut rng = Rng::new(72);
    let wide = |n: f32| n / 16.0;
    let queries: Vec<LookupQuery> = (0..400)
        .map(|i| {
            let n = [2.0, 4.0, 3.0, 100.0, f32::INFINITY][i % 5];
            let uv = [rng.unit() as f32, rng.unit() as f32, 0.0, 0.0];
            let (dx, dy) = ([wide(n), 0.0, 0.0, 0.0], [0.0, wide(n), 0.0, 0.0]);
            LookupQuery { sampler: i as u32 % 2, uv, dx, dy, ..query(&scene, 0, [0.0; 2]) }
        })
        .collect();
    for (query, answer) in queries.iter().zip(answers(&scene, &queries)) {
        assert!(answer.iter().all(|v| v.is_finite()), "{answer:?} at {query:?}");
    }
}
