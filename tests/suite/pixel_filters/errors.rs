//! Errors of scene files and of the command line, and the contents of reports.

use std::path::Path;

use moire::internal::scene::model::{PixelFilter, PixelFilterKind};
use moire::internal::scene::parse;

use crate::support::{moire, told};

fn image(keys: &str) -> moire::internal::core::error::Result<PixelFilter> {
    let text = format!(
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 8\nheight = 8\n{keys}\n"
    );
    parse(Path::new("filter.toml"), &text).map(|scene| scene.pixel_filter)
}

#[test]
fn names_and_radii_are_read_with_defaults_by_name() {
    assert_eq!(image("").unwrap(), PixelFilter { kind: PixelFilterKind::Box, radius: 0.5 });
    for (&kind, radius) in PixelFilterKind::ALL.iter().zip([0.5, 1.0, 1.5, 2.0, 1.5]) {
        assert_eq!(image(&format!("pixel_filter = '{kind}'")).unwrap(), PixelFilter { kind, radius });
        let keys = format!("pixel_filter = '{kind}'\npixel_filter_radius = 3");
        assert_eq!(image(&keys).unwrap(), PixelFilter { kind, radius: 3.0 });
    }
    assert_eq!(image("pixel_filter_radius = 8").unwrap().radius, 8.0);
}

#[test]
fn wrong_values_are_refused_with_file_line_and_key() {
    for (keys, key, what) in [
        ("pixel_filter = 'tend'", "image.pixel_filter", "did you mean \"tent\""),
        ("pixel_filter = 'sinc'", "image.pixel_filter", "box, tent, gaussian, mitchell, blackman-harris"),
        ("pixel_filter = 2", "image.pixel_filter", "a string"),
        ("pixel_filter_radius = 0", "image.pixel_filter_radius", "above 0 and at most 8"),
        ("pixel_filter_radius = -1", "image.pixel_filter_radius", "above 0 and at most 8"),
        ("pixel_filter_radius = 8.001", "image.pixel_filter_radius", "above 0 and at most 8"),
        ("pixel_filter_radius = 1e-40", "image.pixel_filter_radius", "above 0 and at most 8"),
        ("pixel_filter_radius = nan", "image.pixel_filter_radius", "a finite number"),
        ("pixel_filter_radius = inf", "image.pixel_filter_radius", "a finite number"),
        ("pixel_filter_radius = 'wide'", "image.pixel_filter_radius", "a finite number"),
        ("pixel_filter_width = 2", "pixel_filter_width", "pixel_filter"),
    ] {
        let error = told(image(keys));
        for wanted in [key, what, "filter.toml:8"] {
            assert!(error.contains(wanted), "{keys}: {error}");
        }
    }
}

fn render(options: &[&str]) -> std::process::Output {
    let folder = tempfile::tempdir().unwrap();
    let scene = std::fs::canonicalize(crate::stage::path("zone_plate")).unwrap();
    let mut command = moire();
    command.current_dir(&folder).arg("render").arg(scene);
    command.args(["--size", "8x8", "--spp", "4", "--device", "oracle", "--json", "-q"]).args(options);
    command.output().unwrap()
}

#[test]
fn the_command_line_overrides_the_scene() {
    for (options, name, radius) in [
        (&[][..], "gaussian", 1.5),
        (&["--pixel-filter", "mitchell"], "mitchell", 2.0),
        (&["--pixel-filter-radius", "2.5"], "gaussian", 2.5),
        (&["--pixel-filter", "tent", "--pixel-filter-radius", "3"], "tent", 3.0),
    ] {
        let output = render(options);
        let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(json["options"]["pixel_filter"], name, "{options:?}");
        assert_eq!(json["options"]["pixel_filter_radius"], radius, "{options:?}");
    }
    for wrong in ["0", "-1", "9", "nan", "inf", "wide"] {
        let output = render(&["--pixel-filter-radius", wrong]);
        let text = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{text}");
        assert!(text.contains("--pixel-filter-radius") && text.contains("at most 8"), "{text}");
    }
    let output = render(&["--pixel-filter", "tend"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("tent"));
}
