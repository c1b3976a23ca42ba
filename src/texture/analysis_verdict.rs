//! The verdict on whether an axis tiles: classifies the seam from the sizes of the steps and the
//! period of the edges. The thresholds were calibrated on some 500 axes of textures made for the
//! purpose (octave noise, grain, gradients, skies, bricks, tiles, planks, stones, checkers,
//! stripes, letters; tileable, rolled, cropped, short of one texel).

use super::analysis_period::Period;
use super::analysis_steps::Sizes;
use crate::core::named::named_enum;

/// A seam above this multiple of the largest interior step is visible; one slightly above the
/// largest may be. On textures that tile and have no edges the seam reached 0.98 of the largest.
pub const VISIBLE: f64 = 1.25;
/// The same threshold for means over runs of pairs, of which there are fewer.
pub const VISIBLE_RUNS: f64 = 1.5;
pub const DOUBTFUL: f64 = 1.05;
/// A seam up to this multiple of the median interior step, or larger than at most this fraction of
/// all steps, is an ordinary step.
pub const ORDINARY: f64 = 1.5;
pub const ORDINARY_RANK: f64 = 0.9;
/// Thresholds of the period's misfit across the seam: below the first the pattern continues, above
/// the second it does not. Textures that tile reached 0.08; the others began at 0.45.
pub const CONTINUES: f64 = 0.2;
pub const BREAKS: f64 = 0.35;
/// A seam whose own edges mismatch by this factor is no line of the pattern, whatever its
/// neighbours. Lines of a pattern reached 1.11; last columns shifted along themselves mostly were
/// above 2.
pub const MISPLACED: f64 = 1.5;
/// The seam is an edge that recurs in the interior if their sizes, pair by pair, differ by at most
/// this fraction of the seam, and by as much again for grain if the median interior step has it.
pub const RECURS: f64 = 0.1;
/// Up to this fraction it may be such an edge with other tones.
pub const RESEMBLES: f64 = 0.5;
/// A seam that resembles no interior step is visible if it exceeds nearly all of them by this
/// factor. Of 5000 borders of tileable stones, leaves and letters, rolled arbitrarily, one exceeded
/// it.
pub const ISOLATED: f64 = 1.6;
const NEARLY_ALL: f64 = 0.98;

named_enum! {
    /// The class of the seam of one axis.
    pub enum Seam {
        /// An ordinary step like those of the interior.
        Smooth = "smooth",
        /// An edge that also occurs in the interior, or that belongs to a pattern repeating there.
        Pattern = "pattern",
        /// Last and first texels are equal although no interior neighbours are: each repeat doubles
        /// a texel.
        Doubled = "doubled",
        /// All texels along the axis are equal, or there is only one.
        Constant = "constant",
        /// A step that does not occur in the interior.
        Visible = "visible",
        /// The interior pattern does not continue across the seam.
        Broken = "broken",
        /// A step among the largest of the interior or slightly above them, which only roughly
        /// resembles one of them.
        Uncertain = "uncertain",
        /// Every pair of the seam, or of the interior, has a non-finite value.
        Unknown = "unknown",
    }
}

named_enum! {
    /// The verdict on whether the axis tiles.
    pub enum Verdict {
        Yes = "yes",
        Perhaps = "perhaps",
        No = "no",
        Unknown = "unknown",
    }
}

impl Seam {
    pub fn verdict(self) -> Verdict {
        match self {
            Seam::Smooth | Seam::Pattern | Seam::Doubled | Seam::Constant => Verdict::Yes,
            Seam::Visible | Seam::Broken => Verdict::No,
            Seam::Uncertain => Verdict::Perhaps,
            Seam::Unknown => Verdict::Unknown,
        }
    }

    /// Returns the verdict as a boolean, or `None` if it cannot be decided.
    pub fn tiles(self) -> Option<bool> {
        match self.verdict() {
            Verdict::Yes => Some(true),
            Verdict::No => Some(false),
            Verdict::Perhaps | Verdict::Unknown => None,
        }
    }
}

/// The size of the seam relative to the interior steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeamRank {
    /// The fraction of interior steps that are smaller; equal ones count half.
    pub share: f64,
    /// The ratio to the largest interior step; absent if that is 0.
    pub of_largest: Option<f64>,
    /// The ratio to the median interior step.
    of_median: f64,
    /// The ratio to the largest interior step, both by runs of pairs.
    runs_of_largest: f64,
    /// The ratio to the step that exceeds nearly all others.
    of_nearly_all: f64,
}

impl SeamRank {
    pub fn new(sizes: &Sizes) -> SeamRank {
        let (seam, interior) = (sizes.seam, &sizes.interior);
        let smaller = interior.partition_point(|s| *s < seam);
        let equal = interior.partition_point(|s| *s <= seam) - smaller;
        let share = (smaller as f64 + 0.5 * equal as f64) / interior.len() as f64;
        let largest = interior.last().copied().unwrap_or(0.0);
        let ratio = |a: f64, b: f64| if a == b { 1.0 } else { a / b };
        SeamRank {
            share,
            of_largest: (largest > 0.0).then(|| seam / largest),
            of_median: ratio(seam, interior[interior.len() / 2]),
            of_nearly_all: ratio(seam, interior[(NEARLY_ALL * (interior.len() - 1) as f64) as usize]),
            runs_of_largest: sizes.runs.map_or(0.0, |[own, largest]| ratio(own, largest)),
        }
    }
}

/// Classifies a seam that is not constant and has interior steps. `nearest` is the result of
/// [`Steps::nearest_to_seam`](super::analysis_steps::Steps::nearest_to_seam).
pub fn classify(rank: &SeamRank, period: Option<Period>, nearest: Option<[f64; 2]>) -> Seam {
    let recurs = nearest.is_some_and(|[distance, median]| distance <= RECURS + median.min(RECURS));
    let resembles = nearest.is_some_and(|[distance, _]| distance <= RESEMBLES);
    let over = rank.of_largest.unwrap_or(f64::INFINITY);
    match period {
        _ if over > VISIBLE || rank.runs_of_largest > VISIBLE_RUNS => Seam::Visible,
        Some(period) if period.misfit >= BREAKS || period.edge_misfit > MISPLACED => Seam::Broken,
        Some(period) if period.misfit > CONTINUES => Seam::Uncertain,
        Some(_) if rank.of_median > ORDINARY => Seam::Pattern,
        Some(_) => Seam::Smooth,
        None if over > DOUBTFUL => Seam::Uncertain,
        None if rank.of_median <= ORDINARY || rank.share <= ORDINARY_RANK => Seam::Smooth,
        None if recurs => Seam::Pattern,
        None if !resembles && rank.of_nearly_all > ISOLATED => Seam::Visible,
        None => Seam::Uncertain,
    }
}
