//! Student's t distribution: the half width of a 95 % interval in standard errors, by degrees of
//! freedom.

/// 97.5 % quantiles for 1 to 30 degrees of freedom.
const TABLE: [f64; 30] = [
    12.7062, 4.3027, 3.1824, 2.7764, 2.5706, 2.4469, 2.3646, 2.3060, 2.2622, 2.2281, 2.2010, 2.1788, 2.1604,
    2.1448, 2.1314, 2.1199, 2.1098, 2.1009, 2.0930, 2.0860, 2.0796, 2.0739, 2.0687, 2.0639, 2.0595, 2.0555,
    2.0518, 2.0484, 2.0452, 2.0423,
];
/// The 97.5 % quantile of the normal distribution.
const NORMAL: f64 = 1.959_963_985;

/// Returns the 97.5 % quantile; beyond the table by its expansion in 1/n about the normal one
/// (Abramowitz & Stegun 26.7.5), which is accurate there to 1e-5. Infinite for zero degrees of
/// freedom.
pub fn quantile(freedom: usize) -> f64 {
    match freedom {
        0 => f64::INFINITY,
        1..=30 => TABLE[freedom - 1],
        _ => {
            let (z, n) = (NORMAL, freedom as f64);
            let first = (z.powi(3) + z) / 4.0;
            let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / 96.0;
            z + first / n + second / (n * n)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the probability of |t| below `bound`, by Simpson's rule over θ, t = √n·tan θ: the
    /// density is cosⁿ⁻¹θ up to normalisation.
    fn inside(bound: f64, n: usize) -> f64 {
        let power = n as i32 - 1;
        let integral = |end: f64| {
            let steps = 20_000;
            let at = |i: usize| (end * i as f64 / f64::from(steps as u32)).cos().powi(power);
            let inner: f64 = (1..steps).map(|i| at(i) * if i % 2 == 1 { 4.0 } else { 2.0 }).sum();
            (at(0) + inner + at(steps)) * end / (3.0 * f64::from(steps as u32))
        };
        integral((bound / (n as f64).sqrt()).atan()) / integral(std::f64::consts::FRAC_PI_2)
    }

    #[test]
    fn quantiles_leave_five_parts_in_a_hundred_outside() {
        for n in (1..=40).chain([63, 100, 1000]) {
            // Four digits of the table: 5e-5 times the density there, at most 0.12.
            assert!((inside(quantile(n), n) - 0.95).abs() < 1e-5, "{n}: {}", inside(quantile(n), n));
        }
        assert_eq!(quantile(0), f64::INFINITY);
    }
}
