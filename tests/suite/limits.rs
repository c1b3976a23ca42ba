//! Every limit of the scene vocabulary: the limit value parses, and one step beyond is an error
//! that states the limit.

use std::path::Path;

use moire::internal::core::error::Error;
use moire::internal::scene::model::Pattern;
use moire::internal::scene::{check_spp, parse};

mod device;

const HEAD: &str = "camera = { eye = [0, 1, 5], look_at = [0, 1, 0], vertical_fov = 60 }\n";
const IMAGE: &str = "image = { width = 4, height = 4 }\n";

fn outcome(text: &str) -> Result<(), String> {
    match parse(Path::new("a.toml"), text) {
        Ok(_) => Ok(()),
        Err(Error::Scene { message, .. }) => Err(message),
        Err(other) => Err(format!("no scene error: {other}")),
    }
}

/// (scene with `N` for the number, allowed, refused, text that the message must contain).
type Rule = (&'static str, &'static [&'static str], &'static [&'static str], &'static str);

const RULES: &[Rule] = &[
    ("image = { width = N, height = 1 }", &["1", "16384"], &["0", "16385"], "1 to 16384"),
    ("image = { width = 1, height = N }", &["1", "16384"], &["0", "16385"], "1 to 16384"),
    ("+sampling = { spp = N, pattern = 'random' }", &["1", "16777216"], &["0", "16777217"], "1 to 16777216"),
    ("+sampling = { spp = N }", &["1", "16777216"], &["2", "16777215"], "no square"),
    (
        "+sampling = { spp = N, pattern = 'blue-noise' }",
        &["1", "16777216"],
        &["3", "16777215"],
        "no power of two",
    ),
    ("+sampling = { max_depth = N }", &["0", "64"], &["65", "-1"], "0 to 64"),
    ("+sampling = { seed = N }", &["0", "4294967295"], &["4294967296", "-1"], "0 to 4294967295"),
    ("+sampler = [{ name = 's', max_anisotropy = N }]", &["1", "64"], &["0", "65"], "1 to 64"),
    ("+texture = [{ name = 't', procedural = 'fbm', octaves = N }]", &["1", "16"], &["0", "17"], "1 to 16"),
    (
        "+texture = [{ name = 't', procedural = 'fbm', seed = N }]",
        &["0", "4294967295"],
        &["4294967296"],
        "0 to 4294967295",
    ),
    (
        "+texture = [{ name = 't', procedural = 'fbm', lacunarity = N }]",
        &["1", "16"],
        &["0", "0.999", "16.01"],
        "1 to 16",
    ),
    (
        "+texture = [{ name = 't', procedural = 'fbm', gain = N }]",
        &["0.01", "1"],
        &["0", "0.0099", "1.01"],
        "0.01 to 1",
    ),
    (
        "+texture = [{ name = 't', procedural = 'wood', distortion = N }]",
        &["0", "100"],
        &["-0.1", "100.1"],
        "0 to 100",
    ),
    ("+texture = [{ name = 't', procedural = 'grid', dimensions = N }]", &["2", "3"], &["1", "4"], "2 to 3"),
    (
        "+texture = [{ name = 't', procedural = 'stripes', width = N }]",
        &["0", "1"],
        &["-0.1", "1.1"],
        "0 to 1",
    ),
    (
        "+texture = [{ name = 't', procedural = 'brick', aspect = N }]",
        &["0.2", "100"],
        &["0", "0.009", "101"],
        "0.01 to 100",
    ),
    ("+texture = [{ name = 't', procedural = 'brick', width = N }]", &["0", "0.99"], &["1"], "below both"),
    (
        "+texture = [{ name = 't', procedural = 'cellular', jitter = N }]",
        &["0", "1"],
        &["-0.1", "1.1"],
        "0 to 1",
    ),
    (
        "+texture = [{ name = 't', volume = { file = 'f', format = 'grey8', size = [N, 1, 1] } }]",
        &["1", "65536"],
        &["0", "65537"],
        "1 to 65536",
    ),
    (
        "+texture = [{ name = 't', volume = { file = 'f', format = 'grey8', size = [1, 1, N] } }]",
        &["1", "65536"],
        &["0", "65537"],
        "1 to 65536",
    ),
    (
        "+material = [{ name = 'm', model = 'dielectric', ior = N }]",
        &["0.01", "100"],
        &["0", "0.0099", "100.1"],
        "0.01 to 100",
    ),
    (
        "+material = [{ name = 'm', model = 'phong', exponent = N }]",
        &["1", "1e6"],
        &["0", "0.99", "1000001"],
        "1 to 1e6",
    ),
    (
        "+material = [{ name = 'm', model = 'mirror', roughness = N }]",
        &["0", "1"],
        &["-0.01", "1.01"],
        "0 to 1",
    ),
    (
        "+sphere = [{ center = [0, 0, 0], radius = N }]",
        &["1e-30", "1e30"],
        &["0", "9e-31", "1.1e30"],
        "1e-30 to 1e30",
    ),
    (
        "+plane = [{ origin = [0, 0, 0], tangent = [1, 0, 0], bitangent = [0, 1, 0], half_extent = N }]",
        &["1e-30", "1e30"],
        &["0", "1.1e30"],
        "1e-30 to 1e30",
    ),
    (
        "+sphere = [{ center = [0, N, 0], radius = 1 }]",
        &["0", "-1e30", "1e30"],
        &["1.1e30", "-1.1e30"],
        "-1e30 and 1e30",
    ),
    (
        "+light = [{ kind = 'directional', direction = [0, 1, 0], irradiance = [1, 1, 1], angle = N }]",
        &["0", "180"],
        &["-0.1", "180.1"],
        "0 to 180",
    ),
    (
        "+light = [{ kind = 'sphere', position = [0, 9, 0], intensity = [1, 1, 1], radius = N }]",
        &["0", "1e30"],
        &["-1", "1.1e30"],
        "0 to 1e30",
    ),
    (
        "+light = [{ kind = 'point', position = [0, 9, 0], intensity = [N, 1, 1] }]",
        &["0", "1e30"],
        &["-1", "1.1e30"],
        "0 to 1e30",
    ),
    (
        "image = { width = 4, height = 4, pixel_filter = 'gaussian', pixel_filter_radius = N }",
        &["1e-30", "8"],
        &["0", "8.01", "-1"],
        "at most 8",
    ),
];

#[test]
fn numbers_are_taken_at_their_limits_and_refused_beyond_with_the_limit_named() {
    let mut failures = String::new();
    for (snippet, allowed, refused, words) in RULES {
        let scene = |number: &str| match snippet.strip_prefix('+') {
            Some(more) => format!("{HEAD}{IMAGE}{}\n", more.replace('N', number)),
            None => format!("{HEAD}{}\n", snippet.replace('N', number)),
        };
        for number in *allowed {
            if let Err(message) = outcome(&scene(number)) {
                failures += &format!("\n{snippet} with {number}: {message}");
            }
        }
        for number in *refused {
            match outcome(&scene(number)) {
                Err(message) if message.contains(words) => {}
                other => failures += &format!("\n{snippet} with {number}: {other:?} without {words:?}"),
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn lists_of_slices_and_colours_are_taken_up_to_their_limit() {
    let of = |key: &str, item: &str, count: usize| {
        format!("{HEAD}{IMAGE}texture = [{{ name = 't', {key} = [{}] }}]\n", vec![item; count].join(", "))
    };
    for (key, item) in [("slices", "'f'"), ("ramp", "[1, 0, 0]")] {
        for count in [1, 65_536] {
            assert_eq!(outcome(&of(key, item, count)), Ok(()), "{count} {key}");
        }
        for count in [0, 65_537] {
            let message = outcome(&of(key, item, count)).unwrap_err();
            assert!(message.contains("1 to 65536"), "{count} {key}: {message}");
        }
    }
    let faces = |count: usize| of("faces", "'f'", count);
    assert_eq!(outcome(&faces(6)), Ok(()));
    for count in [0, 5, 7] {
        assert!(outcome(&faces(count)).unwrap_err().contains('6'), "{count} faces");
    }
}

#[test]
fn sample_counts_next_to_the_limit_are_named_as_the_nearest_that_fit() {
    assert_eq!(check_spp(Pattern::Random, 1 << 24), Ok(()));
    assert!(check_spp(Pattern::Random, (1 << 24) + 1).unwrap_err().contains("1 to 16777216"));
    // The square and the power of two above the greatest number would not be allowed.
    for pattern in [Pattern::Grid, Pattern::BlueNoise] {
        let message = check_spp(pattern, (1 << 24) - 1).unwrap_err();
        assert!(message.contains("or 16777216"), "{message}");
    }
}
