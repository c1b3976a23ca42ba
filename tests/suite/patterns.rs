//! Sample patterns: positions on the device and in the oracle, the properties of each pattern,
//! spectra, errors of pixels, and `moire pattern`.

mod agree;
mod blue_noise;
mod command;
mod errors;
mod laws;
mod pictures;
mod randomness;
mod spectra;

use moire::internal::oracle::patterns::{Points, pair_points, pixel_points, sample_pair};
use moire::internal::oracle::rng::pixel_key;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Pattern;
use moire::internal::schema::layout::Header;

/// All patterns with different points in each pixel.
const SCATTERED: [Pattern; 7] = [
    Pattern::Random,
    Pattern::Stratified,
    Pattern::MultiJittered,
    Pattern::Halton,
    Pattern::SobolOwen,
    Pattern::BlueNoise,
    Pattern::NRooks,
];

fn header(pattern: Pattern, samples: u32, shared: bool, seed: u32) -> Header {
    Header {
        pattern,
        strata_side: pattern.strata_side(samples),
        samples,
        seed,
        shares_pattern: shared,
        ..Default::default()
    }
}

fn scene(pattern: Pattern, samples: u32, shared: bool, seed: u32) -> PackedScene {
    PackedScene { header: header(pattern, samples, shared, seed), samples, ..Default::default() }
}

fn points(header: &Header, pixel: [u32; 2], pair: u32) -> Points {
    let key = pixel_key(pixel, header.seed, header.shares_pattern);
    pair_points(&pixel_points(header, pixel, key), pair)
}

/// All positions of one pixel and pair in the oracle.
fn set(pattern: Pattern, samples: u32, seed: u32, pixel: [u32; 2], pair: u32) -> Vec<[u32; 2]> {
    let points = points(&header(pattern, samples, false, seed), pixel, pair);
    (0..samples).map(|s| sample_pair(&points, s)).collect()
}

/// Converts to [0, 1), at the centre of the steps of 2⁻²⁴.
fn unit(positions: &[[u32; 2]]) -> Vec<[f64; 2]> {
    positions.iter().map(|p| p.map(|x| (f64::from(x) + 0.5) / f64::from(1 << 24))).collect()
}
