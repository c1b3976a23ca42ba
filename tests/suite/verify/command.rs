//! `moire verify` on the device under test: what it prints, how it exits and how it stops.

use moire::error::Error;
use moire::progress::Progress;
use moire::verify::verify;
use serde_json::Value;

use crate::shared_gpu::gpu;
use crate::stage::device_name;
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
    assert!(matches!(verify(&gpu(), None, &Stop), Err(Error::Interrupted)));
}

#[test]
fn the_device_under_test_conforms_and_the_report_is_one_json_object() {
    let output = moire()
        .env("MOIRE_VALIDATION", "1")
        .args(["verify", "--device", &device_name(), "--json", "--strict"])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(told, "", "nothing belongs on stderr");
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let summary = |key: &str| report["summary"][key].as_u64().unwrap();
    assert_eq!(summary("outside"), 0, "{}", report["summary"]);
    let strict_fails = summary("known_faults") > 0;
    assert_eq!(output.status.code(), Some(i32::from(strict_fails)));
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len() as u64, summary("variants"));
    assert_eq!(summary("variants") + summary("not_offered"), 2 * 1200 + 4 * 900);
    assert!(report["limits"]["sub_texel_bits"].as_u64().unwrap() >= 4); // Vulkan 1.3, required limits
    for row in rows {
        assert!(row["look_ups"].as_u64().unwrap() > 100, "{row}");
        assert!(row["worst_error"].is_f64() && row["worst_beyond"].is_f64(), "{row}");
        let known = row["verdict"] == "known fault";
        assert_eq!(row["fault"].is_string(), known, "{row}");
        assert!(known || row["verdict"] == "within", "{row}");
    }
    let bits = |class: &str, address: &str| {
        let of = rows.iter().find(|r| {
            r["class"] == class
                && r["address"] == serde_json::json!([address, address])
                && r["weights"].is_object()
        });
        of.unwrap()["weights"]["bits"].as_u64().unwrap()
    };
    if report["driver"].as_str().unwrap().contains("llvmpipe") {
        assert!(strict_fails, "lavapipe's 8-bit path was not noticed");
        assert_eq!(
            [bits("unorm8", "repeat"), bits("unorm8", "mirrored-repeat"), bits("float32", "repeat")],
            [8, 16, 16]
        );
    }
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
