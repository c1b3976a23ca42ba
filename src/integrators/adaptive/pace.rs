//! Measures sampling rate and host time, and decides by how much all counts may grow at once.

use super::Goal;

/// Largest factor by which the counts of an idle device grow at once.
const MAX_IDLE: f64 = 64.0;
/// Ratio of the error for which passes are planned to the goal: below 1, so that few audits are needed.
pub const PLANNED: f64 = 0.93;

/// The rate of sampling, and the time that the host needs between passes.
#[derive(Default)]
pub struct Pace {
    /// Samples per second, and seconds of sampling, in the last pass.
    pub rate: f64,
    sampling: f64,
    pub hosting: f64,
}

impl Pace {
    pub fn learn(&mut self, samples: f64, seconds: f64) {
        (self.rate, self.sampling) = (samples / seconds.max(1e-9), seconds);
    }

    /// Returns the factor by which all counts may grow if the device mostly waits for the host: until both take the
    /// same time, or the goal is met. That is cheaper than deciding where samples are needed most.
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
        // Half the error takes 2^(2 / 1.6) = 2.4 times as many samples; with the planned margin 2.7.
        assert_eq!(waits.idle(Goal::Error(5e-3), 1.0, 1e-2, 1.6), Some(2));
        assert_eq!(waits.idle(Goal::Error(1e-5), 1.0, 1e-2, 1.6), Some(64));
        assert_eq!(waits.idle(Goal::Samples(64), 1.0, 1e-2, 1.6), None);
        let works = Pace { sampling: 0.15, ..waits };
        assert_eq!(works.idle(Goal::Seconds(10.0), 1.0, 1e-2, 1.6), None);
    }
}
