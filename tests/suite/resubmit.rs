//! A driver compiles a shader once, not at each submission: pictures of a few pixels take a small
//! fraction of the time in which their pipelines were built. lavapipe needs a workaround for this
//! (`glsl/shared/opaque.glsl`).

use std::time::Instant;

use moire::internal::core::progress::NoProgress;
use moire::internal::gpu::{DeviceKind, DeviceSelect, Gpu};
use moire::internal::lab::probe::MipProbe;
use moire::internal::render::{Session, Tuning};
use moire::internal::scene::model::{Algorithm, Pattern};
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};

use crate::stage::{device_name, packed, small};
use crate::support::untested;

/// Recompiling takes a third or more of the time of building a pipeline; without it, a hundredth.
const MOST: f64 = 0.1;

/// A separate device: tests that share one wait for each other, which would look like compiling, and each keeps the
/// pipelines that it has built. Only CPU drivers compile for so long that times show anything.
fn cpu() -> Option<Gpu> {
    let gpu = Gpu::open(&DeviceSelect::parse(&device_name()).unwrap()).unwrap();
    if gpu.info().kind != DeviceKind::Cpu {
        untested("whether shaders are compiled once: the device is no CPU");
        return None;
    }
    Some(gpu)
}

/// Returns the least of several measurements: other tests share the cores.
fn least<T>(of: impl IntoIterator<Item = T>, act: impl FnMut(T) -> f64) -> f64 {
    of.into_iter().map(act).fold(f64::INFINITY, f64::min)
}

/// Returns the share of the time to build, `first`, that another submission takes: the least of many, because a machine
/// may be busy for seconds. A driver that compiles again is never below [`MOST`], however often it is tried.
fn share_of(first: f64, mut again: impl FnMut() -> f64) -> f64 {
    let mut shortest = f64::INFINITY;
    for _ in 0..500 {
        shortest = f64::min(shortest, again());
        if shortest < MOST * first {
            break;
        }
    }
    shortest / first
}

fn seconds(act: impl FnOnce()) -> f64 {
    let clock = Instant::now();
    act();
    clock.elapsed().as_secs_f64()
}

/// Seconds to render once more, over those to build the pipelines.
fn share(name: &str, algorithm: Algorithm, keep_everything: bool) -> Option<f64> {
    let mut scene = small(name, 8, 16);
    scene.sampling.algorithm = algorithm;
    scene.sampling.pattern = Pattern::SobolOwen;
    scene.sampling.shared = false;
    let scene = packed(scene, None);
    let gpus = [cpu()?, cpu()?];
    let open = |gpu| Session::open(gpu, scene.clone(), keep_everything, &Tuning::default()).unwrap();
    // Beams build the pipeline of pixels left to samples when they find one.
    let build =
        least(&gpus, |gpu| open(gpu).prepare().unwrap().render(&NoProgress).unwrap().1.seconds.compile);
    let session = open(&gpus[0]);
    let prepared = session.prepare().unwrap();
    drop(prepared.render(&NoProgress).unwrap());
    Some(share_of(build, || seconds(|| drop(prepared.render(&NoProgress).unwrap()))))
}

fn check(algorithm: Algorithm, names: &[&str]) {
    for name in names {
        let Some(share) = share(name, algorithm, false) else { return };
        assert!(share < MOST, "{name} by {algorithm}: {share:.3} of the time to build it");
    }
}

#[test]
fn tiles_are_compiled_once() {
    check(Algorithm::Samples, &["s1a", "s2", "lecture"]);
}

#[test]
fn jobs_are_compiled_once() {
    check(Algorithm::Adaptive, &["s1a", "s2", "lecture"]);
}

#[test]
fn beams_are_compiled_once() {
    check(Algorithm::Beam, &["s1a", "beams", "lecture"]);
}

#[test]
fn cones_are_compiled_once() {
    check(Algorithm::Cone, &["beams", "lecture"]);
}

#[test]
fn a_pipeline_with_everything_is_compiled_once() {
    let Some(share) = share("s1a", Algorithm::Samples, true) else { return };
    assert!(share < MOST, "{share:.3} of the time to build it");
}

#[test]
fn passes_of_a_pyramid_are_compiled_once() {
    let (Some(first), Some(second)) = (cpu(), cpu()) else { return };
    let texture = TextureData {
        name: "grey".into(),
        dimension: Dimension::Two,
        // Few passes, as a driver that keeps machine code builds theirs in milliseconds.
        width: 8,
        height: 8,
        depth: 1,
        format: TexelFormat::Grey8,
        color_space: ColorSpace::Linear,
        file_channels: 1,
        texels: vec![128; 8 * 8],
        stored_levels: Vec::new(),
    };
    let mut probes = [MipProbe::new(&first), MipProbe::new(&second)];
    let make = |probe: &mut MipProbe| seconds(|| drop(probe.make(&texture).unwrap()));
    let first = least(&mut probes, make);
    let share = share_of(first, || make(&mut probes[0]));
    assert!(share < MOST, "{share:.3} of the {first} s of the first time");
}
