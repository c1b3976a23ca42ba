//! Lookups over footprints: the singular values of a footprint by an exact root, the level by a
//! logarithm to 256 bits, the mean of two levels of an exact mip chain, and the Gaussian over an
//! ellipse.

use glam::{DVec2, DVec3};
use moire::internal::lab::verify::queries::{self, Rng};
use moire::internal::oracle::filter::ewa::ellipse_weight;
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::footprint_axes::{FootprintEllipse, texel_spread};
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::Footprint;
use moire::internal::schema::layout::Texture;
use moire::internal::texture::data::Dimension;
use moire::internal::texture::sampler_spec::{Filter, MipMode, SamplerSpec};
use num_traits::{Signed, Zero};

use super::numbers::{Q, approx, exp, frac, log2, modulo, q, sqrt};
use super::scenes::grey;
use super::{U, Worst};

const SIDES: [u32; 2] = [16, 8];

/// Small whole numbers: means of powers of two of them are exact in f32.
fn texels() -> Vec<f32> {
    let mut rng = Rng::new(131);
    (0..SIDES[0] * SIDES[1]).map(|_| (rng.unit() * 32.0).floor() as f32).collect()
}

fn scene(specs: &[SamplerSpec]) -> PackedScene {
    let pairs: Vec<_> = (0..specs.len()).map(|s| (0, s)).collect();
    let texture = grey(Dimension::Two, [SIDES[0], SIDES[1], 1], &texels());
    queries::pairs_over(Footprint::Differentials, vec![texture], specs, &pairs).unwrap()
}

/// Squares of the axes of J = [x y], from the eigenvalues of J Jᵀ.
fn axes(changes: [DVec2; 2]) -> [Q; 2] {
    let size = SIDES.map(|n| frac(n.into(), 1));
    let [x, y] = changes.map(|d| [q(d.x) * &size[0], q(d.y) * &size[1]]);
    let [a, c] = [0, 1].map(|i| &x[i] * &x[i] + &y[i] * &y[i]);
    let b = &x[0] * &x[1] + &y[0] * &y[1];
    let root = sqrt(&((&a - &c) * (&a - &c) + frac(4, 1) * &b * &b));
    let half = frac(1, 2);
    [(&a + &c + &root) * &half, (a + c - root) * half]
}

fn coordinate(at: DVec2, changes: [DVec2; 2]) -> Coordinate {
    Coordinate { at: at.extend(0.0), change: changes.map(|d| d.extend(0.0)) }
}

/// Round, long, and almost collinear.
fn footprints(longest: f64) -> Vec<[DVec2; 2]> {
    let mut rng = Rng::new(132);
    let mut all = Vec::new();
    for i in 0..60 {
        let vector = |rng: &mut Rng| DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
        let x = vector(&mut rng) * longest * rng.unit();
        let y = match i % 3 {
            0 => x.perp(),
            1 => vector(&mut rng) * longest * rng.unit(),
            _ => x * rng.between(-1.0, 1.0) + 1e-9 * vector(&mut rng),
        };
        all.push([x, y]);
    }
    all
}

fn spreads(read: impl Fn(&Texture, &Coordinate) -> FootprintEllipse) -> Worst {
    let scene = scene(&[SamplerSpec::default()]);
    let mut worst = Worst::default();
    for changes in footprints(0.5) {
        let [major, minor] = axes(changes);
        let got = read(&scene.records.textures[0], &coordinate(DVec2::ZERO, changes));
        // Squares and their sums: relative to the major one for both.
        let bound = 12.0 * U * approx(&major);
        worst.add(got.major, &major, bound);
        worst.add(got.minor, &minor, bound);
    }
    worst
}

#[test]
fn the_axes_of_a_footprint_are_its_singular_values() {
    spreads(texel_spread).holds("axes of footprints");
    let longer = |image: &Texture, c: &Coordinate| {
        let [x, y] = c.change.map(|d| d * DVec3::new(16.0, 8.0, 0.0));
        let major = x.length_squared().max(y.length_squared());
        FootprintEllipse { major, ..texel_spread(image, c) }
    };
    spreads(longer).fails("the longer of two vectors");
}

/// The texel of a level at whole places of the endless texture: a mean over the texels that it covers.
fn level_texel(texels: &[f32], level: u32, at: [i64; 2]) -> Q {
    let size = SIDES.map(|n| i64::from((n >> level).max(1)));
    let cover = [0, 1].map(|i| i64::from(SIDES[i]) / size[i]);
    let first = [0, 1].map(|i| at[i].rem_euclid(size[i]) * cover[i]);
    let mut sum = Q::zero();
    for y in first[1]..first[1] + cover[1] {
        for x in first[0]..first[0] + cover[0] {
            sum += q(texels[(y * i64::from(SIDES[0]) + x) as usize].into());
        }
    }
    sum / frac(cover[0] * cover[1], 1)
}

fn linear(texels: &[f32], level: u32, at: DVec2) -> Q {
    let place = |i: usize| modulo(&q(at[i]), 1) * frac((SIDES[i] >> level).max(1).into(), 1) - frac(1, 2);
    let [x, y] = [place(0), place(1)];
    let [i, j] = [&x, &y].map(|p| i64::try_from(p.floor().to_integer()).unwrap());
    let mut sum = Q::zero();
    for (di, dj) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let near = |p: &Q, n: i64| frac(1, 1) - (p - frac(n, 1)).abs();
        sum += near(&x, i + di) * near(&y, j + dj) * level_texel(texels, level, [i + di, j + dj]);
    }
    sum
}

fn two_levels(read: impl Fn(&PackedScene, &Coordinate) -> f64) -> Worst {
    let scene = scene(&[SamplerSpec { mip: MipMode::Linear, ..Default::default() }]);
    let texels = texels();
    let mut rng = Rng::new(133);
    let mut worst = Worst::default();
    for changes in footprints(1.5) {
        let at = DVec2::new(rng.between(-2.0, 2.0), rng.between(-2.0, 2.0));
        let level = (log2(&axes(changes)[0]) / frac(2, 1)).max(Q::zero()).min(frac(4, 1));
        let low = level.floor();
        let rest = &level - &low;
        let low = approx(&low) as u32;
        let [a, b] = [low, (low + 1).min(4)].map(|l| linear(&texels, l, at));
        let exact = (frac(1, 1) - &rest) * a + rest * b;
        // A level is off by 12 U / (2 ln 2) and its own rounding, a place by 4 U of 16 texels; texels to 32.
        let bound = 32.0 * U * (10.0 + 6.0 * approx(&level) + 4.0 * 16.0 + 20.0);
        worst.add(read(&scene, &coordinate(at, changes)), &exact, bound);
    }
    worst
}

fn answer(scene: &PackedScene, c: &Coordinate) -> f64 {
    sample_texture(scene, &scene.records.textures[0], &scene.records.samplers[0], c, [1, 2]).x
}

#[test]
fn between_two_levels_a_look_up_is_the_mean_of_both_by_the_exact_level() {
    two_levels(answer).holds("two levels");
    two_levels(|s, c| answer(s, &Coordinate { change: c.change.map(|d| d * 1.000_001), ..*c }))
        .fails("a millionth wider");
    two_levels(|s, c| answer(s, &Coordinate { at: c.at + 0.5 / 16.0, ..*c })).fails("half a texel");
}

/// exp(−2 r²) − exp(−2) over the texels within the ellipse of the footprint, widened by one texel's variance.
fn gaussian(texels: &[f32], at: DVec2, changes: [DVec2; 2]) -> Q {
    let size = SIDES.map(|n| frac(n.into(), 1));
    let [x, y] = changes.map(|d| [q(d.x) * &size[0], q(d.y) * &size[1]]);
    let [a, c] = [0, 1].map(|i| &x[i] * &x[i] + &y[i] * &y[i] + frac(1, 1));
    let b = &x[0] * &x[1] + &y[0] * &y[1];
    let determinant = &a * &c - &b * &b;
    let center = [0, 1].map(|i| q(at[i]) * &size[i] - frac(1, 2));
    let reach = (approx(&a).max(approx(&c))).sqrt().ceil() as i64 + 1;
    let middle = [0, 1].map(|i| i64::try_from(center[i].floor().to_integer()).unwrap());
    let (mut sum, mut weights) = (Q::zero(), Q::zero());
    let floor = exp(&frac(-2, 1));
    for j in middle[1] - reach..=middle[1] + reach {
        for i in middle[0] - reach..=middle[0] + reach {
            let (dx, dy) = (frac(i, 1) - &center[0], frac(j, 1) - &center[1]);
            let squared = (&c * &dx * &dx - frac(2, 1) * &b * &dx * &dy + &a * &dy * &dy) / &determinant;
            if squared <= frac(1, 1) {
                let weight = exp(&(squared * frac(-2, 1))) - &floor;
                sum += &weight * level_texel(texels, 0, [i, j]);
                weights += weight;
            }
        }
    }
    sum / weights
}

fn ellipses(read: impl Fn(&PackedScene, &Coordinate) -> f64) -> Worst {
    let ewa =
        SamplerSpec { min: Filter::Ewa, max_anisotropy: 16, mip: MipMode::Linear, ..Default::default() };
    let scene = scene(&[ewa]);
    let texels = texels();
    let mut rng = Rng::new(134);
    let mut worst = Worst::default();
    for _ in 0..12 {
        // Between one and two texels wide, so that level 0 is read, and up to 8 long.
        let [long, wide] = [rng.between(2.0, 8.0), rng.between(1.05, 1.95)];
        let turn = DVec2::from_angle(rng.between(0.0, std::f64::consts::TAU));
        let size = DVec2::new(16.0, 8.0);
        let changes = [turn * long / size, turn.perp() * wide / size];
        let at = DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
        // The Gaussian is a polynomial within WEIGHT of it, under a mean weight of about 0.3; texels to 32.
        let bound = 32.0 * 2.0 * WEIGHT / 0.3;
        worst.add(read(&scene, &coordinate(at, changes)), &gaussian(&texels, at, changes), bound);
    }
    worst
}

/// What the polynomial of the weight is off by: most where the weight is greatest, 0.8642 for 1 − exp(−2).
const WEIGHT: f64 = 5.2e-4;

#[test]
fn an_ellipse_is_weighted_by_the_gaussian() {
    let mut worst = Worst::default();
    for k in 0..=256 {
        let squared = frac(k, 256);
        let exact = exp(&(&squared * frac(-2, 1))) - exp(&frac(-2, 1));
        worst.add(ellipse_weight(approx(&squared)), &exact, WEIGHT);
    }
    worst.holds("the weight's polynomial");
    ellipses(answer).holds("ellipses");
    ellipses(|s, c| answer(s, &Coordinate { at: c.at + 0.5 / 16.0, ..*c })).fails("half a texel");
    ellipses(|s, c| answer(s, &Coordinate { change: c.change.map(|d| d * 1.2), ..*c }))
        .fails("a fifth wider");
    ellipses(|s, c| answer(s, &Coordinate { change: c.change.map(|d| DVec3::new(d.x, -d.y, 0.0)), ..*c }))
        .fails("turned the other way");
}
