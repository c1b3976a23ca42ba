//! Cells whose names differ and whose pictures do not: a note says so. Budgets: what is said of samples and renders is true.

use serde_json::Value;
use tempfile::tempdir;

use super::{SIZE, cells, record};

fn warnings(options: &str) -> Vec<String> {
    let folder = tempdir().unwrap();
    let options: Vec<&str> = options.split(' ').collect();
    let fixed = ["--repeats", "1", "--reference", "none"];
    let record = record(folder.path(), &[&SIZE[..], &fixed, &options].concat());
    record["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap().to_owned()).collect()
}

#[test]
fn settings_without_an_effect_are_named_and_others_are_not() {
    for (options, expected) in [
        (
            "--pattern center --spp 1 --vary seed=1,2",
            vec!["seed has no effect here: its values make the same picture"],
        ),
        (
            "--vary pattern=center,random --spp 1 --vary seed=1,2,3",
            vec!["seed has no effect with \"pattern: center\": its values make the same picture"],
        ),
        (
            "--spp 1 --vary pattern=center,random,grid",
            vec!["\"pattern: center\" and \"pattern: grid\" are the same picture"],
        ),
        ("--vary spp=1,4 --vary seed=1,2", vec![]),
        // These share a film, and are not said to be alike.
        ("--vary exposure=0,1 --vary seed=1,2", vec![]),
    ] {
        let told = warnings(options);
        assert_eq!(told, expected, "{options}");
    }
}

#[test]
fn a_key_that_another_one_overrides_is_said_to_have_no_effect() {
    let told = warnings("--vary sampler.*.filter=nearest,linear --vary sampler.0.filter=linear,nearest");
    assert_eq!(told, ["sampler.*.filter has no effect here: its values make the same picture"]);
}

#[test]
fn budgets_are_rendered_once_and_name_no_samples_that_are_not_taken() {
    let folder = tempdir().unwrap();
    let options = ["--spp", "4", "--vary", "budget=5ms,20ms", "--reference-spp", "16", "-o", "s.html"];
    let made = record(folder.path(), &[&SIZE[..], &options].concat());
    assert_eq!(made["repeats"], 1);
    assert!(cells(&made).iter().all(|cell| cell["seconds"].as_array().unwrap().len() == 1));
    let idle = Value::from("--spp has no effect with --budget or --target-error, which choose the samples");
    assert!(made["warnings"].as_array().unwrap().contains(&idle), "{}", made["warnings"]);
    let page = std::fs::read_to_string(folder.path().join("s.html")).unwrap();
    assert!(page.contains("<title>horizon</title>"), "the title names 4 samples");
    assert!(page.contains("times: one render each") && !page.contains("median of"));
}
