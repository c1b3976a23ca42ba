//! The command line: output streams, files, the effect of each option, exit codes, Ctrl-C.

use std::fs;
use std::path::Path;
use std::process::Output;

use moire::internal::core::film::Film;
use moire::internal::core::range::Rect;
use moire::internal::lab::metrics::{compare, read_picture};
use serde_json::Value;
use tempfile::{TempDir, tempdir};

use crate::stage::{assert_same_bits, cut, device_name, path};
use crate::support::moire;

/// `moire render SCENE --device …` in `folder`, with validation.
fn render(folder: &Path, scene: &str, options: &[&str]) -> Output {
    let mut command = moire();
    command.current_dir(folder).env("MOIRE_VALIDATION", "1").arg("render").arg(absolute(&path(scene)));
    if !options.contains(&"--device") {
        command.args(["--device", &device_name()]);
    }
    let output = command.args(options).output().unwrap();
    assert!(!text(&output.stderr).contains("validation:"), "{}", text(&output.stderr));
    output
}

fn absolute(path: &Path) -> std::path::PathBuf {
    std::path::absolute(path).unwrap()
}

fn text(bytes: &[u8]) -> &str {
    std::str::from_utf8(bytes).unwrap()
}

/// Returns the picture rendered with these options, by way of an EXR file.
fn film(scene: &str, options: &[&str]) -> Film {
    let folder = tempdir().unwrap();
    let output = render(folder.path(), scene, &[options, &["-q", "-o", "a.exr"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    read_picture(&folder.path().join("a.exr")).unwrap()
}

fn files(folder: &TempDir) -> Vec<String> {
    let entries = fs::read_dir(folder.path()).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn rmse(a: &Film, b: &Film) -> f64 {
    compare(a, b).unwrap().rmse
}

#[test]
fn without_output_the_picture_is_named_after_the_scene_and_lies_here() {
    let folder = tempdir().unwrap();
    let output = render(folder.path(), "horizon", &["--size", "32x24", "--spp", "1"]);
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(files(&folder), ["horizon.png"]);
    assert_eq!(text(&output.stdout), "");
    let told = text(&output.stderr);
    assert!(told.starts_with("horizon.png: 32×24 pixels, 1 sample a pixel on "), "{told}");
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(!told.contains(['\r', '\x1b']), "bytes of a progress bar: {told:?}");
}

#[test]
fn several_outputs_hold_the_same_picture_in_every_format() {
    let folder = tempdir().unwrap();
    let names = ["a.exr", "a.hdr", "a.jpeg", "a.jpg", "a.png", "a.tif", "a.tiff", "b.PNG"];
    let mut options = vec!["--size", "48x48", "--spp", "4", "-q"];
    names.iter().for_each(|name| options.extend(["-o", name]));
    assert_eq!(render(folder.path(), "inside", &options).status.code(), Some(0));
    let mut sorted = names;
    sorted.sort();
    assert_eq!(files(&folder), sorted);
    let read = |name: &str| read_picture(&folder.path().join(name)).unwrap();
    let exact = read("a.exr");
    for (name, bound) in [("a.hdr", 2e-3), ("a.png", 2e-3), ("a.tif", 2e-3), ("a.jpg", 4e-2)] {
        assert!(rmse(&read(name), &exact) <= bound, "{name}: {}", rmse(&read(name), &exact));
    }
    assert_eq!(read("a.png"), read("b.PNG"));
    assert_eq!(read("a.tif"), read("a.tiff"));
    assert_eq!(read("a.jpg"), read("a.jpeg"));
}

#[test]
fn quiet_says_nothing() {
    let folder = tempdir().unwrap();
    let output = render(folder.path(), "horizon", &["--size", "16x16", "--spp", "1", "-q"]);
    assert_eq!((text(&output.stdout), text(&output.stderr)), ("", ""));
    assert_eq!(files(&folder), ["horizon.png"]);
}

#[test]
fn verbose_lists_what_was_left_out_and_how_textures_are_held() {
    let folder = tempdir().unwrap();
    let output = render(folder.path(), "horizon", &["--size", "16x16", "--spp", "1", "-v"]);
    let told = text(&output.stderr);
    for part in ["left out:", "shadow rays", "bounces", "texture \"tiles\": 256×256", "seconds: startup"] {
        assert!(told.contains(part), "{part} not in: {told}");
    }
    assert_eq!(text(&output.stdout), "");
    let output = render(folder.path(), "horizon", &["--size", "16x16", "-v", "--keep-everything"]);
    assert!(!text(&output.stderr).contains("shadow rays"), "{}", text(&output.stderr));
}

fn json(scene: &str, options: &[&str]) -> Value {
    let folder = tempdir().unwrap();
    let output = render(folder.path(), scene, &[options, &["--json"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("one JSON object and nothing else")
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value.as_object().unwrap().keys().map(String::as_str).collect();
    keys.sort();
    keys
}

#[test]
fn json_is_one_object_with_the_documented_fields() {
    let told = json("lecture", &["--size", "40x30", "--spp", "4", "-o", "x.exr", "-o", "y.png"]);
    for field in
        ["device", "driver", "options", "left_out", "samples", "outputs", "seconds", "device_seconds"]
    {
        assert!(!told[field].is_null(), "{field} is missing: {told:#}");
    }
    let stages = ["compile", "load", "readback", "render", "startup", "total", "upload", "write"];
    assert_eq!(keys(&told["seconds"]), stages);
    let second = |name: &str| told["seconds"][name].as_f64().unwrap();
    assert!(stages.iter().all(|s| second(s) >= 0.0) && second("total") >= second("render"), "{told:#}");
    assert_eq!(keys(&told["device_seconds"]), ["render"]);
    assert!(told["device_seconds"]["render"].as_f64().unwrap() <= second("render"));
    assert_eq!((&told["samples"], &told["outputs"]), (&4.into(), &serde_json::json!(["x.exr", "y.png"])));
    assert!(told["left_out"].as_array().unwrap().iter().all(Value::is_string));
    assert_ne!(told["left_out"], serde_json::json!([]));
    assert_eq!(told["warnings"], serde_json::json!([]));
    assert_eq!(told["options"]["size"], serde_json::json!([40, 30]));
    let kept = json("lecture", &["--size", "8x8", "--keep-everything"]);
    assert_eq!(
        (&kept["left_out"], &kept["options"]["keep_everything"]),
        (&serde_json::json!([]), &true.into())
    );
}

#[test]
fn filters_that_the_footprint_leaves_idle_are_warned_of_unless_quiet() {
    let told = json("filters", &["--size", "8x8", "--footprint", "none"]);
    assert!(told["warnings"][0].as_str().unwrap().contains("mip = \"linear\""), "{told:#}");
    let folder = tempdir().unwrap();
    let options = ["--size", "8x8", "--footprint", "none"];
    let output = render(folder.path(), "filters", &options);
    assert!(text(&output.stderr).contains("warning: footprint = \"none\""), "{}", text(&output.stderr));
    let quiet = render(folder.path(), "filters", &[&options[..], &["-q"]].concat());
    assert_eq!(text(&quiet.stderr), "");
    let followed = render(folder.path(), "filters", &["--size", "8x8"]);
    assert!(!text(&followed.stderr).contains("warning"), "{}", text(&followed.stderr));
}

#[test]
fn goals_choose_an_algorithm_and_say_what_was_reached() {
    let told = json("s2", &["--size", "64x64", "--target-error", "5e-3"]);
    assert_eq!(
        (&told["options"]["algorithm"], &told["options"]["pattern"]),
        (&"auto".into(), &"sobol-owen".into())
    );
    assert_eq!(told["reached"]["reached"], true);
    assert!(told["reached"]["estimated_rmse"].as_f64().unwrap() <= 5e-3, "{told:#}");
    // More than the two samples of the first pass, unless the machine stood still for all of the time.
    let told = json("s2", &["--size", "64x64", "--budget", "0.5"]);
    let reached = &told["reached"];
    assert!(reached["mean_samples"].as_f64().unwrap() > 2.0 || reached["reached"] == false, "{told:#}");
    // One sample per pixel takes longer than that on any device, and is the least that can be done.
    let told = json("s2", &["--size", "64x64", "--budget", "1e-6"]);
    assert_eq!((&told["reached"]["reached"], &told["reached"]["mean_samples"]), (&false.into(), &1.0.into()));
    assert!(json("s2", &["--size", "8x8"])["reached"].is_null());
}

#[test]
fn goals_that_cannot_be_followed_are_refused() {
    let cases: [(&[&str], &str); 5] = [
        (&["--budget", "1", "--target-error", "1e-3"], "cannot be used with"),
        (&["--budget", "0"], "above 0"),
        (&["--target-error", "nan"], "above 0"),
        (&["--budget", "1", "--algorithm", "samples"], "takes a number of samples"),
        (&["--target-error", "1e-3", "--pattern", "stratified"], "sobol-owen"),
    ];
    for (options, expected) in cases {
        let folder = tempdir().unwrap();
        let output = render(folder.path(), "s2", options);
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(text(&output.stderr).contains(expected), "{options:?}: {}", text(&output.stderr));
        assert_eq!(files(&folder), [""; 0], "{options:?}");
    }
}

#[test]
fn options_replace_the_values_of_the_scene() {
    let options =
        ["--size", "20x10", "--spp", "9", "--pattern", "grid", "--seed", "5", "--method", "hardware"];
    let told = json("horizon", &options);
    let used = &told["options"];
    assert_eq!(used["size"], serde_json::json!([20, 10]));
    assert_eq!((&used["spp"], &used["seed"]), (&9.into(), &5.into()));
    assert_eq!((&used["pattern"], &told["samples"]), (&"grid".into(), &9.into()));
    assert_eq!(used["methods"], serde_json::json!(["hardware"]));
    let centre = json("horizon", &["--size", "20x10", "--pattern", "center"]);
    assert_eq!(centre["samples"], 1);
}

const SMALL: [&str; 4] = ["--size", "48x36", "--spp", "4"];

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SMALL, more].concat()
}

#[test]
fn size_and_samples_are_those_asked_for() {
    let film = film("horizon", &["--size", "50x20", "--spp", "1"]);
    assert_eq!((film.width, film.height), (50, 20));
}

#[test]
fn the_seed_chooses_the_noise() {
    let [a, again, b] = ["7", "7", "8"].map(|seed| film("horizon", &with(&["--seed", seed])));
    assert_same_bits(&a, &again, "the same seed");
    assert!(a != b, "another seed gives the same picture");
}

#[test]
fn pattern_filter_and_method_change_what_they_should() {
    let plain = film("horizon", &SMALL);
    for options in [["--pattern", "random"], ["--pattern", "grid"], ["--filter", "nearest"]] {
        assert!(film("horizon", &with(&options)) != plain, "{options:?} changes nothing");
    }
    let hardware = film("lecture", &with(&["--method", "hardware"]));
    let shader = film("lecture", &SMALL);
    assert!(hardware != shader, "the texture unit has fewer sub-texel bits than f32");
    assert!(rmse(&hardware, &shader) < 2e-3, "{}", rmse(&hardware, &shader));
}

#[test]
fn a_crop_writes_the_pixels_of_the_full_picture() {
    let full = film("lecture", &SMALL);
    let part = film("lecture", &with(&["--crop", "10,20,30,16"]));
    assert_same_bits(&part, &cut(&full, Rect { x: 10, y: 20, width: 30, height: 16 }), "crop");
}

#[test]
fn a_cropped_exr_is_compared_where_it_lies_in_its_picture() {
    let folder = tempdir().unwrap();
    for options in [&["-o", "full.exr"][..], &["-o", "part.exr", "-o", "part.png", "--crop", "10,20,30,16"]] {
        assert_eq!(
            render(folder.path(), "lecture", &with(&[&["-q"], options].concat())).status.code(),
            Some(0)
        );
    }
    let compared = |a: &str, b: &str| {
        let output = moire().current_dir(folder.path()).args(["compare", a, b, "--json"]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    for (a, b) in [("part.exr", "full.exr"), ("full.exr", "part.exr"), ("part.exr", "part.exr")] {
        let told = compared(a, b);
        assert_eq!(
            (&told["max"], &told["part"]),
            (&0.0.into(), &serde_json::json!([10, 20, 30, 16])),
            "{a}, {b}"
        );
    }
    // A PNG does not record the picture that it is a part of.
    let told = compared("part.exr", "part.png");
    assert!(told["part"].is_null() && told["rmse"].as_f64().unwrap() < 2e-3, "{told}");
    let whole = read_picture(&folder.path().join("full.exr")).unwrap();
    assert_eq!((whole.width, whole.height), (48, 36));
}

#[test]
fn a_goal_advises_no_footprint_and_tells_that_it_chooses_the_samples() {
    let warnings = |options: &[&str]| json("filters", options)["warnings"].clone();
    assert_eq!(warnings(&["--size", "8x8", "--budget", "10ms"]), serde_json::json!([]));
    let told = warnings(&["--size", "8x8", "--budget", "10ms", "--spp", "4"]);
    assert!(told[0].as_str().unwrap().contains("--spp has no effect"), "{told}");
}

#[test]
fn png_can_have_sixteen_bits() {
    let folder = tempdir().unwrap();
    let options = with(&["-q", "-o", "a.png", "-o", "a.exr", "--png-bits", "16"]);
    assert_eq!(render(folder.path(), "lecture", &options).status.code(), Some(0));
    let picture = image::open(folder.path().join("a.png")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgb16);
    let read = |name: &str| read_picture(&folder.path().join(name)).unwrap();
    assert!(rmse(&read("a.png"), &read("a.exr")) < 1e-5);
}

#[test]
fn the_oracle_is_a_device_by_name_only() {
    let told = json("lights", &with(&["--device", "oracle"]));
    assert_eq!(told["device"], "oracle");
    let folder = tempdir().unwrap();
    let options = with(&["-q", "-o", "a.exr", "--device", "oracle"]);
    assert_eq!(render(folder.path(), "lights", &options).status.code(), Some(0));
    let oracle = read_picture(&folder.path().join("a.exr")).unwrap();
    assert!(rmse(&oracle, &film("lights", &SMALL)) < 1e-3);
}

fn devices() -> Vec<Value> {
    let output = moire().args(["devices", "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn devices_lists_each_with_index_name_and_limits() {
    let devices = devices();
    for (i, device) in devices.iter().enumerate() {
        assert_eq!(device["index"], i);
        assert!(device["name"].is_string() && device["driver"].is_string(), "{device:#}");
        assert!(device["limits"]["max_image_2d"].as_u64().unwrap() >= 4096, "{device:#}");
    }
    assert_eq!(devices.iter().filter(|d| d["default"] == true).count(), 1);
    let output = moire().arg("devices").output().unwrap();
    let listing = text(&output.stdout);
    assert!(devices.iter().all(|d| listing.contains(d["name"].as_str().unwrap())), "{listing}");
}

#[test]
fn a_device_is_chosen_by_index_and_by_a_part_of_its_name() {
    let chosen = json("quad", &["--size", "8x8"])["device"].as_str().unwrap().to_string();
    let devices = devices();
    let index = devices.iter().position(|d| d["name"] == chosen.as_str()).unwrap().to_string();
    let part: String = chosen.to_uppercase().chars().take(7).collect();
    for select in [index.as_str(), part.as_str()] {
        let told = json("quad", &["--size", "8x8", "--device", select]);
        assert_eq!(told["device"], chosen.as_str(), "--device {select}");
    }
}

#[test]
fn help_and_version_are_answers_on_stdout() {
    for args in [&["--help"][..], &["--version"], &["render", "--help"], &["compare", "--help"]] {
        let output = moire().args(args).output().unwrap();
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(0), ""), "{args:?}");
        assert!(!output.stdout.is_empty(), "{args:?}");
    }
}

#[test]
fn help_names_each_value_once_and_groups_the_options() {
    for form in ["-h", "--help"] {
        let output = moire().args(["render", form]).output().unwrap();
        let help = text(&output.stdout);
        // Words of one vocabulary only.
        for value in ["multi-jittered", "summed-area", "differentials", "blackman-harris", "buffer"] {
            assert_eq!(help.matches(value).count(), 1, "{value} in: {help}");
        }
        for group in ["Write files:", "Take samples:", "Filter textures:", "Choose devices:", "Measure:"] {
            assert_eq!(help.lines().filter(|line| *line == group).count(), 1, "{group} in: {help}");
        }
    }
}

#[test]
fn words_of_other_programs_are_answered_with_those_of_this_one() {
    for (options, wanted) in [
        (["--pattern", "jittered"], "'stratified'"),
        (["--filter", "bilinear"], "'linear'"),
        (["--filter", "trilinear"], "--mip linear"),
        (["--pixel-filter", "triangle"], "'tent'"),
        (["--pattern", "poisson-disk"], "'blue-noise'"),
        (["--algorithm", "ssaa"], "'samples'"),
        (["--algorithm", "fxaa"], "smooths finished pictures"),
        (["--filter", "mipmap"], "--mip linear"),
        (["--filter", "gaussian"], "'ewa'"),
        (["--tone-map", "hable"], "'filmic'"),
        (["--gamut", "p3"], "'display-p3'"),
        (["--gamut", "acescg"], "display-p3 writes"),
        (["--precision", "f64"], "'double'"),
        (["--estimates", "gpu"], "'device'"),
        (["--shared", "yes"], "'true'"),
        (["--aov", "depth,z"], "'depth'"),
        (["--samples", "4"], "'--spp'"),
        (["--resolution", "4x4"], "'--size'"),
        (["--pattern", "stratfied"], "'stratified'"),
    ] {
        let output = moire().args(["render", "x.toml"]).args(options).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{options:?}");
        assert!(text(&output.stderr).contains(wanted), "{options:?}: {}", text(&output.stderr));
    }
}

#[test]
fn commands_and_methods_of_other_names_are_answered_with_those_of_this_program() {
    let cases: [(&[&str], &str); 9] = [
        (&["diff"], "'compare'"),
        (&["texure"], "'texture'"),
        (&["new", "sphere"], "\"ball\""),
        (&["compare", "a", "b", "--rmse", "1"], "'--max-rmse'"),
        (&["study", "x.toml", "--methods", "ewa"], "did you mean stratified+cone+ewa?"),
        (&["study", "x.toml", "--methods", "stratifed+cone"], "did you mean stratified?"),
        (&["study", "x.toml", "--methods", "random+cone+trilinear"], "did you mean stratified+cone+linear?"),
        (&["study", "x.toml", "--reference", "oracl"], "did you mean \"oracle\"?"),
        (&["texture", "x.png", "--color-space", "sRGB"], "'srgb'"),
    ];
    for (arguments, wanted) in cases {
        let output = moire().args(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(text(&output.stderr).contains(wanted), "{arguments:?}: {}", text(&output.stderr));
    }
}

#[test]
fn compare_judges_rendered_files() {
    let folder = tempdir().unwrap();
    for (name, spp) in [("a.exr", "4"), ("b.exr", "16")] {
        let options = ["--size", "32x32", "-q", "--spp", spp, "-o", name];
        assert_eq!(render(folder.path(), "horizon", &options).status.code(), Some(0));
    }
    let run = |args: &[&str]| moire().current_dir(folder.path()).arg("compare").args(args).output().unwrap();
    assert_eq!(run(&["a.exr", "b.exr"]).status.code(), Some(0));
    assert_eq!(run(&["a.exr", "a.exr", "--max-rmse", "0"]).status.code(), Some(0));
    assert_eq!(run(&["a.exr", "b.exr", "--max-rmse", "1e-4"]).status.code(), Some(1));
}

#[test]
fn only_the_last_ending_of_the_scenes_name_is_replaced() {
    let folder = tempdir().unwrap();
    let text = "camera = { eye = [0, 0, 1], look_at = [0, 0, 0], vertical_fov = 40 }\nimage = { width = 2, height = 2 }";
    fs::write(folder.path().join("floor.v2.toml"), text).unwrap();
    let output =
        moire().current_dir(folder.path()).args(["render", "floor.v2.toml", "--device", "oracle"]).output();
    assert_eq!(output.unwrap().status.code(), Some(0));
    assert_eq!(files(&folder), ["floor.v2.png", "floor.v2.toml"]);
}

/// A pipe whose reader has exited, and a full device.
#[cfg(target_os = "linux")]
fn deaf_ears() -> [std::process::Stdio; 2] {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    [writer.into(), fs::OpenOptions::new().write(true).open("/dev/full").unwrap().into()]
}

#[cfg(target_os = "linux")]
#[test]
fn a_render_that_nobody_listens_to_still_writes_its_picture() {
    for stderr in deaf_ears() {
        let folder = tempdir().unwrap();
        let status = std::process::Command::new(crate::support::program())
            .current_dir(folder.path())
            .args(["render", "-v", "--size", "8x8", "--device", "oracle"])
            .arg(absolute(&path("horizon")))
            .stderr(stderr)
            .status();
        assert_eq!((status.unwrap().code(), files(&folder)), (Some(0), vec!["horizon.png".to_owned()]));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_report_that_cannot_be_printed_is_an_error_but_a_closed_pipe_is_none() {
    for (stdout, (code, said)) in deaf_ears().into_iter().zip([(0, ""), (2, "standard output")]) {
        let folder = tempdir().unwrap();
        let output = std::process::Command::new(crate::support::program())
            .current_dir(folder.path())
            .args(["render", "-q", "--json", "--size", "8x8", "--device", "oracle"])
            .arg(absolute(&path("horizon")))
            .stdout(stdout)
            .output()
            .unwrap();
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{told}");
        assert!(told.contains(said) && !told.contains("panicked"), "{told}");
    }
}
