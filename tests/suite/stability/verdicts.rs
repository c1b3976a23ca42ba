//! Verdicts within and above bounds, and the continuation or end of a run after a failing case.

use moire::internal::core::error::{Error, Result};
use moire::internal::core::progress::{NoProgress, Progress};
use moire::internal::lab::stability::case::{Bench, Point};
use moire::internal::lab::stability::report::Verdict;
use moire::internal::lab::stability::run::run;
use moire::internal::lab::stability::text::text;
use moire::internal::lab::stability::{all, case::Case};

use super::{case, none, points, report, row};
use crate::stage::device;
use crate::support::told;

#[test]
fn an_error_at_the_bound_is_within_and_one_above_or_no_number_is_broken() {
    for (errors, expected, worst) in [
        (vec![0.0, 1e-3, 1e-9], Verdict::Within, 1e-3),
        (vec![0.0], Verdict::Within, 0.0),
        (vec![1e-4, 1.01e-3, 0.0], Verdict::Broken, 1.01e-3),
        (vec![0.0, f64::NAN, 1e-9], Verdict::Broken, f64::INFINITY),
        (vec![-f64::NAN], Verdict::Broken, f64::INFINITY),
        (vec![f64::INFINITY], Verdict::Broken, f64::INFINITY),
        (vec![], Verdict::Broken, f64::INFINITY),
    ] {
        let row = row("a", &errors);
        assert_eq!((row.verdict, row.worst.error), (expected, worst), "{errors:?}");
        assert_eq!(report(vec![row]).passes(), expected == Verdict::Within, "{errors:?}");
    }
}

#[test]
fn the_worst_of_errors_is_kept_with_its_place_and_no_number_is_the_worst() {
    let errors = |list: &[f64]| list.iter().map(|e| (*e, format!("at {e}"))).collect::<Vec<_>>();
    assert_eq!(Point::worst(2.0, errors(&[0.25, 0.5, 0.0])).place, "at 0.5");
    assert_eq!(Point::worst(2.0, errors(&[0.0])).error, 0.0);
    let nan = Point::worst(2.0, errors(&[0.25, f64::NAN, 0.5]));
    assert_eq!((nan.error, nan.place.as_str()), (f64::INFINITY, "at NaN"));
}

#[test]
fn the_table_has_a_line_a_case_and_tells_the_reasons_of_broken_bounds() {
    let report = report(vec![row("sound", &[1e-4, 0.0, 5e-4]), row("off", &[1e-4, 0.25]), row("void", &[])]);
    let text = text(&report);
    let line = |start: &str| {
        let found = text.lines().find(|l| l.starts_with(start));
        found
            .unwrap_or_else(|| panic!("no line {start}\n{text}"))
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(
        line("planted/sound"),
        "planted/sound distance in metres, 1 to 100 5e-4 pixels 1e-3 100, pixel (2, 0) within"
    );
    assert_eq!(
        line("planted/off"),
        "planted/off distance in metres, 1 to 10 0.25 pixels 1e-3 10, pixel (1, 0) broken"
    );
    assert_eq!(
        line("planted/void"),
        "planted/void distance in metres ∞ pixels 1e-3 no value was measured broken"
    );
    assert_eq!(line("3 cases"), "3 cases, 5 points, 12.3 s: 1 within, 2 broken");
    assert_eq!(
        line("broken: planted/off"),
        "broken: planted/off: 0.25 pixels at 10, pixel (1, 0); the bound is 1e-3: half an ulp & no more"
    );
    assert!(!text.contains("broken: planted/sound"), "{text}");
}

fn small(_: &Bench<'_>) -> Result<Vec<Point>> {
    Ok(points(&[1e-6, 1e-5]))
}

fn fails(_: &Bench<'_>) -> Result<Vec<Point>> {
    Err(Error::with_help("the picture is too wide", "make it smaller"))
}

fn interrupted(_: &Bench<'_>) -> Result<Vec<Point>> {
    Err(Error::Interrupted)
}

fn cases() -> Vec<Case> {
    vec![case("a", "one", 1e-3, small), case("a", "two", 1e-3, fails), case("b", "one", 1e-7, small)]
}

#[test]
fn a_case_that_fails_is_broken_with_its_message_and_the_others_go_on() {
    let report = run(&device(), cases(), None, &NoProgress).unwrap();
    let verdicts: Vec<&str> = report.rows.iter().map(|r| r.verdict.name()).collect();
    assert_eq!(verdicts, ["within", "broken", "broken"]);
    assert_eq!(report.rows[1].worst.place, "the picture is too wide (make it smaller)");
    assert_eq!((report.summary.cases, report.summary.points, report.summary.broken), (3, 4, 2));
}

#[test]
fn only_chooses_by_a_part_of_the_name_and_an_unknown_one_lists_all_names() {
    let labels = |only| {
        let report = run(&device(), cases(), Some(only), &NoProgress).unwrap();
        report.rows.iter().map(|r| r.label()).collect::<Vec<_>>()
    };
    assert_eq!(labels("one"), ["a/one", "b/one"]);
    assert_eq!(labels("b/"), ["b/one"]);
    let told = told(run(&device(), cases(), Some("three"), &NoProgress));
    assert!(told.contains("\"three\"") && told.contains("a/one, a/two, b/one"), "{told}");
}

struct Stop;

impl Progress for Stop {
    fn advance(&self, _done: f64) {}

    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn a_wish_to_stop_ends_the_run_before_and_within_a_case() {
    let stopped = |cases, progress: &dyn Progress| {
        matches!(run(&device(), cases, None, progress), Err(Error::Interrupted))
    };
    assert!(stopped(vec![case("a", "one", 1.0, none)], &Stop));
    assert!(stopped(vec![case("a", "one", 1.0, interrupted)], &NoProgress));
    // All cases poll between values.
    let gpu = device();
    for case in all() {
        let outcome = (case.run)(&Bench::new(&gpu, &Stop));
        assert!(matches!(outcome, Err(Error::Interrupted)), "{} goes on", case.label());
    }
}

#[test]
fn all_cases_have_names_of_their_own_a_bound_and_a_reason() {
    let mut labels: Vec<String> = all().iter().map(Case::label).collect();
    let groups: Vec<&str> = all().iter().map(|c| c.group).collect();
    let mut blocks = groups.clone();
    blocks.dedup();
    let mut distinct = groups.clone();
    distinct.sort();
    distinct.dedup();
    assert_eq!(blocks.len(), distinct.len(), "cases of one group stand together: {groups:?}");
    for case in all() {
        assert!(case.bound.is_finite() && case.bound >= 0.0, "{}", case.label());
        assert!(case.reason.len() > 20 && case.reason.len() < 400, "{}: {}", case.label(), case.reason);
        assert!(!case.unit.is_empty() && !case.parameter.is_empty(), "{}", case.label());
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        assert!(format!("{}{}", case.group, case.name).chars().all(plain), "{}", case.label());
    }
    let count = labels.len();
    labels.sort();
    labels.dedup();
    assert_eq!(labels.len(), count);
}
