//! Scene files and command lines with invalid values.

use super::Case;
use crate::stage::device_name;

#[test]
fn nan_and_infinity_are_refused_wherever_a_number_stands() {
    for bad in ["nan", "inf", "-inf"] {
        for (old, new, key) in [
            ("eye = [0.0,", format!("eye = [{bad},"), "eye"),
            ("vertical_fov = 60.0", format!("vertical_fov = {bad}"), "vertical_fov"),
            ("spp = 4", format!("spp = {bad}"), "spp"),
            ("width = 16", format!("width = {bad}"), "width"),
            ("origin = [0.0,", format!("origin = [{bad},"), "origin"),
            ("model = \"unlit\"", format!("model = \"unlit\"\ncolor = [1.0, {bad}, 0.0]"), "color"),
            ("[[texture]]", format!("[background]\ncolor = [0.0, 0.0, {bad}]\n[[texture]]"), "color"),
            (
                "model = \"unlit\"",
                format!("model = \"unlit\"\nmapping = {{ kind = \"surface\", rotate = {bad} }}"),
                "rotate",
            ),
            (
                "[[plane]]",
                format!("[[sphere]]\ncenter = [0.0, 0.0, 0.0]\nradius = {bad}\n[[plane]]"),
                "radius",
            ),
            (
                "[[plane]]",
                format!(
                    "[[light]]\nkind = \"point\"\nposition = [0, {bad}, 0]\nintensity = [1, 1, 1]\n[[plane]]"
                ),
                "position",
            ),
        ] {
            Case::edit(old, &new).refused(&[], &["scene.toml", key]);
        }
    }
}

#[test]
fn unknown_keys_and_names_come_with_a_suggestion() {
    for (old, new, wanted) in [
        ("vertical_fov", "vertical_fow", &["vertical_fow", "vertical_fov", "scene.toml:5"][..]),
        ("[[sampler]]", "[[samplr]]", &["samplr", "sampler"]),
        ("model = \"unlit\"", "model = \"unlitt\"", &["unlitt", "unlit"]),
        ("texture = \"tiles\"", "texture = \"tile\"", &["tile", "tiles"]),
        ("material = \"floor\"", "material = \"flor\"", &["flor", "floor"]),
        ("spp = 4", "spp = 4\npatern = \"grid\"", &["patern", "pattern"]),
    ] {
        Case::edit(old, new).refused(&[], wanted);
    }
    let case = Case::new();
    case.refused(&["--patern", "grid"], &["--patern", "--pattern"]);
    case.refused(&["--pattern", "stratifed"], &["stratifed", "stratified"]);
}

#[test]
fn duplicate_names_are_refused() {
    let twice = "[[texture]]\nname = \"tiles\"\nfile = \"tiles.png\"\n[[texture]]";
    Case::edit("[[texture]]", twice).refused(&[], &["tiles", "texture", "scene.toml"]);
    Case::edit("spp = 4", "spp = 4\nspp = 9").refused(&[], &["spp", "duplicate"]);
}

#[test]
fn camera_without_a_direction_is_refused() {
    let up = "eye = [0.0, 1.0, 0.0]\nup = [0.0, 0.4, -2.0]";
    let along = Case::edit("eye = [0.0, 1.0, 0.0]", &up.replace("[0.0, 0.4, -2.0]", "[0.0, -0.8, -4.0]"));
    along.refused(&[], &["up", "parallel"]);
    Case::edit("look_at = [0.0, 0.2, -4.0]", "look_at = [0.0, 1.0, 0.0]").refused(&[], &["look_at", "eye"]);
    for fov in ["0.0", "180.0", "-10.0"] {
        Case::edit("vertical_fov = 60.0", &format!("vertical_fov = {fov}")).refused(&[], &["vertical_fov"]);
    }
}

#[test]
fn sizes_of_zero_and_over_the_limit_are_refused() {
    for width in ["0", "-1", "16385", "99999999999", "1.5"] {
        Case::edit("width = 16", &format!("width = {width}")).refused(&[], &["width"]);
    }
    for size in ["0x4", "4x0", "16385x4", "4", "axb", "-4x4", "99999999999x1"] {
        Case::new().refused(&[&format!("--size={size}")], &["--size", "16384"]);
    }
}

#[test]
fn sample_counts_are_checked_from_either_side() {
    for (spp, wanted) in [("0", "1 to 16777216"), ("5", "4 or 9"), ("16777217", "16777216")] {
        Case::edit("spp = 4", &format!("spp = {spp}")).refused(&[], &["spp", wanted]);
        Case::new().refused(&["--spp", spp], &["--spp", wanted]);
    }
    Case::new().refused(&["--spp=-1"], &["--spp"]);
    Case::new().renders(&["--spp", "5", "--pattern", "random"]);
}

#[test]
fn crops_outside_the_picture_are_refused() {
    for crop in ["0,0,17,1", "15,11,2,1", "4294967295,0,2,1", "0,0,0,1", "1,2,3", "a,b,c,d"] {
        Case::new().refused(&[&format!("--crop={crop}")], &["--crop"]);
    }
}

#[test]
fn what_is_no_scene_is_told() {
    let case = Case::new();
    let device = device_name();
    let render = |scene: &str, wanted: &[&str]| {
        case.fails(&[], &["render", scene, "-o", "out.png", "--device", &device], wanted);
    };
    render("none.toml", &["none.toml"]);
    render(".", &["it is a folder"]);
    render("tiles.png", &["tiles.png", "it is a picture"]);
    case.put("broken.toml", b"[camera\neye = 1");
    render("broken.toml", &["broken.toml", "TOML"]);
    case.put("empty.toml", b"");
    render("empty.toml", &["empty.toml", "camera"]);
}

#[test]
fn a_picture_as_a_scene_and_a_scene_that_is_not_there_are_answered_with_what_to_type() {
    let case = Case::new();
    let told = ["tiles.png", "it is a picture", "moire new floor -t", "--from"];
    case.fails(&[], &["render", "tiles.png", "-o", "a.png"], &told);
    for (arguments, near) in [
        (["render", "scene.tmol", "-o", "a.png"], "scene.toml"),
        (["view", "scen.toml", "--port", "0"], "scene.toml"),
        (["render", "--from", "tiels.png", "-q"], "tiles.png"),
    ] {
        let said = format!("did you mean ./{near}?");
        case.fails(&[], &arguments, &[arguments[1].trim_start_matches("--from"), &said]);
    }
    case.fails(&[], &["render", "none/scene.toml", "-o", "a.png"], &["the folder none does not exist"]);
}
