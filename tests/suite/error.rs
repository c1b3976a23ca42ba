//! The known error of n × n jittered sampling on the benchmark scenes, as measured by independent
//! float64 code against references of many thousand samples: a renderer that samples a wrong
//! picture, or the right one unevenly, cannot reproduce it.

use moire::internal::lab::metrics::{compare, read_picture};

use crate::stage::{packed, render, scene};
use crate::support::data;

fn meets(name: &str, spp: u32, known: f64) {
    let reference = read_picture(&data().join(format!("reference/{name}.exr"))).unwrap();
    let mut scene = scene(name);
    scene.sampling.spp = spp;
    let compared = compare(&render(&packed(scene, None)), &reference).unwrap();
    assert_eq!(compared.nan_pixels, 0);
    let ratio = compared.rmse / known;
    assert!((0.94..=1.06).contains(&ratio), "RMSE {:.4e}, known {known:.4e}", compared.rmse);
}

#[test]
fn of_s1a_at_64_samples() {
    meets("s1a", 64, 1.333e-2);
}

#[test]
fn of_s1a_at_256_samples() {
    meets("s1a", 256, 5.55e-3);
}

#[test]
fn of_s1b_at_64_samples() {
    meets("s1b", 64, 5.60e-3);
}

#[test]
fn of_s2_at_64_samples() {
    meets("s2", 64, 5.07e-4);
}
