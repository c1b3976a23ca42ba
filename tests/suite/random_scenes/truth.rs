//! The float64 path tracer's value of a pixel with its uncertainty, against which other methods are
//! compared.

use glam::DVec3;
use moire::internal::oracle::render::sample;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::{Algorithm, Footprint, Pattern, Scene};

use crate::stage::packed;

/// Strata per axis at first, and if those leave a doubt.
const FEW: u32 = 8;
const MANY: u32 = 64;

/// With normal noise 1 value in 370 exceeds this at first, 1 in 1.7 million at last.
const DOUBT: f64 = 3.0;
const SURE: f64 = 5.0;

/// A part of the pixel this large, over the number of strata, is missed by two samples in each of them
/// once in a million: e^(-2 · 7).
const UNSEEN: f64 = 7.0;

pub struct Truth {
    few: PackedScene,
    many: PackedScene,
    /// The brightest value that a part which no sample saw may have.
    brightest: f64,
}

/// Mean of a pixel, and its noise, by channel.
struct Mean {
    value: DVec3,
    sigma: DVec3,
    brightest: f64,
}

/// Two samples in each stratum: half their difference is the deviation of their mean.
fn mean(scene: &PackedScene, place: [u32; 2]) -> Mean {
    let (mut sum, mut squares, mut brightest) = (DVec3::ZERO, DVec3::ZERO, 0.0f64);
    for s in 0..scene.samples {
        let [a, b] = [0, 1].map(|half| sample(scene, &scene.header, place, half, s).0);
        sum += 0.5 * (a + b);
        squares += 0.25 * (a - b) * (a - b);
        brightest = brightest.max(a.max_element()).max(b.max_element());
    }
    let strata = f64::from(scene.samples);
    let sigma = DVec3::from_array((squares / (strata * strata)).to_array().map(f64::sqrt));
    Mean { value: sum / strata, sigma, brightest }
}

impl Truth {
    pub fn of(scene: &Scene) -> Truth {
        let with = |strata: u32| {
            let mut scene = scene.clone();
            scene.sampling.algorithm = Algorithm::Samples;
            scene.sampling.pattern = Pattern::Stratified;
            scene.sampling.footprint = Footprint::None;
            scene.sampling.shared = false;
            scene.sampling.spp = strata * strata;
            packed(scene, None)
        };
        let few = with(FEW);
        let [width, height] = few.header.film_size.to_array();
        let pixels = (0..width * height).step_by(7).map(|i| [i % width, i / width]);
        let brightest = pixels.map(|place| mean(&few, place).brightest).fold(0.0, f64::max);
        Truth { few, many: with(MANY), brightest }
    }

    /// Returns the excess of an error over noise and `own`, the known error of its method.
    pub fn excess(&self, place: [u32; 2], value: DVec3, own: f64) -> f64 {
        let beyond = |mean: &Mean, sigmas: f64, unseen: f64| {
            let allowed = sigmas * mean.sigma + unseen * self.brightest.max(mean.brightest) + own;
            ((value - mean.value).abs() - allowed).max_element()
        };
        if !value.is_finite() {
            return f64::INFINITY;
        }
        if beyond(&mean(&self.few, place), DOUBT, 0.0) <= 0.0 {
            return 0.0;
        }
        beyond(&mean(&self.many, place), SURE, UNSEEN / f64::from(MANY * MANY)).max(0.0)
    }
}
