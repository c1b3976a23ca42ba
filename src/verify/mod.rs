//! Sampler conformance: a device in, a report out. Every variant of sampler and texel format is looked
//! up on the device over random, awkward and finely stepped coordinates and held against the float64
//! oracle by the interval rule; so are the shader's own filters from both texel sources. Images of two
//! dimensions, level 0.

pub mod groups;
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
use queries::Axis;
use report::{Report, Row};
use run::Tally;
use variants::{Reader, Variant};

/// Rounds of the shader's variants; each gives its textures other sizes.
const ROUNDS: usize = 2;

/// Variants whose look-ups one dispatch answers, by their place in the list of all.
struct Batch {
    members: Vec<usize>,
    precision: Precision,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Scattered,
    Ramp(Axis),
}

/// Verifies everything that the device offers.
pub fn verify(gpu: &Gpu, progress: &dyn Progress) -> Result<Report> {
    let start = Instant::now();
    let device = gpu.info();
    let offered = |v: &Variant| {
        v.reader != Reader::Sampler || probe::can_sample(gpu, &v.spec, v.format, v.class.color_space())
    };
    let all = variants::all(device.limits.custom_border_color, ROUNDS);
    let (variants, missing): (Vec<Variant>, Vec<Variant>) = all.into_iter().partition(offered);

    let batches = batches(&variants, Precision::declared(device));
    let mut tallies = vec![Tally::default(); variants.len()];
    for (done, batch) in batches.iter().enumerate() {
        let members = batch.members.iter().map(|&i| &variants[i]).collect();
        let found = match batch.kind {
            Kind::Scattered => run::look_ups(gpu, members, batch.precision, 1 + done as u64)?,
            Kind::Ramp(axis) => run::ramps(gpu, members, batch.precision, axis)?,
        };
        for (&i, tally) in batch.members.iter().zip(found) {
            tallies[i].merge(tally);
        }
        progress.advance((done + 1) as f64 / batches.len() as f64);
        if progress.cancelled() {
            return Err(Error::Interrupted);
        }
    }
    let rows = variants.iter().zip(tallies).map(|(variant, tally)| Row::new(device, variant, tally));
    Ok(Report::new(device, rows.collect(), &missing, start.elapsed().as_secs_f64()))
}

/// As many variants a batch as one pipeline reads: a slot each for the device's samplers, a slot a
/// texture for the shader.
fn batches(variants: &[Variant], declared: Precision) -> Vec<Batch> {
    let indices = |wanted: &dyn Fn(&Variant) -> bool| -> Vec<usize> {
        (0..variants.len()).filter(|&i| wanted(&variants[i])).collect()
    };
    let mut all = Vec::new();
    let mut add = |members: Vec<usize>, size: usize, precision: Precision, kind: Kind| {
        let batch = |chunk: &[usize]| Batch { members: chunk.to_vec(), precision, kind };
        all.extend(members.chunks(size).map(batch));
    };
    add(indices(&|v| v.reader == Reader::Sampler), MAX_SLOTS, declared, Kind::Scattered);
    for reader in [Reader::ShaderBuffer, Reader::ShaderImage] {
        let size = variants::shader_variants(reader, 0).len();
        add(indices(&|v| v.reader == reader), size, Precision::Shader, Kind::Scattered);
    }
    add(indices(&wants_ramp), MAX_SLOTS, declared, Kind::Ramp(Axis::U));
    add(indices(&wants_ramp), MAX_SLOTS, declared, Kind::Ramp(Axis::V));
    all
}

/// One ramp an axis for each pair of address modes, scale and class of formats.
fn wants_ramp(variant: &Variant) -> bool {
    let spec = &variant.spec;
    let linear = spec.mag == Filter::Linear && spec.min == Filter::Linear;
    variant.reader == Reader::Sampler && linear && spec.mip == MipMode::None
}
