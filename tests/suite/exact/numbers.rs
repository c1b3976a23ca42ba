//! Exact numbers: f64 as rationals, vectors of rationals, and irrational values (roots, angles, sines,
//! powers) as rationals within a relative 2^-256, far below anything that is compared.

use std::cell::RefCell;

use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};
use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use num_bigint::{BigInt, Sign as IntSign};
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

pub type Q = BigRational;

const BITS: usize = 256;

/// Every finite f64 is a rational.
pub fn q(x: f64) -> Q {
    Q::from_float(x).expect("a finite number")
}

pub fn frac(numerator: i64, denominator: i64) -> Q {
    Q::new(numerator.into(), denominator.into())
}

/// The nearest f64, for bounds and messages.
pub fn approx(x: &Q) -> f64 {
    x.to_f64().unwrap()
}

/// Returns |got − exact|; infinite for NaN and infinity.
pub fn off(got: f64, exact: &Q) -> f64 {
    Q::from_float(got).map_or(f64::INFINITY, |got| approx(&(got - exact).abs()))
}

/// Returns the same on a circle of that length.
pub fn modulo(x: &Q, period: i64) -> Q {
    let period = frac(period, 1);
    x - (x / &period).floor() * period
}

/// Brings `exact` to within half a period of `near`: two names of one place.
pub fn nearest_turn(exact: &Q, near: f64, period: i64) -> Q {
    if !near.is_finite() {
        return exact.clone();
    }
    let period = frac(period, 1);
    let turns = ((q(near) - exact) / &period + frac(1, 2)).floor();
    exact + turns * period
}

#[derive(Clone, Debug)]
pub struct V(pub [Q; 3]);

pub fn v(p: DVec3) -> V {
    V(p.to_array().map(q))
}

impl V {
    fn with(&self, other: &V, f: impl Fn(&Q, &Q) -> Q) -> V {
        V(std::array::from_fn(|i| f(&self.0[i], &other.0[i])))
    }

    pub fn plus(&self, other: &V) -> V {
        self.with(other, |a, b| a + b)
    }

    pub fn minus(&self, other: &V) -> V {
        self.with(other, |a, b| a - b)
    }

    pub fn times(&self, scale: &Q) -> V {
        V(std::array::from_fn(|i| &self.0[i] * scale))
    }

    pub fn dot(&self, other: &V) -> Q {
        (0..3).map(|i| &self.0[i] * &other.0[i]).sum()
    }

    pub fn cross(&self, other: &V) -> V {
        let term = |i: usize, j: usize| &self.0[i] * &other.0[j] - &self.0[j] * &other.0[i];
        V([term(1, 2), term(2, 0), term(0, 1)])
    }

    pub fn length(&self) -> Q {
        sqrt(&self.dot(self))
    }

    pub fn unit(&self) -> V {
        self.times(&self.length().recip())
    }

    pub fn approx(&self) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|i| approx(&self.0[i])))
    }
}

pub fn determinant(a: &V, b: &V, c: &V) -> Q {
    a.dot(&b.cross(c))
}

/// (integer, exponent) with x about integer · 2^exponent and so many bits.
fn scaled(x: &Q, bits: i64) -> (BigInt, i64) {
    let shift = bits - x.numer().bits() as i64 + x.denom().bits() as i64;
    let up = |n: &BigInt, by: i64| if by > 0 { n << by } else { n.clone() };
    (up(x.numer(), shift) / up(x.denom(), -shift), -shift)
}

fn power_of_two(exponent: i64) -> Q {
    let power = Q::from(BigInt::from(1) << exponent.unsigned_abs());
    if exponent < 0 { power.recip() } else { power }
}

pub fn sqrt(x: &Q) -> Q {
    assert!(!x.is_negative(), "the root of {}", approx(x));
    if x.is_zero() {
        return Q::zero();
    }
    let (mut digits, mut exponent) = scaled(x, 2 * BITS as i64 + 8);
    if exponent % 2 != 0 {
        digits <<= 1;
        exponent -= 1;
    }
    Q::from(digits.sqrt()) * power_of_two(exponent / 2)
}

fn big(x: &Q) -> BigFloat {
    if x.is_zero() {
        return BigFloat::new(BITS);
    }
    let (digits, exponent) = scaled(x, BITS as i64 + 32);
    let words: Vec<u64> = digits.iter_u64_digits().collect();
    let sign = if digits.sign() == IntSign::Minus { Sign::Neg } else { Sign::Pos };
    BigFloat::from_words(&words, sign, (64 * words.len() as i64 + exponent) as i32)
}

fn rational(x: &BigFloat) -> Q {
    let (words, _, sign, exponent, _) = x.as_raw_parts().expect("a number");
    let sign = if sign == Sign::Neg { IntSign::Minus } else { IntSign::Plus };
    let digits: Vec<u32> = words.iter().flat_map(|w| [*w as u32, (*w >> 32) as u32]).collect();
    let exponent = i64::from(exponent) - 64 * words.len() as i64;
    Q::from(BigInt::from_slice(sign, &digits)) * power_of_two(exponent)
}

fn by(f: impl FnOnce(&mut Consts, usize, RoundingMode) -> BigFloat) -> Q {
    thread_local!(static CONSTANTS: RefCell<Consts> = RefCell::new(Consts::new().unwrap()));
    CONSTANTS.with_borrow_mut(|constants| rational(&f(constants, BITS, RoundingMode::ToEven)))
}

pub fn pi() -> Q {
    by(|c, p, rm| c.pi(p, rm))
}

pub fn sin(x: &Q) -> Q {
    by(|c, p, rm| big(x).sin(p, rm, c))
}

pub fn cos(x: &Q) -> Q {
    by(|c, p, rm| big(x).cos(p, rm, c))
}

pub fn tan(x: &Q) -> Q {
    by(|c, p, rm| big(x).tan(p, rm, c))
}

pub fn exp(x: &Q) -> Q {
    by(|c, p, rm| big(x).exp(p, rm, c))
}

pub fn log2(x: &Q) -> Q {
    by(|c, p, rm| big(x).log2(p, rm, c))
}

pub fn power(x: &Q, y: &Q) -> Q {
    by(|c, p, rm| big(x).pow(&big(y), p, rm, c))
}

/// The angle of (x, y) from +x towards +y, in (−π, π]; 0 at the origin.
pub fn angle(y: &Q, x: &Q) -> Q {
    if x.is_zero() && y.is_zero() {
        return Q::zero();
    }
    let atan = |t: &Q| by(|c, p, rm| big(t).atan(p, rm, c));
    let half = pi() * frac(1, 2);
    if y.abs() > x.abs() {
        let upright = if y.is_negative() { -half } else { half };
        return upright - atan(&(x / y));
    }
    let turned = atan(&(y / x));
    match (x.is_negative(), y.is_negative()) {
        (false, _) => turned,
        (true, false) => turned + pi(),
        (true, true) => turned - pi(),
    }
}

pub fn degrees(x: f64) -> Q {
    q(x) * pi() / frac(180, 1)
}

/// Random vectors.
pub fn vector(rng: &mut Rng, reach: f64) -> DVec3 {
    DVec3::new(rng.between(-reach, reach), rng.between(-reach, reach), rng.between(-reach, reach))
}

pub fn direction(rng: &mut Rng) -> DVec3 {
    loop {
        let way = vector(rng, 1.0);
        if (0.01..=1.0).contains(&way.length_squared()) {
            return way.normalize();
        }
    }
}

#[test]
fn the_exact_functions_are_right_where_their_answers_are_known() {
    let near = |got: &Q, exact: &Q| assert!(approx(&(got - exact).abs()) < 1e-70, "{}", approx(got));
    near(&sqrt(&frac(1, 4)), &frac(1, 2));
    near(&(sqrt(&frac(2, 1)) * sqrt(&frac(2, 1))), &frac(2, 1));
    near(&(angle(&frac(1, 1), &frac(1, 1)) * frac(4, 1)), &pi());
    near(&angle(&frac(0, 1), &frac(-1, 1)), &pi());
    near(&(angle(&frac(-1, 1), &frac(0, 1)) * frac(-2, 1)), &pi());
    near(&(angle(&frac(-3, 1), &frac(-3, 1)) * frac(-4, 3)), &pi());
    near(&sin(&(pi() * frac(1, 6))), &frac(1, 2));
    near(&cos(&(pi() * frac(1, 3))), &frac(1, 2));
    near(&tan(&(pi() * frac(1, 4))), &frac(1, 1));
    near(&log2(&frac(1, 1024)), &frac(-10, 1));
    near(&power(&frac(9, 4), &frac(3, 2)), &frac(27, 8));
    near(&(exp(&frac(3, 1)) * exp(&frac(-3, 1))), &frac(1, 1));
    // Next to the f64 nearest to it, by the sine of that one (Muller 2016, chapter 11).
    assert!(off(std::f64::consts::PI, &(pi() - q(1.224_646_799_147_353_2e-16))) < 1e-31);
}
