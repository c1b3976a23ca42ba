//! Levels, kinds of textures and anisotropy: errors of a device in these are detected.

use std::collections::BTreeSet;

use moire::internal::lab::probe::LookupQuery;
use moire::internal::lab::verify::judge::{Judge, Precision};
use moire::internal::lab::verify::level_variants::{anisotropic_variants, level_variants};
use moire::internal::lab::verify::queries::{Rng, noise, pairs_over, place_of, query};
use moire::internal::lab::verify::reading::readings;
use moire::internal::lab::verify::sweeps::{level_sweep, long_footprints, paint_levels};
use moire::internal::lab::verify::variants::{FormatClass, Reader, Scale, Variant};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::schema::layout::Sampler;
use moire::internal::texture::data::Dimension;
use moire::internal::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec};

use super::device;

fn variant(dimension: Dimension, filter: Filter, mip: MipMode) -> Variant {
    let spec = SamplerSpec { mag: filter, min: filter, mip, method: Method::Hardware, ..Default::default() };
    let (class, scale) = (FormatClass::Float32, Scale::Levels);
    let size = match dimension {
        Dimension::One => [16, 1, 1],
        Dimension::Two => [8, 16, 1],
        Dimension::Three => [8, 4, 8],
        Dimension::Cube => [64, 64, 6],
    };
    Variant { reader: Reader::Sampler, spec, scale, class, format: class.formats()[2], dimension, size }
}

fn scene_of(variant: &Variant) -> PackedScene {
    let image = noise(variant.dimension, variant.size, variant.format, variant.class.color_space(), 5);
    pairs_over(Footprint::Differentials, vec![image], &[variant.spec], &[(0, 0)]).unwrap()
}

/// Returns the fraction of wrong answers of a device whose query and sampler are altered by `tamper`.
fn wrong(variant: &Variant, precision: Precision, tamper: impl Fn(&mut LookupQuery, &mut Sampler)) -> f64 {
    let scene = scene_of(variant);
    let judge = Judge::new(&scene, precision);
    let queries = level_sweep(&mut Rng::new(7), variant, &query(&scene, 0, [0.0; 2]));
    let is_wrong = |query: &&LookupQuery| {
        let (mut asked, mut how) = (**query, scene.records.samplers[0]);
        tamper(&mut asked, &mut how);
        let answer = sample_texture(&scene, &scene.records.textures[0], &how, &place_of(&asked), [0; 2]);
        !judge.judge(query, answer.as_vec4().to_array()).right
    };
    queries.iter().filter(is_wrong).count() as f64 / queries.len() as f64
}

fn precisions() -> [Precision; 2] {
    [Precision::Shader, Precision::declared(&device("another"))]
}

/// Coarse levels of a cube are mostly around corners, where devices differ.
fn many(dimension: Dimension) -> f64 {
    if dimension == Dimension::Cube { 0.08 } else { 0.15 }
}

fn wider(query: &mut LookupQuery, by: f32) {
    query.dx = query.dx.map(|d| d * by);
    query.dy = query.dy.map(|d| d * by);
}

#[test]
fn half_a_level_more_or_less_is_told_from_the_right_one() {
    for &dimension in Dimension::ALL {
        for filter in [Filter::Nearest, Filter::Linear] {
            for mip in [MipMode::Nearest, MipMode::Linear] {
                let variant = variant(dimension, filter, mip);
                for precision in precisions() {
                    let label = format!("{} {precision:?}", variant.label());
                    assert_eq!(wrong(&variant, precision, |_, _| ()), 0.0, "{label}");
                    for by in [0.5f32.sqrt(), 2f32.sqrt()] {
                        let found = wrong(&variant, precision, |query, _| wider(query, by));
                        assert!(found > many(dimension), "{found}, {label}");
                    }
                }
            }
        }
    }
}

#[test]
fn another_mip_mode_or_filter_is_noticed() {
    for &dimension in Dimension::ALL {
        for precision in precisions() {
            let nearest = variant(dimension, Filter::Linear, MipMode::Nearest);
            let other = |mip: MipMode| move |_: &mut LookupQuery, how: &mut Sampler| how.mip_mode = mip;
            assert!(
                wrong(&nearest, precision, other(MipMode::Linear)) > many(dimension),
                "{dimension} linear"
            );
            assert!(wrong(&nearest, precision, other(MipMode::None)) > many(dimension), "{dimension} none");
            let min = |_: &mut LookupQuery, how: &mut Sampler| how.min_filter = Filter::Nearest;
            assert!(wrong(&nearest, precision, min) > many(dimension), "{dimension} minification");
        }
    }
}

#[test]
fn swapped_faces_and_a_clamped_third_axis_are_noticed() {
    for precision in precisions() {
        let cube = variant(Dimension::Cube, Filter::Nearest, MipMode::Nearest);
        let swapped = wrong(&cube, precision, |query, _| query.uv.swap(0, 1));
        assert!(swapped > 0.4, "{swapped}");
        let mirrored = wrong(&cube, precision, |query, _| query.uv[0] = -query.uv[0]);
        assert!(mirrored > 0.4, "{mirrored}");
        let volume = variant(Dimension::Three, Filter::Linear, MipMode::None);
        let clamped = wrong(&volume, precision, |_, how| how.address_w = Address::ClampToEdge);
        assert!(clamped > 0.1, "{clamped}");
        let shifted = wrong(&volume, precision, |query, _| query.uv[2] += 0.5 / 8.0);
        assert!(shifted > 0.6, "{shifted}");
    }
}

/// Returns the fraction of wrong answers of a device that selects the level by `level` of the footprint's
/// axes, in texels.
fn wrong_anisotropic(variant: &Variant, level: impl Fn(f64, f64) -> f64) -> f64 {
    let mut scene = scene_of(variant);
    paint_levels(&mut scene, 0);
    let judge = Judge::new(&scene, Precision::declared(&device("another")));
    let queries = long_footprints(&mut Rng::new(7), variant, &query(&scene, 0, [0.0; 2]));
    let is_wrong = |query: &&LookupQuery| {
        let axes = place_of(query).change.map(|d| d.length() * f64::from(variant.size[0]));
        let level = level(axes[0].max(axes[1]), axes[0].min(axes[1])).clamp(0.0, 8.0);
        !judge.judge(query, [(level / 8.0) as f32; 4]).right
    };
    queries.iter().filter(is_wrong).count() as f64 / queries.len() as f64
}

#[test]
fn anisotropy_may_read_any_level_between_the_axes_and_no_other() {
    for variant in anisotropic_variants().iter().filter(|v| v.spec.mip == MipMode::Linear) {
        let most = f64::from(variant.spec.max_anisotropy);
        let label = variant.label();
        let exact = |major: f64, minor: f64| minor.max(major / most).log2();
        assert_eq!(wrong_anisotropic(variant, exact), 0.0, "{label}");
        assert_eq!(wrong_anisotropic(variant, |major, _| major.log2()), 0.0, "{label}");
        for (what, found) in [
            ("level 0", wrong_anisotropic(variant, |_, _| 0.0)),
            ("sharper", wrong_anisotropic(variant, |major, minor| exact(major, minor) - 0.5)),
            ("coarser", wrong_anisotropic(variant, |major, _| major.log2() + 0.5)),
        ] {
            assert!(found > 0.2, "{what}: {found}, {label}");
        }
    }
}

#[test]
fn levels_round_as_vulkan_says() {
    let of = |mip, [from, to]: [f64; 2]| {
        let scene = scene_of(&variant(Dimension::Two, Filter::Linear, mip));
        let list = readings(&scene.records.samplers[0], 5, [from, to]);
        list.iter().map(|r| (r.levels, r.share)).collect::<Vec<_>>()
    };
    let one = |level: u32| vec![([level; 2], [0.0; 2])];
    for (level, nearest) in [(-1.0, 0), (0.4, 0), (0.6, 1), (1.4, 1), (3.6, 4), (9.0, 4)] {
        assert_eq!(of(MipMode::Nearest, [level; 2]), one(nearest), "{level}");
    }
    assert_eq!(of(MipMode::Nearest, [1.45, 1.55]), [one(1), one(2)].concat());
    assert_eq!(of(MipMode::Linear, [1.25; 2]), [([1, 2], [0.25; 2])]);
    assert_eq!(of(MipMode::Linear, [1.75, 2.25]), [([1, 2], [0.75, 1.0]), ([2, 3], [0.0, 0.25])]);
    assert_eq!(of(MipMode::None, [3.0; 2]), one(0));
}

#[test]
fn every_axis_meets_every_address_mode_and_every_mip_mode_every_class() {
    for &dimension in Dimension::ALL {
        let all = level_variants(Reader::Sampler, dimension);
        let labels: BTreeSet<String> = all.iter().map(Variant::label).collect();
        assert_eq!(labels.len(), all.len());
        let classes: BTreeSet<_> =
            all.iter().map(|v| (v.spec.mag, v.spec.min, v.spec.mip, v.class)).collect();
        assert_eq!(classes.len(), 2 * 2 * 3 * 4, "{dimension}");
        let axes = all[0].addresses().len();
        for a in 0..axes {
            for b in 0..a {
                let pairs: BTreeSet<_> = all.iter().map(|v| (v.addresses()[a], v.addresses()[b])).collect();
                assert_eq!(pairs.len(), 25, "{dimension}: axes {a} and {b}");
            }
        }
    }
}
