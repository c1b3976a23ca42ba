//! Fresnel's equations and Snell's law to 256 bits: at right angles, grazing and on both sides of the critical
//! angle, for refractive indices a ten-millionth from 1, and of a thousand.

use std::sync::OnceLock;

use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::bsdf::dielectric::{fresnel_dielectric, refracted};
use moire::internal::oracle::bsdf::mirror::mirrored;
use num_traits::Signed;

use super::numbers::{Q, V, approx, direction, frac, q, sqrt, v};
use super::{U, Worst};

const AXES: [DVec3; 3] = [DVec3::X, DVec3::NEG_Y, DVec3::Z];

/// (direction, normal against it, ratio of indices in front over behind).
fn cases() -> Vec<(DVec3, DVec3, f64)> {
    let mut rng = Rng::new(101);
    let mut all = Vec::new();
    for index in [1.0 + 1e-7, 1.0 + 1e-15, 1.333, 1.5, 2.4, 100.0, 1e3] {
        for ratio in [1.0 / index, index] {
            for (i, &n) in AXES.iter().enumerate() {
                let side = AXES[(i + 1) % 3];
                let mut add = |cosine: f64, sine: f64| {
                    all.push(((sine * side - cosine * n) * rng.between(0.3, 3.0), n, ratio))
                };
                add(1.0, 0.0);
                for k in [0, 1, 2, 3, 5, 7, 9, 11] {
                    // From steep to grazing, and around the critical angle.
                    let small = 10f64.powi(-k);
                    add(small, 1.0);
                    add(1.0, small);
                    let sine: f64 = (1.0 / ratio) * (1.0 + [small, -small][k as usize % 2] * 0.1);
                    if sine < 1.0 {
                        add((1.0 - sine * sine).sqrt(), sine);
                    }
                }
                all.push((direction(&mut rng), n, ratio));
            }
        }
    }
    all.into_iter().map(|(d, n, ratio)| (d, if d.dot(n) > 0.0 { -n } else { n }, ratio)).collect()
}

struct Exact {
    share: Q,
    bound: f64,
    way: V,
    way_bound: f64,
}

/// Returns `None` if rounding decides between total reflection and refraction.
fn exact(d: DVec3, n: DVec3, ratio: f64) -> Option<Exact> {
    let (d, n, eta) = (v(d), v(n), q(ratio));
    let size = d.length();
    let before = d.dot(&n).abs() / &size;
    let under = frac(1, 1) - &eta * &eta * (frac(1, 1) - &before * &before);
    // 1 less a sine with 6 roundings.
    let e_under = 8.0 * U * (1.0 + (1.0 - approx(&under)).max(0.0));
    if approx(&under).abs() <= 2.0 * e_under {
        return None;
    }
    if !under.is_positive() {
        return Some(Exact { share: frac(1, 1), bound: 0.0, way: d, way_bound: 0.0 });
    }
    let behind = sqrt(&under);
    let e_behind = e_under / (2.0 * approx(&behind)) + U * approx(&behind);
    let wave = |a: Q, b: Q, e_a: f64, e_b: f64| {
        let sum = approx(&(&a + &b));
        let r = (&a - &b) / (&a + &b);
        // Of (a − b) / (a + b), by its derivatives, and 4 roundings.
        let e = 2.0 * (approx(&b) * e_a + approx(&a) * e_b) / (sum * sum) + 4.0 * U * approx(&r).abs();
        (r, e)
    };
    let (c, k) = (approx(&before), approx(&behind));
    let (s, e_s) = wave(&eta * &before, behind.clone(), 4.0 * U * ratio * c, e_behind);
    let (p, e_p) = wave(before.clone(), &eta * &behind, 4.0 * U * c, ratio * e_behind + 2.0 * U * ratio * k);
    let bound = approx(&s).abs() * e_s + approx(&p).abs() * e_p + 0.5 * (e_s * e_s + e_p * e_p);
    let share = (&s * &s + &p * &p) / frac(2, 1);
    let along = d.minus(&n.times(&d.dot(&n))).times(&eta);
    let way_bound = approx(&size) * (6.0 * U * approx(&along.length()) / approx(&size) + e_behind + 2.0 * U);
    let way = along.minus(&n.times(&(&behind * &size)));
    Some(Exact { bound: bound + 2.0 * U * approx(&share), share, way, way_bound })
}

/// The bound of every comparison.
type Known = ((DVec3, DVec3, f64), Option<Exact>);

fn known() -> &'static [Known] {
    static KNOWN: OnceLock<Vec<Known>> = OnceLock::new();
    KNOWN.get_or_init(|| cases().into_iter().map(|case| (case, exact(case.0, case.1, case.2))).collect())
}

fn compare(
    share: impl Fn(DVec3, DVec3, f64) -> f64,
    shape_operator: impl Fn(DVec3, DVec3, f64) -> DVec3,
) -> (Worst, u32) {
    let mut worst = Worst::default();
    let mut open = 0;
    for ((d, n, ratio), exact) in known() {
        let (d, n, ratio) = (*d, *n, *ratio);
        let Some(exact) = exact else {
            open += 1;
            continue;
        };
        worst.add(share(d, n, ratio), &exact.share, exact.bound);
        let way = shape_operator(d, n, ratio);
        for k in 0..3 {
            worst.add(way[k], &exact.way.0[k], exact.way_bound);
        }
    }
    (worst, open)
}

#[test]
fn fresnel_and_snell_are_exact_to_their_condition() {
    let (worst, open) = compare(fresnel_dielectric, refracted);
    worst.holds("glass");
    println!("glass: {open} directions within rounding of the critical angle");
    assert!(open < 100, "{open} were not decided");
}

#[test]
fn planted_errors_of_glass_are_told() {
    compare(|d, n, r| fresnel_dielectric(d, n, 1.0 / r), refracted).0.fails("indices the wrong way round");
    compare(|d, n, r| fresnel_dielectric(d, n, r) * (1.0 + 1e-12), refracted)
        .0
        .fails("a trillionth more is mirrored");
    compare(fresnel_dielectric, |d, n, r| refracted(d, n, r).reflect(n)).0.fails("a ray that stays in front");
    compare(fresnel_dielectric, |d, n, r| refracted(d, n, r * (1.0 + 1e-12)))
        .0
        .fails("a trillionth more of index");
    // Schlick's approximation.
    let schlick = |d: DVec3, n: DVec3, r: f64| {
        let zero = ((1.0 - r) / (1.0 + r)).powi(2);
        zero + (1.0 - zero) * (1.0 - d.dot(n).abs() / d.length()).powi(5)
    };
    compare(schlick, refracted).0.fails("an approximation");
}

#[test]
fn mirrors_reflect_about_the_exact_normal() {
    let mut rng = Rng::new(102);
    let mut worst = Worst::default();
    for _ in 0..100 {
        let (d, n) = (direction(&mut rng), direction(&mut rng));
        let unit = v(n).unit();
        let exact = v(d).minus(&unit.times(&(frac(2, 1) * v(d).dot(&unit))));
        for k in 0..3 {
            worst.add(mirrored(d, n)[k], &exact.0[k], 16.0 * U); // n's 3 roundings twice, and 6 more
        }
    }
    worst.holds("mirrors");
}
