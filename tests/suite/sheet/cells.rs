//! The cells: each is what its command renders, against the reference that is named or one of many samples.

use moire::internal::output::{WriteOptions, write};
use serde_json::Value;
use tempfile::tempdir;

use super::{SIZE, cells, record, sheet, told};
use crate::support::{gradient, moire};

#[test]
fn each_cell_is_the_picture_of_its_command() {
    let folder = tempdir().unwrap();
    let reference = folder.path().join("reference.exr");
    write(&gradient(32, 24), &reference, &WriteOptions::default()).unwrap();
    let name = reference.to_str().unwrap();
    let vary = ["--vary", "filter=nearest,ewa", "--vary", "pattern=random,center", "--vary", "spp=1,3"];
    let options = ["--footprint", "cone", "--reference", name, "--repeats", "2"];
    let record = record(folder.path(), &[&SIZE[..], &vary, &options].concat());
    assert_eq!(cells(&record).len(), 8);
    let order = |name: &str| cells(&record).iter().map(|c| c["settings"][name].clone()).collect::<Vec<_>>();
    let expected = ["nearest", "ewa", "nearest", "ewa", "nearest", "ewa", "nearest", "ewa"];
    assert_eq!(order("filter"), expected, "the first setting varies fastest");
    assert_eq!(order("spp"), ["1", "1", "1", "1", "3", "3", "3", "3"]);
    for cell in cells(&record) {
        let command = cell["command"].as_str().unwrap().replace("cell.png", "cell.exr");
        let words: Vec<&str> = command.split(' ').collect();
        let output = moire().current_dir(folder.path()).args(&words[1..]).output().unwrap();
        assert!(output.status.success(), "{command}: {}", told(&output));
        let compared = moire()
            .current_dir(folder.path())
            .args(["compare", "cell.exr", name, "--json"])
            .output()
            .unwrap();
        let json: Value = serde_json::from_slice(&compared.stdout).unwrap();
        for metric in ["rmse", "flip"] {
            let [sheet, alone] = [&cell[metric], &json[metric]].map(|v| v.as_f64().unwrap());
            // Sums over threads are the same; text keeps 17 digits.
            assert!((sheet - alone).abs() <= 1e-12 * alone, "{command}: {metric} {sheet}, alone {alone}");
        }
        let times: Vec<f64> =
            cell["device_seconds"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect();
        assert_eq!(times.len(), 2);
        let median = cell["median_device_seconds"].as_f64().unwrap();
        // Text keeps 17 digits.
        assert!((median / (0.5 * (times[0] + times[1])) - 1.0).abs() < 1e-12, "{median} of {times:?}");
    }
}

#[test]
fn errors_are_measured_against_many_samples_without_a_prefilter() {
    let folder = tempdir().unwrap();
    let options = ["--vary", "spp=1,4,64", "--reference-spp", "2048", "--repeats", "1"];
    let plain = record(folder.path(), &[&SIZE[..], &options].concat());
    let errors =
        |record: &Value| cells(record).iter().map(|c| c["rmse"].as_f64().unwrap()).collect::<Vec<_>>();
    let found = errors(&plain);
    assert!(found[0] > 1.5 * found[1] && found[1] > 3.0 * found[2], "errors do not fall: {found:?}");
    let own = plain["references"][0]["rmse"].as_f64().unwrap();
    assert!(own > 0.0 && own < 0.5 * found[2], "{own} for {found:?}");
    // A prefilter on the command line is one of the cells, not of the reference.
    let prefilter = ["--footprint", "cone", "--filter", "linear", "--mip", "linear"];
    let blurred = record(folder.path(), &[&SIZE[..], &options, &prefilter].concat());
    for key in ["samples", "rmse"] {
        assert_eq!(blurred["references"][0][key], plain["references"][0][key]);
    }
    assert_ne!(errors(&blurred), found);
}

#[test]
fn each_view_has_a_reference_of_its_own_and_settings_of_sampling_share_one() {
    let folder = tempdir().unwrap();
    let count = |options: &[&str]| {
        let record = record(folder.path(), &[options, &["--repeats", "1", "--reference-spp", "32"]].concat());
        record["references"].as_array().unwrap().len()
    };
    assert_eq!(count(&["--vary", "size=24x18,32x24"]), 2);
    assert_eq!(count(&["--size", "32x24", "--vary", "pixel-filter=box,tent", "--vary", "spp=1,4"]), 2);
    let shared = ["--vary", "algorithm=samples,adaptive,beam,cone", "--vary", "precision=single,double"];
    assert_eq!(count(&[&SIZE[..], &shared].concat()), 1);
}

#[test]
fn keys_of_the_scene_vary_as_options_do() {
    let folder = tempdir().unwrap();
    let keys = ["--vary", "sampler.*.filter=nearest,ewa", "--set", "sampling.footprint=cone"];
    let of_keys = record(folder.path(), &[&SIZE[..], &keys, &["--reference-spp", "32"]].concat());
    let options = ["--vary", "filter=nearest,ewa", "--footprint", "cone"];
    let of_options = record(folder.path(), &[&SIZE[..], &options, &["--reference-spp", "32"]].concat());
    for i in 0..2 {
        assert_eq!(cells(&of_keys)[i]["rmse"], cells(&of_options)[i]["rmse"], "cell {i}");
    }
    assert_eq!(of_keys["axes"][0]["labels"][1], "sampler.*.filter: ewa");
    let arrays = ["--vary", "camera.eye=[0, 1, 0],[0, 2, 0]", "--repeats", "1", "--reference-spp", "32"];
    let moved = record(folder.path(), &[&SIZE[..], &arrays].concat());
    assert_eq!(moved["references"].as_array().unwrap().len(), 2);
    assert_eq!(cells(&moved)[1]["settings"]["camera.eye"], "[0, 2, 0]");
}

#[test]
fn cells_may_end_at_a_time_or_an_error() {
    let folder = tempdir().unwrap();
    let record = record(
        folder.path(),
        &[&SIZE[..], &["--vary", "target-error=0.1,0.02", "--reference-spp", "512"]].concat(),
    );
    let [coarse, fine] = [0, 1].map(|i| cells(&record)[i]["rmse"].as_f64().unwrap());
    assert!(fine < coarse && fine < 0.05, "{coarse}, {fine}");
    assert!(cells(&record)[1]["taken"].as_str().unwrap().contains("on average"), "{record}");
    let timed = self::record(folder.path(), &[&SIZE[..], &["--vary", "budget=5ms,20ms"]].concat());
    assert_eq!(timed["axes"][0]["labels"], serde_json::json!(["budget: 5ms", "budget: 20ms"]));
}

#[test]
fn combinations_that_the_scene_does_not_allow_say_why_and_the_others_are_rendered() {
    let folder = tempdir().unwrap();
    let options = ["--vary", "filter=linear,ewa", "--vary", "method=shader,hardware", "--repeats", "1"];
    let output = sheet(folder.path(), &[&SIZE[..], &options, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", told(&output));
    let record: Value = serde_json::from_slice(&output.stdout).unwrap();
    let errors: Vec<bool> = cells(&record).iter().map(|cell| !cell["error"].is_null()).collect();
    assert_eq!(errors, [false, false, false, true]);
    assert!(
        told(&output).contains("filter: ewa, method: hardware: no picture: texture"),
        "{}",
        told(&output)
    );
    let rendered = cells(&record).iter().filter(|cell| cell["rmse"].is_f64()).count();
    assert_eq!(rendered, 3);
    assert!(folder.path().join("horizon-sheet.png").is_file(), "the default name");
}
