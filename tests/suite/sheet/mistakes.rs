//! Mistakes are refused before anything is rendered, with what is allowed; no file is left.

use moire::internal::output::{WriteOptions, write};
use tempfile::tempdir;

use super::{sheet, told};
use crate::support::gradient;

#[test]
fn mistakes_end_with_exit_code_2_and_leave_no_file() {
    let folder = tempdir().unwrap();
    let kept = folder.path().join("small.exr");
    write(&gradient(3, 3), &kept, &WriteOptions::default()).unwrap();
    let spp = ["--vary", "spp=1,4"];
    let with = |more: &[&'static str]| [&spp[..], more].concat();
    for (options, what) in [
        (vec![], "--vary"),
        (vec!["--vary", "fliter=ewa"], "did you mean \"filter\"?"),
        (
            vec!["--vary", "filter=linear,neares"],
            "--vary filter: \"neares\" is none of its values: nearest, linear, cubic",
        ),
        (vec!["--vary", "filter=neares"], "did you mean \"nearest\"?"),
        (vec!["--vary", "filter=bilinear"], "did you mean \"linear\"?"),
        (vec!["--vary", "tone-map=agxx"], "--vary tone-map: \"agxx\" is none of its values: none, reinhard"),
        (vec!["--vary", "exposure=1,x"], "--vary exposure: \"x\": expected a number of stops from -64 to 64"),
        (vec!["--vary", "exposure=1", "--exposure", "2"], "--exposure fixes what --vary exposure varies"),
        (vec!["--vary", "white-balance=3"], "--vary white-balance: \"3\": expected kelvin from"),
        (vec!["--vary", "tonemap=agx"], "did you mean \"tone-map\"?"),
        (vec!["--vary", "shared=yes"], "--vary shared: \"yes\" is none of its values: true, false"),
        (vec!["--vary", "size=64"], "--vary size: \"64\": expected WIDTHxHEIGHT"),
        (vec!["--vary", "budget=5ms..20ms"], "ranges are 1..4 (each whole number), 1..64x4"),
        (vec!["--vary", "budget=5 parsecs"], "--vary budget: \"5 parsecs\": \"parsecs\" is no unit"),
        (vec!["--vary", "spp=4..1"], "spp: \"4..1\" ends below its start"),
        (vec!["--vary", "spp=1..65"], "has more values than the 64 cells of a sheet"),
        (vec!["--vary", "spp=1..a"], "--vary spp: \"1..a\": expected a whole number"),
        (
            vec!["--vary", "budget=5ms", "--vary", "target-error=0.1"],
            "--vary target-error decides what --vary budget varies",
        ),
        (vec!["--vary", "filter=nearest,,ewa"], "a value is missing"),
        (vec!["--vary", "spp=1,1"], "1 is named twice"),
        (
            vec!["--vary", "sampler.tile.filter=ewa"],
            "--vary sampler.tile.filter: ewa: sampler has no item \"tile\"",
        ),
        (vec!["--vary", "sampler.*.filter=ewa,neares"], "--vary sampler.*.filter: neares: "),
        (vec!["--vary", "spp=x"], "--vary spp: \"x\": expected a whole number"),
        (with(&["--vary", "spp=16"]), "--vary spp is given twice"),
        (with(&["--spp", "4"]), "--spp fixes what --vary spp varies"),
        (with(&["--vary", "seed=1,2", "--vary", "filter=ewa", "--vary", "mip=none"]), "given 4 times"),
        (vec!["--vary", "seed=1,2,3,4,5,6,7,8,9", "--vary", "spp=1,2,3,4,5,6,7,8"], "make 72 cells"),
        (with(&["--zoom", "400,0,200,20"]), "--zoom 400,0,200,20 reaches outside the picture of 512×384"),
        (with(&["--zoom", "1,2,3"]), "expected X,Y,W,H"),
        (with(&["--columns", "2", "--vary", "seed=1,2"]), "--columns arranges the values of one setting"),
        (with(&["--zoom-factor", "2", "--cell", "100"]), "cannot be used with"),
        (with(&["--reference", "small.exr"]), "3×3 pixels, and the sheet renders 512×384"),
        (with(&["--reference", "none.exr"]), "none.exr"),
        (with(&["--reference", "none", "--diff"]), "--diff shows differences from a reference"),
        (with(&["-o", "a.exr"]), "end its name with one of .png, .jpg, .tif, .html"),
        (with(&["-o", "none/a.html"]), "none"),
        (
            vec!["--vary", "size=4096x4096,4096x4095,4096x4094"],
            "have 101 million pixels, of which it takes 40",
        ),
        (with(&["--device", "oracle"]), "--device"),
        (vec!["--vary", "spp=2,3"], "no cell of this sheet can be rendered: --spp: "),
    ] {
        let output = sheet(folder.path(), &options);
        assert_eq!(output.status.code(), Some(2), "{options:?}: {}", told(&output));
        assert!(told(&output).contains(what), "{what} not in: {}", told(&output));
        let files = std::fs::read_dir(folder.path()).unwrap().count();
        assert_eq!(files, 1, "{options:?} left a file");
    }
}

#[test]
fn settings_of_which_one_decides_what_another_names_are_refused_with_both() {
    let folder = tempdir().unwrap();
    for (options, what) in [
        ("--size 96x72 --vary image.size=[32,24],[64,48]", "--size fixes what --vary image.size varies"),
        ("--size 96x72 --vary image.width=32,64", "--size fixes what --vary image.width varies"),
        (
            "--filter linear --vary sampler.tiled.filter=nearest,ewa",
            "--filter fixes what --vary sampler.tiled.filter varies",
        ),
        ("--mip none --vary sampler.*.mip=none,linear", "--mip fixes what --vary sampler.*.mip varies"),
        ("--spp 4 --vary sampling.spp=1,16", "--spp fixes what --vary sampling.spp varies"),
        (
            "--pixel-filter tent --vary image.pixel_filter_radius=1,2",
            "--pixel-filter fixes what --vary image.pixel_filter_radius varies",
        ),
        (
            "--vary filter=nearest,ewa --vary sampler.tiled.filter=linear,cubic",
            "--vary filter decides what --vary sampler.tiled.filter varies",
        ),
        (
            "--vary sampler.tiled.filter=linear,cubic --vary sampler.*.filter=nearest,ewa",
            "--vary sampler.*.filter decides what --vary sampler.tiled.filter varies",
        ),
        (
            "--set sampler.tiled.filter=linear --vary sampler.tiled.filter=nearest,ewa",
            "--set sampler.tiled.filter=linear fixes what --vary sampler.tiled.filter varies",
        ),
        (
            "--set sampler.tiled.filter=linear --vary filter=nearest,ewa",
            "--set sampler.tiled.filter=linear fixes what --vary filter varies",
        ),
        (
            "--set camera.eye.0=1 --vary camera.eye=[0,1,0],[0,2,0]",
            "--set camera.eye.0=1 fixes what --vary camera.eye varies",
        ),
        ("--budget 20ms --vary spp=1,4", "--budget fixes what --vary spp varies"),
        ("--vary spp=1,4 --vary target-error=0.1", "--vary target-error decides what --vary spp varies"),
        ("--budget 20ms --vary target-error=0.1", "--budget fixes what --vary target-error varies"),
        ("--budget 20ms --vary sampling.pattern=grid,halton", "--budget fixes what --vary sampling.pattern"),
    ] {
        let output = sheet(folder.path(), &options.split(' ').collect::<Vec<_>>());
        let told = told(&output);
        assert_eq!(output.status.code(), Some(2), "{options}: {told}");
        assert!(told.contains(what) && told.contains("leave one of them away"), "{what} not in: {told}");
    }
    // Both have an effect.
    for options in [
        "--set camera.eye=[0,1,0] --vary camera.eye.1=1,2",
        "--set sampler.*.filter=linear --vary sampler.tiled.mip=none,linear",
        "--pixel-filter-radius 1.5 --vary pixel-filter=tent,gaussian",
        "--budget 5ms --vary algorithm=adaptive,auto",
        "--budget 5ms --algorithm adaptive --vary sampling.footprint=none,cone",
    ] {
        let output = sheet(
            folder.path(),
            &[&["--reference", "none", "-q"][..], &options.split(' ').collect::<Vec<_>>()].concat(),
        );
        assert_eq!(output.status.code(), Some(0), "{options}: {}", told(&output));
    }
}

#[test]
fn mistakes_in_keys_name_the_key_and_the_option_that_are_meant() {
    let folder = tempdir().unwrap();
    for (options, what, also) in [
        ("--vary max_anisotropy=1,16", "\"max_anisotropy\" is no option", "sampler.*.max_anisotropy\"?"),
        ("--vary crop=0,0,9,9", "\"crop\" is no option that can vary", "camera, size"),
        (
            "--vary seed=1 --set max_anisotropy=16",
            "unknown key",
            "did you mean \"sampler.*.max_anisotropy\"?",
        ),
        ("--vary seed=1 --set filter=ewa", "did you mean \"sampler.*.filter\"?", "--filter ewa is an option"),
        ("--vary gamut=p3", "is none of its values: srgb, display-p3", "did you mean \"display-p3\"?"),
        ("--vary sampler.*.filtr=ewa", "╭─[--vary:1:11]", "did you mean \"filter\"?"),
    ] {
        let output = sheet(folder.path(), &options.split(' ').collect::<Vec<_>>());
        let told = told(&output);
        assert_eq!(output.status.code(), Some(2), "{options}: {told}");
        assert!(told.contains(what) && told.contains(also), "{what}, {also} not in: {told}");
    }
    // `render` reads scenes on another way.
    let mut render = crate::support::moire();
    let refused = render.arg("render").arg(super::scene()).args(["--set", "filter=ewa"]).output().unwrap();
    assert!(told(&refused).contains("--filter ewa is an option of its own"), "{}", told(&refused));
}

#[test]
fn a_sheet_of_the_oracle_is_refused_by_name() {
    let refused = crate::support::moire()
        .args(["sheet", "x.toml", "--vary", "spp=1,4", "--device", "oracle"])
        .output()
        .unwrap();
    assert_eq!(refused.status.code(), Some(2));
    assert!(told(&refused).contains("a sheet measures a device"), "{}", told(&refused));
}
