//! The pixels of a picture that is sampled to a goal, kept by the device: it estimates variances, distributes samples, lists
//! their batches and draws an audit's pixels itself (`glsl/goal`). Input: the decisions of the loop of passes. Output: a few
//! words after each step, and at last the film. The twin on the host is `integrators::adaptive`'s `HostPixels`.

mod draws;
mod listed;
mod steps;

pub use steps::GoalSteps;

use super::Report;
use super::batch_lists::AtOnce;
use super::batches::BatchSampler;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::core::progress::Progress;
use crate::gpu::{BindGroup, Buffer, BufferUse, Gpu};
use crate::integrators::adaptive::{DrawSums, shares};
use crate::sampling::{Aim, AuditPlan, Audited, Backend, Estimated, PilotRun, Pixels, Plan, Planned, Raises};
use crate::schema::blocks::GoalStep;
use crate::schema::constants::*;
use crate::schema::enums::GoalStepKind as Kind;

/// The samples of the next pass.
enum Next {
    /// As many in each half of all pixels, of which this number is taken.
    All { now: u32, next: u32 },
    /// The numbers of batches of each class, in the list on the device.
    Listed(Vec<u32>),
}

/// Work of the next submission, before its own steps.
enum Ahead {
    Step(Kind, GoalStep),
    /// Samples that go to the film, and parts of long batches.
    Samples(AtOnce),
    Parts(AtOnce),
}

/// The backend whose device keeps the pixels.
pub trait GoalBackend<'p>: Backend {
    fn gpu(&self) -> &'p Gpu;

    /// Returns what takes the samples, and the report of the render.
    fn sampler(&mut self) -> Result<(&mut BatchSampler<'p>, &mut Report)>;

    /// Returns true if pixels have different numbers of samples in the first pass.
    fn first_samples_differ(&self) -> bool;
}

pub struct DevicePixels<'b, 'p> {
    backend: &'b mut dyn GoalBackend<'p>,
    gpu: &'p Gpu,
    steps: &'p GoalSteps,
    resolved: Option<Buffer>,
    group: BindGroup,
    /// The film with the list of batches, and the sums of parts with theirs.
    sample_groups: [BindGroup; 2],
    ahead: Vec<Ahead>,
    /// What all steps of a pass have in common.
    push: GoalStep,
    next: Next,
    /// True if samples were taken since the counts were last updated.
    took: bool,
    /// Seconds of the last samples.
    sampling: f64,
    /// By the last estimate.
    seen: Estimated,
    draw_sums: DrawSums,
}

impl<'b, 'p> DevicePixels<'b, 'p> {
    pub fn new(backend: &'b mut dyn GoalBackend<'p>, steps: &'p GoalSteps) -> Result<DevicePixels<'b, 'p>> {
        let gpu = backend.gpu();
        let group = steps.bind(gpu, None)?;
        let sample_groups = sample_groups(backend, steps)?;
        let [width, height] = steps.size;
        let push = GoalStep { width, height, parts: steps.parts(), ..GoalStep::default() };
        let next = Next::All { now: 0, next: 0 };
        let (seen, draw_sums) = Default::default();
        Ok(DevicePixels {
            backend,
            gpu,
            steps,
            resolved: None,
            group,
            sample_groups,
            ahead: Vec::new(),
            push,
            next,
            took: false,
            sampling: 0.0,
            seen,
            draw_sums,
        })
    }

    /// Submits what is to be done ahead, and steps of which nothing is read.
    fn submit(&mut self, kinds: &[(Kind, GoalStep)]) -> Result<()> {
        self.run::<1>(kinds, 0).map(|_| ())
    }

    /// Runs steps, and reads words of the totals from `first` on.
    fn run<const N: usize>(&mut self, kinds: &[(Kind, GoalStep)], first: u32) -> Result<[u32; N]> {
        let mut words = [0; N];
        self.run_into(kinds, first, &mut words)?;
        Ok(words)
    }

    /// Submits what is to be done ahead, and steps.
    fn run_into(&mut self, kinds: &[(Kind, GoalStep)], first: u32, words: &mut [u32]) -> Result<()> {
        let mut work = std::mem::take(&mut self.ahead);
        work.extend(kinds.iter().map(|&(kind, push)| Ahead::Step(kind, push)));
        let mut samples = 0.0;
        let mut dispatches = Vec::with_capacity(work.len());
        for one in &work {
            let (at_once, group) = match one {
                Ahead::Step(kind, push) => {
                    dispatches.push(self.steps.dispatch(&self.group, *kind, push));
                    continue;
                }
                Ahead::Samples(at_once) => (at_once, &self.sample_groups[0]),
                Ahead::Parts(at_once) => (at_once, &self.sample_groups[1]),
            };
            samples += at_once.samples;
            dispatches.push(at_once.dispatch(group));
        }
        let out = bytemuck::cast_slice_mut(words);
        let time = self.gpu.run_and_read(&dispatches, &self.steps.totals, 4 * u64::from(first), out)?;
        let (sampler, report) = self.backend.sampler()?;
        report.add_slice(time);
        if samples > 0.0 {
            sampler.passes.learn(samples, time);
            self.sampling += time.wall_seconds;
        }
        Ok(())
    }

    /// Reads an array of all pixels.
    fn read_array<T: bytemuck::Pod>(&self, array: u32) -> Result<Vec<T>> {
        let mut values = vec![T::zeroed(); self.steps.count() as usize];
        let offset = 4 * u64::from(array) * u64::from(self.steps.count());
        self.gpu.read_buffer(&self.steps.pixels, offset, bytemuck::cast_slice_mut(&mut values))?;
        Ok(values)
    }

    fn bind(&mut self) -> Result<()> {
        self.group = self.steps.bind(self.gpu, self.resolved.as_ref())?;
        Ok(())
    }

    /// Returns the pixels of each class from the words of a plan.
    fn classes(words: &[u32]) -> Vec<u32> {
        let first = (GOAL_CLASSES_AT - GOAL_MULTIPLIER) as usize;
        words[first..first + GOAL_CLASSES as usize].to_vec()
    }
}

/// Binds the film with the list of batches, and the sums of parts with theirs.
fn sample_groups(backend: &mut dyn GoalBackend<'_>, steps: &GoalSteps) -> Result<[BindGroup; 2]> {
    let passes = &backend.sampler()?.0.passes;
    Ok([passes.bind(&steps.film, &steps.batches)?, passes.bind(&steps.long.sums, &steps.long.list)?])
}

/// Words of a plan: from its multiplier to the classes of its batches.
const PLAN_WORDS: usize = (GOAL_CLASSES_AT + GOAL_CLASSES - GOAL_MULTIPLIER) as usize;

impl Pixels for DevicePixels<'_, '_> {
    fn backend(&mut self) -> &mut dyn Backend {
        self.backend
    }

    fn plan_first(&mut self, most: u32) -> Result<()> {
        let (none, all) = (GoalStep { count: 0, ..self.push }, GoalStep { count: most, ..self.push });
        let plan = [(Kind::PlanAll, none), (Kind::TakeCounts, none), (Kind::PlanAll, all)];
        self.ahead.extend(plan.map(|(kind, push)| Ahead::Step(kind, push)));
        self.next = Next::All { now: 0, next: most };
        if self.backend.first_samples_differ() {
            self.submit(&[])?;
            let counts = self.backend.first_samples(most, self.steps.count() as usize)?;
            let offset = 4 * u64::from(GOAL_NEXT) * u64::from(self.steps.count());
            self.gpu.write_buffer(&self.steps.pixels, offset, bytemuck::cast_slice(&counts))?;
            let empty = [0u32; PLAN_WORDS + GOAL_CLASSES as usize];
            let offset = 4 * u64::from(GOAL_MULTIPLIER);
            self.gpu.write_buffer(&self.steps.totals, offset, bytemuck::cast_slice(&empty))?;
            let list = [(Kind::ChooseCounts, self.push), (Kind::ListBatches, self.push)];
            let words: [u32; PLAN_WORDS] = self.run(&list, GOAL_MULTIPLIER)?;
            self.next = Next::Listed(Self::classes(&words));
        }
        Ok(())
    }

    fn plan_all(&mut self, count: u32) -> Result<()> {
        let all = GoalStep { count, ..self.push };
        self.ahead.push(Ahead::Step(Kind::PlanAll, all));
        self.next = Next::All { now: self.seen.least, next: count };
        Ok(())
    }

    fn plan(&mut self, plan: &Plan) -> Result<Planned> {
        let (aim, aims_at_error) = match plan.aim {
            Aim::Samples(samples) => (samples, 0),
            Aim::Mse(mse) => (mse * f64::from(self.steps.count()), 1),
        };
        let push = GoalStep {
            aim: (aim as f32).to_bits(),
            aims_at_error,
            exponent: (plan.exponent as f32).to_bits(),
            growth: (plan.growth as f32).to_bits(),
            most: plan.most,
            chooses: 1,
            ..self.push
        };
        let steps = [Kind::FillBins, Kind::Solve, Kind::ChooseCounts, Kind::ListBatches];
        let words: [u32; PLAN_WORDS] = self.run(&steps.map(|kind| (kind, push)), GOAL_MULTIPLIER)?;
        let classes = Self::classes(&words);
        let gaining = words[(GOAL_GAINING - GOAL_MULTIPLIER) as usize];
        let gains = gaining > 0 || plan.explores && classes.iter().any(|&pixels| pixels > 0);
        let cost = f32::from_bits(words[(GOAL_PLANNED_SAMPLES - GOAL_MULTIPLIER) as usize]);
        self.next = Next::Listed(classes);
        Ok(Planned { gains, cost: f64::from(cost) })
    }

    fn sample(&mut self, progress: &dyn Progress) -> Result<()> {
        let begun = self.backend.seconds();
        match &self.next {
            Next::All { now, next } => {
                let (now, next) = (*now, *next);
                self.sample_all(now, next, progress)?;
            }
            Next::Listed(classes) => {
                let classes = classes.clone();
                self.sample_classes(&classes, progress)?;
            }
        }
        self.sampling = self.backend.seconds() - begun;
        // Visits of the pass before are then looked at.
        self.push.pass += u32::from(self.seen.most > 0);
        self.took = true;
        Ok(())
    }

    fn estimate(&mut self, bright: bool) -> Result<Estimated> {
        self.push.bright = u32::from(bright);
        let reals = GoalStep { count: GOAL_MOST, ..self.push };
        let mut steps = Vec::new();
        if std::mem::take(&mut self.took) {
            steps.push((Kind::TakeCounts, self.push));
        }
        if self.push.resolves > 0 {
            steps.push((Kind::Replace, self.push));
        }
        let rest = [Kind::See, Kind::SumRows, Kind::FindVariances, Kind::FindUnseen, Kind::SpreadDiscoveries];
        steps.extend(rest.map(|kind| (kind, self.push)));
        steps.push((Kind::SumPartials, reals));
        let words: [u32; GOAL_COLUMNS as usize] = self.run(&steps, 0)?;
        let real = |column: u32| f64::from(f32::from_bits(words[column as usize]));
        let long = |lower: u32, upper: u32| {
            f64::from(words[lower as usize]) + 65_536.0 * f64::from(words[upper as usize])
        };
        let pixels = f64::from(self.steps.count());
        self.seen = Estimated {
            taken: 2.0 * long(GOAL_LOWER, GOAL_UPPER),
            sampling: self.sampling,
            mse: real(GOAL_DIFFERENCE) / pixels,
            deviation: (2.0 / 3.0 * real(GOAL_SQUARES)).sqrt() / pixels,
            variance: real(GOAL_VARIANCE) / pixels,
            resolved: real(GOAL_RESOLVED_PIXELS) as u64,
            least: !words[GOAL_LEAST as usize],
            most: words[GOAL_MOST as usize],
        };
        self.draw_sums = DrawSums {
            pixels,
            inverse_cost: real(GOAL_INVERSE_COST),
            variance: real(GOAL_VARIANCE),
            cost_variance: real(GOAL_COST_VARIANCE),
        };
        Ok(self.seen)
    }

    fn audit(&mut self, plan: &AuditPlan, progress: &dyn Progress) -> Result<Vec<Audited>> {
        self.audit_pixels(plan, progress)
    }

    fn raise(&mut self, raises: &Raises) -> Result<()> {
        let mut steps = Vec::new();
        let around = &raises.around[..raises.around.len().min(MAX_GOAL_DRAWS as usize)];
        if !around.is_empty() {
            let words: Vec<u32> =
                around.iter().flat_map(|&(pixel, spread)| [pixel, spread.to_bits()]).collect();
            let offset = 4 * u64::from(GOAL_RAISES);
            self.gpu.write_buffer(&self.steps.totals, offset, bytemuck::cast_slice(&words))?;
            steps.push((Kind::RaiseListed, GoalStep { count: around.len() as u32, ..self.push }));
        }
        if let Some(floors) = &raises.floors {
            let offset = 4 * u64::from(GOAL_FLOORS);
            self.gpu.write_buffer(&self.steps.totals, offset, bytemuck::cast_slice(floors))?;
            steps.push((Kind::RaiseToFloors, self.push));
        }
        if steps.is_empty() { Ok(()) } else { self.submit(&steps) }
    }

    fn shares(&mut self, pilot: &PilotRun, exponent: f64) -> Result<[f64; 2]> {
        let (counts, variances) = (self.read_array(GOAL_COUNTS)?, self.read_array(GOAL_VARIANCES)?);
        Ok(shares(pilot, &counts, &variances, exponent))
    }

    fn resolve(&mut self, resolved: Vec<[f32; 4]>) -> Result<()> {
        let bytes = bytemuck::cast_slice(&resolved);
        let buffer = self.gpu.upload_buffer("resolved pixels", BufferUse::Storage, bytes)?;
        self.resolved = Some(buffer);
        self.bind()?;
        self.push.resolves = 1;
        Ok(())
    }

    fn write_to(&mut self, film: &mut Film) -> Result<()> {
        self.submit(&[(Kind::FindMeans, self.push)])?;
        let offset = 4 * u64::from(GOAL_PAIRS) * u64::from(self.steps.count());
        self.gpu.read_buffer(&self.steps.pixels, offset, bytemuck::cast_slice_mut(&mut film.pixels))
    }

    fn counts_and_variances(&mut self) -> Result<(Vec<u32>, Vec<f32>)> {
        let counts: Vec<u32> = self.read_array(GOAL_COUNTS)?;
        Ok((counts.into_iter().map(|count| 2 * count).collect(), self.read_array(GOAL_VARIANCES)?))
    }
}
