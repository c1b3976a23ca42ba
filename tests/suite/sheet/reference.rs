//! The noise of rendered references: it is known, taken out of errors, told where it matters, and bounded in time.

use serde_json::Value;
use tempfile::tempdir;

use super::{SIZE, cells, record};

fn numbers(record: &Value, key: &str) -> Vec<f64> {
    cells(record).iter().map(|cell| cell[key].as_f64().unwrap()).collect()
}

#[test]
fn errors_against_a_noisy_reference_are_those_against_a_quiet_one() {
    let folder = tempdir().unwrap();
    let vary = ["--vary", "filter=nearest,linear", "--vary", "spp=1,4", "--repeats", "1", "--reference-spp"];
    let of = |spp: &str| record(folder.path(), &[&SIZE[..], &vary, &[spp]].concat());
    let [noisy, quiet] = [of("8"), of("16384")];
    let own = noisy["references"][0]["rmse"].as_f64().unwrap();
    let [found, truth, deviations] =
        [numbers(&noisy, "rmse"), numbers(&quiet, "rmse"), numbers(&noisy, "rmse_deviation")];
    for ((found, truth), deviation) in found.iter().zip(&truth).zip(&deviations) {
        assert!((found - truth).abs() < 4.0 * deviation, "{found} ± {deviation}, in truth {truth}");
    }
    // The noise itself is no small part of what the best picture and the reference differ by.
    let best = truth.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(best.hypot(own) > 1.05 * best, "a reference off by {own} tests nothing at {best}");
    let close = numbers(&quiet, "rmse_deviation").iter().zip(&truth).all(|(d, rmse)| *d < 0.01 * rmse);
    assert!(close, "{quiet}");
}

#[test]
fn what_the_noise_does_not_tell_is_said() {
    let folder = tempdir().unwrap();
    let options = ["--spp", "64", "--vary", "seed=1,2,3", "--repeats", "1", "--reference-spp"];
    let noisy = record(folder.path(), &[&SIZE[..], &options, &["2"]].concat());
    let told = noisy["warnings"].to_string();
    assert!(told.contains("does not tell which is better of") && told.contains("seed 1"), "{told}");
    assert!(told.contains("the reference itself is off by RMSE"), "{told}");
    assert!(told.contains("--reference-spp"), "{told}");
    let bounds =
        cells(&noisy).iter().filter(|cell| cell["rmse_below"].is_f64() && cell["rmse"].is_null()).count();
    assert!(bounds > 0, "errors within the noise are bounded: {noisy}");
    let clear = ["--vary", "spp=1,64", "--repeats", "1", "--reference-spp", "4096"];
    let clear = record(folder.path(), &[&SIZE[..], &clear].concat());
    assert_eq!(clear["warnings"], serde_json::json!([]));
}

#[test]
fn a_reference_ends_when_it_is_good_enough_or_its_time_is_over() {
    let folder = tempdir().unwrap();
    let coarse = record(folder.path(), &[&SIZE[..], &["--vary", "spp=1"], &["--repeats", "1"]].concat());
    let reference = &coarse["references"][0];
    let [own, seconds] = ["rmse", "seconds"].map(|key| reference[key].as_f64().unwrap());
    let rmse = coarse["cells"][0]["rmse"].as_f64().unwrap();
    assert!(own < 0.25 * rmse && own < 1.0 / 255.0, "{own} for {rmse}");
    assert!(reference["samples"].as_u64().unwrap() < 1 << 15, "{reference}");
    // The last run may have been slower than foreseen on a busy machine.
    assert!(seconds < 20.0, "{seconds}");
}
