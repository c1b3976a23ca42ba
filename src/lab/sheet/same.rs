//! Cells with the same picture. Input: the plan, and a digest of each film. Output: notes that say which settings have no
//! effect and where, and which cells are alike though their names differ.

use std::collections::BTreeMap;
use std::hash::{DefaultHasher, Hasher};

use super::plan::Plan;
use crate::core::film::Film;

/// The most places and pictures that a note names.
const MAX_NAMED: usize = 4;

/// Returns a number that is another one for films that differ in a bit.
pub(super) fn digest(film: &Film) -> u64 {
    let mut hasher = DefaultHasher::new();
    hasher.write_u32(film.width);
    film.pixels.iter().flatten().for_each(|value| hasher.write_u32(value.to_bits()));
    hasher.finish()
}

/// Returns what is to be said; cells without a film of their own have no digest.
pub(super) fn notes(plan: &Plan, digests: &[Option<u64>]) -> Vec<String> {
    let mut notes = Vec::new();
    // Cells of which it is said already that they are alike have the same number.
    let mut told: Vec<usize> = (0..digests.len()).collect();
    for axis in 0..plan.axes.len() {
        let lines = lines(plan, digests, axis);
        let is_even = |line: &&Vec<usize>| line.iter().all(|cell| digests[*cell] == digests[line[0]]);
        let (even, uneven): (Vec<&Vec<usize>>, Vec<_>) = lines.iter().partition(is_even);
        for line in &even {
            let known: Vec<usize> = line.iter().map(|cell| told[*cell]).collect();
            told.iter_mut().filter(|own| known.contains(own)).for_each(|own| *own = known[0]);
        }
        let name = &plan.axes[axis].name;
        match (even.len(), uneven.len()) {
            (0, _) => {}
            (_, 0) => notes.push(format!("{name} has no effect here: its values make the same picture")),
            _ => notes.push(format!(
                "{name} has no effect with {}: its values make the same picture",
                listed(places(plan, axis, &even, &uneven))
            )),
        }
    }
    notes.extend(others(plan, digests, &told));
    notes
}

/// Returns the cells with a film that differ in one setting only.
fn lines(plan: &Plan, digests: &[Option<u64>], axis: usize) -> Vec<Vec<usize>> {
    let mut lines: BTreeMap<Vec<usize>, Vec<usize>> = BTreeMap::new();
    for (i, cell) in plan.cells.iter().enumerate().filter(|(i, _)| digests[*i].is_some()) {
        let mut place = cell.at.clone();
        place[axis] = 0;
        // Compared as a person reads them: the last setting stands for whole blocks.
        place.reverse();
        lines.entry(place).or_default().push(i);
    }
    lines.into_values().filter(|line| line.len() > 1).collect()
}

/// Returns the names of lines by as few values of other settings as tell them apart from those that are uneven.
fn places(plan: &Plan, axis: usize, even: &[&Vec<usize>], uneven: &[&Vec<usize>]) -> Vec<String> {
    let others: Vec<usize> =
        (0..plan.axes.len()).filter(|other| *other != axis && plan.axes[*other].labels.len() > 1).collect();
    let value = |line: &[usize], other: usize| plan.cells[line[0]].at[other];
    let mut names = Vec::new();
    for line in even {
        let alone = |other: &&usize| uneven.iter().all(|one| value(one, **other) != value(line, **other));
        let told: Vec<usize> = match others.iter().find(alone) {
            Some(one) => vec![*one],
            None => others.clone(),
        };
        let words: Vec<&str> =
            told.iter().map(|other| plan.axes[*other].labels[value(line, *other)].as_str()).collect();
        let name = format!("\"{}\"", words.join(", "));
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Returns a note of the cells that are alike, but for those of which it is told.
fn others(plan: &Plan, digests: &[Option<u64>], told: &[usize]) -> Option<String> {
    let mut alike: BTreeMap<u64, Vec<usize>> = BTreeMap::new();
    for (i, digest) in digests.iter().enumerate().filter_map(|(i, digest)| Some((i, (*digest)?))) {
        let cells = alike.entry(digest).or_default();
        if cells.iter().all(|cell| told[*cell] != told[i]) {
            cells.push(i);
        }
    }
    let name = |cell: &usize| {
        let at = plan.axes.iter().zip(&plan.cells[*cell].at).filter(|(axis, _)| axis.labels.len() > 1);
        let words: Vec<&str> = at.map(|(axis, at)| axis.labels[*at].as_str()).collect();
        format!("\"{}\"", words.join(", "))
    };
    let mut groups: Vec<&Vec<usize>> = alike.values().filter(|cells| cells.len() > 1).collect();
    groups.sort();
    let said: Vec<String> = groups
        .iter()
        .take(MAX_NAMED)
        .map(|cells| format!("{} are the same picture", listed(cells.iter().map(name).collect())))
        .collect();
    (!said.is_empty()).then(|| said.join("; "))
}

fn listed(mut names: Vec<String>) -> String {
    let more = names.len().saturating_sub(MAX_NAMED);
    names.truncate(MAX_NAMED);
    if more > 0 {
        return format!("{} and {more} more", names.join(", "));
    }
    match names.split_last() {
        Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
        _ => names.concat(),
    }
}
