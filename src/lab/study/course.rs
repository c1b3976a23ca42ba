//! The order in which points are measured: all of them; or a coarse pass over all methods and then the promising ones; and
//! points that come nearer to a question. Input: the planned points. Output: the record's points and notes.

use super::identity::Hash;
use super::limit::Limit;
use super::measure::Measurement;
use super::method::Method;
use super::plan::Point;
use super::record::{PointRecord, Record};
use super::reference::Reference;
use super::refine::COARSE;
use super::session_cache::SessionCache;
use super::{Options, plan, refine};
use crate::core::counted::counted;
use crate::core::error::Result;
use crate::core::progress::Progress;
use crate::scene::model::{Algorithm, Scene};

/// The parts of the progress at which the coarse pass and the points for a question end and begin.
const COARSE_END: f64 = 0.3;
const QUESTION_START: f64 = 0.8;

pub struct Course<'a> {
    pub sessions: &'a SessionCache<'a>,
    pub scene: &'a Scene,
    pub options: &'a Options,
    pub methods: &'a [Method],
    pub reference: &'a Reference,
    pub identity: &'a Hash,
    pub limit: &'a Limit,
    pub progress: &'a dyn Progress,
}

impl Course<'_> {
    pub fn run(&self, record: &mut Record, points: Vec<Point>, kept: Vec<PointRecord>) -> Result<()> {
        let repeats = self.options.repeats;
        let mut all = points;
        let mut paused = Vec::new();
        let mut begin = 0.0;
        let end = if self.options.question.is_some() { QUESTION_START } else { 1.0 };
        if self.options.best {
            let coarse = self.coarse(&all)?;
            self.measure(record, &coarse, 1, &[], [begin, COARSE_END], &kept)?;
            let going_on = self.choose(record);
            paused = (0..self.methods.len()).filter(|i| !going_on.contains(i)).collect();
            all.retain(|point| going_on.contains(&point.method) || coarse.contains(point));
            all.extend(coarse.into_iter().filter(|point| !going_on.contains(&point.method)));
            let mut seen: Vec<Point> = Vec::new();
            all.retain(|point| {
                let is_new = !seen.contains(point);
                seen.push(*point);
                is_new
            });
            begin = COARSE_END;
        }
        self.measure(record, &all, repeats, &paused, [begin, end], &kept)?;
        let Some(question) = self.options.question else { return Ok(()) };
        let largest = self.options.counts.iter().copied().max().unwrap_or(1);
        let more = refine::toward(question, record, self.methods, self.scene, largest)?;
        if more.is_empty() {
            return Ok(());
        }
        // What is measured further is measured as often as the others.
        paused.retain(|method| !more.iter().any(|point| point.method == *method));
        all.extend(more);
        self.measure(record, &all, repeats, &paused, [end, 1.0], &kept)
    }

    /// Returns the points with few samples, and the one of beams.
    fn coarse(&self, points: &[Point]) -> Result<Vec<Point>> {
        let mut counts = self.options.counts.clone();
        counts.sort_unstable();
        let few = counts.iter().filter(|count| **count <= COARSE).count().max(1);
        let mut coarse = plan::points(self.methods, self.scene, &counts[..few])?;
        let is_beam = |point: &Point| self.methods[point.method].algorithm == Algorithm::Beam;
        coarse.retain(|point| !is_beam(point));
        coarse.extend(points.iter().copied().filter(is_beam));
        Ok(coarse)
    }

    /// Returns the methods to go on with, and notes which they are.
    fn choose(&self, record: &mut Record) -> Vec<usize> {
        let counts = &self.options.counts;
        let most = counts.iter().copied().max().unwrap_or(1);
        let coarse = counts.iter().copied().filter(|count| *count <= COARSE).max().unwrap_or(most);
        let growth = f64::from(most) / f64::from(coarse);
        let going_on = refine::promising(record, self.options.question, growth);
        let names: Vec<String> = going_on.iter().map(|i| record.methods[*i].label.clone()).collect();
        record.notes.push(format!(
            "--methods best: after one render of each point with at most {} of {}, these went on: {}",
            counted(coarse, "sample"),
            counted(self.methods.len(), "method"),
            names.join("; ")
        ));
        going_on
    }

    fn measure(
        &self,
        record: &mut Record,
        points: &[Point],
        repeats: u32,
        paused: &[usize],
        progress: [f64; 2],
        kept: &[PointRecord],
    ) -> Result<()> {
        let kept = [record.points.as_slice(), kept].concat();
        let start = self.reference.progress;
        Measurement {
            sessions: self.sessions,
            scene: self.scene,
            options: self.options,
            methods: self.methods,
            points,
            repeats,
            paused,
            span: progress.map(|part| start + (1.0 - start) * part),
            reference: self.reference,
            identity: self.identity,
            limit: self.limit,
            progress: self.progress,
        }
        .run(record, kept)
    }
}
