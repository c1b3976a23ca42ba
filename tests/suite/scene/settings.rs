//! Invalid cameras, images, sampling and backgrounds.

use std::path::Path;

use moire::internal::scene::advice::of_scene;
use moire::internal::scene::model::Pattern;
use moire::internal::scene::{check_shared, check_spp, parse};

use super::HEAD;
use super::errors::{PATH, check, check_behind_head, check_replaced};

#[test]
fn camera_and_image_rules() {
    check_replaced(&[
        ("eye missing", "eye = [0, 1, 5]\n", "", &[":1:1:", "\"camera.eye\"", "missing"]),
        ("look_at missing", "look_at = [0, 1, 0]\n", "", &["\"camera.look_at\"", "missing"]),
        ("no projection", "vertical_fov = 60\n", "", &["vertical_fov, camera_constant, orthographic_height"]),
        (
            "two projections",
            "vertical_fov = 60",
            "vertical_fov = 60\ncamera_constant = 1",
            &[":5:19:", "camera.camera_constant", "vertical_fov is given too", "exactly one"],
        ),
        ("fov 0", "= 60", "= 0", &["camera.vertical_fov", "above 0 and below 180 degrees", "found 0"]),
        ("fov 180", "= 60", "= 180.0", &["above 0 and below 180", "found 180.0"]),
        ("constant 0", "vertical_fov = 60", "camera_constant = 0", &["camera.camera_constant", "above 0"]),
        (
            "orthographic negative",
            "vertical_fov = 60",
            "orthographic_height = -2",
            &["camera.orthographic_height", "above 0", "found -2"],
        ),
        (
            "nan",
            "[0, 1, 5]",
            "[0, nan, 1]",
            &["a.toml:2:11: key \"camera.eye\": expected 3 finite numbers, found [0, nan, 1]"],
        ),
        ("inf", "[0, 1, 5]", "[0, 1, -inf]", &[":2:14:", "3 finite numbers, found [0, 1, -inf]"]),
        ("overflow of double", "[0, 1, 5]", "[0, 1, 1e999]", &["3 finite numbers", "1e999"]),
        ("overflow of single", "[0, 1, 5]", "[0, 1, 2e30]", &["between -1e30 and 1e30", "2e30"]),
        ("huge integer", "[0, 1, 5]", "[0, 1, 99999999999999999999999999999999]", &["-1e30 and 1e30"]),
        ("too few", "[0, 1, 5]", "[0, 1]", &["3 finite numbers, found [0, 1]"]),
        ("too many", "[0, 1, 5]", "[0, 1, 5, 6]", &["3 finite numbers, found [0, 1, 5, 6]"]),
        ("text in a vector", "[0, 1, 5]", "[0, '1', 5]", &[":2:11:", "3 finite numbers"]),
        ("scalar for a vector", "[0, 1, 5]", "'here'", &["3 finite numbers, found the string 'here'"]),
        ("eye at look_at", "[0, 1, 5]", "[0, 1, 0]", &["camera.look_at", "where the eye is"]),
        ("default up parallel", "[0, 1, 5]", "[0, 7, 0]", &["camera.up", "[0, 1, 0]", "parallel"]),
        (
            "given up parallel",
            "vertical_fov = 60",
            "vertical_fov = 60\nup = [0, 0, 3]",
            &[":5:6:", "camera.up", "parallel"],
        ),
        ("up zero", "vertical_fov = 60", "vertical_fov = 60\nup = [0, 0, 0]", &["camera.up", "not zero"]),
        ("camera twice", "[image]", "[camera]", &[":6:2:", "duplicate key"]),
        ("camera as array", "[camera]", "[[camera]]", &["one table [camera]", "found [[camera]]"]),
        ("image missing", "[image]\nwidth = 64\nheight = 48\n", "", &["section [image] is missing", "width"]),
        ("height missing", "height = 48\n", "", &[":6:1:", "image.height", "missing"]),
        ("width 0", "= 64", "= 0", &["image.width", "an integer from 1 to 16384, found 0"]),
        ("height over the limit", "= 48", "= 16385", &["image.height", "1 to 16384, found 16385"]),
        ("fractional width", "= 64", "= 64.0", &["integer", "found 64.0"]),
        ("negative width", "= 64", "= -64", &["integer", "found -64"]),
        ("boolean width", "= 64", "= true", &["integer", "found true"]),
    ]);
    check(&[("no camera", "", &["scenes/a.toml:1:1:", "section [camera] is missing", "look_at"])]);
}

#[test]
fn sampling_and_background_rules() {
    check_behind_head(&[
        ("spp 0", "[sampling]\nspp = 0", &["sampling.spp", "from 1 to 16777216, found 0"]),
        ("spp over 2^24", "[sampling]\nspp = 16777217", &["from 1 to 16777216"]),
        ("no square", "[sampling]\nspp = 15", &["sampling.spp", "spp = 15 is no square; use 9 or 16"]),
        ("no square grid", "[sampling]\npattern = 'grid'\nspp = 2", &["use 1 or 4", "\"grid\""]),
        (
            "shared grid",
            "[sampling]\npattern = 'grid'\nshared = true",
            &["sampling.shared", "stratified", "grid"],
        ),
        (
            "no power of two",
            "[sampling]\npattern = 'blue-noise'\nspp = 9",
            &["sampling.spp", "spp = 9 is no power of two; use 8 or 16", "\"blue-noise\""],
        ),
        (
            "shared blue noise",
            "[sampling]\npattern = 'blue-noise'\nshared = true",
            &["sampling.shared", "neighbouring pixels differ", "sobol-owen"],
        ),
        ("shared as text", "[sampling]\nshared = 'yes'", &["true or false, found the string 'yes'"]),
        ("depth 65", "[sampling]\nmax_depth = 65", &["sampling.max_depth", "from 0 to 64, found 65"]),
        ("seed negative", "[sampling]\nseed = -1", &["sampling.seed", "from 0 to 4294967295, found -1"]),
        (
            "near pattern",
            "[sampling]\npattern = 'stratfied'",
            &["did you mean \"stratified\"?", "center, grid"],
        ),
        ("far pattern", "[sampling]\npattern = 'voronoi'", &["\"voronoi\"; allowed: center, grid, random"]),
        ("algorithm", "[sampling]\nalgorithm = 'rays'", &["sampling.algorithm", "allowed: samples"]),
        ("footprint", "[sampling]\nfootprint = 'ray'", &["\"ray\"; allowed: none, cone, differentials"]),
        ("number as name", "[sampling]\npattern = 3", &["a string, one of center", "found 3"]),
        (
            "negative background",
            "[background]\ncolor = [0, -0.1, 0]",
            &[":10:13:", "background.color", "negative"],
        ),
        (
            "environment",
            "[background]\nenvironment = 'x'",
            &["background.environment", "\"x\"", "no [[texture]]"],
        ),
        (
            "environment of one dimension",
            "[[texture]]\nname = 't'\nramp = [[1, 1, 1]]\n[background]\nenvironment = 't'",
            &["background.environment", "a 2d or a cube texture; this one is 1d"],
        ),
        (
            "layout of the other dimension",
            "[[texture]]\nname = 't'\nfile = 'f'\n[background]\nenvironment = 't'\nlayout = 'cube'",
            &["background.layout", "2d, which needs layout \"equirectangular\""],
        ),
        ("turned nothing", "[background]\nrotate = 90", &["background.rotate", "needs an environment"]),
        ("mirrored nothing", "[background]\nmirror = true", &["background.mirror", "needs an environment"]),
        (
            "mirrored how",
            "[[texture]]\nname = 't'\nfile = 'f'\n[background]\nenvironment = 't'\nmirror = 'x'",
            &["background.mirror", "true or false"],
        ),
        (
            "sampler of nothing",
            "[background]\nsampler = 's'",
            &["background.sampler", "needs an environment"],
        ),
    ]);
}

/// Rows of an environment continue across its poles: another address of v is reported if the scene states it, not if it
/// is the default.
#[test]
fn an_address_that_poles_replace_is_told() {
    let told = |sampler: &str, texture: &str| {
        let text = format!(
            "{HEAD}[[texture]]\nname = 't'\n{texture}\n[[sampler]]\nname = 's'\n{sampler}\n\
             [background]\nenvironment = 't'\nsampler = 's'\n"
        );
        let told = of_scene(&parse(Path::new(PATH), &text).unwrap());
        told.into_iter().filter(|t| t.contains("over its poles")).collect::<Vec<_>>()
    };
    let flat = "file = 'f'";
    for (stated, name) in [
        ("address = 'mirrored-repeat'", "\"mirrored-repeat\""),
        ("address = ['clamp-to-edge', 'clamp-to-border']", "\"clamp-to-border\""),
        ("address = 'repeat'", "\"repeat\""),
    ] {
        let told = told(stated, flat);
        assert!(told.len() == 1 && told[0].contains(name), "{stated}: {told:?}");
    }
    for silent in ["", "address = 'clamp-to-edge'", "address = ['repeat', 'clamp-to-edge']"] {
        assert!(told(silent, flat).is_empty(), "{silent}");
    }
    let cube = "file = 'f'\ndimension = 'cube'\nlayout = 'horizontal-cross'";
    assert!(told("address = 'mirrored-repeat'", cube).is_empty());
}

#[test]
fn spp_and_shared_rules_stand_for_the_command_line_too() {
    for pattern in [Pattern::Grid, Pattern::Stratified] {
        let message = check_spp(pattern, 15).unwrap_err();
        assert!(message.contains("spp = 15 is no square; use 9 or 16"), "{message}");
        assert!(check_spp(pattern, (1 << 24) - 1).unwrap_err().contains("use 16769025 or 16777216"));
        assert_eq!(check_spp(pattern, 1 << 24), Ok(()));
    }
    let blue = check_spp(Pattern::BlueNoise, 100).unwrap_err();
    assert!(blue.contains("spp = 100 is no power of two; use 64 or 128"), "{blue}");
    for spp in [1, 2, 1 << 23, 1 << 24] {
        assert_eq!(check_spp(Pattern::BlueNoise, spp), Ok(()));
    }
    use Pattern::{Center, Halton, MultiJittered, NRooks, Random, SobolOwen};
    for pattern in [Center, Random, MultiJittered, Halton, SobolOwen, NRooks] {
        assert_eq!(check_spp(pattern, 15), Ok(()));
    }
    assert!(check_spp(Pattern::Random, 0).unwrap_err().contains("1 to 16777216"));
    assert!(check_spp(Pattern::Random, u32::MAX).is_err());
    assert!(check_shared(Pattern::Random, true).unwrap_err().contains("stratified"));
    for pattern in [Pattern::Stratified, MultiJittered, Halton, SobolOwen, NRooks] {
        assert_eq!(check_shared(pattern, true), Ok(()));
    }
}
