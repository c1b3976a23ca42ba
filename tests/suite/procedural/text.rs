//! The keys of `[[texture]]` with `procedural`: defaults, values, limits, and keys of other kinds.

use std::path::Path;

use moire::internal::scene;
use moire::internal::texture::procedural::{Procedural, ProceduralKind};

use crate::support::told;

fn parse(keys: &str) -> moire::internal::core::error::Result<Procedural> {
    let rest =
        "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 1\nheight = 1\n";
    let text = format!("[[texture]]\nname = \"t\"\n{keys}\n{rest}");
    let scene = scene::parse(Path::new("test.toml"), &text)?;
    Ok(*scene.textures[0].content.procedural().unwrap())
}

#[test]
fn a_kind_alone_has_its_defaults() {
    for kind in ProceduralKind::ALL {
        assert_eq!(parse(&format!("procedural = \"{kind}\"")).unwrap(), Procedural::new(*kind));
    }
}

#[test]
fn every_parameter_is_read() {
    let brick = parse(
        "procedural = \"brick\"\ncolors = [[0.5, 0.4, 0.3], [1, 2, 3]]\nwidth = 0.2\naspect = 3\noffset = 0.25",
    );
    let mut expected = Procedural::new(ProceduralKind::Brick);
    expected.colors = [[0.5, 0.4, 0.3], [1.0, 2.0, 3.0]];
    (expected.width, expected.aspect, expected.offset) = (0.2, 3.0, 0.25);
    assert_eq!(brick.unwrap(), expected);

    let marble = parse(
        "procedural = \"marble\"\nseed = 7\noctaves = 9\nlacunarity = 2.5\ngain = 0.25\ndistortion = 1.5",
    );
    let mut expected = Procedural::new(ProceduralKind::Marble);
    (expected.seed, expected.octaves, expected.distortion) = (7, 9, 1.5);
    (expected.lacunarity, expected.gain) = (2.5, 0.25);
    assert_eq!(marble.unwrap(), expected);

    assert_eq!(parse("procedural = \"cellular\"\njitter = 0.5").unwrap().jitter, 0.5);
    assert_eq!(parse("procedural = \"grid\"\ndimensions = 3").unwrap().dimensions, 3);
}

#[test]
fn what_is_wrong_is_named_with_its_place_and_what_is_allowed() {
    for (keys, expected) in [
        (
            "width = 0.1",
            "key \"texture.file\" is missing in [[texture]]: give one of file, faces, slices, volume, ramp, procedural",
        ),
        ("procedural = \"chequer\"", "test.toml:3:14: key \"texture.procedural\": unknown value \"chequer\""),
        (
            "procedural = \"checker\"\njitter = 0.5",
            "test.toml:4:10: key \"texture.jitter\": procedural \"checker\" has no jitter; cellular has it",
        ),
        ("procedural = \"noise\"\noctaves = 3", "fbm, turbulence, marble, wood have it"),
        ("procedural = \"fbm\"\noctaves = 17", "an integer from 1 to 16, found 17"),
        ("procedural = \"fbm\"\noctaves = 0", "an integer from 1 to 16, found 0"),
        ("procedural = \"fbm\"\nlacunarity = 0.5", "a number from 1 to 16, found 0.5"),
        ("procedural = \"fbm\"\ngain = 0", "a number from 0.01 to 1, found 0"),
        ("procedural = \"stripes\"\nwidth = 1.5", "a number from 0 to 1, found 1.5"),
        ("procedural = \"wood\"\ndistortion = nan", "a finite number"),
        ("procedural = \"grid\"\ndimensions = 4", "an integer from 2 to 3, found 4"),
        ("procedural = \"brick\"\naspect = 0.0", "a number from 0.01 to 100, found 0.0"),
        (
            "procedural = \"brick\"\naspect = 0.05",
            "key \"texture.aspect\": joints of width 0.1 leave nothing",
        ),
        ("procedural = \"brick\"\nwidth = 1", "key \"texture.width\": joints of width 1 leave nothing"),
        ("procedural = \"checker\"\ncolors = [[1, 1, 1]]", "2 colours, background and figure"),
        ("procedural = \"checker\"\ncolors = [[1, 1, 1], [0, -1, 0]]", "not negative"),
        ("procedural = \"checker\"\nscale = 2", "unknown key \"scale\""),
    ] {
        let message = told(parse(keys));
        assert!(message.contains(expected), "{keys:?} gave {message}");
    }
}
