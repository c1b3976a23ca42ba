//! Limits through the program: each limit value works, and one step beyond ends with exit code 2
//! and a message that states the limit.

use std::fs;

use super::Case;
use crate::stage::device_name;

#[test]
fn the_largest_picture_is_rendered_through_a_crop_and_a_larger_one_is_refused() {
    let case = Case::new();
    case.renders(&["--size", "16384x16384", "--crop", "16383,16383,1,1"]);
    case.refused(&["--size", "16384x16385"], &["--size", "16384"]);
    case.refused(&["--size", "16384x16384", "--crop", "16384,0,1,1"], &["--crop"]);
    Case::new().renders(&["--size", "1x1"]);
}

#[test]
fn options_are_taken_at_their_limits_and_refused_beyond() {
    let one = ["--size", "1x1"];
    for allowed in [
        &["--seed", "0"][..],
        &["--seed", "4294967295"],
        &["--spp", "1"],
        &["--pattern", "random", "--spp", "3"],
        &["--workgroup", "8x1"],
        &["--crop", "0,0,1,1"],
        &["--pixel-filter", "gaussian", "--pixel-filter-radius", "8"],
        &["--target-error", "1e30"],
    ] {
        Case::new().renders(&[&one[..], allowed].concat());
    }
    let case = Case::new();
    for (refused, wanted) in [
        (&["--seed", "4294967296"][..], &["--seed", "4294967295"][..]),
        (&["--seed", "-1"], &["--seed"]),
        (&["--spp", "16777217"], &["--spp", "16777216"]),
        (&["--spp", "4294967296"], &["--spp"]),
        (&["--workgroup", "4x1"], &["8 to 1024"]),
        (&["--workgroup", "0x0"], &["8 to 1024"]),
        (&["--workgroup", "65536x65536"], &["8 to 1024"]),
        (&["--crop", "0,0,1,0"], &["--crop", "at least 1"]),
        (&["--crop", "0,0,4294967296,1"], &["--crop"]),
        (&["--pixel-filter-radius", "8.01"], &["at most 8"]),
        (&["--pixel-filter-radius", "0"], &["above 0"]),
        (&["--budget", "0"], &["above 0"]),
        (&["--budget", "inf"], &["above 0"]),
        (&["--target-error", "0"], &["above 0"]),
    ] {
        case.refused(refused, wanted);
    }
}

#[test]
fn studies_and_patterns_have_limits_too() {
    let case = Case::new();
    for (option, value, wanted) in [
        ("--spp", "0", "1..=16777216"),
        ("--spp", "16777217", "1..=16777216"),
        ("--repeats", "0", "1..=1000"),
        ("--repeats", "1001", "1..=1000"),
        ("--size", "16385x1", "16384"),
        ("--seconds", "0", "above 0"),
    ] {
        case.fails(&[], &["study", "scene.toml", "--out", "study", option, value], &[option, wanted]);
    }
    for (name, spp, wanted) in
        [("random", "0", "1 to"), ("random", "4097", "4096"), ("grid", "4095", "3969 or 4096")]
    {
        case.fails(&[], &["pattern", name, "--spp", spp], &["--spp", wanted]);
    }
    assert_eq!(case.run(&[], &["pattern", "random", "--spp", "1", "--pair", "15", "--json"]).0, Some(0));
    assert_eq!(case.run(&[], &["compare", "tiles.png", "tiles.png", "--max-rmse", "0"]).0, Some(0));
    case.fails(&[], &["compare", "tiles.png", "tiles.png", "--max-rmse=-1"], &["at least 0"]);
}

#[test]
fn the_longest_texture_file_is_read_and_a_longer_one_is_refused() {
    for (width, height) in [(65_536, 1), (1, 65_536)] {
        let case = Case::new();
        case.texture(width, height);
        case.renders(&["--texels", "buffer"]);
        case.texture(width + width / 65_536, height + height / 65_536);
        case.refused(&[], &["tiles.png", "too many", "65536"]);
    }
}

#[test]
fn a_scene_file_of_64_mebibytes_is_read_and_a_longer_one_is_refused() {
    let case = Case::new();
    let mut text = fs::read(case.path("scene.toml")).unwrap();
    // One comment.
    text.push(b'#');
    text.resize(64 << 20, b'x');
    case.put("scene.toml", &text);
    case.renders(&[]);
    text.push(b'x');
    let case = Case::new();
    case.put("scene.toml", &text);
    case.refused(&[], &["scene.toml", "64 MiB"]);
}

/// A volume one texel too long for the device's images is read from a buffer instead.
#[test]
fn a_volume_too_long_for_images_is_told_by_the_devices_limit() {
    let devices = moire::internal::gpu::list_devices().unwrap();
    let select = moire::internal::gpu::DeviceSelect::parse(&device_name()).unwrap();
    let limit = devices[select.choose(&devices).unwrap()].limits.max_image_3d;
    let case = |length: u32| {
        let volume = format!("volume = {{ file = \"v.raw\", size = [{length}, 1, 1], format = \"grey8\" }}");
        let case = Case::edit("file = \"tiles.png\"", &volume);
        let text = fs::read_to_string(case.path("scene.toml")).unwrap();
        let solid = "sampler = \"linear\"\nmapping = { kind = \"solid\" }";
        case.put("scene.toml", text.replace("sampler = \"linear\"", solid).as_bytes());
        case.put("v.raw", &vec![100; length as usize]);
        case
    };
    case(limit).renders(&["--method", "hardware"]);
    case(limit + 1).renders(&[]);
    let wanted = ["too large", &format!("{limit}×{limit}×{limit}")];
    case(limit + 1).refused(&["--method", "hardware"], &wanted);
}
