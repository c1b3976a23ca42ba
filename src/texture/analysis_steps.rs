//! Sizes of the steps of one axis. Accumulates pairs of neighbouring texels, line by line, and
//! returns the size of the seam and of every interior step. Each step has two sizes: the mean of
//! |d| over its pairs, and the mean of |mean of d| over runs of pairs along the step, in which
//! grain cancels but an offset does not.
//!
//! |d| is clamped to a little above the seam's values, so that a sun beside the seam weighs no more than an edge. Pairs with a non-finite value are left out.

/// The number of pairs along the step whose differences are averaged before taking the magnitude.
const RUN: usize = 16;
/// Differences are clamped to this multiple of the seam's large differences, which are its quantile
/// `LARGE`.
const HEADROOM: f64 = 1.5;
const LARGE: f64 = 0.9;

/// The pairs across the seam: differences of stored values and of mapped values.
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    pub stored: Vec<f64>,
    pub mapped: Vec<f64>,
}

/// The sums of the steps between columns (or rows) i and i + 1.
#[derive(Clone, Debug, Default)]
struct Step {
    /// Σ d² of stored and of mapped values.
    square: f64,
    weighed_square: f64,
    pairs: u64,
    /// Σ min(|d|, cap) of mapped values.
    size: f64,
    /// Σ (|d| − |s|)², with s the difference of the seam's pair in the same row and channel.
    against_seam: f64,
    pairs_with_seam: u64,
    /// Σ d of the current incomplete run of each channel, and the texels in it.
    run: [f64; 4],
    in_run: usize,
    /// Σ min(|mean d|, cap) over complete runs.
    run_size: f64,
    runs: u64,
}

pub struct Steps {
    interior: Vec<Step>,
    seam: Step,
    limits: Limits,
}

struct Limits {
    /// The clamping limits of |d| and of |mean of a run|.
    pair: f64,
    run: f64,
    channels: usize,
}

/// The step sizes from which the verdict on an axis is derived.
#[derive(Clone, Debug, Default)]
pub struct Sizes {
    pub seam: f64,
    /// The sizes of the interior steps in ascending order.
    pub interior: Vec<f64>,
    /// The sizes by runs of the seam and of the largest interior step; absent if there are few
    /// runs.
    pub runs: Option<[f64; 2]>,
}

impl Step {
    /// Adds the differences of pairs, channel by channel, with those of the seam.
    fn add(&mut self, limits: &Limits, stored: &[f64], mapped: &[f64], seam: Option<&[f64]>) {
        for (i, (d, e)) in stored.iter().zip(mapped).enumerate() {
            let channel = i % limits.channels;
            if d.is_finite() && e.is_finite() {
                self.square += d * d;
                self.weighed_square += e * e;
                self.pairs += 1;
                self.size += e.abs().min(limits.pair);
                self.run[channel] += e;
                if let Some(s) = seam.map(|s| s[i]).filter(|s| s.is_finite()) {
                    self.against_seam += (e.abs() - s.abs()).powi(2);
                    self.pairs_with_seam += 1;
                }
            }
            if channel + 1 == limits.channels {
                self.in_run += 1;
                if self.in_run == RUN {
                    let means = self.run[..limits.channels].iter().map(|sum| (sum / RUN as f64).abs());
                    self.run_size += means.map(|mean| mean.min(limits.run)).sum::<f64>();
                    self.runs += 1;
                    (self.run, self.in_run) = ([0.0; 4], 0);
                }
            }
        }
    }
}

impl Steps {
    pub fn new(interior: usize, channels: usize, pairs: &Pairs) -> Steps {
        let whole_runs = pairs.mapped.chunks_exact(RUN * channels);
        let means = whole_runs.flat_map(|run| (0..channels).map(move |c| mean_of(run, c, channels)));
        let limits = Limits { pair: cap(pairs.mapped.iter().copied()), run: cap(means), channels };
        let mut seam = Step::default();
        seam.add(&limits, &pairs.stored, &pairs.mapped, None);
        Steps { interior: vec![Step::default(); interior], seam, limits }
    }

    /// Adds the differences along step `at`, in the order of the seam's pairs, each with that of
    /// the seam.
    pub fn add(&mut self, at: usize, stored: &[f64], mapped: &[f64], seam: &[f64]) {
        self.interior[at].add(&self.limits, stored, mapped, Some(seam));
    }

    /// Returns true for an axis of one texel.
    pub fn is_empty(&self) -> bool {
        self.interior.is_empty()
    }

    /// Returns √(Σ s² ⁄ pairs) of stored values.
    pub fn seam_rms(&self) -> Option<f64> {
        rms(self.seam.square, self.seam.pairs)
    }

    /// Returns √(Σ d² ⁄ pairs) of stored values over all interior steps.
    pub fn interior_rms(&self) -> Option<f64> {
        rms(self.interior.iter().map(|s| s.square).sum(), self.interior.iter().map(|s| s.pairs).sum())
    }

    pub fn sizes(&self) -> Option<Sizes> {
        let size = |s: &Step| (s.pairs > 0).then(|| s.size / s.pairs as f64);
        let mut interior: Vec<f64> = self.interior.iter().filter_map(size).collect();
        interior.sort_by(f64::total_cmp);
        let of_runs = |s: &Step| s.run_size / s.runs.max(1) as f64;
        let largest = self.interior.iter().map(of_runs).fold(0.0, f64::max);
        let runs = (self.seam.runs >= 4).then(|| [of_runs(&self.seam), largest]);
        (!interior.is_empty()).then_some(Sizes { seam: size(&self.seam)?, interior, runs })
    }

    /// Returns the smallest √(Σ (|d| − |s|)² ⁄ pairs) of a step that has every pair of the seam,
    /// and the median RMS of all steps, both relative to the RMS of the seam.
    pub fn nearest_to_seam(&self) -> Option<[f64; 2]> {
        let seam = rms(self.seam.weighed_square, self.seam.pairs).filter(|seam| *seam > 0.0)?;
        let complete = self.interior.iter().filter(|s| s.pairs_with_seam == self.seam.pairs);
        let nearest =
            complete.filter_map(|s| rms(s.against_seam, s.pairs_with_seam)).min_by(f64::total_cmp)?;
        let mut all: Vec<f64> = self.interior.iter().filter_map(|s| rms(s.weighed_square, s.pairs)).collect();
        all.sort_by(f64::total_cmp);
        Some([nearest / seam, all.get(all.len() / 2)? / seam])
    }

    /// Returns true if no two interior neighbours are equal.
    pub fn all_differ(&self) -> bool {
        self.interior.iter().all(|s| s.square > 0.0)
    }
}

fn mean_of(run: &[f64], channel: usize, channels: usize) -> f64 {
    let own = run[channel..].iter().step_by(channels).filter(|d| d.is_finite());
    own.sum::<f64>() / RUN as f64
}

fn cap(differences: impl Iterator<Item = f64>) -> f64 {
    let mut sizes: Vec<f64> = differences.map(f64::abs).filter(|d| *d > 0.0 && d.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get((LARGE * sizes.len() as f64) as usize).map_or(f64::INFINITY, |large| HEADROOM * large)
}

fn rms(square: f64, pairs: u64) -> Option<f64> {
    (pairs > 0).then(|| (square / pairs as f64).sqrt())
}
