//! The pixels of a picture that is sampled to a goal, kept by the device and by the host: from the same decisions both
//! estimate the same errors, place the same samples and draw audits that represent the whole picture.

use moire::internal::core::film::Film;
use moire::internal::core::progress::NoProgress;
use moire::internal::integrators::adaptive::HostPixels;
use moire::internal::pack::PackedScene;
use moire::internal::render::{DeviceBackend, EstimateChoice, Session, Tuning};
use moire::internal::sampling::{
    Aim, AuditPlan, Audited, Backend, Estimated, PilotRun, Pixels, Plan, Raises,
};
use moire::internal::scene::model::Algorithm;
use moire::internal::schema::layout::{BATCH_APART, BATCH_STREAM_SHIFT};

use super::{rmse, with};
use crate::stage::{device, small};

/// Does the same to the pixels of a scene, kept by a device and by the host. Returns both results.
fn both<T>(scene: &PackedScene, act: impl Fn(&mut dyn Pixels) -> T) -> [T; 2] {
    [EstimateChoice::Device, EstimateChoice::Host].map(|estimates| {
        let gpu = device();
        let tuning = Tuning { estimates, ..Tuning::default() };
        let session = Session::open(&gpu, scene.clone(), false, &tuning).unwrap();
        let prepared = session.prepare().unwrap();
        let mut backend = DeviceBackend::new(&prepared).unwrap();
        let size = scene.header.film_size.to_array();
        if estimates == EstimateChoice::Device {
            assert!(backend.keeps_pixels(), "the device does not keep the pixels");
            let mut pixels = backend.kept_pixels().unwrap().unwrap();
            act(&mut *pixels)
        } else {
            assert!(!backend.keeps_pixels());
            act(&mut HostPixels::new(&mut backend, size))
        }
    })
}

fn scenes() -> Vec<(&'static str, PackedScene)> {
    ["bench/s1a", "lecture", "models", "lights", "filters"]
        .map(|name| (name, with(small(name, 100, 4), Algorithm::Adaptive, 64)))
        .into()
}

fn sampled(pixels: &mut dyn Pixels) -> Estimated {
    pixels.sample(&NoProgress).unwrap();
    pixels.estimate(false).unwrap()
}

const ROUNDING: f64 = f32::EPSILON as f64 / 16.0;

fn plan(aim: Aim) -> Plan {
    Plan { aim, exponent: 1.4, growth: 16.0, most: 1 << 16, explores: false }
}

/// Returns what differs by more than a part of it, and more than rounding can: the variance of a mean of 16 samples of about 1
/// is the difference of two numbers of about 1/16 in f32.
fn differences(a: &[f64], b: &[f64], part: f64) -> Vec<String> {
    assert_eq!(a.len(), b.len());
    let differs = |(_, (a, b)): &(usize, (&f64, &f64))| {
        (*a - *b).abs() > part * a.abs().max(b.abs()) + ROUNDING || a.is_nan() != b.is_nan()
    };
    let told = |(i, (a, b))| format!("{i}: {a:e} and {b:e}");
    a.iter().zip(b).enumerate().filter(differs).map(told).collect()
}

fn numbers(seen: &Estimated) -> [f64; 7] {
    let Estimated { taken, mse, deviation, variance, resolved, least, most, .. } = *seen;
    [taken, mse, deviation, variance, resolved as f64, f64::from(least), f64::from(most)]
}

#[test]
fn planted_differences_are_found() {
    assert_eq!(differences(&[1.0, 2.0, 0.0], &[1.0, 2.0, 0.0], 1e-6), Vec::<String>::new());
    assert_eq!(differences(&[1.0, 2.0], &[1.0, 2.1], 1e-2).len(), 1);
    assert_eq!(differences(&[1.0, f64::NAN], &[1.0, 0.0], 1e-2).len(), 1);
    assert_eq!(differences(&[1.0, 1e-7], &[1.0, 0.0], 1e-2).len(), 1);
    assert_eq!(differences(&[1.0, 1e-9], &[1.0, 0.0], 1e-2), Vec::<String>::new());
}

#[test]
fn device_and_host_estimate_the_same_variances() {
    for (name, scene) in scenes() {
        let [device, host] = both(&scene, |pixels| {
            pixels.plan_first(8).unwrap();
            let seen = sampled(pixels);
            let (counts, variances) = pixels.counts_and_variances().unwrap();
            (numbers(&seen), counts, variances.into_iter().map(f64::from).collect::<Vec<_>>())
        });
        assert_eq!(differences(&device.0, &host.0, 1e-4), Vec::<String>::new(), "{name}");
        assert_eq!(device.1, host.1, "{name}: samples");
        assert_eq!(differences(&device.2, &host.2, 1e-3), Vec::<String>::new(), "{name}: variances");
    }
}

#[test]
fn device_and_host_place_the_same_samples() {
    for (name, scene) in scenes() {
        let [device, host] = both(&scene, |pixels| {
            pixels.plan_first(8).unwrap();
            let first = sampled(pixels);
            // To a fifth of the error, then as many again.
            let planned = pixels.plan(&plan(Aim::Mse(0.04 * first.variance))).unwrap();
            let second = sampled(pixels);
            let (counts, _) = pixels.counts_and_variances().unwrap();
            let more = pixels.plan(&plan(Aim::Samples(2.0 * second.taken))).unwrap();
            let third = sampled(pixels);
            (planned, counts, second, more, third)
        });
        assert!(device.0.gains && host.0.gains && device.3.gains, "{name}");
        // Of a bin, the device knows the middle.
        assert_eq!(differences(&[device.0.cost], &[host.0.cost], 0.03), Vec::<String>::new(), "{name}");
        let other = device.1.iter().zip(&host.1).filter(|(a, b)| a != b).count();
        assert!(other * 20 < device.1.len(), "{name}: {other} of {} counts differ", device.1.len());
        assert_eq!(differences(&numbers(&device.2)[..1], &numbers(&host.2)[..1], 0.05), Vec::<String>::new());
        assert_eq!(differences(&[device.3.cost], &[host.3.cost], 0.05), Vec::<String>::new(), "{name}");
        let taken = device.4.taken / device.2.taken;
        assert!((1.7..2.4).contains(&taken), "{name}: {taken} times as many samples, not twice");
    }
}

/// Long batches, which the device divides into parts, and pixels that gain nothing.
#[test]
fn the_film_is_that_of_the_host() {
    for (name, scene) in scenes() {
        let size = scene.header.film_size.to_array();
        let [device, host] = both(&scene, |pixels| {
            pixels.plan_first(8).unwrap();
            let first = sampled(pixels);
            let goal = Plan { growth: 64.0, ..plan(Aim::Mse(0.003 * first.variance)) };
            pixels.plan(&goal).unwrap();
            sampled(pixels);
            let mut film = Film::new(size[0], size[1], 0);
            pixels.write_to(&mut film).unwrap();
            (film, pixels.counts_and_variances().unwrap().0)
        });
        assert!(*device.1.iter().max().unwrap() > 256, "{name}: no long batch");
        // A pixel of another count differs by its noise.
        let same = |film: &Film| {
            let pixels = film.pixels.iter().zip(device.1.iter().zip(&host.1));
            let pixels = pixels.map(|(p, (a, b))| if a == b { *p } else { [0.0; 3] }).collect();
            Film { pixels, ..film.clone() }
        };
        let error = rmse(&same(&device.0), &same(&host.0));
        assert!(error < 2e-6, "{name}: {error:e}");
    }
}

/// More parts of batches than there is room for at once.
#[test]
fn parts_are_taken_in_rounds() {
    let scene = with(small("bench/s1a", 24, 4), Algorithm::Adaptive, 64);
    let size = scene.header.film_size.to_array();
    let pixels_of = f64::from(size[0]) * f64::from(size[1]);
    let [device, host] = both(&scene, |pixels| {
        pixels.plan_first(8).unwrap();
        sampled(pixels);
        // All pixels vary alike, so that all have as many samples.
        let raises = Raises { around: Vec::new(), floors: Some(vec![1e6; 18]) };
        pixels.raise(&raises).unwrap();
        let all = Plan { growth: 1e6, ..plan(Aim::Samples(6e4 * pixels_of)) };
        assert!(pixels.plan(&all).unwrap().gains);
        let seen = sampled(pixels);
        let mut film = Film::new(size[0], size[1], 0);
        pixels.write_to(&mut film).unwrap();
        (film, seen)
    });
    assert_eq!(numbers(&device.1)[5..], numbers(&host.1)[5..]);
    assert!(device.1.least > 20_000, "{:?}", device.1);
    let error = rmse(&device.0, &host.0);
    assert!(error < 2e-6, "{error:e}");
}

fn audit(pixels: &mut dyn Pixels, budget: f64) -> Vec<Audited> {
    let plan = AuditPlan { budget, start: 0.3, part: BATCH_APART | 2 << BATCH_STREAM_SHIFT };
    pixels.audit(&plan, &NoProgress).unwrap()
}

#[test]
fn audits_of_the_device_represent_the_whole_picture() {
    let mut equal = 0;
    for (name, scene) in scenes() {
        let [width, height] = scene.header.film_size.to_array();
        let [device, host] = both(&scene, |pixels| {
            pixels.plan_first(8).unwrap();
            let first = sampled(pixels);
            pixels.plan(&plan(Aim::Mse(0.05 * first.variance))).unwrap();
            sampled(pixels);
            let (counts, _) = pixels.counts_and_variances().unwrap();
            (audit(pixels, 3e5), counts)
        });
        for (who, (audited, counts)) in [("device", &device), ("host", &host)] {
            // Each draw stands for 1 / draws pixels; systematic draws miss the sum by few of the largest.
            let stands: f64 = audited.iter().map(|a| 1.0 / a.drawn.draws).sum();
            let all = f64::from(width) * f64::from(height);
            assert!((stands / all - 1.0).abs() < 0.1, "{name}, {who}: {stands} of {all} pixels");
            let taken: f64 = audited.iter().map(|a| 2.0 * f64::from(a.samples)).sum();
            assert!((1e5..3.1e5).contains(&taken), "{name}, {who}: {taken} samples");
            let right = |a: &&Audited| a.drawn.count * 2 == counts[a.drawn.pixel as usize];
            assert_eq!(audited.iter().filter(right).count(), audited.len(), "{name}, {who}");
            let mut pixels: Vec<u32> = audited.iter().map(|a| a.drawn.pixel).collect();
            pixels.sort_unstable();
            pixels.dedup();
            assert_eq!(pixels.len(), audited.len(), "{name}, {who}: a pixel is drawn twice");
        }
        // Of pixels that both drew the first samples are the same.
        let mut shared = 0;
        for a in &device.0 {
            let Some(b) = host.0.iter().find(|b| b.drawn.pixel == a.drawn.pixel) else { continue };
            shared += 1;
            if a.samples == b.samples {
                let flat = |sums: [[f32; 4]; 2]| sums.concat().into_iter().map(f64::from).collect::<Vec<_>>();
                assert_eq!(differences(&flat(a.sums), &flat(b.sums), 1e-5), Vec::<String>::new(), "{name}");
                equal += 1;
            }
        }
        assert!(shared > device.0.len() / 10, "{name}: only {shared} of {} in both", device.0.len());
    }
    assert!(equal > 100, "only {equal} pixels with the same number of samples");
}

#[test]
fn what_an_audit_found_raises_the_same_variances() {
    let (name, scene) = scenes().swap_remove(0);
    let [width, _] = scene.header.film_size.to_array();
    let raises = Raises {
        around: vec![(5 * width + 3, 2.0), (5 * width + 5, 8.0), (40 * width + 50, 1e-3)],
        floors: Some((0..18).map(|octave| 1e-3 * f32::powi(2.0, octave)).collect()),
    };
    let [device, host] = both(&scene, |pixels| {
        pixels.plan_first(8).unwrap();
        let before = sampled(pixels);
        pixels.raise(&raises).unwrap();
        let (_, variances) = pixels.counts_and_variances().unwrap();
        // Those that were raised are looked at again after the next pass.
        pixels.plan(&plan(Aim::Mse(0.1 * before.variance))).unwrap();
        sampled(pixels);
        let (counts, _) = pixels.counts_and_variances().unwrap();
        (variances.into_iter().map(f64::from).collect::<Vec<_>>(), counts)
    });
    assert_eq!(differences(&device.0, &host.0, 1e-3), Vec::<String>::new(), "{name}");
    let around = (5 * width + 4) as usize;
    assert!(device.0[around] >= 0.25 * 8.0 / 16.0, "{}", device.0[around]);
    let other = device.1.iter().zip(&host.1).filter(|(a, b)| a != b).count();
    assert!(other * 20 < device.1.len(), "{other} of {} counts differ", device.1.len());
}

#[test]
fn resolved_pixels_have_their_value_on_the_device_too() {
    let (name, scene) = scenes().swap_remove(1);
    let size = scene.header.film_size.to_array();
    let count = size[0] * size[1];
    let resolved: Vec<[f32; 4]> =
        (0..count).map(|i| [0.25, 0.5, i as f32 / count as f32, f32::from(u8::from(i % 3 == 0))]).collect();
    let [device, host] = both(&scene, |pixels| {
        pixels.plan_first(8).unwrap();
        sampled(pixels);
        let pilot = PilotRun { seconds: 1.0, pixels: (0..count).map(|i| (i, i % 2 == 0)).collect() };
        let shares = pixels.shares(&pilot, 1.4).unwrap();
        pixels.resolve(resolved.clone()).unwrap();
        let seen = pixels.estimate(false).unwrap();
        pixels.plan(&plan(Aim::Mse(0.1 * seen.variance))).unwrap();
        sampled(pixels);
        let mut film = Film::new(size[0], size[1], 0);
        pixels.write_to(&mut film).unwrap();
        (shares, numbers(&seen), film)
    });
    assert_eq!(differences(&device.0, &host.0, 1e-3), Vec::<String>::new(), "{name}: shares");
    assert_eq!(differences(&device.1, &host.1, 1e-4), Vec::<String>::new(), "{name}");
    assert_eq!(device.1[4], f64::from(count - count.div_ceil(3)));
    for (i, pixel) in device.2.pixels.iter().enumerate().filter(|(i, _)| i % 3 != 0) {
        let off = pixel.iter().zip(&resolved[i]).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-6, "{i}: {pixel:?}, not {:?}", resolved[i]);
    }
}
