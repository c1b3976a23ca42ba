//! Sums over the steps of one axis: pairs of neighbouring texels go in, the RMS of the seam and of the
//! interior come out, and how near an interior step comes to the seam. A pair with a value that is
//! not finite is left out.

/// Of the steps between columns i and i + 1 (or rows).
#[derive(Clone, Copy, Default)]
struct Step {
    /// Σ d², d the difference of a pair.
    square: f64,
    pairs: u64,
    /// Σ (|d| − |s|)², s the difference of the seam's pair in the same row and channel.
    against_seam: f64,
    pairs_with_seam: u64,
}

pub struct Steps {
    interior: Vec<Step>,
    seam: Step,
}

impl Steps {
    pub fn new(interior: usize) -> Steps {
        Steps { interior: vec![Step::default(); interior], seam: Step::default() }
    }

    pub fn add_seam(&mut self, differences: &[f64]) {
        let finite = || differences.iter().filter(|d| d.is_finite());
        self.seam.square += finite().map(|d| d * d).sum::<f64>();
        self.seam.pairs += finite().count() as u64;
    }

    /// Each difference with that of the seam.
    pub fn add<'a>(&mut self, at: usize, differences: impl Iterator<Item = (f64, &'a f64)>) {
        let step = &mut self.interior[at];
        for (d, s) in differences.filter(|(d, _)| d.is_finite()) {
            step.square += d * d;
            step.pairs += 1;
            if s.is_finite() {
                let apart = d.abs() - s.abs();
                step.against_seam += apart * apart;
                step.pairs_with_seam += 1;
            }
        }
    }

    /// An axis of one texel.
    pub fn is_empty(&self) -> bool {
        self.interior.is_empty()
    }

    /// √(Σ s² ⁄ pairs)
    pub fn seam_rms(&self) -> Option<f64> {
        rms(self.seam.square, self.seam.pairs)
    }

    /// √(Σ d² ⁄ pairs) over all interior steps.
    pub fn interior_rms(&self) -> Option<f64> {
        rms(self.interior.iter().map(|s| s.square).sum(), self.interior.iter().map(|s| s.pairs).sum())
    }

    /// The smallest √(Σ (|d| − |s|)² ⁄ pairs) of a step that has every pair of the seam.
    pub fn nearest_to_seam(&self) -> Option<f64> {
        let complete = self.interior.iter().filter(|s| s.pairs_with_seam == self.seam.pairs);
        complete.filter_map(|s| rms(s.against_seam, s.pairs_with_seam)).min_by(f64::total_cmp)
    }

    /// No two neighbours inside are equal.
    pub fn all_differ(&self) -> bool {
        self.interior.iter().all(|s| s.square > 0.0)
    }
}

fn rms(square: f64, pairs: u64) -> Option<f64> {
    (pairs > 0).then(|| (square / pairs as f64).sqrt())
}
