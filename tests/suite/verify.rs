//! The parts of `moire verify` (table of variants, verdicts, weight bits) distinguish a faulty
//! device from a correct one.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use moire::internal::gpu::{DeviceInfo, DeviceKind, DeviceLimits};
use moire::internal::lab::verify::groups::lines;
use moire::internal::lab::verify::judge::{Judge, Judgement, Precision};
use moire::internal::lab::verify::queries::{
    Axis, Rng, coordinates, pairs, query, ramp, ramp_texture, texture, uv_of,
};
use moire::internal::lab::verify::report::{ConformanceReport, Row, Verdict};
use moire::internal::lab::verify::run::Tally;
use moire::internal::lab::verify::text::text;
use moire::internal::lab::verify::variants::{
    FormatClass, Reader, Scale, Variant, sampler_variants, shader_variants,
};
use moire::internal::lab::verify::weights::{RAMP_STEPS, WeightBits, weight_bits};
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::texture::data::Dimension;
use moire::internal::texture::sampler_spec::{Address, Filter, SamplerSpec};

mod command;
mod levels;

const LAVAPIPE: &str = "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)";

fn device(driver: &str) -> DeviceInfo {
    DeviceInfo {
        index: 0,
        name: "made up".into(),
        kind: DeviceKind::Cpu,
        driver: driver.into(),
        api_version: "1.3.0".into(),
        uuid: None,
        limits: DeviceLimits { sub_texel_bits: 8, mip_bits: 4, ..Default::default() },
        suitable: Ok(()),
    }
}

fn variant(address: Address, filter: Filter, class: FormatClass) -> Variant {
    let spec = SamplerSpec { address: [address; 2], mag: filter, min: filter, ..Default::default() };
    let scale = Scale::Magnified;
    Variant {
        reader: Reader::Sampler,
        spec,
        scale,
        class,
        format: class.formats()[2],
        dimension: Dimension::Two,
        size: [8, 6, 1],
    }
}

/// Returns the verdict on a device with this look-up; `shift` in texels along u.
fn row(driver: &str, variant: &Variant, shift: f64) -> Row {
    let device = device(driver);
    let image = texture(8, 6, variant.format, variant.class.color_space(), 5);
    let scene = pairs(vec![image], &[variant.spec], &[(0, 0)]).unwrap();
    let judge = Judge::new(&scene, Precision::declared(&device));
    let mut tally = Tally::default();
    for uv in coordinates(&mut Rng::new(3), [8, 6], 100, false) {
        let query = query(&scene, 0, uv);
        let at = uv_of(&query) + DVec2::X * shift / 8.0;
        let answer = sample_texture(
            &scene,
            &scene.records.textures[0],
            &scene.records.samplers[0],
            &Coordinate::flat(at),
            [0; 2],
        )
        .as_vec4()
        .to_array();
        tally.add(judge.judge(&query, answer));
    }
    Row::new(&device, variant, tally)
}

#[test]
fn a_device_that_does_as_the_oracle_is_within_and_one_half_a_texel_off_is_outside() {
    for &class in FormatClass::ALL {
        for filter in [Filter::Nearest, Filter::Linear] {
            for &address in Address::ALL {
                let variant = variant(address, filter, class);
                for driver in [LAVAPIPE, "another"] {
                    let label = variant.label();
                    assert_eq!(row(driver, &variant, 0.0).verdict, Verdict::Within, "{label}");
                    assert_eq!(row(driver, &variant, 0.5).verdict, Verdict::Outside, "{label}");
                    assert_eq!(row(driver, &variant, -0.5).verdict, Verdict::Outside, "{label}");
                }
            }
        }
    }
}

/// A tally of one look-up that is this far beyond the declared precision.
fn tally(beyond: f64, weights: Option<WeightBits>) -> Tally {
    let mut tally = Tally { weights, ..Default::default() };
    tally.add(Judgement { error: beyond, beyond, right: beyond == 0.0 });
    tally
}

#[test]
fn known_faults_hold_for_their_driver_their_variants_and_their_extent() {
    let linear = variant(Address::Repeat, Filter::Linear, FormatClass::Unorm8);
    let verdict =
        |driver, variant: &Variant, beyond| Row::new(&device(driver), variant, tally(beyond, None)).verdict;
    assert_eq!(verdict(LAVAPIPE, &linear, 0.0035), Verdict::KnownFault);
    assert_eq!(verdict(LAVAPIPE, &linear, 0.0), Verdict::Within);
    assert_eq!(verdict(LAVAPIPE, &linear, 0.006), Verdict::Outside);
    assert_eq!(verdict(LAVAPIPE, &linear, f64::INFINITY), Verdict::Outside);
    assert_eq!(verdict("another", &linear, 0.0035), Verdict::Outside);
    for other in [
        variant(Address::MirroredRepeat, Filter::Linear, FormatClass::Unorm8),
        variant(Address::Repeat, Filter::Nearest, FormatClass::Unorm8),
        variant(Address::Repeat, Filter::Linear, FormatClass::Srgb8),
        variant(Address::Repeat, Filter::Linear, FormatClass::Float32),
        Variant { reader: Reader::ShaderBuffer, ..linear },
        Variant { scale: Scale::Levels, ..variant(Address::Repeat, Filter::Nearest, FormatClass::Unorm8) },
    ] {
        assert_eq!(verdict(LAVAPIPE, &other, 0.0035), Verdict::Outside, "{}", other.label());
    }
}

#[test]
fn weights_coarser_than_declared_are_outside_whatever_the_driver() {
    let linear = variant(Address::Repeat, Filter::Linear, FormatClass::Unorm8);
    for (bits, expected) in [(6, Verdict::Outside), (7, Verdict::Outside), (8, Verdict::Within)] {
        let weights = Some(WeightBits { bits, at_least: false });
        assert_eq!(Row::new(&device(LAVAPIPE), &linear, tally(0.0, weights)).verdict, expected);
    }
}

#[test]
fn answers_that_are_no_numbers_are_wrong() {
    let variant = variant(Address::ClampToEdge, Filter::Linear, FormatClass::Float32);
    let scene = pairs(
        vec![texture(8, 6, variant.format, variant.class.color_space(), 5)],
        &[variant.spec],
        &[(0, 0)],
    );
    let scene = scene.unwrap();
    let judge = Judge::new(&scene, Precision::declared(&device("x")));
    for odd in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let found = judge.judge(&query(&scene, 0, [0.3, 0.3]), [odd; 4]);
        assert!(!found.right && found.beyond.is_infinite(), "{odd}: {found:?}");
    }
}

#[test]
fn weight_bits_are_those_of_the_quantiser() {
    let weights = || (0..=RAMP_STEPS).map(|k| f64::from(k) / f64::from(RAMP_STEPS));
    for bits in 3..=14u32 {
        let steps = f64::from(bits).exp2();
        let exactly = WeightBits { bits, at_least: false };
        let floored = weights().map(|w| ((w * steps).floor() / steps) as f32);
        assert_eq!(weight_bits(floored), exactly, "truncated weights");
        let rounded = weights().map(|w| ((w * steps).round() / steps) as f32);
        assert_eq!(weight_bits(rounded), exactly, "rounded weights");
        let stored = weights().map(|w| ((w * (steps - 1.0)).round() / (steps - 1.0)) as f32);
        assert_eq!(weight_bits(stored), exactly, "results rounded to normalized integers");
    }
    assert_eq!(weight_bits(weights().map(|w| w as f32)), WeightBits { bits: 16, at_least: true });
    assert_eq!(weight_bits(weights().map(|_| 0.5)).bits, 0);
}

#[test]
fn the_ramp_runs_from_one_texel_to_the_other_in_equal_exact_steps() {
    for &class in FormatClass::ALL {
        for (format, &axis) in class.formats().into_iter().flat_map(|f| Axis::ALL.iter().map(move |a| (f, a)))
        {
            let spec = SamplerSpec::default();
            let texture = ramp_texture(axis, format, class.color_space());
            let scene = pairs(vec![texture], &[spec], &[(0, 0)]).unwrap();
            for (k, uv) in ramp(axis, 1024).enumerate() {
                let uv = uv_of(&query(&scene, 0, uv));
                let value = sample_texture(
                    &scene,
                    &scene.records.textures[0],
                    &scene.records.samplers[0],
                    &Coordinate::flat(uv),
                    [0; 2],
                );
                assert_eq!(value.x, k as f64 / 1024.0, "{format} along {axis} at step {k}");
            }
        }
    }
}

#[test]
fn the_table_has_every_sampler_with_every_class_and_each_group_meets_all_sizes_and_channels() {
    let all = sampler_variants(true);
    assert_eq!(all.len(), SamplerSpec::all().count() * 2 * FormatClass::ALL.len());
    let labels: BTreeSet<String> =
        all.iter().map(|v| format!("{} {} {}", v.spec.label(), v.scale, v.class)).collect();
    assert_eq!(labels.len(), all.len());
    let mut groups: BTreeMap<String, Vec<&Variant>> = BTreeMap::new();
    for v in &all {
        let [a, b] = v.spec.address;
        groups.entry(format!("{a}/{b} {} {} {}", v.scale, v.filter(), v.class)).or_default().push(v);
    }
    assert_eq!(groups.len(), 25 * 2 * 2 * 4);
    for (label, group) in groups {
        let sizes: BTreeSet<[u32; 3]> = group.iter().map(|x| x.size).collect();
        let formats: BTreeSet<&str> = group.iter().map(|x| x.format.name()).collect();
        assert_eq!((sizes.len(), formats.len()), (6, 3), "{label}");
    }
    let borders: BTreeSet<String> = all.iter().map(|v| format!("{:?}", v.spec.border_color)).collect();
    assert_eq!(borders.len(), 4);
    for reader in [Reader::ShaderBuffer, Reader::ShaderImage] {
        assert_eq!(shader_variants(reader, 0).len(), 25 * 3 * 12);
    }
}

#[test]
fn a_minified_variant_asks_the_device_for_level_0_by_the_minification_filter() {
    let split = SamplerSpec { mag: Filter::Nearest, min: Filter::Linear, ..Default::default() };
    let magnified = Variant { spec: split, ..variant(Address::Repeat, Filter::Linear, FormatClass::Unorm8) };
    let minified = Variant { scale: Scale::Minified, ..magnified };
    assert_eq!([magnified, minified].map(|v| v.filter()), [Filter::Nearest, Filter::Linear]);
    assert_eq!([magnified, minified].map(|v| v.asked_sampler().mag), [Filter::Nearest, Filter::Linear]);
    assert_eq!(magnified.device_sampler(), split);
    let bound = minified.device_sampler();
    assert!(bound.min_lod > 0.0 && bound.min_lod < 0.25, "{bound:?}");
    assert_eq!(SamplerSpec { min_lod: 0.0, ..bound }, split);
}

#[test]
fn the_text_names_what_is_outside_and_strictness_decides_about_known_faults() {
    let report = |beyond: f64, weights| {
        let device = device(LAVAPIPE);
        let linear = variant(Address::Repeat, Filter::Linear, FormatClass::Unorm8);
        let missing = [variant(Address::MirrorClampToEdge, Filter::Linear, FormatClass::Unorm8)];
        ConformanceReport::new(
            &device,
            vec![Row::new(&device, &linear, tally(beyond, weights))],
            &missing,
            1.0,
        )
    };
    let coarse = Some(WeightBits { bits: 6, at_least: false });
    let (sound, known, broken) = (report(0.0, None), report(0.0035, None), report(0.1, None));
    let blunt = report(0.0, coarse);
    assert_eq!([&sound, &known, &broken, &blunt].map(|r| r.passes(false)), [true, true, false, false]);
    assert_eq!([&sound, &known, &broken, &blunt].map(|r| r.passes(true)), [true, false, false, false]);
    for (report, expected) in [
        (&sound, "1 within, 0 with a known fault, 0 outside, 1 not offered"),
        (&known, "known fault (1 variant): lavapipe filters"),
        (&broken, "outside: sampler 2d repeat/repeat mag=linear"),
        (&broken, "1 of 1 wrong, worst 1.0e-1"),
        (&blunt, "weights of 6 bits, 8 declared"),
    ] {
        assert!(text(report).contains(expected), "{expected}\n{}", text(report));
    }
}

#[test]
fn the_text_has_one_line_for_address_modes_that_fared_alike() {
    let device = device(LAVAPIPE);
    let row = |address, beyond| {
        Row::new(&device, &variant(address, Filter::Linear, FormatClass::Unorm8), tally(beyond, None))
    };
    let rows = [Address::Repeat, Address::ClampToEdge, Address::ClampToBorder].map(|a| row(a, 0.0));
    let lines = |rows: &[Row]| {
        let lines = lines(rows).into_iter();
        lines.map(|l| (l.address, l.variants, l.wrong, l.verdict)).collect::<Vec<_>>()
    };
    assert_eq!(lines(&rows), [("all 3 pairs".into(), 3, 0, Verdict::Within)]);
    let mixed = [rows[0].clone(), row(Address::ClampToEdge, 0.0035), rows[2].clone()];
    assert_eq!(
        lines(&mixed),
        [
            ("2 pairs".into(), 2, 0, Verdict::Within),
            ("clamp-to-edge/clamp-to-edge".into(), 1, 1, Verdict::KnownFault)
        ]
    );
}
