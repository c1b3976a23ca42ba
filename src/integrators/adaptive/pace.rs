//! How fast a device samples and how long the host thinks → by how much all counts may grow at once.

use super::Goal;

/// Counts of a device that is idle grow at most so much at once.
const MAX_IDLE: f64 = 64.0;
/// The error that passes are planned for, over the goal: an audit shall find it met, so that few are needed.
pub const PLANNED: f64 = 0.93;

/// How fast samples are taken, and how long the host thinks about them.
#[derive(Default)]
pub struct Pace {
    /// Samples a second, and the seconds that they took, in the last pass.
    pub rate: f64,
    sampling: f64,
    pub hosting: f64,
}

impl Pace {
    pub fn learn(&mut self, samples: f64, seconds: f64) {
        (self.rate, self.sampling) = (samples / seconds.max(1e-9), seconds);
    }

    /// Of a device that mostly waits for the host: by how much all counts may grow until both work alike, or the
    /// goal is met. That costs less than to think of where samples are wanted most.
    pub fn idle(&self, goal: Goal, elapsed: f64, rmse: f64, exponent: f64) -> Option<u32> {
        let (time, most) = match goal {
            Goal::Samples(_) => return None,
            Goal::Error(wanted) => (f64::INFINITY, (rmse / (PLANNED * wanted)).powf(2.0 / exponent)),
            Goal::Seconds(limit) => (0.5 * (limit - elapsed), MAX_IDLE),
        };
        let factor = self.hosting.min(time) / self.sampling.max(1e-9);
        let factor = factor.min(most.max(2.0)).min(MAX_IDLE);
        (factor >= 2.0).then(|| 1 << (factor as u32).ilog2())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_grow_where_a_device_waits_for_the_host_and_no_further_than_to_the_goal() {
        let waits = Pace { rate: 1e9, sampling: 1e-3, hosting: 0.2 };
        assert_eq!(waits.idle(Goal::Seconds(10.0), 1.0, 1e-2, 1.6), Some(64));
        assert_eq!(waits.idle(Goal::Seconds(1.02), 1.0, 1e-2, 1.6), Some(8), "half of what is left");
        // Samples that lower the error by half are 2^(2 / 1.6) = 2.4 times as many; with what is planned beyond 2.7.
        assert_eq!(waits.idle(Goal::Error(5e-3), 1.0, 1e-2, 1.6), Some(2));
        assert_eq!(waits.idle(Goal::Error(1e-5), 1.0, 1e-2, 1.6), Some(64));
        assert_eq!(waits.idle(Goal::Samples(64), 1.0, 1e-2, 1.6), None);
        let works = Pace { sampling: 0.15, ..waits };
        assert_eq!(works.idle(Goal::Seconds(10.0), 1.0, 1e-2, 1.6), None);
    }
}
