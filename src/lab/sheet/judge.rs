//! What the pictures of one view err by. Input: pictures, and a reference that may be noisy. Output: errors with what the
//! noise leaves unknown of them, and notes where it is too large to rank two of them.

use super::record::{CellRecord, Record};
use super::reference::Reference;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::lab::metrics::Halves;
use crate::lab::metrics::flip::PerceptualFeatures;
use crate::lab::study::format::error;
use crate::lab::study::label;
use crate::scene::MAX_SPP;

/// The error of a reference is to be at most this share of that of the best picture: FLIP and differences contain it.
const QUIET: f64 = 0.25;
/// And at most a step of an 8-bit file, for it is looked at, too.
const INVISIBLE: f64 = 1.0 / 255.0;
/// The share from which on it is told that they do.
const LOUD: f64 = 0.5;
/// The most times as many samples that are advised.
const WORTHWHILE: f64 = 64.0;
/// The most pairs that are named.
const MAX_PAIRS: usize = 3;

/// A picture that waits for its reference.
pub(super) struct Drawn {
    /// Its cell.
    pub(super) index: usize,
    pub(super) film: Film,
}

/// Returns true if a reference of these halves is good enough for the pictures.
pub(super) fn is_enough(halves: &Halves, drawn: &[Drawn]) -> Result<bool> {
    let own = halves.rmse()?;
    if own > INVISIBLE {
        return Ok(false);
    }
    for Drawn { film, .. } in drawn {
        if let Some(mse) = halves.mse_of(film)?
            && (!mse.is_clear() || own > QUIET * mse.value.max(0.0).sqrt())
        {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Records what a picture errs by.
pub(super) fn judge(record: &mut CellRecord, film: &Film, reference: &Reference) -> Result<()> {
    let Some(mse) = reference.mse_of(film)? else { return Ok(()) };
    record.flip = Some(PerceptualFeatures::of(film).mean(&reference.features));
    if !mse.is_clear() {
        record.rmse_below = Some(mse.bound().sqrt());
        return Ok(());
    }
    let rmse = mse.value.max(0.0).sqrt();
    record.rmse = Some(rmse);
    // The derivative of the root.
    record.rmse_deviation =
        reference.halves.as_ref().map(|_| 0.5 * mse.deviation / rmse.max(f64::MIN_POSITIVE));
    Ok(())
}

/// Returns what is to be said of the reference of pictures that were judged by it; `whose` it is stands behind it.
pub(super) fn notes(
    record: &Record,
    drawn: &[Drawn],
    reference: &Reference,
    whose: &str,
) -> Result<Vec<String>> {
    let Some(halves) = &reference.halves else { return Ok(Vec::new()) };
    let mut notes: Vec<String> = unranked(record, drawn, halves, whose)?.into_iter().collect();
    let of = |drawn: &Drawn| record.cells[drawn.index].rmse.or(record.cells[drawn.index].rmse_below);
    let least = drawn.iter().filter_map(of).fold(f64::INFINITY, f64::min);
    let own = reference.record.rmse.unwrap_or(0.0);
    if own > LOUD * least {
        let wanted = quieter(reference.record.samples, own / (QUIET * least.max(f64::MIN_POSITIVE)));
        notes.push(format!(
            "the reference{whose} itself is off by RMSE {}, which FLIP and difference pictures contain and RMSE does not; \
             quieter: --reference-spp {wanted}",
            error(own)
        ));
    }
    Ok(notes)
}

/// Returns the neighbours in rank of which the reference does not tell which one is better.
fn unranked(record: &Record, drawn: &[Drawn], halves: &Halves, whose: &str) -> Result<Option<String>> {
    let mut ranked = Vec::with_capacity(drawn.len());
    for one in drawn {
        if let Some(mse) = halves.mse_of(&one.film)? {
            ranked.push((mse.value, one));
        }
    }
    ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pairs = Vec::new();
    let mut factor: f64 = 1.0;
    for pair in ranked.windows(2) {
        let [x, y] = [pair[0].1, pair[1].1];
        if let Some(more) = halves.mse_between(&x.film, &y.film)?
            && !more.is_clear()
        {
            let cells = [x, y].map(|one| &record.cells[one.index]);
            pairs.push(named(cells, |name| is_shared(record, drawn, name)));
            factor = factor.max(2.0 * more.deviation / more.value.abs().max(f64::MIN_POSITIVE));
        }
    }
    if pairs.is_empty() {
        return Ok(None);
    }
    let more = match pairs.len().saturating_sub(MAX_PAIRS) {
        0 => String::new(),
        more => format!(" and {more} more pairs"),
    };
    pairs.truncate(MAX_PAIRS);
    let way = match factor * factor <= WORTHWHILE {
        true => format!("it may with --reference-spp {}", quieter(2 * halves.a.samples, factor)),
        false => "they err by nearly the same".into(),
    };
    let pairs = pairs.join("; ");
    Ok(Some(format!(
        "the noise of the reference{whose} does not tell which is better of {pairs}{more}: {way}"
    )))
}

/// Returns the words for those settings of a cell that a test chooses by their names.
fn words(cell: &CellRecord, is_said: impl Fn(&str) -> bool) -> String {
    let own = cell.settings.iter().filter(|(name, _)| is_said(name));
    own.map(|(name, value)| label::setting(name, value)).collect::<Vec<_>>().join(", ")
}

/// Returns true if all cells of a view have the same value of a setting.
fn is_shared(record: &Record, drawn: &[Drawn], name: &str) -> bool {
    let mut values = drawn.iter().map(|one| record.cells[one.index].settings.get(name));
    let first = values.next();
    values.all(|value| Some(value) == first)
}

/// Returns the names of two cells: the settings in which they differ, and then those that they share, but not with all.
fn named([x, y]: [&CellRecord; 2], is_shared: impl Fn(&str) -> bool) -> String {
    let differ = |name: &str| x.settings.get(name) != y.settings.get(name);
    let both = words(x, |name| !differ(name) && !is_shared(name));
    let both = if both.is_empty() { both } else { format!(" ({both})") };
    format!("\"{}\" and \"{}\"{both}", words(x, differ), words(y, differ))
}

/// Returns the samples of a reference whose error is so many times less, a power of two.
fn quieter(samples: u32, factor: f64) -> u32 {
    let wanted = f64::from(samples) * (factor * factor).max(2.0);
    (wanted.min(f64::from(MAX_SPP)) as u32).next_power_of_two().min(MAX_SPP)
}
