//! The level that is read, encoded in textures whose levels contain their own number. Footprints
//! are constructed from their axes, so that the correct level, log2 of an axis in texels (Williams
//! 1983), is known.

use moire::internal::lab::probe::LookupQuery;
use moire::internal::scene::model::Footprint;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::sampler_spec::{Filter, MipMode, SamplerSpec};

use super::bench::{angle, answers, axes, paint_levels, pairs_of, solid};
use crate::lookup::bench::{Rng, query};

const SIZE: u32 = 1024;
const LAST: f64 = 10.0;
const MOST: u32 = 16;

/// One look-up, the axes of its footprint in texels, and the level read.
struct Reading {
    major: f64,
    minor: f64,
    level: f64,
    how: String,
}

/// Footprints of ratio 1, and up to `ratio`, at random angles, from a fifth of a texel to the whole texture.
fn readings(min: Filter, mip: MipMode, ratio: f64, seed: u64) -> Vec<Reading> {
    let spec = SamplerSpec { min, mip, max_anisotropy: MOST, ..Default::default() };
    let texture = solid(Dimension::Two, [SIZE, SIZE, 1], TexelFormat::GreyFloat);
    let mut scene = pairs_of(Footprint::Differentials, vec![texture], &[spec], &[(0, 0)]);
    let levels = if mip == MipMode::None { 1.0 } else { LAST + 1.0 };
    assert_eq!(f64::from(scene.records.textures[0].levels), levels);
    paint_levels(&mut scene, 0);
    let mut rng = Rng::new(seed);
    let mut list = Vec::new();
    let mut queries = Vec::new();
    for i in 0..3000 {
        let minor = rng.between(-2.3, 9.5).exp2();
        let major = if i % 4 == 0 { minor } else { minor * ratio.powf(rng.unit()) };
        let (turn, roll) = (angle(&mut rng), angle(&mut rng));
        let [x, y] = axes(major, minor, turn, roll).map(|d| (d / f64::from(SIZE)).as_vec2());
        list.push((major, minor, format!("{major} by {minor} texels at {turn}, {roll}")));
        let place = [rng.unit() as f32, rng.unit() as f32];
        let (dx, dy) = ([x.x, x.y, 0.0, 0.0], [y.x, y.y, 0.0, 0.0]);
        queries.push(LookupQuery { dx, dy, seed: i, ..query(&scene, 0, place) });
    }
    let read = answers(&scene, &queries);
    let reading = |((major, minor, how), answer): ((f64, f64, String), &[f32; 4])| Reading {
        major,
        minor,
        level: answer[0].into(),
        how,
    };
    list.into_iter().zip(&read).map(reading).collect()
}

fn level_of(axis: f64) -> f64 {
    axis.log2().clamp(0.0, LAST)
}

#[test]
fn trilinear_reads_the_level_of_the_major_axis() {
    for filter in [Filter::Linear, Filter::Nearest, Filter::Cubic] {
        for r in readings(filter, MipMode::Linear, 100.0, 1) {
            let off = r.level - level_of(r.major);
            assert!(off.abs() < 1e-3, "{filter}: level {} is off by {off}, {}", r.level, r.how);
        }
    }
}

#[test]
fn nearest_mips_read_the_nearest_level_of_the_major_axis() {
    for r in readings(Filter::Nearest, MipMode::Nearest, 100.0, 2) {
        let off = r.level - level_of(r.major);
        assert!(
            r.level.fract() == 0.0 && off.abs() < 0.5 + 1e-3,
            "level {} is off by {off}, {}",
            r.level,
            r.how
        );
    }
}

#[test]
fn without_mips_level_0_is_read() {
    for r in readings(Filter::Nearest, MipMode::None, 100.0, 3) {
        assert_eq!(r.level, 0.0, "{}", r.how);
    }
}

/// By the minor axis, or if that is too short for the largest anisotropy by the corresponding fraction of the major
/// one. Never more than half a level off; with linear mips, almost exact.
#[test]
fn anisotropic_reads_the_level_of_the_minor_axis() {
    for (mip, allowed) in [(MipMode::Linear, 2e-3), (MipMode::Nearest, 0.5 + 2e-3)] {
        for r in readings(Filter::Anisotropic, mip, 100.0, 4) {
            // A ratio up to 1e-3 above an integer is treated as that integer.
            let right = level_of(r.minor.max(r.major / f64::from(MOST)));
            let right = if r.major <= 1.0 { 0.0 } else { right };
            let off = r.level - right;
            assert!(off.abs() < allowed, "{mip}: level {} is off by {off}, {}", r.level, r.how);
        }
    }
}

/// The ellipse has its size whatever level is used: that must not be coarser than the minor axis, and its texel not
/// less than half that axis.
#[test]
fn ewa_draws_its_ellipse_on_the_last_level_that_is_no_coarser_than_the_minor_axis() {
    for r in readings(Filter::Ewa, MipMode::Linear, 100.0, 5) {
        let right = level_of(r.minor.max(r.major / f64::from(MOST)));
        let right = if r.major <= 1.0 { 0.0 } else { right };
        let finer = right - r.level;
        assert!((-1e-3..1.0 + 1e-3).contains(&finer), "level {} for {right}, {}", r.level, r.how);
    }
}

/// The probability of the next level is the fraction of the level: the mean over readings is correct.
#[test]
fn stochastic_reads_whole_levels_whose_mean_is_the_level_of_the_major_axis() {
    let all = readings(Filter::Stochastic, MipMode::Linear, 100.0, 6);
    let mut sum = 0.0;
    let mut variance = 0.0;
    for r in &all {
        let right = level_of(r.major);
        let off = r.level - right;
        assert!(
            r.level.fract() == 0.0 && off.abs() < 1.0 + 1e-3,
            "level {} is off by {off}, {}",
            r.level,
            r.how
        );
        sum += off;
        variance += right.fract() * (1.0 - right.fract());
    }
    assert!(sum.abs() < 5.0 * variance.sqrt(), "{sum} over {} readings, variance {variance}", all.len()); // 5 sigma
}

/// The same on volumes and on cubes, whose footprints are changes of the direction.
#[test]
fn volumes_and_cubes_read_the_level_of_their_major_axis() {
    let spec = SamplerSpec { mip: MipMode::Linear, ..Default::default() };
    let textures = vec![
        solid(Dimension::Three, [64, 64, 64], TexelFormat::GreyFloat),
        solid(Dimension::Cube, [64, 64, 6], TexelFormat::GreyFloat),
    ];
    let mut scene = pairs_of(Footprint::Cone, textures, &[spec], &[(0, 0), (1, 0)]);
    (0..2).for_each(|t| paint_levels(&mut scene, t));
    let mut rng = Rng::new(7);
    let mut queries = Vec::new();
    let mut right = Vec::new();
    for i in 0..2000 {
        let minor = rng.between(-1.0, 4.0).exp2();
        let major = minor * rng.between(0.0, 3.0).exp2();
        let (turn, roll) = (angle(&mut rng), angle(&mut rng));
        let change = axes(major, minor, turn, roll);
        right.push(major.log2().clamp(0.0, 6.0));
        if i % 2 == 0 {
            // In the plane of v and w.
            let [dx, dy] = change.map(|d| (d / 64.0).as_vec2()).map(|d| [0.0, d.x, d.y, 0.0]);
            let place = [rng.unit(), rng.unit(), rng.unit(), 0.0].map(|x| x as f32);
            queries.push(LookupQuery { uv: place, dx, dy, ..query(&scene, 0, [0.0; 2]) });
        } else {
            // On the face -z, a side of 2 at distance 1, of a direction of any length.
            let long = rng.between(0.1, 10.0);
            let [s, t] = [0, 1].map(|_| rng.between(-0.9, 0.9));
            let uv = [-s * long, -t * long, -long, 0.0].map(|x| x as f32);
            let [dx, dy] =
                change.map(|d| d * (2.0 / 64.0 * long)).map(|d| [-d.x as f32, -d.y as f32, 0.0, 0.0]);
            queries.push(LookupQuery { uv, dx, dy, ..query(&scene, 1, [0.0; 2]) });
        }
    }
    for ((query, answer), right) in queries.iter().zip(answers(&scene, &queries)).zip(right) {
        let off = f64::from(answer[0]) - right;
        assert!(off.abs() < 1e-3, "{query:?}: level {} is off by {off}", answer[0]);
    }
}
