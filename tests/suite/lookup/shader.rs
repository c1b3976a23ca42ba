//! The shader method: every filter and address mode against the oracle.

use moire::internal::lab::probe::{self, LookupQuery};
use moire::internal::lab::verify::judge::{Precision, messages as judge};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::texture::data::{ColorSpace, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Address, SamplerSpec, TexelCenter};

use super::assert_none;
use super::bench::{CERTAIN, Rng, coordinates, formats, pairs, query, texture, uv_of};
use crate::stage::device;

/// Uncommon, distinct values, so that a wrong border channel is detected.
const BORDER: [f32; 4] = [0.9, 0.1, 0.6, 0.3];

const SIZES: [[u32; 2]; 7] = [[1, 1], [1, 7], [6, 1], [2, 2], [5, 3], [7, 4], [64, 64]];

fn specs() -> Vec<SamplerSpec> {
    let mut all = Vec::new();
    for &u in Address::ALL {
        for &v in Address::ALL {
            for filter in CERTAIN {
                for &texel_center in TexelCenter::ALL {
                    all.push(SamplerSpec {
                        address: [u, v],
                        mag: filter,
                        min: filter,
                        texel_center,
                        border_color: BORDER,
                        ..Default::default()
                    });
                }
            }
        }
    }
    all
}

fn check(scene: &PackedScene, image_source: bool, keep_everything: bool, queries: &[LookupQuery]) {
    let answers = probe::lookups(&device(), scene, image_source, keep_everything, queries).unwrap();
    assert_none(&judge(scene, queries, &answers, Precision::Shader), queries.len());
}

/// Every pair of texture and sampler, each at some coordinates.
fn everything(
    textures: Vec<TextureData>,
    random: usize,
    keep_one_in: usize,
) -> (PackedScene, Vec<LookupQuery>) {
    let specs = specs();
    // A pair a texture: look-ups of method shader share their slot, whatever the sampler.
    let list: Vec<(usize, usize)> = (0..textures.len()).map(|t| (t, 0)).collect();
    let scene = pairs(textures, &specs, &list);
    let mut rng = Rng::new(11);
    let mut queries = Vec::new();
    for (t, record) in scene.records.textures.iter().enumerate() {
        for sampler in 0..specs.len() {
            for uv in coordinates(&mut rng, [record.size.x, record.size.y], random, true) {
                if (rng.bits() as usize).is_multiple_of(keep_one_in) {
                    queries.push(LookupQuery { sampler: sampler as u32, ..query(&scene, t, uv) });
                }
            }
        }
    }
    (scene, queries)
}

#[test]
fn every_format_size_and_mode_from_the_texel_buffer() {
    let mut textures = Vec::new();
    for size in SIZES {
        for (format, space) in formats() {
            textures.push(texture(size[0], size[1], format, space, textures.len() as u64));
        }
    }
    let (scene, queries) = everything(textures, 40, 6);
    check(&scene, false, true, &queries);
}

#[test]
fn every_format_and_mode_from_images() {
    for sizes in [[[5, 3], [64, 64]], [[1, 1], [7, 4]]] {
        let choose = |i: usize| sizes[i % 2];
        let of = |(i, (format, space)): (usize, (TexelFormat, ColorSpace))| {
            texture(choose(i)[0], choose(i)[1], format, space, i as u64)
        };
        let (scene, queries) = everything(formats().into_iter().enumerate().map(of).collect(), 40, 6);
        check(&scene, true, true, &queries);
    }
}

#[test]
fn pipelines_narrowed_to_one_mode_agree() {
    let formats = formats();
    let chosen = specs()
        .into_iter()
        .filter(|s| s.address[0] == s.address[1] || s.address == [Address::Repeat, Address::ClampToBorder]);
    for (i, spec) in chosen.enumerate() {
        let [width, height] = SIZES[(i * 3 + 5) % SIZES.len()];
        let (format, space) = formats[i % formats.len()];
        let scene = pairs(vec![texture(width, height, format, space, i as u64)], &[spec], &[(0, 0)]);
        let list = coordinates(&mut Rng::new(i as u64), [width, height], 200, true);
        let queries: Vec<LookupQuery> = list.into_iter().map(|uv| query(&scene, 0, uv)).collect();
        check(&scene, i % 2 == 0, false, &queries);
    }
}

#[test]
fn coordinates_that_are_no_numbers_read_a_texel_and_the_oracles() {
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e30, -1e30];
    let textures = vec![
        texture(5, 3, TexelFormat::Rgba8, ColorSpace::Linear, 1),
        texture(8, 8, TexelFormat::RgbaFloat, ColorSpace::Linear, 2),
    ];
    let list = [(0, 0), (1, 0)];
    let specs = specs();
    let scene = pairs(textures, &specs, &list);
    let mut queries = Vec::new();
    for pair in 0..list.len() {
        for sampler in 0..specs.len() {
            for a in odd {
                for uv in [[a, 0.3], [0.3, a], [a, a]] {
                    queries.push(LookupQuery { sampler: sampler as u32, ..query(&scene, pair, uv) });
                }
            }
        }
    }
    for image_source in [false, true] {
        let answers = probe::lookups(&device(), &scene, image_source, true, &queries).unwrap();
        for (query, answer) in queries.iter().zip(&answers) {
            let (image, how) = (
                &scene.records.textures[query.texture as usize],
                &scene.records.samplers[query.sampler as usize],
            );
            let expected = sample_texture(&scene, image, how, &Coordinate::flat(uv_of(query)), [0; 2]);
            assert!(expected.is_finite(), "the oracle at {:?}", query.uv);
            let label = scene.sampler_specs[query.sampler as usize].label();
            for (got, expected) in answer.iter().zip(expected.to_array()) {
                // 8 · 2⁻²² of a range of 8, and 4 ulp of 6.
                let close =
                    (f64::from(*got) - expected).abs() <= 8.0 * 8.0 / 4_194_304.0 + 4.0 * 6.0 / 8_388_608.0;
                assert!(close, "{label} at {:?}: {answer:?}, oracle {expected}", query.uv);
            }
        }
    }
}
