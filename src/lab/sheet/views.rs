//! The views of a plan: cells that one reference judges. Input: the plan. Output: groups of cells, those that can share a
//! session after each other, and what a person calls a group.

use super::identity::Identity;
use super::plan::{Job, Plan, ReferenceChoice};

/// Returns the cells to render, those of one reference together and among them those of one session.
pub(super) fn views(plan: &Plan) -> Vec<Vec<usize>> {
    let keys: Vec<(Identity, Identity, usize)> =
        plan.with_films().map(|(i, job)| (reference_of(plan, job), Identity::of(&job.scene), i)).collect();
    let views = groups(keys, |a, b| a.0 == b.0).into_iter();
    let sorted = |view| groups(view, |a: &(Identity, Identity, usize), b| a.1 == b.1).into_iter().flatten();
    views.map(|view| sorted(view).map(|key| key.2).collect()).collect()
}

/// Returns groups of entries that are alike, in the order of their first ones.
fn groups<T>(entries: Vec<T>, alike: impl Fn(&T, &T) -> bool) -> Vec<Vec<T>> {
    let mut groups: Vec<Vec<T>> = Vec::new();
    for entry in entries {
        match groups.iter_mut().find(|group| alike(&group[0], &entry)) {
            Some(group) => group.push(entry),
            None => groups.push(vec![entry]),
        }
    }
    groups
}

fn reference_of(plan: &Plan, job: &Job) -> Identity {
    // A file is the reference of all.
    let first = plan.jobs().next().unwrap_or(job);
    let is_file = matches!(plan.reference, ReferenceChoice::File { .. });
    Identity::of(&if is_file { first } else { job }.reference)
}

/// Returns the name of each view: the values that its cells share, and not all views do. A single view has none.
pub(super) fn names(plan: &Plan, views: &[Vec<usize>]) -> Vec<String> {
    let shared = |axis: usize, cells: &[usize]| {
        let mut values = cells.iter().map(|cell| plan.cells[*cell].at[axis]);
        let first = values.next()?;
        values.all(|value| value == first).then_some(first)
    };
    let differ = |axis: &usize| {
        let mut values = views.iter().map(|view| shared(*axis, view));
        let first = values.next().flatten();
        values.any(|value| value != first)
    };
    let axes: Vec<usize> = (0..plan.axes.len()).filter(differ).collect();
    let name = |view: &Vec<usize>| {
        let words =
            axes.iter().filter_map(|axis| Some(plan.axes[*axis].labels[shared(*axis, view)?].as_str()));
        words.collect::<Vec<_>>().join(", ")
    };
    views.iter().map(name).collect()
}
