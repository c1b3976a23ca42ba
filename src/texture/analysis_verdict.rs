//! Whether an axis tiles. In: the sizes of its steps and the period of its edges. Out: what the seam is. The
//! thresholds are from some 500 axes of textures made for it (noise of octaves, grain, gradients, skies,
//! bricks, tiles, planks, stones, checkers, stripes, letters; tileable, rolled, cut, short of one texel).

use super::analysis_period::Period;
use super::analysis_steps::Sizes;
use crate::core::named::named_enum;

/// A seam larger than this many times the largest step inside is seen; one a little above it may be. Of
/// textures that tile and have no edges the seam reached 0.98 of the largest.
pub const SEEN: f64 = 1.25;
/// The same of means over runs of pairs, of which there are fewer.
pub const SEEN_RUNS: f64 = 1.5;
pub const DOUBTFUL: f64 = 1.05;
/// Up to this many times the middle step inside, or larger than this part of all steps at most, a seam is one
/// step of many.
pub const USUAL: f64 = 1.5;
pub const USUAL_RANK: f64 = 0.9;
/// Misfit of the period across the seam: below the first the pattern goes on, above the second it does not.
/// Textures that tile reached 0.08, others began at 0.45.
pub const FITS: f64 = 0.2;
pub const BREAKS: f64 = 0.35;
/// A seam that strays this much is no line of the pattern, whatever lies beside it. Those that are reached 1.11; last
/// columns that were shifted along themselves mostly lay above 2.
pub const STRAYS: f64 = 1.5;
/// The seam is an edge that is found inside if their sizes, pair by pair, differ by this part of the seam, and by as
/// much again for grain, if the middle step inside has it.
pub const RECURS: f64 = 0.1;
/// Up to this part it may be, with other tones.
pub const RESEMBLES: f64 = 0.5;
/// What resembles no step inside is seen if it is so many times as large as nearly all of them. Of 5000 borders of
/// stones, leaves and letters that tile, rolled to anywhere, one had more.
pub const ALONE: f64 = 1.6;
const NEARLY_ALL: f64 = 0.98;

named_enum! {
    /// What the seam of one axis is.
    pub enum Seam {
        /// One step of many inside.
        Smooth = "smooth",
        /// An edge, but one that the picture has inside as well, or that belongs to what repeats inside.
        Pattern = "pattern",
        /// Last and first are equal where no neighbours inside are: each repeat stutters by a texel.
        Doubled = "doubled",
        /// All texels along the axis are equal, or there is one.
        Constant = "constant",
        /// A step that the picture does not have inside.
        Visible = "visible",
        /// What repeats inside does not go on across the seam.
        Broken = "broken",
        /// Among the largest steps inside, or a little above them, and only roughly like one of them.
        Uncertain = "uncertain",
        /// Every pair of the seam, or of the interior, has a value that is not finite.
        Unknown = "unknown",
    }
}

named_enum! {
    /// Whether the axis tiles.
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

    /// None: it cannot be told.
    pub fn tiles(self) -> Option<bool> {
        match self.verdict() {
            Verdict::Yes => Some(true),
            Verdict::No => Some(false),
            Verdict::Perhaps | Verdict::Unknown => None,
        }
    }
}

/// Where the seam stands among the steps inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rank {
    /// Part of the steps inside that are smaller; equal ones count half.
    pub share: f64,
    /// Over the largest step inside; none where that is 0.
    pub of_largest: Option<f64>,
    /// Over the middle step inside.
    of_middle: f64,
    /// Of runs of pairs, over the largest inside.
    runs_of_largest: f64,
    /// Over the step that nearly all are smaller than.
    of_nearly_all: f64,
}

impl Rank {
    pub fn new(sizes: &Sizes) -> Rank {
        let (seam, interior) = (sizes.seam, &sizes.interior);
        let smaller = interior.partition_point(|s| *s < seam);
        let equal = interior.partition_point(|s| *s <= seam) - smaller;
        let share = (smaller as f64 + 0.5 * equal as f64) / interior.len() as f64;
        let largest = interior.last().copied().unwrap_or(0.0);
        let ratio = |a: f64, b: f64| if a == b { 1.0 } else { a / b };
        Rank {
            share,
            of_largest: (largest > 0.0).then(|| seam / largest),
            of_middle: ratio(seam, interior[interior.len() / 2]),
            of_nearly_all: ratio(seam, interior[(NEARLY_ALL * (interior.len() - 1) as f64) as usize]),
            runs_of_largest: sizes.runs.map_or(0.0, |[own, largest]| ratio(own, largest)),
        }
    }
}

/// Of a seam that is no constant and has steps inside; `nearest` is that of
/// [`Steps::nearest_to_seam`](super::analysis_steps::Steps::nearest_to_seam).
pub fn judge(rank: &Rank, period: Option<Period>, nearest: Option<[f64; 2]>) -> Seam {
    let recurs = nearest.is_some_and(|[distance, middle]| distance <= RECURS + middle.min(RECURS));
    let resembles = nearest.is_some_and(|[distance, _]| distance <= RESEMBLES);
    let over = rank.of_largest.unwrap_or(f64::INFINITY);
    match period {
        _ if over > SEEN || rank.runs_of_largest > SEEN_RUNS => Seam::Visible,
        Some(period) if period.misfit >= BREAKS || period.stray > STRAYS => Seam::Broken,
        Some(period) if period.misfit > FITS => Seam::Uncertain,
        Some(_) if rank.of_middle > USUAL => Seam::Pattern,
        Some(_) => Seam::Smooth,
        None if over > DOUBTFUL => Seam::Uncertain,
        None if rank.of_middle <= USUAL || rank.share <= USUAL_RANK => Seam::Smooth,
        None if recurs => Seam::Pattern,
        None if !resembles && rank.of_nearly_all > ALONE => Seam::Visible,
        None => Seam::Uncertain,
    }
}
