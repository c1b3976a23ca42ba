//! Sampler conformance: a device in, a report out. Every variant of sampler and texel format is looked
//! up on the device over random, awkward and finely stepped coordinates and held against the float64
//! oracle by the interval rule; so are the shader's own filters from both texel sources. Images of two
//! dimensions, level 0 by explicit level.

pub mod judge;
pub mod known;
pub mod queries;
pub mod report;
pub mod run;
pub mod text;
pub mod variants;
pub mod weights;

use std::time::Instant;

use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::pack::MAX_SLOTS;
use crate::probe;
use crate::progress::Progress;
use crate::texture::sampler_spec::{Filter, MipMode};
use judge::Precision;
use report::{Report, Row};
use run::Tally;
use variants::{Reader, Variant};

/// Rounds of the shader's variants; each gives its textures other sizes.
const ROUNDS: usize = 2;

/// Verifies everything that the device offers.
pub fn verify(gpu: &Gpu, progress: &dyn Progress) -> Result<Report> {
    let start = Instant::now();
    let device = gpu.info();
    let all = variants::sampler_variants(device.limits.custom_border_color);
    let offered = |v: &Variant| probe::can_sample(gpu, &v.spec, v.format, v.class.color_space());
    let (samplers, missing): (Vec<Variant>, Vec<Variant>) = all.into_iter().partition(offered);
    let shaders: Vec<Variant> = [Reader::ShaderBuffer, Reader::ShaderImage]
        .into_iter()
        .flat_map(|reader| (0..ROUNDS).flat_map(move |round| variants::shader_variants(reader, round)))
        .collect();
    let per_round = shaders.len() / (2 * ROUNDS);

    let mut batches: Vec<(&[Variant], Precision)> = Vec::new();
    let declared = Precision::declared(device);
    batches.extend(samplers.chunks(MAX_SLOTS).map(|batch| (batch, declared)));
    batches.extend(shaders.chunks(per_round).map(|batch| (batch, Precision::Shader)));
    let ramps: Vec<usize> = (0..samplers.len()).filter(|&i| wants_ramp(&samplers[i])).collect();
    let steps = (batches.len() + ramps.len().div_ceil(MAX_SLOTS)) as f64;
    let mut done = 0.0;
    let mut step = || {
        done += 1.0;
        progress.advance(done / steps);
        if progress.cancelled() { Err(Error::Interrupted) } else { Ok(()) }
    };

    let mut tallies: Vec<Tally> = Vec::new();
    for (seed, (batch, precision)) in (1..).zip(batches) {
        tallies.extend(run::look_ups(gpu, batch.iter().collect(), precision, seed)?);
        step()?;
    }
    for batch in ramps.chunks(MAX_SLOTS) {
        let found = run::weights(gpu, batch.iter().map(|&i| &samplers[i]).collect())?;
        for (&i, bits) in batch.iter().zip(found) {
            tallies[i].weights = Some(bits);
        }
        step()?;
    }
    let rows = samplers.iter().chain(&shaders).zip(tallies);
    let rows = rows.map(|(variant, tally)| Row::new(device, variant, tally)).collect();
    Ok(Report::new(device, rows, &missing, start.elapsed().as_secs_f64()))
}

/// One ramp for each pair of address modes and class of formats.
fn wants_ramp(variant: &Variant) -> bool {
    let spec = &variant.spec;
    spec.mag == Filter::Linear && spec.min == Filter::Linear && spec.mip == MipMode::None
}
