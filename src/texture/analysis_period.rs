//! Whether what repeats inside a texture goes on across its seam. In: the sizes of the steps along some lines of
//! the texture, each line closed to a ring. Out: the period of their edges, and how they fit a period later
//! across the seam. Tones do not matter: bricks may differ, their joints lie at the same distance.

use rayon::prelude::*;

/// Periods beyond these many texels are not looked for, nor those that the axis does not hold three times.
const LONGEST: usize = 2048;
/// Of the mismatch at any distance: what must be left of it a period later, in every window of a period.
const PERIODIC: f64 = 0.9;
/// Distances count from where the mismatch has come to this part of the usual: nearer ones tell of smoothness.
const APART: f64 = 0.8;
/// Edges that differ less than this from each other are no pattern.
const FLAT: f64 = 1e-3;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Period {
    pub texels: usize,
    /// How much worse than inside the texture fits itself a period later across the seam: 0 as well as in the
    /// worst window inside, 1 no better than at any distance.
    pub misfit: f64,
    /// How many times worse the seam's own edges fit those a period before or after it, whichever they fit better,
    /// than the worst step inside.
    pub stray: f64,
}

/// Mismatches at one distance: mean and largest window inside, and the window across the seam.
#[derive(Clone, Copy)]
struct Lag {
    mean: f64,
    worst: f64,
    across: f64,
}

/// `lines` of equal length, each the sizes of its steps, the last one that of the seam.
pub fn period(lines: &[Vec<f32>]) -> Option<Period> {
    let length = lines.first()?.len();
    let interior = || lines.iter().flat_map(|line| &line[..length - 1]);
    let square: f64 = interior().map(|&e| f64::from(e).powi(2)).sum();
    let scale = (square / (lines.len() * (length - 1).max(1)) as f64).sqrt() as f32;
    if scale <= 0.0 {
        return None;
    }
    // Strong edges are alike, whatever their height; grain stays small.
    let edges: Vec<Vec<f32>> =
        lines.iter().map(|line| line.iter().map(|e| e / (e + scale)).collect()).collect();
    let lags: Vec<Lag> =
        (1..=(length / 3).min(LONGEST)).into_par_iter().map(|distance| lag(&edges, distance)).collect();
    let mut means: Vec<f64> = lags.iter().map(|lag| lag.mean).collect();
    means.sort_by(f64::total_cmp);
    let usual = *means.get(means.len() / 2)?;
    if usual < FLAT {
        return None;
    }
    let first = lags.iter().position(|lag| lag.mean >= APART * usual)?;
    let best = (first..lags.len()).min_by(|&a, &b| lags[a].worst.total_cmp(&lags[b].worst))?;
    let [worst, across] = [lags[best].worst, lags[best].across].map(|mismatch| mismatch / usual);
    (worst <= PERIODIC).then(|| Period {
        texels: best + 1,
        misfit: ((across - worst) / (1.0 - worst)).max(0.0),
        stray: stray(&edges, best + 1),
    })
}

fn stray(lines: &[Vec<f32>], distance: usize) -> f64 {
    let (length, seam) = (lines[0].len(), lines[0].len() - 1);
    if seam <= 2 * distance {
        return 0.0;
    }
    // Between a step and the one a period on.
    let mismatch = |i: usize| {
        lines.iter().map(|line| f64::from((line[i] - line[(i + distance) % length]).abs())).sum::<f64>()
    };
    let of = |i: usize| mismatch(i - distance).min(mismatch(i));
    let worst = (distance..seam - distance).map(of).fold(0.0, f64::max);
    let own = of(seam);
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

    fn ring(length: usize, edge: impl Fn(usize) -> f32) -> Vec<Vec<f32>> {
        vec![(0..length).map(edge).collect()]
    }

    fn every_eight(i: usize) -> f32 {
        if i % 8 == 7 { 1.0 } else { 0.0 }
    }

    #[test]
    fn edges_that_go_on_fit_and_those_that_do_not_are_found() {
        assert_eq!(period(&ring(64, every_eight)), Some(Period { texels: 8, misfit: 0.0, stray: 0.0 }));
        let cut = period(&ring(60, every_eight)).unwrap();
        assert!(cut.texels == 8 && cut.misfit > 0.4, "{cut:?}");
    }

    #[test]
    fn a_seam_that_belongs_elsewhere_strays() {
        let lines = |seam: [f32; 2]| {
            let line = |k: usize| {
                (0..64).map(|i| if i == 63 { seam[k] } else { every_eight(i) * (k + 1) as f32 }).collect()
            };
            [line(0), line(1)]
        };
        let stray = |seam| period(&lines(seam)).unwrap().stray;
        assert_eq!(stray([1.0, 2.0]), 0.0);
        assert!(stray([0.0, 0.5]) > 100.0, "nothing inside strays at all");
    }

    #[test]
    fn flat_and_irregular_lines_have_no_period() {
        assert_eq!(period(&ring(64, |_| 0.0)), None);
        assert_eq!(period(&ring(64, |_| 1.0)), None);
        assert_eq!(period(&ring(64, |i| (i * i % 61) as f32 / 61.0)), None);
        assert_eq!((period(&ring(1, |_| 1.0)), period(&ring(2, |_| 1.0)), period(&[])), (None, None, None));
    }
}
