//! docs/scene-format.md against the reader of scenes: each section, each key, what it takes, which keys are
//! required, and what a key that is left out stands for.

use std::collections::BTreeSet;

use super::probe::{Context, NO_WORD, listed};
use super::table::{correct, rows};
use super::{judge, pages, synonyms};

const PAGE: &str = "docs/scene-format.md";
/// The columns: key, values, default, meaning. The first two are generated.
const COLUMNS: usize = 4;

const NONE: Context =
    Context { heading: "", header: "", body: &[], inline: None, beside: &[], without: &[], kinds: None };
const EYE: &[(&str, &str)] =
    &[("eye", "[0.0, 0.0, 1.0]"), ("look_at", "[0.0, 0.0, 0.0]"), ("vertical_fov", "40.0")];
const MATERIAL: &[(&str, &str)] = &[("name", "\"m\"")];
const SAMPLER: &[(&str, &str)] = &[("name", "\"s\"")];
const SPHERE_LIGHT: &[(&str, &str)] = &[
    ("kind", "\"sphere\""),
    ("position", "[0.0, 1.0, 0.0]"),
    ("radius", "1.0"),
    ("intensity", "[1.0, 1.0, 1.0]"),
];
const RECTANGLE: &[(&str, &str)] = &[
    ("kind", "\"rectangle\""),
    ("position", "[0.0, 1.0, 0.0]"),
    ("edge_u", "[1.0, 0.0, 0.0]"),
    ("edge_v", "[0.0, 0.0, 1.0]"),
    ("radiance", "[1.0, 1.0, 1.0]"),
];
const VOLUME: &[(&str, &str)] = &[("file", "\"v.raw\""), ("size", "[1, 1, 1]"), ("format", "\"rgba8\"")];
const PROCEDURAL: &[(&str, &str)] = &[("name", "\"p\""), ("procedural", "\"fbm\"")];
const ENVIRONMENT: &[(&str, &str)] = &[("environment", "\"t\"")];
const MESH: &[(&str, &str)] = &[("file", "\"data/models/sign.glb\"")];
const NORMAL_MAP: &[(&str, &str)] = &[("normal_map", "\"t\"")];

/// Every table of the format, in the order of the reference.
const CONTEXTS: &[Context] = &[
    Context {
        heading: "## `[camera]`",
        header: "[camera]",
        body: EYE,
        without: &[("camera_constant", "vertical_fov"), ("orthographic_height", "vertical_fov")],
        ..NONE
    },
    Context {
        heading: "### `motion` of `[camera]`",
        header: "[camera]",
        body: EYE,
        inline: Some(("motion", &[])),
        ..NONE
    },
    Context {
        heading: "## `[image]`",
        header: "[image]",
        body: &[("width", "4"), ("height", "4")],
        without: &[("size", "width"), ("size", "height")],
        ..NONE
    },
    Context { heading: "## `[sampling]`", header: "[sampling]", ..NONE },
    Context {
        heading: "## `[background]`",
        header: "[background]",
        beside: &[
            ("sampler", ENVIRONMENT),
            ("layout", ENVIRONMENT),
            ("rotate", ENVIRONMENT),
            ("mirror", ENVIRONMENT),
        ],
        ..NONE
    },
    Context {
        heading: "## `[[texture]]`",
        header: "[[texture]]",
        body: &[("name", "\"u\""), ("file", "\"u.png\"")],
        beside: &[("layout", &[("dimension", "\"cube\"")])],
        without: &[
            ("faces", "file"),
            ("slices", "file"),
            ("volume", "file"),
            ("ramp", "file"),
            ("procedural", "file"),
        ],
        ..NONE
    },
    Context {
        heading: "### `volume` of `[[texture]]`",
        header: "[[texture]]",
        body: &[("name", "\"u\"")],
        inline: Some(("volume", VOLUME)),
        ..NONE
    },
    Context {
        heading: "### `[[texture]]` with `procedural`",
        header: "[[texture]]",
        body: PROCEDURAL,
        kinds: Some("procedural"),
        ..NONE
    },
    Context { heading: "## `[[sampler]]`", header: "[[sampler]]", body: SAMPLER, ..NONE },
    Context {
        heading: "### `filter` of `[[sampler]]`",
        header: "[[sampler]]",
        body: SAMPLER,
        inline: Some(("filter", &[])),
        ..NONE
    },
    Context {
        heading: "## `[[material]]`",
        header: "[[material]]",
        body: MATERIAL,
        beside: &[
            ("green", NORMAL_MAP),
            ("strength", NORMAL_MAP),
            ("alpha_cutoff", &[("alpha", "\"mask\"")]),
            ("opacity", &[("alpha", "\"blend\"")]),
            ("occlusion_strength", &[("occlusion_map", "\"t\"")]),
        ],
        kinds: Some("model"),
        ..NONE
    },
    Context {
        heading: "### `mapping` of `[[material]]`",
        header: "[[material]]",
        body: MATERIAL,
        inline: Some(("mapping", &[("kind", "\"planar\"")])),
        ..NONE
    },
    Context {
        heading: "## `[[plane]]`",
        header: "[[plane]]",
        body: &[
            ("origin", "[0.0, 0.0, 0.0]"),
            ("tangent", "[1.0, 0.0, 0.0]"),
            ("bitangent", "[0.0, 0.0, 1.0]"),
        ],
        ..NONE
    },
    Context {
        heading: "## `[[sphere]]`",
        header: "[[sphere]]",
        body: &[("center", "[0.0, 0.0, 0.0]"), ("radius", "1.0")],
        ..NONE
    },
    Context {
        heading: "## `[[disc]]`",
        header: "[[disc]]",
        body: &[("center", "[0.0, 0.0, 0.0]"), ("normal", "[0.0, 0.0, 1.0]"), ("radius", "1.0")],
        ..NONE
    },
    Context {
        heading: "## `[[triangle]]`",
        header: "[[triangle]]",
        body: &[("vertices", "[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]")],
        ..NONE
    },
    Context { heading: "## `[[mesh]]`", header: "[[mesh]]", body: MESH, ..NONE },
    Context {
        heading: "### `transform` of `[[mesh]]`",
        header: "[[mesh]]",
        body: MESH,
        inline: Some(("transform", &[])),
        ..NONE
    },
    Context {
        heading: "## `[[light]]` of kind `point`",
        header: "[[light]]",
        body: &[("kind", "\"point\""), ("position", "[0.0, 1.0, 0.0]"), ("intensity", "[1.0, 1.0, 1.0]")],
        ..NONE
    },
    Context {
        heading: "## `[[light]]` of kind `directional`",
        header: "[[light]]",
        body: &[
            ("kind", "\"directional\""),
            ("direction", "[0.0, 1.0, 0.0]"),
            ("irradiance", "[1.0, 1.0, 1.0]"),
        ],
        ..NONE
    },
    Context { heading: "## `[[light]]` of kind `sphere`", header: "[[light]]", body: SPHERE_LIGHT, ..NONE },
    Context {
        heading: "## `[[light]]` of kind `rectangle`",
        header: "[[light]]",
        body: RECTANGLE,
        without: &[("intensity", "radiance")],
        ..NONE
    },
    Context {
        heading: "## `[[light]]` of kind `spot`",
        header: "[[light]]",
        body: &[
            ("kind", "\"spot\""),
            ("position", "[0.0, 1.0, 0.0]"),
            ("direction", "[0.0, -1.0, 0.0]"),
            ("intensity", "[1.0, 1.0, 1.0]"),
            ("outer", "30.0"),
        ],
        ..NONE
    },
    Context {
        heading: "## `[[light]]` of kind `environment`",
        header: "[[light]]",
        body: &[("kind", "\"environment\"")],
        ..NONE
    },
];

/// Returns `name` of `[[name]]`.
fn bare(header: &str) -> &str {
    header.trim_matches(['[', ']'])
}

#[test]
fn every_table_key_and_word_stands_in_the_reference() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let (mut text, mut faults) = (page.text.clone(), Vec::new());
    for context in CONTEXTS {
        let wanted: Vec<Vec<String>> =
            context.keys().iter().map(|key| vec![format!("`{key}`"), context.values(key)]).collect();
        assert!(!wanted.is_empty(), "{}: its context is refused", context.heading);
        correct(&mut text, context.heading, COLUMNS, &wanted, &mut faults);
    }
    let headings = page.text.lines().filter(|l| l.starts_with('#') && l.contains("`["));
    let strange = headings.filter(|heading| !CONTEXTS.iter().any(|c| c.heading == *heading));
    faults.extend(strange.map(|heading| format!("\"{heading}\" is no table of the format")));
    synonyms::correct(&mut text, &mut faults);
    judge(PAGE, &faults, &text);
}

/// A section, a key of one of its kinds or a kind that no context reaches would stand in no table.
#[test]
fn the_contexts_reach_the_whole_format() {
    let headers: BTreeSet<String> = CONTEXTS.iter().map(|c| bare(c.header).to_string()).collect();
    let none = Context { header: "[[\"?\"]]", ..NONE };
    let told = none.error(None, "name", Some("1")).unwrap();
    assert_eq!(headers, listed(&told).into_iter().collect(), "sections: {told}");
    for header in &headers {
        let own = || CONTEXTS.iter().filter(|c| bare(c.header) == header && c.inline.is_none());
        let reached: BTreeSet<String> = own().flat_map(Context::keys).collect();
        let told = own().next().unwrap().error(None, "?", Some("1")).unwrap();
        let all: BTreeSet<String> = listed(&told).into_iter().collect();
        assert_eq!(reached, all, "keys of {header}");
    }
    let lights = CONTEXTS.iter().filter(|c| c.header == "[[light]]");
    let kinds: BTreeSet<&str> = lights.clone().map(|c| c.body[0].1.trim_matches('"')).collect();
    let told = lights.clone().next().unwrap().error(None, "kind", Some(NO_WORD)).unwrap();
    assert_eq!(
        kinds.into_iter().map(String::from).collect::<BTreeSet<_>>(),
        listed(&told).into_iter().collect()
    );
}

/// A default in backticks is TOML: stated, it changes nothing. "required" is what the reader asks for.
#[test]
fn defaults_of_the_reference_are_those_of_the_reader() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let mut stated = 0;
    for context in CONTEXTS {
        for row in rows(&page.text, context.heading) {
            let (key, default) = (row[0].trim_matches('`'), &row[2]);
            let place = format!("{PAGE}: {}: {key}", context.heading);
            assert_eq!(default == "required", context.is_required(key), "{place}: {default}");
            let Some(value) = default.strip_prefix('`').and_then(|d| d.strip_suffix('`')) else { continue };
            let left_out = context.read(key, None);
            assert!(left_out.is_some(), "{place}: without it the scene is refused");
            assert_eq!(context.read(key, Some(value)), left_out, "{place}: {value} is not the default");
            stated += 1;
        }
    }
    assert!(stated > 30, "only {stated} defaults were compared");
}

/// Values of the kinds that keys take, some of which each key refuses.
const TRIED: &[&str] = &[
    "\"?\"",
    "0",
    "1",
    "-1",
    "2.5",
    "1e3",
    "true",
    "[0, 1]",
    "[1.0, 0.5, 0.25]",
    "[0, 0, 0, 1]",
    "\"t\"",
    "\"m\"",
    "[]",
    "{}",
    "[[0, 0, 0]]",
    "[-1, 2, 1e31]",
    "{ kind = \"planar\" }",
    "{ eye = [1, 0, 0] }",
];

#[test]
fn a_setting_of_any_key_does_what_the_file_with_that_value_does() {
    let (mut accepted, mut refused, mut keys) = (0, 0, 0);
    for context in CONTEXTS {
        for key in context.keys() {
            keys += 1;
            let words = context.words_of(&key);
            let mut outcomes = Vec::new();
            for value in TRIED.iter().map(|value| (*value).to_owned()).chain(words) {
                let [set, written] = context.set_and_written(&key, &value);
                let place = format!("{} {key} = {value}", context.heading);
                match (&set, &written) {
                    (Ok(set), Ok(written)) => assert_eq!(set, written, "{place}"),
                    (Err(set), Err(written)) => {
                        // Both say what, after the place.
                        let what = written.split_once(": ").unwrap_or_else(|| panic!("{place}: {written}")).1;
                        assert!(set.ends_with(what), "{place}:\n{set}\n{written}");
                        refused += 1;
                    }
                    _ => panic!("{place}:\n{set:?}\n{written:?}"),
                }
                accepted += usize::from(set.is_ok());
                outcomes.push(set.is_ok());
            }
            assert!(outcomes.contains(&false), "{}: {key} takes anything", context.heading);
        }
    }
    assert!(keys > 120 && accepted > 200 && refused > 1000, "{keys} keys, {accepted}, {refused}");
}

/// The first scene of the page is complete.
#[test]
fn the_scene_of_the_reference_can_be_read() {
    let Some(page) = pages().into_iter().find(|page| page.name == PAGE) else { return };
    let scene = page.text.split("```toml\n").nth(1).and_then(|rest| rest.split("```").next()).unwrap();
    moire::internal::scene::parse(std::path::Path::new("docs/scene.toml"), scene).unwrap();
}
