//! Tests of the judge: it accepts the oracle's own answers, and never accepts a half-texel shift,
//! swapped axes, a wrong address mode, confused colour spaces or a flipped v, even with the largest
//! tolerance in use.

use glam::DVec2;
use moire::internal::lab::probe::LookupQuery;
use moire::internal::lab::verify::judge::{Precision, messages as judge};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::schema::layout::{Sampler, Texture};
use moire::internal::texture::data::{ColorSpace, TexelFormat};
use moire::internal::texture::sampler_spec::{Address, Filter, SamplerSpec};

use super::bench::{BASIC, CERTAIN, Rng, coordinates, pairs, query, texture, uv_of};

const HARDWARE: Precision =
    Precision::Hardware { sub_texel: 1.0 / 256.0, level: 0.0, value: [2.0 / 255.0; 2], decode: 0.5 / 255.0 };

/// The interval rule covers the filters of texture units.
fn filters(precision: Precision) -> &'static [Filter] {
    if matches!(precision, Precision::Shader) { &CERTAIN } else { &BASIC }
}

/// Random coordinates on an 8 × 6 texture.
fn bench(filter: Filter, address: Address, space: ColorSpace) -> (PackedScene, Vec<LookupQuery>) {
    let spec = SamplerSpec { address: [address; 2], mag: filter, min: filter, ..Default::default() };
    let scene = pairs(vec![texture(8, 6, TexelFormat::Rgba8, space, 5)], &[spec], &[(0, 0)]);
    let list = coordinates(&mut Rng::new(3), [8, 6], 300, false);
    let queries = list.into_iter().map(|uv| query(&scene, 0, uv)).collect();
    (scene, queries)
}

/// Returns the fraction of wrong answers of a tampered look-up.
fn caught(
    (scene, queries): &(PackedScene, Vec<LookupQuery>),
    precision: Precision,
    tamper: impl Fn(&mut Texture, &mut Sampler, DVec2) -> DVec2,
) -> f64 {
    let answer = |query: &LookupQuery| {
        let (mut image, mut how) = (scene.records.textures[0], scene.records.samplers[0]);
        let uv = tamper(&mut image, &mut how, uv_of(query));
        sample_texture(scene, &image, &how, &Coordinate::flat(uv), [0; 2]).as_vec4().to_array()
    };
    let answers: Vec<[f32; 4]> = queries.iter().map(answer).collect();
    judge(scene, queries, &answers, precision).len() as f64 / queries.len() as f64
}

#[test]
fn the_judge_is_silent_about_right_answers() {
    for precision in [Precision::Shader, HARDWARE] {
        for &filter in filters(precision) {
            for &address in Address::ALL {
                for &space in ColorSpace::ALL {
                    let share = caught(&bench(filter, address, space), precision, |_, _, uv| uv);
                    assert_eq!(share, 0.0, "{precision:?} {filter} {address} {space}");
                }
            }
        }
    }
}

#[test]
fn planted_errors_of_look_ups_are_caught() {
    for precision in [Precision::Shader, HARDWARE] {
        for &filter in filters(precision) {
            for &space in ColorSpace::ALL {
                let bench = bench(filter, Address::Repeat, space);
                let assert_caught = |what: &str, share: f64| {
                    assert!(share > 0.2, "{what}: {share} caught, {precision:?} {filter} {space}");
                };
                let size = DVec2::new(8.0, 6.0);
                assert_caught(
                    "half a texel to the right",
                    caught(&bench, precision, |_, _, uv| uv + DVec2::X * 0.5 / size),
                );
                assert_caught(
                    "half a texel up",
                    caught(&bench, precision, |_, _, uv| uv - DVec2::Y * 0.5 / size),
                );
                assert_caught("swapped axes", caught(&bench, precision, |_, _, uv| DVec2::new(uv.y, uv.x)));
                assert_caught(
                    "flipped v",
                    caught(&bench, precision, |_, _, uv| DVec2::new(uv.x, 1.0 - uv.y)),
                );
                let mixed = caught(&bench, precision, |image, _, uv| {
                    image.color_space = match image.color_space {
                        ColorSpace::Linear => ColorSpace::Srgb,
                        ColorSpace::Srgb => ColorSpace::Linear,
                    };
                    uv
                });
                assert_caught("colour space mixed up", mixed);
            }
        }
    }
}

#[test]
fn planted_address_modes_and_filters_are_caught() {
    for precision in [Precision::Shader, HARDWARE] {
        for &right in Address::ALL {
            for &filter in filters(precision) {
                let bench = bench(filter, right, ColorSpace::Linear);
                for &wrong in Address::ALL.iter().filter(|&&a| a != right) {
                    for axis in [0, 1] {
                        let share = caught(&bench, precision, |_, how, uv| {
                            *[&mut how.address_u, &mut how.address_v][axis] = wrong;
                            uv
                        });
                        assert!(
                            share > 0.05,
                            "{right} read as {wrong} on axis {axis}: {share}, {precision:?}"
                        );
                    }
                }
                for &wrong in filters(precision).iter().filter(|&&f| f != filter) {
                    let share = caught(&bench, precision, |_, how, uv| {
                        how.mag_filter = wrong;
                        uv
                    });
                    assert!(share > 0.05, "{filter} read as {wrong}: {share}, {precision:?}");
                }
            }
        }
    }
}
