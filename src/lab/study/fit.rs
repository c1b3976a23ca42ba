//! Straight lines and curves through points. In: pairs of numbers. Out: a line by least squares, a median, the time at
//! which a curve comes down to an error.

pub(super) struct Line {
    pub value: f64,
    /// The residual sum of squares.
    pub residual: f64,
    pub sxx: f64,
}

/// Fits a straight line through (x, y) with at least two different x.
pub(super) fn least_squares(points: &[(f64, f64)]) -> Line {
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let sxx: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let value = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / sxx;
    let residual = points.iter().map(|p| (p.1 - y - value * (p.0 - x)).powi(2)).sum();
    Line { value, residual, sxx }
}

/// Returns the middle of sorted values; of two, their mean.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => sorted[middle],
        _ => 0.5 * (sorted[middle - 1] + sorted[middle]),
    }
}

/// Returns the time at which a curve of (seconds, RMSE) first reaches `error`, interpolated
/// linearly in the logarithms.
pub fn time_to(curve: &[(f64, f64)], error: f64) -> Option<f64> {
    let mut curve = curve.to_vec();
    curve.sort_by(|a, b| a.0.total_cmp(&b.0));
    let after = curve.iter().position(|p| p.1 <= error)?;
    let (b, Some(a)) = (curve[after], after.checked_sub(1).map(|i| curve[i])) else {
        return Some(curve[after].0);
    };
    let share = (a.1 / error).ln() / (a.1 / b.1).ln();
    Some(if b.1 > 0.0 { a.0 * (b.0 / a.0).powf(share) } else { b.0 })
}
