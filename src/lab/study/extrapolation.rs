//! The error of a method in a time longer than it was measured for. Input: its points and its fitted slope. Output: an
//! estimate with its uncertainty, and whether its lead over a measured point is larger than that.
//!
//! Estimates reach no further than [`FURTHEST`] times a method's longest time and no lower than the reference's own error:
//! what is beyond was not measured of any method, and the picture with the least noise is the wrong one to judge it by.

use super::bootstrap::ratio;
use super::record::{PointRecord, ReferenceRecord};
use super::results::MethodSlope;

/// The longest time, over that of a method's longest point.
const FURTHEST: f64 = 4.0;

pub(super) struct Estimate<'a> {
    /// The longest measured point of the method.
    pub last: &'a PointRecord,
    pub spp: u32,
    pub seconds: f64,
    pub rmse: f64,
    /// The error over that of the last point: the least and the most by the interval of the slope.
    factors: [f64; 2],
}

impl<'a> Estimate<'a> {
    /// Returns the estimate within a time, if that is longer than what was measured and the method follows a law.
    pub fn of(
        points: &[&'a PointRecord],
        slope: &MethodSlope,
        budget: f64,
        reference: &ReferenceRecord,
    ) -> Option<Estimate<'a>> {
        let mut own: Vec<&PointRecord> =
            points.iter().copied().filter(|p| p.method == slope.method).collect();
        own.sort_by(|a, b| a.median_seconds().total_cmp(&b.median_seconds()));
        let last = *own.last()?;
        let law = slope.fitted.filter(|f| !slope.theory.is_empty() && f.value < 0.0)?;
        let (start, floor) = (last.own(), reference.rmse.unwrap_or(0.0));
        if start.rmse <= floor || !start.is_known() {
            return None;
        }
        let (time, count) = (last.median_seconds(), f64::from(last.spp));
        // What a sample costs may have grown with their number.
        let recent = own
            .iter()
            .rev()
            .find(|p| p.spp < last.spp)
            .map_or(0.0, |before| (time - before.median_seconds()) / (count - f64::from(before.spp)));
        let each = recent.max(time / count);
        let room = count + (budget.min(FURTHEST * time) - time) / each;
        let down_to_floor = count * (start.rmse / floor).powf(-2.0 / law.value);
        let spp = room.min(down_to_floor).floor();
        let growth = spp / count;
        let half_width = law.half_width.unwrap_or(0.0);
        let factor = |slope: f64| growth.powf(0.5 * slope);
        (growth > 1.0).then(|| Estimate {
            last,
            spp: spp as u32,
            seconds: time + (spp - count) * each,
            rmse: start.rmse * factor(law.value),
            factors: [factor(law.value - half_width), factor(law.value + half_width)],
        })
    }

    /// Returns the interval of the error by the slope and by the noise of the last point.
    pub fn interval(&self) -> [f64; 2] {
        let own = self.last.own();
        [own.low * self.factors[0], own.high * self.factors[1]]
    }

    /// Returns true if the error is less than a measured one beyond the uncertainty of both.
    pub fn beats(&self, point: &PointRecord, reference: &ReferenceRecord) -> bool {
        let known = squared_ratio(self.last, point, reference);
        self.rmse < point.own().rmse && known.is_some_and(|[_, high]| high * self.factors[1].powi(2) < 1.0)
    }

    /// Returns true if it is not known which of two estimates is less.
    pub fn ties(&self, other: &Estimate<'_>, reference: &ReferenceRecord) -> bool {
        let low = |a: &Estimate<'_>, b: &Estimate<'_>| {
            let known = squared_ratio(a.last, b.last, reference)?;
            Some(known[0] * (a.factors[0] / b.factors[1]).powi(2))
        };
        let may_be_less =
            |a: &Estimate<'_>, b: &Estimate<'_>| a.rmse <= b.rmse || low(a, b).is_none_or(|low| low <= 1.0);
        may_be_less(self, other) && may_be_less(other, self)
    }
}

/// Returns the interval of the ratio of two squared errors, both without the reference's: of the same parts of both
/// pictures, or by each alone if there are no parts. `None` if the second one may be none at all.
fn squared_ratio(a: &PointRecord, b: &PointRecord, reference: &ReferenceRecord) -> Option<[f64; 2]> {
    if a.blocks.is_empty() || b.blocks.is_empty() {
        let (a, b) = (a.own(), b.own());
        return b.is_known().then(|| [(a.low / b.high).powi(2), (a.high / b.low).powi(2)]);
    }
    ratio(&a.own_blocks(reference), &b.own_blocks(reference), 0.95)
}
