//! `moire verify` on the device under test: its output, its exit code and its cancellation.

use moire::internal::core::error::Error;
use moire::internal::core::progress::Progress;
use moire::internal::lab::verify::verify;
use serde_json::Value;

use crate::stage::{device, device_name};
use crate::support::moire;

struct Stop;

impl Progress for Stop {
    fn advance(&self, _done: f64) {}

    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn a_wish_to_stop_ends_after_one_batch() {
    assert!(matches!(verify(&device(), None, &Stop), Err(Error::Interrupted)));
}

/// All classes of formats, filters and readers with one address mode: flat textures, volumes and
/// anisotropy by the first name, cubes by the other.
#[test]
fn the_device_under_test_conforms_and_the_report_is_one_json_object() {
    for (only, variants) in [(" repeat/repeat", 314), (" cube", 96)] {
        let output = moire()
            .env("MOIRE_VALIDATION", "1")
            .args(["verify", "--device", &device_name(), "--json", "--strict", "--only", only])
            .output()
            .unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(told, "", "nothing belongs on stderr");
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        check(&report, variants);
        let strict_fails = report["summary"]["known_faults"].as_u64().unwrap() > 0;
        assert_eq!(output.status.code(), Some(i32::from(strict_fails)));
    }
}

fn check(report: &Value, variants: u64) {
    let summary = |key: &str| report["summary"][key].as_u64().unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len() as u64, summary("variants"));
    assert_eq!(summary("variants") + summary("not_offered"), variants);
    assert!(report["limits"]["sub_texel_bits"].as_u64().unwrap() >= 4); // Vulkan 1.3, required limits
    for row in rows {
        assert!(row["look_ups"].as_u64().unwrap() > 100, "{row}");
        assert!(row["worst_error"].is_f64() && row["worst_beyond"].is_f64(), "{row}");
        let known = row["verdict"] == "known fault";
        assert_eq!(row["fault"].is_string(), known, "{row}");
        assert!(known || row["verdict"] == "within", "{row}");
    }
    let lavapipe = report["driver"].as_str().unwrap().contains("llvmpipe");
    let bits = |key: &str, class: &str| {
        let of = rows.iter().find(|r| r["class"] == class && r[key].is_object());
        of.map(|row| row[key]["bits"].as_u64().unwrap())
    };
    if lavapipe && rows[0]["dimension"] == "2d" {
        assert!(summary("known_faults") > 0, "lavapipe's 8-bit path was not noticed");
        let weights = ["unorm8", "float32"].map(|class| bits("weights", class));
        assert_eq!(weights, [Some(8), Some(16)]);
        assert!(rows.iter().any(|r| r["level_weights"].is_object()));
    }
}

#[test]
fn a_name_that_no_variant_has_is_exit_2() {
    let output = moire().args(["verify", "--device", &device_name(), "--only", "7d"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("no variant has \"7d\"") && told.contains("sampler 2d repeat/repeat"), "{told}");
}

#[test]
fn a_device_that_is_not_there_is_exit_2() {
    for (name, expected) in [("voodoo", "voodoo"), ("oracle", "the oracle itself is no device")] {
        let output = moire().args(["verify", "--device", name]).output().unwrap();
        assert_eq!(output.status.code(), Some(2));
        assert!(output.stdout.is_empty());
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(told.contains(expected), "{told}");
    }
}
