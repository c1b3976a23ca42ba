//! Lists of jobs → sums of two halves, in f64 on all cores. Twin of the jobs of
//! `glsl/shared/render_main.glsl`.

use rayon::prelude::*;

use super::pixel_filter::filter_width;
use super::render::sample;
use crate::adaptive::{Sums, Tracer};
use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::pack::{PackedScene, filtered_mean};
use crate::schema::layout::{JOB_BARE, Job};

pub struct JobTracer<'a> {
    scene: &'a PackedScene,
    /// Of each half: red, green, blue, squares' mean; red, green, blue of samples whose sign is negative; sum of the
    /// signs, number of samples.
    halves: [Vec<[f64; 9]>; 2],
}

impl JobTracer<'_> {
    pub fn new(scene: &PackedScene) -> JobTracer<'_> {
        let [width, height, _, _] = scene.header.size;
        let half = || vec![[0.0; 9]; width as usize * height as usize];
        JobTracer { scene, halves: [half(), half()] }
    }

    fn sum(&self, job: &Job) -> [f64; 9] {
        let place = job.column_and_row();
        let mut sum = [0.0; 9];
        let mut header = self.scene.header;
        let samples = 2.0 * f64::from(job.first + job.count);
        let share = filter_width(&header) / samples.sqrt();
        header.step_x[3] = if job.part & JOB_BARE != 0 { 0.0 } else { share };
        for s in job.first..job.first + job.count {
            let (seen, sign) = sample(self.scene, &header, place, job.stream(), s);
            let [x, y, z] = (sign * seen).to_array();
            let [r, g, b] = if sign < 0.0 { seen.to_array() } else { [0.0; 3] };
            let terms = [x, y, z, seen.length_squared() / 3.0, r, g, b, sign, 1.0];
            sum = std::array::from_fn(|i| sum[i] + terms[i]);
        }
        sum
    }

    /// Weighed by the samples' signs.
    fn radiance(&self, &[r, g, b, squares, ref negative @ .., signs, samples]: &[f64; 9]) -> [f32; 4] {
        let mut sums = [r, g, b];
        if let Some(mean) = self.scene.mean_sign.filter(|_| samples > 0.0) {
            let filtered = |c: usize| filtered_mean(sums[c], negative[c], signs, samples, mean);
            sums = [0, 1, 2].map(|c| samples * filtered(c));
        }
        [sums[0], sums[1], sums[2], squares].map(|v| v as f32)
    }
}

impl Tracer for JobTracer<'_> {
    fn sample(&mut self, jobs: &[Job], progress: &dyn Progress) -> Result<()> {
        let of_job = |job: &Job| if progress.cancelled() { [0.0; 9] } else { self.sum(job) };
        let sums: Vec<[f64; 9]> = jobs.par_iter().map(of_job).collect();
        if progress.cancelled() {
            return Err(Error::Interrupted);
        }
        let width = self.scene.header.size[0];
        for (job, sum) in jobs.iter().zip(sums) {
            let [x, y] = job.column_and_row();
            let at = (y * width + x) as usize;
            let total = &mut self.halves[(job.part & 1) as usize][at];
            *total = std::array::from_fn(|i| if job.first > 0 { total[i] + sum[i] } else { sum[i] });
        }
        Ok(())
    }

    fn sample_apart(&mut self, jobs: &[Job], progress: &dyn Progress) -> Result<Vec<[f32; 4]>> {
        let of_job = |job: &Job| if progress.cancelled() { [0.0; 9] } else { self.sum(job) };
        let sums: Vec<[f64; 9]> = jobs.par_iter().map(of_job).collect();
        if progress.cancelled() {
            return Err(Error::Interrupted);
        }
        Ok(sums.iter().map(|sum| self.radiance(sum)).collect())
    }

    fn bright_share(&self) -> f64 {
        self.scene.bright_share.unwrap_or(1.0)
    }

    fn prefilters(&self) -> bool {
        self.scene.prefilters()
    }

    fn read(&mut self, sums: &mut Sums) -> Result<()> {
        for (out, half) in sums.halves.iter_mut().zip(&self.halves) {
            out.iter_mut().zip(half).for_each(|(out, sum)| *out = self.radiance(sum));
        }
        Ok(())
    }
}
