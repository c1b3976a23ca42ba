//! Periodicity across the seam: finds the period of the edges along some lines of a texture, each
//! closed to a ring, from the sizes of their steps, and how well the edges match one period later
//! across the seam. Tones do not matter: bricks may differ while their joints are equally spaced.

use rayon::prelude::*;

/// The longest period in texels that is searched; a period must also fit three times into the axis.
const MAX_PERIOD: usize = 2048;
/// A distance is a period if in every window of one period the mismatch there is at most this
/// fraction of the mean mismatch over all distances.
const PERIODIC: f64 = 0.9;
/// Only distances beyond the first one at which the mismatch reaches this fraction of the mean are
/// candidates: at shorter ones the mismatch is small only because the texture is smooth.
const DECORRELATED: f64 = 0.8;
/// Edges that differ by less than this are not a pattern.
const FLAT: f64 = 1e-3;
/// Steps that differ by this part of a typical one are equal, whatever the roundings of their texels.
const EQUAL: f32 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    pub texels: usize,
    /// The excess mismatch one period later across the seam over the worst window of the interior:
    /// 0 if the seam fits as well as that window, 1 if it fits no better than an arbitrary
    /// distance.
    pub misfit: f64,
    /// The mismatch of the seam's own edges with those one period before or after, the smaller of
    /// both, over that of the worst interior step.
    pub edge_misfit: f64,
}

/// Mismatches at one distance: mean and largest window of the interior, and the window across the
/// seam.
#[derive(Clone, Copy)]
struct Lag {
    mean: f64,
    worst: f64,
    across: f64,
}

/// Returns the period of `lines`, which have equal length. Each holds the sizes of its steps, the
/// seam's last; roundings of texels change the difference of two by `grain` at most.
pub fn period(lines: &[Vec<f32>], grain: f32) -> Option<Period> {
    let length = lines.first()?.len();
    let interior = || lines.iter().flat_map(|line| &line[..length - 1]);
    let square: f64 = interior().map(|&e| f64::from(e).powi(2)).sum();
    let scale = (square / (lines.len() * (length - 1).max(1)) as f64).sqrt() as f32;
    if scale <= 0.0 {
        return None;
    }
    // The root makes strong edges alike whatever their height and keeps grain small.
    let edges: Vec<Vec<f32>> =
        lines.iter().map(|line| line.iter().map(|e| e / (e + scale)).collect()).collect();
    let lags: Vec<Lag> =
        (1..=(length / 3).min(MAX_PERIOD)).into_par_iter().map(|distance| lag(&edges, distance)).collect();
    let mut means: Vec<f64> = lags.iter().map(|lag| lag.mean).collect();
    means.sort_by(f64::total_cmp);
    let typical = *means.get(means.len() / 2)?;
    if typical < FLAT {
        return None;
    }
    let first = lags.iter().position(|lag| lag.mean >= DECORRELATED * typical)?;
    let best = (first..lags.len()).min_by(|&a, &b| lags[a].worst.total_cmp(&lags[b].worst))?;
    let [worst, across] = [lags[best].worst, lags[best].across].map(|mismatch| mismatch / typical);
    (worst <= PERIODIC).then(|| Period {
        texels: best + 1,
        misfit: ((across - worst) / (1.0 - worst)).max(0.0),
        edge_misfit: edge_misfit(lines, &edges, best + 1, grain.max(EQUAL * scale)),
    })
}

/// `sizes`: of the steps from which `lines` were made. Of the seam, those that differ by `grain` at most are equal.
fn edge_misfit(sizes: &[Vec<f32>], lines: &[Vec<f32>], distance: usize, grain: f32) -> f64 {
    let (length, seam) = (lines[0].len(), lines[0].len() - 1);
    if seam <= 2 * distance {
        return 0.0;
    }
    // The mismatch between a step and the one a period later.
    let mismatch = |i: usize, grain: f32| {
        let step = |line: &[f32]| (line[i] - line[(i + distance) % length]).abs();
        let differ = lines.iter().zip(sizes).filter(|(_, sizes)| step(sizes) > grain);
        differ.map(|(line, _)| f64::from(step(line))).sum::<f64>()
    };
    let of = |i: usize, grain: f32| mismatch(i - distance, grain).min(mismatch(i, grain));
    let worst = (distance..seam - distance).map(|i| of(i, 0.0)).fold(0.0, f64::max);
    let own = of(seam, grain);
    if own > 0.0 { own / worst } else { 0.0 }
}

fn lag(lines: &[Vec<f32>], distance: usize) -> Lag {
    let length = lines[0].len();
    let seam = length - 1;
    let mut inside = vec![0f32; seam - distance];
    let mut across = 0.0;
    for line in lines {
        let pairs = line[..seam - distance].iter().zip(&line[distance..seam]);
        inside.iter_mut().zip(pairs).for_each(|(sum, (a, b))| *sum += (a - b).abs());
        let beyond = |i: usize| line[(i + distance) % length];
        across += (seam - distance..seam).map(|i| f64::from((line[i] - beyond(i)).abs())).sum::<f64>();
    }
    let mut window: f64 = inside[..distance].iter().copied().map(f64::from).sum();
    let mut worst = window;
    for i in distance..inside.len() {
        window += f64::from(inside[i]) - f64::from(inside[i - distance]);
        worst = worst.max(window);
    }
    let count = lines.len() as f64;
    let total: f64 = inside.iter().copied().map(f64::from).sum();
    let of_window = |sum: f64| sum / (count * distance as f64);
    Lag { mean: total / (count * inside.len() as f64), worst: of_window(worst), across: of_window(across) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn period(lines: &[Vec<f32>]) -> Option<Period> {
        super::period(lines, 0.0)
    }

    fn ring(length: usize, edge: impl Fn(usize) -> f32) -> Vec<Vec<f32>> {
        vec![(0..length).map(edge).collect()]
    }

    fn every_eight(i: usize) -> f32 {
        if i % 8 == 7 { 1.0 } else { 0.0 }
    }

    #[test]
    fn edges_that_continue_fit_and_those_that_do_not_are_found() {
        assert_eq!(period(&ring(64, every_eight)), Some(Period { texels: 8, misfit: 0.0, edge_misfit: 0.0 }));
        let cut = period(&ring(60, every_eight)).unwrap();
        assert!(cut.texels == 8 && cut.misfit > 0.4, "{cut:?}");
    }

    #[test]
    fn a_seam_that_belongs_elsewhere_misfits() {
        let lines = |seam: [f32; 2]| {
            let line = |k: usize| {
                (0..64).map(|i| if i == 63 { seam[k] } else { every_eight(i) * (k + 1) as f32 }).collect()
            };
            [line(0), line(1)]
        };
        let edge_misfit = |seam| period(&lines(seam)).unwrap().edge_misfit;
        assert_eq!(edge_misfit([1.0, 2.0]), 0.0);
        assert!(edge_misfit([0.0, 0.5]) > 100.0, "every interior edge fits");
    }

    /// Sizes of the steps of sin(πi/4), of which texels are multiples of 1.
    #[test]
    fn a_seam_that_differs_by_a_rounding_fits() {
        let inside = [71.0, 30.0, 30.0, 70.0, 71.0, 29.0, 29.0, 70.0];
        let lines = |seam: f32| ring(32, |i| if i == 31 { seam } else { inside[i % 8] });
        let misfit = |seam| super::period(&lines(seam), 2.0).unwrap().edge_misfit;
        assert_eq!([70.0, 71.0, 72.0].map(misfit), [0.0; 3]);
        assert!(misfit(60.0) > 1.5, "no rounding");
    }

    #[test]
    fn flat_and_irregular_lines_have_no_period() {
        assert_eq!(period(&ring(64, |_| 0.0)), None);
        assert_eq!(period(&ring(64, |_| 1.0)), None);
        assert_eq!(period(&ring(64, |i| (i * i % 61) as f32 / 61.0)), None);
        assert_eq!((period(&ring(1, |_| 1.0)), period(&ring(2, |_| 1.0)), period(&[])), (None, None, None));
    }
}
