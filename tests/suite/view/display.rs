//! Exposure, white balance, tone map and gamut of the page: the picture is that of the command, the film stays, and a pixel's
//! numbers are those of the picture.

use serde_json::{Value, json};
use tempfile::tempdir;

use super::pictures::{picture, rendered};
use super::{View, refined};

const SIZE: &[&str] = &["--size", "40x30", "--spp", "4"];

fn with(display: Value) -> Value {
    let mut options = json!({ "size": "40x30", "spp": "4" });
    options.as_object_mut().unwrap().extend(display.as_object().unwrap().clone());
    options
}

fn all() -> [Value; 6] {
    [
        json!({ "exposure": "1.5" }),
        json!({ "white-balance": "2700" }),
        json!({ "tone-map": "agx" }),
        json!({ "gamut": "display-p3" }),
        json!({ "exposure": "-0.75", "white-balance": "9000", "tone-map": "aces", "gamut": "display-p3" }),
        json!({}),
    ]
}

/// Returns the names of a PNG file's chunks.
fn chunks(png: &[u8]) -> Vec<String> {
    let (mut found, mut at) = (Vec::new(), 8);
    while at < png.len() {
        let length = u32::from_be_bytes(png[at..at + 4].try_into().unwrap()) as usize;
        found.push(String::from_utf8(png[at + 4..at + 8].to_vec()).unwrap());
        at += 12 + length;
    }
    found.retain(|name| name != "tEXt" && name != "IDAT");
    found
}

#[test]
fn shown_pictures_are_those_of_the_command_and_the_film_is_rendered_once() {
    let view = View::of("start/ball", SIZE);
    let folder = tempdir().unwrap();
    let mut tab = view.tab("t");
    let first = tab.done()["sides"][0].clone();
    let plain = picture(&view, "a");
    for display in all() {
        let words = display.to_string();
        let before = tab.last["sides"][0]["display"].clone();
        assert_eq!(view.set("t", "a", with(display), &[]), None);
        let state = tab.until(|state| state["sides"][0]["display"] != before);
        let side = &state["sides"][0];
        for same in ["number", "points", "spp", "next"] {
            assert_eq!(side[same], first[same], "{words}: {same}");
        }
        let command = side["command"].as_str().unwrap();
        let (pixels, file) = rendered(command, folder.path());
        assert!(picture(&view, "a") == pixels, "{command}");
        assert_eq!(chunks(&view.get("picture?tab=t&side=a").body), chunks(&file), "{command}");
        assert_eq!(plain == pixels, words == "{}", "{command}");
        assert!(picture(&view, "b") == plain, "the other side has changed");
    }
}

#[test]
fn a_pixel_tells_the_light_of_the_film_and_the_numbers_of_the_picture() {
    let view = View::of("start/ball", SIZE);
    let mut tab = view.tab("t");
    tab.done();
    let pixel = |x: u32, y: u32| view.get(&format!("pixel?tab=t&side=a&x={x}&y={y}")).json()["value"].clone();
    let plain = pixel(20, 15);
    for display in all() {
        assert_eq!(view.set("t", "a", with(display.clone()), &[]), None);
        let shown = picture(&view, "a");
        for (x, y) in [(0, 0), (20, 15), (39, 29), (7, 22)] {
            let told = pixel(x, y);
            let at = 3 * (y * 40 + x) as usize;
            assert_eq!(told["shown"], json!(shown[at..at + 3]), "{display} at {x}, {y}");
            assert_eq!(told["gamut"], display.get("gamut").unwrap_or(&json!("srgb")).clone());
        }
        assert_eq!(pixel(20, 15)["linear"], plain["linear"], "{display}");
    }
}

#[test]
fn options_of_the_display_are_starting_values_and_survive_other_changes() {
    let view = View::of("start/ball", &[SIZE, &["--tone-map", "filmic", "--exposure", "-1"]].concat());
    let mut tab = view.tab("t");
    let first = view.get("page").json()["first"]["options"].clone();
    assert_eq!((&first["tone-map"], &first["exposure"]), (&json!("filmic"), &json!("-1")));
    let command = tab.done()["sides"][1]["command"].as_str().unwrap().to_owned();
    assert!(command.contains(" --exposure -1 --tone-map filmic --device "), "{command}");
    let folder = tempdir().unwrap();
    assert!(picture(&view, "b") == rendered(&command, folder.path()).0);
    let side = refined(&view, &mut tab, 0, with(json!({ "tone-map": "filmic", "filter": "nearest" })), &[]);
    let command = side["command"].as_str().unwrap();
    assert!(command.contains(" --filter nearest --size 40x30 --tone-map filmic --device "), "{command}");
    assert!(picture(&view, "a") == rendered(command, folder.path()).0, "{command}");
}

#[test]
fn sides_of_one_film_differ_in_nothing_but_what_is_shown_and_change_places() {
    let view = View::of("start/ball", SIZE);
    let mut tab = view.tab("t");
    tab.done();
    assert_eq!(view.set("t", "b", with(json!({ "tone-map": "aces" })), &[]), None);
    let state = tab.until(|state| state["sides"][1]["display"] != "");
    let [a, b] = &state["sides"].as_array().unwrap()[..] else { unreachable!() };
    assert_eq!((&a["number"], &state["difference"]), (&b["number"], &Value::Null));
    refined(&view, &mut tab, 0, with(json!({ "seed": "5" })), &[]);
    let before = tab.last.clone();
    let [shown_a, shown_b] = ["a", "b"].map(|side| picture(&view, side));
    let post =
        format!("POST /{}/swap?tab=t HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n", view.token);
    assert_eq!(view.raw(post.as_bytes()).json()["error"], Value::Null);
    let after = tab.until(|state| state["sides"] != before["sides"]);
    assert_eq!((&after["sides"][0], &after["sides"][1]), (&before["sides"][1], &before["sides"][0]));
    assert!(picture(&view, "a") == shown_b && picture(&view, "b") == shown_a);
    assert!(view.raw(post.replace("tab=t", "tab=u").as_bytes()).json()["error"].is_string());
}

#[test]
fn a_wrong_display_is_told_and_changes_nothing() {
    let view = View::of("start/ball", SIZE);
    let mut tab = view.tab("t");
    let before = tab.done();
    for (display, wanted) in [
        (json!({ "exposure": "bright" }), "--exposure: found \"bright\"; expected a number of stops"),
        (json!({ "exposure": "65" }), "from -64 to 64"),
        (json!({ "white-balance": "100" }), "from 1500 to 25000"),
        (json!({ "tone-map": "acez" }), "expected one of none, reinhard"),
        (json!({ "gamut": "rec2020" }), "expected one of srgb, display-p3"),
    ] {
        let told = view.set("t", "a", with(display), &[]).expect("it is refused");
        assert!(told.contains(wanted), "{told}");
    }
    assert_eq!(view.set("t", "b", with(json!({ "gamut": "srgb" })), &[]), None);
    let state = tab.until(|state| state["sides"][1]["display"] != "");
    assert_eq!(state["sides"][0], before["sides"][0]);
}

#[test]
fn the_display_changes_while_a_picture_takes_hours() {
    let scene = std::path::absolute(crate::stage::path("lecture")).unwrap();
    let arguments = ["--size", "512x512", "--spp", "1048576", "--device", &crate::stage::device_name()];
    let view = View::of_file(&scene, &arguments);
    let mut tab = view.tab("t");
    let number =
        tab.until(|state| state["sides"][0]["spp"].as_u64() >= Some(16))["sides"][0]["number"].clone();
    let options = json!({ "size": "512x512", "spp": "1048576", "tone-map": "agx" });
    assert_eq!(view.set("t", "a", options, &[]), None);
    let state = tab.until(|state| state["sides"][0]["display"] == "--tone-map agx");
    assert_eq!(view.get("picture?tab=t&side=a").status, 200);
    assert_eq!(state["sides"][0]["number"], number);
    assert!(state["sides"][0]["spp"].as_u64() >= Some(16));
}
