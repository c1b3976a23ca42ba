//! What a study is asked: what is best in a time, or what comes to an error fastest. Input: the measured points. Output:
//! the point that answers, whether it keeps what was asked, the best point of each method in order, and a note where the
//! reference is too poor to tell.

use super::format::{asked_error, error};
use super::record::{PointRecord, Question, Record};

impl Question {
    /// Returns true if a point keeps what was asked.
    pub fn is_met_by(self, point: &PointRecord) -> bool {
        match self {
            Question::Budget(seconds) => point.median_seconds() <= seconds,
            Question::Error(rmse) => point.own().rmse <= rmse,
        }
    }

    /// Returns what is to be as small as possible: first of points that keep what was asked, second of others.
    fn measures(self, point: &PointRecord) -> [f64; 2] {
        let [error, time] = [point.errors.rmse, point.median_seconds()];
        match self {
            Question::Budget(_) => [error, time],
            Question::Error(_) => [time, error],
        }
    }

    /// Returns true if `a` answers better than `b`.
    fn prefers(self, a: &PointRecord, b: &PointRecord) -> bool {
        let [first, second] = [self.measures(a), self.measures(b)];
        match (self.is_met_by(a), self.is_met_by(b)) {
            (true, true) => (first[0], first[1]) < (second[0], second[1]),
            // What is nearest to what was asked.
            (false, false) => (first[1], first[0]) < (second[1], second[0]),
            (met, _) => met,
        }
    }

    /// Returns the best point of each method, the best of all first.
    pub fn ranking(self, points: &[PointRecord]) -> Vec<&PointRecord> {
        let usable = points.iter().filter(|p| p.median_seconds() > 0.0 && p.errors.rmse.is_finite());
        let mut best: Vec<&PointRecord> = Vec::new();
        for point in usable {
            match best.iter_mut().find(|own| own.method == point.method) {
                Some(own) if self.prefers(point, own) => *own = point,
                Some(_) => {}
                None => best.push(point),
            }
        }
        best.sort_by(|a, b| match (self.prefers(a, b), self.prefers(b, a)) {
            (true, _) => std::cmp::Ordering::Less,
            (_, true) => std::cmp::Ordering::Greater,
            _ => std::cmp::Ordering::Equal,
        });
        best
    }

    /// Returns the point that answers.
    pub fn answer(self, points: &[PointRecord]) -> Option<&PointRecord> {
        self.ranking(points).first().copied()
    }
}

/// Returns a note if the reference errs by more than the error that is asked for.
pub fn note(record: &Record) -> Option<String> {
    let Some(Question::Error(asked)) = record.conditions.question else { return None };
    let own = record.reference.rmse.filter(|own| *own > asked)?;
    Some(format!(
        "the reference itself errs by {}, more than the {} that was asked for: what points err by below that is uncertain; \
         more --seconds or larger numbers in --spp make it better, or name a better one with --reference",
        error(own),
        asked_error(asked)
    ))
}
