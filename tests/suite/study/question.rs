//! A study that is asked for a time or an error: the answer of synthetic points, the notes of a busy machine, the methods to
//! go on with, and the command.

use std::fs;

use moire::internal::lab::study::method::Method;
use moire::internal::lab::study::record::{Conditions, Errors, MethodRecord, PointRecord, Question, Record};
use moire::internal::lab::study::results::Steadiness;
use moire::internal::lab::study::{analysis, question, refine, steadiness};
use moire::internal::scene::model::Pattern;
use tempfile::tempdir;

use super::{points, scene, studied, study, told};
use crate::stage::{self, path};

fn point(method: &str, spp: u32, seconds: &[f64], rmse: f64) -> PointRecord {
    PointRecord {
        method: method.into(),
        spp,
        samples: spp,
        picture: format!("{method} {spp}"),
        seconds: seconds.to_vec(),
        errors: Errors { rmse, ..Errors::default() },
        ..PointRecord::default()
    }
}

/// A record of these points, analysed.
fn record(points: Vec<PointRecord>, question: Option<Question>) -> Record {
    let conditions = Conditions {
        program: String::new(),
        scene: String::new(),
        size: [8, 8],
        seed: 1,
        device: stage::device().info().clone(),
        repeats: 3,
        limit: 600.0,
        counts: vec![1, 4, 16],
        arguments: Vec::new(),
        folder: String::new(),
        question,
    };
    let mut names: Vec<String> = points.iter().map(|p| p.method.clone()).collect();
    names.dedup();
    let method = |name: &String| MethodRecord {
        name: name.clone(),
        label: Method::parse(name).unwrap().label(Pattern::Stratified),
        algorithm: "samples".into(),
        pattern: "stratified".into(),
        footprint: "none".into(),
        filter: None,
    };
    let mut record = Record::new(conditions, names.iter().map(method).collect());
    record.points = points;
    record.analysis = Some(analysis::analyse(&record));
    record
}

fn three_methods() -> Vec<PointRecord> {
    vec![
        point("random", 1, &[0.001], 0.2),
        point("random", 4, &[0.004], 0.1),
        point("random", 16, &[0.016], 0.05),
        point("sobol-owen", 1, &[0.002], 0.15),
        point("sobol-owen", 4, &[0.008], 0.03),
        point("stratified+cone+linear", 1, &[0.006], 0.04),
        point("stratified+cone+linear", 4, &[0.03], 0.035),
    ]
}

#[test]
fn the_least_error_in_a_time_and_the_least_time_to_an_error_are_recommended() {
    let answer = |question| {
        let record = record(three_methods(), Some(question));
        let analysis = record.analysis.unwrap();
        let best = analysis.recommended.unwrap();
        (best.method, best.spp, analysis.recommendation)
    };
    let (method, spp, sentence) = answer(Question::Budget(0.007));
    assert_eq!((method.as_str(), spp), ("stratified+cone+linear", 1));
    assert!(sentence.starts_with("In 7 ms use trilinear, cone footprint with 1 sample: RMSE"), "{sentence}");
    assert!(sentence.contains("next comes random with 4 samples"), "{sentence}");
    let (method, spp, _) = answer(Question::Budget(0.05));
    assert_eq!((method.as_str(), spp), ("sobol-owen", 4));
    let (method, spp, sentence) = answer(Question::Error(0.045));
    assert_eq!((method.as_str(), spp), ("stratified+cone+linear", 1));
    assert!(sentence.starts_with("Fastest to an RMSE of 0.045 is trilinear"), "{sentence}");
    assert!(sentence.contains("next comes Sobol-Owen with 4 samples: 8.00 ms"), "{sentence}");
    // What nothing keeps is told as such, with what comes nearest.
    let (method, spp, sentence) = answer(Question::Budget(1e-6));
    assert_eq!((method.as_str(), spp), ("random", 1));
    assert!(sentence.starts_with("Nothing that was measured takes as little as 1 µs"), "{sentence}");
    let (method, spp, sentence) = answer(Question::Error(1e-6));
    assert_eq!((method.as_str(), spp), ("sobol-owen", 4));
    assert!(sentence.starts_with("Nothing that was measured errs as little as 1e−6"), "{sentence}");
}

#[test]
fn a_reference_that_errs_by_more_than_what_is_asked_is_noted() {
    let mut asked = record(three_methods(), Some(Question::Error(0.01)));
    asked.reference.rmse = Some(0.02);
    let note = question::note(&asked).unwrap();
    assert!(note.contains("the reference itself errs by 2.00e−2, more than the 0.01"), "{note}");
    asked.reference.rmse = Some(0.005);
    assert_eq!(question::note(&asked), None);
    asked.conditions.question = Some(Question::Budget(0.001));
    asked.reference.rmse = Some(0.02);
    assert_eq!(question::note(&asked), None);
}

#[test]
fn ranking_has_the_best_point_of_each_method_in_order() {
    let points = three_methods();
    let names = |question: Question| {
        question.ranking(&points).iter().map(|p| (p.method.clone(), p.spp)).collect::<Vec<_>>()
    };
    let expected = [("stratified+cone+linear", 1), ("random", 4), ("sobol-owen", 1)];
    assert_eq!(names(Question::Budget(0.007)), expected.map(|(name, spp)| (name.to_owned(), spp)));
    let expected = [("stratified+cone+linear", 1), ("sobol-owen", 4), ("random", 16)];
    assert_eq!(names(Question::Error(0.04)), expected.map(|(name, spp)| (name.to_owned(), spp)));
}

/// Two methods whose times to one error are a tenth apart, with repeats that spread this far.
fn neighbours(spread: f64) -> Record {
    let times = |seconds: f64| [seconds, seconds * (1.0 - 0.5 * spread), seconds * (1.0 + 0.5 * spread)];
    let points = vec![
        point("halton", 1, &times(0.010), 0.2),
        point("halton", 4, &times(0.040), 0.1),
        point("sobol-owen", 1, &times(0.011), 0.2),
        point("sobol-owen", 4, &times(0.044), 0.1),
    ];
    record(points, Some(Question::Error(0.1)))
}

#[test]
fn a_machine_too_busy_to_tell_neighbours_apart_is_told() {
    let steady = |record: &Record| -> Steadiness { record.analysis.clone().unwrap().steadiness.unwrap() };
    let quiet = neighbours(0.02);
    let found = steady(&quiet);
    assert_eq!(found.next, "sobol-owen");
    assert!((found.difference - 0.1).abs() < 1e-9 && (found.spread - 0.02).abs() < 1e-9, "{found:?}");
    assert!(found.tells_apart && steadiness::note(&quiet).is_none());
    let busy = neighbours(0.3);
    assert!(!steady(&busy).tells_apart);
    let note = steadiness::note(&busy).unwrap();
    assert!(note.contains("too busy to tell Halton from Sobol-Owen by time"), "{note}");
    assert!(note.contains("30.0 %") && note.contains("10.0 %"), "{note}");
    // One render each says nothing, and methods of one picture are one.
    let mut once = neighbours(0.3).points;
    once.iter_mut().for_each(|p| p.seconds.truncate(1));
    assert_eq!(record(once, None).analysis.unwrap().steadiness, None);
    let mut same = neighbours(0.3).points;
    same.iter_mut().for_each(|p| p.picture = format!("{}", p.spp));
    assert_eq!(record(same, None).analysis.unwrap().steadiness, None);
}

#[test]
fn methods_that_are_never_near_the_best_do_not_go_on() {
    let mut points = three_methods();
    points.push(point("grid", 1, &[0.010], 0.5));
    points.push(point("grid", 4, &[0.040], 0.4));
    let all = record(points, None);
    let names = |record: &Record, question, growth| {
        let chosen = refine::promising(record, question, growth);
        chosen.into_iter().map(|i| record.methods[i].name.clone()).collect::<Vec<_>>()
    };
    // At first random, then the filter, at last sobol-owen.
    assert_eq!(names(&all, None, 4.0), ["random", "sobol-owen", "stratified+cone+linear"]);
    assert_eq!(names(&all, Some(Question::Budget(10.0)), 4.0), ["random", "sobol-owen"]);
    assert_eq!(names(&all, Some(Question::Budget(0.007)), 4.0), ["sobol-owen", "stratified+cone+linear"]);
}

#[test]
fn one_cold_render_drops_no_method_and_two_go_on_at_least() {
    let names = |record: &Record, question| {
        let chosen = refine::promising(record, Some(question), 4.0);
        chosen.into_iter().map(|i| record.methods[i].name.clone()).collect::<Vec<_>>()
    };
    // 12 ms at first where others have taken 9, though with the least error.
    let mut points = three_methods();
    points.push(point("random+cone+ewa", 1, &[0.012], 0.02));
    let found = names(&record(points.clone(), None), Question::Budget(0.009));
    assert!(found.contains(&"random+cone+ewa".to_owned()), "{found:?}");
    // Only one fits, and the next shortest goes on beside it.
    let found = names(&record(points, None), Question::Budget(0.001));
    assert_eq!(found, ["random", "sobol-owen"]);
}

#[test]
fn what_a_picture_costs_beside_its_samples_makes_no_method_promising() {
    // A millisecond for the picture and a tenth for each sample: as time goes on, 16 times the samples take 11 times as long.
    let points = vec![
        point("random", 1, &[0.0011], 0.065),
        point("random", 4, &[0.0014], 0.0325),
        point("random", 16, &[0.0026], 0.01625),
        point("stratified+cone+linear", 1, &[0.0015], 0.02),
        point("stratified+cone+linear", 4, &[0.0030], 0.01),
        point("stratified+cone+linear", 16, &[0.0090], 0.005),
        point("center", 1, &[0.0010], 0.09),
    ];
    let record = record(points, None);
    let chosen = refine::promising(&record, Some(Question::Budget(0.05)), 1.0);
    // 490 samples err by 0.0029, 98 filtered ones by 0.002.
    assert_eq!(chosen[..], [0, 1], "at least two");
    let toward = |question| {
        let methods = ["random", "stratified+cone+linear", "center"].map(|name| Method::parse(name).unwrap());
        refine::toward(question, &record, &methods, &stage::scene("s1a"), 1024).unwrap()
    };
    let first: Vec<usize> = toward(Question::Budget(0.05)).iter().map(|p| p.method).collect();
    assert_eq!(first, [1, 0], "the filtered ones come first");
}

#[test]
fn methods_are_said_to_err_the_same_only_if_they_keep_what_was_asked() {
    let blocks = [1.0, 2.0, 3.0, 4.0, 2.0, 1.0, 3.0, 2.0f32];
    let alike = |method: &str, seconds: f64| PointRecord {
        blocks: blocks.to_vec(),
        ..point(method, 4, &[seconds, seconds], 0.1)
    };
    let points = vec![
        alike("grid", 0.02),
        alike("stratified+cone+linear", 0.03),
        alike("stratified+cone+ewa", 0.152),
        alike("adaptive+sobol-owen", 0.522),
    ];
    let said =
        |points: &[PointRecord], question| record(points.to_vec(), question).analysis.unwrap().recommendation;
    let sentence = said(&points, Some(Question::Budget(0.05)));
    assert!(sentence.contains("(“trilinear, cone footprint” errs the same but for noise)"), "{sentence}");
    assert!(!sentence.contains("EWA") && !sentence.contains("adaptive"), "{sentence}");
    let sentence = said(&points, Some(Question::Budget(0.2)));
    assert!(
        sentence
            .contains("(“trilinear, cone footprint” and “EWA, cone footprint” err the same but for noise)"),
        "{sentence}"
    );
    // Where no time is asked for, what takes longer is no equal.
    for question in [None, Some(Question::Error(0.1))] {
        assert!(!said(&points, question).contains("the same but"), "{}", said(&points, question));
    }
}

#[test]
fn points_toward_a_question_lie_between_those_next_to_it() {
    let scene = stage::scene("s1a");
    let find = |names: &[&str], points: Vec<PointRecord>, question| -> Vec<(String, u32)> {
        let methods: Vec<Method> = names.iter().map(|name| Method::parse(name).unwrap()).collect();
        let record = record(points, None);
        let found = refine::toward(question, &record, &methods, &scene, 16).unwrap();
        found.iter().map(|p| (names[p.method].to_owned(), p.spp)).collect()
    };
    // A millisecond a sample up to 4, then 5: by the line from the first to the last, 15 ms would be those of 4.
    let bent = vec![
        point("random", 1, &[0.001], 0.2),
        point("random", 4, &[0.004], 0.1),
        point("random", 16, &[0.064], 0.05),
    ];
    assert_eq!(find(&["random"], bent.clone(), Question::Budget(0.015)), [("random".into(), 6)]);
    // Between errors of 0.1 and 0.05 the exponent is −0.5.
    assert_eq!(find(&["random"], bent, Question::Error(0.08)), [("random".into(), 6)]);
    // One count is enough.
    let one = vec![point("random", 4, &[0.004], 0.1)];
    assert_eq!(find(&["random"], one.clone(), Question::Budget(0.01)), [("random".into(), 9)]);
    assert_eq!(find(&["random"], one, Question::Error(0.05)), [("random".into(), 17)]);
    // Neither a cone, nor the centre, nor the same picture by another name takes one of three places.
    let names = ["cone", "center", "stratified", "n-rooks", "random", "halton", "sobol-owen"];
    let mut all = vec![point("cone", 1, &[0.004], 0.001), point("center", 1, &[0.001], 0.002)];
    for (i, name) in names[2..].iter().enumerate() {
        let worse = 1.0 + 0.1 * i as f64;
        for (spp, error) in [(1, 0.1), (4, 0.03)] {
            let mut own = point(name, spp, &[0.001 * f64::from(spp)], error * worse);
            if i < 2 {
                (own.picture, own.errors.rmse) = (format!("same {spp}"), error);
            }
            all.push(own);
        }
    }
    let found = find(&names, all, Question::Budget(0.011));
    assert_eq!(found, [("stratified".into(), 9), ("random".into(), 10), ("halton".into(), 10)]);
}

#[test]
fn points_toward_a_question_fill_the_time_and_reach_the_error() {
    let scene = stage::scene("s1a");
    let methods = ["random", "sobol-owen"].map(|name| Method::parse(name).unwrap());
    let points = vec![
        point("random", 1, &[0.001], 0.2),
        point("random", 16, &[0.016], 0.05),
        point("sobol-owen", 1, &[0.002], 0.1),
        point("sobol-owen", 16, &[0.032], 0.01),
    ];
    let record = record(points, None);
    let toward = |question| refine::toward(question, &record, &methods, &scene, 16).unwrap();
    // 0.95 of 10 ms: 9 samples of a millisecond, 4 of two; the better method first.
    let found: Vec<(usize, u32)> = toward(Question::Budget(0.01)).iter().map(|p| (p.method, p.spp)).collect();
    assert_eq!(found, [(1, 4), (0, 9)]);
    // Errors fall with the number to the power −0.83 and −0.5; at most four times the largest count.
    let found: Vec<(usize, u32)> = toward(Question::Error(0.02)).iter().map(|p| (p.method, p.spp)).collect();
    assert_eq!(found, [(1, 7), (0, 64)]);
    // A point that is near already needs no other.
    assert!(toward(Question::Budget(0.033)).iter().all(|p| p.method == 0));
}

#[test]
fn the_command_answers_and_marks_the_picture() {
    let folder = tempdir().unwrap();
    let options = ["--methods", "random,stratified+cone+linear", "--spp", "1,4", "--repeats", "2"];
    for (asked, key, heading) in [
        (["--budget", "10s"], "budget", "Best in 10 s"),
        (["--error", "0.5"], "error", "Fastest to an RMSE of 0.5"),
    ] {
        let out = folder.path().join(key);
        let record = studied(&out, &[&options[..], &asked].concat());
        assert!(record["question"][key].is_f64(), "{}", record["question"]);
        assert!(key == "error" || points(&record).len() > 4, "no point was measured for the question");
        let best = &record["analysis"]["recommended"];
        let held = |p: &&serde_json::Value| p["method"] == best["method"] && p["spp"] == best["spp"];
        let best = points(&record).iter().find(held).unwrap();
        let page = fs::read_to_string(out.join("index.html")).unwrap();
        assert!(page.contains(heading) && page.contains("recommended setting"), "{heading}");
        assert!(page.matches("class=\"badge\"").count() >= 1);
        assert!(page.contains(best["command"].as_str().unwrap()));
        let least = points(&record).iter().map(|p| p["errors"]["rmse"].as_f64().unwrap()).fold(9.0, f64::min);
        assert!(key == "error" || best["errors"]["rmse"].as_f64().unwrap() == least, "{best}");
    }
}

#[test]
fn best_goes_on_with_the_promising_ones_and_keeps_the_others_as_they_are() {
    let folder = tempdir().unwrap();
    let methods = "best,center,grid,random,sobol-owen,stratified,stratified+cone+linear";
    let options = ["--methods", methods, "--spp", "1,4,16,64", "--repeats", "2"];
    let record = studied(folder.path(), &options);
    let notes = record["notes"].to_string();
    assert!(
        notes.contains("--methods best: after one render of each point with at most 16 samples"),
        "{notes}"
    );
    let repeats = |p: &serde_json::Value| p["seconds"].as_array().unwrap().len();
    let long: Vec<&str> =
        points(&record).iter().filter(|p| p["spp"] == 64).map(|p| p["method"].as_str().unwrap()).collect();
    assert!((1..=5).contains(&long.len()), "{long:?} have 64 samples");
    for p in points(&record) {
        let went_on = long.contains(&p["method"].as_str().unwrap()) || p["method"] == "center";
        assert!(repeats(p) == if went_on { repeats(p) } else { 1 }, "{p}");
        assert!(repeats(p) <= 2);
    }
    assert!(!notes.contains("fewer than"), "{notes}");
    // The same command finds everything measured.
    let again = studied(folder.path(), &options);
    assert!(again["points"] == record["points"], "points were measured again");
}

#[test]
fn questions_are_checked_before_the_device_starts() {
    let folder = tempdir().unwrap();
    let new = folder.path().join("new");
    for (options, what) in [
        (vec!["--budget", "50 parsec"], "\"parsec\" is no unit; expected a time above 0"),
        (vec!["--budget", "50mS"], "did you mean ms?"),
        (vec!["--error", "-1"], "expected a number above 0"),
        (vec!["--budget", "1s", "--error", "0.1"], "cannot be used with"),
        (vec!["--seconds", "0s"], "such as 0.05, 50ms or 2min"),
    ] {
        let output = study(&new, &options);
        assert_eq!(output.status.code(), Some(2), "{what}");
        assert!(told(&output).contains(what), "{what} not in: {}", told(&output));
        assert!(!new.exists(), "{what}");
    }
    assert!(scene().is_file() && std::path::absolute(path("s1a")).unwrap() == scene());
}
