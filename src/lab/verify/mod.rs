//! Sampler conformance of a device. Every variant of sampler, kind of texture and texel format is
//! looked up on the device over random, awkward and finely stepped coordinates and levels and
//! compared with the float64 oracle by the interval rule; so are the shader's own filters from both
//! texel sources.

pub mod batch;
pub mod groups;
pub mod interval;
pub mod judge;
pub mod known;
pub mod level_variants;
pub mod queries;
pub mod reading;
pub mod report;
pub mod run;
pub mod sweeps;
pub mod text;
pub mod variants;
pub mod weights;

use std::time::Instant;

use crate::core::error::{Error, Result};
use crate::core::progress::Progress;
use crate::gpu::Gpu;
use crate::lab::probe;
use crate::pack::MAX_SLOTS;
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::{Filter, MipMode};
use judge::Precision;
use queries::Axis;
use report::{ConformanceReport, Row};
use run::Tally;
use variants::{Reader, Scale, Variant};

/// The rounds of the shader's variants at level 0; each gives its textures other sizes.
const ROUNDS: usize = 2;

/// Variants whose lookups one dispatch answers, by index in the list of all.
struct WorkItem {
    members: Vec<usize>,
    precision: Precision,
    kind: Kind,
}

#[derive(Clone, Copy)]
enum Kind {
    Scattered,
    Sweep,
    Ramp(Axis),
    LevelRamp,
}

/// Verifies everything that the device offers and whose label contains `only`.
pub fn verify(gpu: &Gpu, only: Option<&str>, progress: &dyn Progress) -> Result<ConformanceReport> {
    let start = Instant::now();
    let device = gpu.info();
    let offered = |v: &Variant| {
        let samples = || probe::can_sample(gpu, &v.spec, v.format, v.class.color_space());
        let follows =
            v.scale != Scale::Anisotropic || v.spec.max_anisotropy as f32 <= device.limits.max_anisotropy;
        v.reader != Reader::Sampler || (follows && samples())
    };
    let mut all = variants::all(device.limits.custom_border_color, ROUNDS);
    if let Some(text) = only {
        let first = all.first().map(Variant::label).unwrap_or_default();
        all.retain(|v| v.label().contains(text));
        if all.is_empty() {
            return Err(Error::with_help(
                format!("no variant has \"{text}\" in its name"),
                format!("names are like \"{first}\""),
            ));
        }
    }
    let (variants, missing): (Vec<Variant>, Vec<Variant>) = all.into_iter().partition(offered);

    let work_items = work_items(&variants, Precision::declared(device));
    let mut tallies = vec![Tally::default(); variants.len()];
    for (done, work) in work_items.iter().enumerate() {
        let members = work.members.iter().map(|&i| &variants[i]).collect();
        let seed = 1 + done as u64;
        let found = match work.kind {
            Kind::Scattered => run::check_lookups(gpu, members, work.precision, seed)?,
            Kind::Sweep => run::sweeps(gpu, members, work.precision, seed)?,
            Kind::Ramp(axis) => run::ramps(gpu, members, work.precision, axis)?,
            Kind::LevelRamp => run::level_ramps(gpu, members, work.precision)?,
        };
        for (&i, tally) in work.members.iter().zip(found) {
            tallies[i].merge(tally);
        }
        progress.advance((done + 1) as f64 / work_items.len() as f64);
        if progress.cancelled() {
            return Err(Error::Interrupted);
        }
    }
    let rows = variants.iter().zip(tallies).map(|(variant, tally)| Row::new(device, variant, tally));
    Ok(ConformanceReport::new(device, rows.collect(), &missing, start.elapsed().as_secs_f64()))
}

/// Splits the variants into work items of as many as one pipeline reads.
fn work_items(variants: &[Variant], declared: Precision) -> Vec<WorkItem> {
    let mut all = Vec::new();
    let mut add = |wanted: &dyn Fn(&Variant) -> bool, precision: Precision, kind: Kind| {
        let members = (0..variants.len()).filter(|&i| wanted(&variants[i])).collect();
        let parts = in_slots(variants, members).into_iter();
        all.extend(parts.map(|members| WorkItem { members, precision, kind }));
    };
    let at_level_0 = |v: &Variant, reader| v.reader == reader && !v.is_filtered();
    add(&|v| at_level_0(v, Reader::Sampler), declared, Kind::Scattered);
    add(&|v| at_level_0(v, Reader::ShaderBuffer), Precision::Shader, Kind::Scattered);
    add(&|v| at_level_0(v, Reader::ShaderImage), Precision::Shader, Kind::Scattered);
    for &dimension in Dimension::ALL {
        let of = |v: &Variant, reader, scale| (v.reader, v.scale, v.dimension) == (reader, scale, dimension);
        add(&|v| of(v, Reader::Sampler, Scale::Levels), declared, Kind::Sweep);
        add(&|v| of(v, Reader::Sampler, Scale::Anisotropic), declared, Kind::Sweep);
        add(&|v| of(v, Reader::ShaderBuffer, Scale::Levels), Precision::Shader, Kind::Sweep);
        add(&|v| of(v, Reader::ShaderImage, Scale::Levels), Precision::Shader, Kind::Sweep);
    }
    add(&wants_ramp, declared, Kind::Ramp(Axis::U));
    add(&wants_ramp, declared, Kind::Ramp(Axis::V));
    add(&wants_level_ramp, declared, Kind::LevelRamp);
    all
}

/// Splits variants to fit the image slots of a pipeline: one per variant for the device's samplers,
/// one per texture for the shader.
fn in_slots(variants: &[Variant], members: Vec<usize>) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = Vec::new();
    let mut slots = Vec::new();
    for i in members {
        let v = &variants[i];
        let slot = (v.class, v.format, v.size);
        let new = v.reader == Reader::Sampler || !slots.contains(&slot);
        if parts.is_empty() || (new && slots.len() == MAX_SLOTS) {
            parts.push(Vec::new());
            slots.clear();
        }
        if v.reader == Reader::Sampler || !slots.contains(&slot) {
            slots.push(slot);
        }
        if let Some(part) = parts.last_mut() {
            part.push(i);
        }
    }
    parts
}

/// Returns true for one ramp per axis for each pair of address modes, scale and class of formats.
fn wants_ramp(variant: &Variant) -> bool {
    filters_linearly(variant) && !variant.is_filtered() && variant.spec.mip == MipMode::None
}

/// Returns true for one variant of each pair of address modes.
fn wants_level_ramp(variant: &Variant) -> bool {
    let levels = variant.scale == Scale::Levels && variant.dimension == Dimension::Two;
    filters_linearly(variant) && levels && variant.spec.mip == MipMode::Linear
}

fn filters_linearly(variant: &Variant) -> bool {
    let spec = &variant.spec;
    variant.reader == Reader::Sampler && spec.mag == Filter::Linear && spec.min == Filter::Linear
}
