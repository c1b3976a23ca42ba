//! The rooms and their interfaces, by the sources: each shader file with functions has its twin in the oracle at the
//! same path, and outside its room no code names a kind of shape, a reflection model or a filter. The checkers are
//! tested with planted files.

use std::collections::BTreeSet;
use std::fs;

use crate::layering::{files_under, source_root};

/// Files of `glsl/shared` without a twin, and why.
const WITHOUT_TWIN: &[(&str, &str)] = &[
    ("bsdf/models", "the oracle's stands at the head of its folder: `bsdf/mod.rs`"),
    ("diagnostics", "counters of the device"),
    ("loops", "a limit of a driver"),
    ("mip_chain", "its twin makes levels on the host: `src/texture/mips`"),
    ("geometry/mesh_lists", "lists shorten a search: pictures with and without them are equal"),
    ("geometry/mesh_survey", "it makes these lists"),
    ("geometry/mesh_shade_region", "what is lit, for the lists of what may shade it"),
    ("geometry/mesh_shade_survey", "it makes these lists"),
    ("geometry/mesh_shades", "so do those of the triangles that may shade a pixel"),
    ("geometry/mesh_receivers", "what a pixel sees, for these"),
    ("geometry/mesh_held", "triangles of lists, kept for many rays"),
    ("geometry/mesh_team", "those that a workgroup keeps for its pixels"),
    ("geometry/mesh_team_shades", "lists of the triangles that may shade these"),
    ("film_sums", "sums of a pixel in the device's film"),
    ("render_team", "which part of the work the threads of a workgroup do"),
    ("probe_main", "a list of look-ups"),
    ("probe_rays_main", "a list of rays"),
    ("slice", "which part of the work a thread does"),
    ("texel_buffer", "buffers of the device"),
];
/// Files of `src/oracle` without a twin, and why.
const WITHOUT_SHADER: &[(&str, &str)] = &[("backend", "who takes the samples of `render_main`")];

/// `main` of a shader is in `X_main.glsl`, its twin in `X.rs`.
fn twin_of(glsl: &str) -> &str {
    glsl.strip_suffix("_main").unwrap_or(glsl)
}

fn has_functions(glsl: &str) -> bool {
    glsl.lines().any(|line| line.starts_with(|c: char| c.is_ascii_lowercase()) && line.contains(") {"))
}

/// Returns missing twins: (path below glsl/shared without its ending, text) against paths below src/oracle.
fn widows(shaders: &[(String, String)], oracle: &BTreeSet<String>) -> Vec<String> {
    let excepted = |list: &[(&str, &str)], name: &str| list.iter().any(|(n, _)| *n == name);
    let mut found = Vec::new();
    for (name, text) in shaders {
        if has_functions(text) && !oracle.contains(twin_of(name)) && !oracle.contains(name) {
            if !excepted(WITHOUT_TWIN, name) {
                found.push(format!("glsl/shared/{name}.glsl has no src/oracle/{}.rs", twin_of(name)));
            }
        } else if excepted(WITHOUT_TWIN, name) {
            found.push(format!("{name} has a twin and is listed as if it had none"));
        }
    }
    for name in oracle.iter().filter(|name| !name.ends_with("mod")) {
        let twin = shaders.iter().any(|(n, _)| n == name || twin_of(n) == name);
        if twin == excepted(WITHOUT_SHADER, name) {
            found.push(format!("src/oracle/{name}.rs: twin {twin}, which the list contradicts"));
        }
    }
    found
}

fn texts(folder: &str, ending: &str) -> Option<Vec<(String, String)>> {
    let root = source_root()?;
    let mut files = Vec::new();
    files_under(&root.join(folder), &mut files);
    let named = files.iter().filter_map(|file| {
        let path = file.strip_prefix(root.join(folder)).ok()?.to_string_lossy().replace('\\', "/");
        Some((path.strip_suffix(ending)?.to_string(), fs::read_to_string(file).ok()?))
    });
    Some(named.collect())
}

#[test]
fn every_shader_file_has_its_twin_at_the_same_place() {
    let (Some(shaders), Some(oracle)) = (texts("glsl/shared", ".glsl"), texts("src/oracle", ".rs")) else {
        return;
    };
    let oracle: BTreeSet<String> = oracle.into_iter().map(|(name, _)| name).collect();
    assert!(oracle.len() > 30, "only {} files of the oracle were found", oracle.len());
    let found = widows(&shaders, &oracle);
    assert!(found.is_empty(), "{}", found.join("\n"));
    let mut fewer = oracle.clone();
    fewer.remove("geometry/plane");
    assert!(widows(&shaders, &fewer)[0].contains("geometry/plane"));
    let mut more = oracle.clone();
    more.insert("geometry/cube".into());
    assert!(widows(&shaders, &more)[0].contains("geometry/cube"));
    more.insert("slice".into());
    assert!(widows(&shaders, &more).iter().any(|f| f.contains("slice has a twin")));
}

/// A room, the words reserved for it, and the files outside it that declare its parts.
struct Door {
    room: &'static str,
    words: &'static [&'static str],
    inside: &'static [&'static str],
}

const DOORS: &[Door] = &[
    Door {
        room: "geometry",
        words: &[
            "plane_at",
            "sphere_at",
            "triangle_at",
            "disc_at",
            "PLANES",
            "SPHERES",
            "TRIANGLES",
            "DISCS",
            ".planes",
            ".spheres",
            ".triangles",
            ".discs",
        ],
        inside: &[
            "glsl/shared/geometry/",
            "src/oracle/geometry/",
            "src/pack/geometry/",
            "src/scene/geometry/",
            // Files of triangles.
            "src/mesh/",
            // Bounds of planes and normals of triangles are features.
            "src/pack/features/narrowed.rs",
            "src/schema/",
            // Tile culling and its twin are stand-ins for an acceleration structure.
            "glsl/shared/tile_culling_main.glsl",
            "src/oracle/tile_culling.rs",
            // Planes of a picture's samples.
            "src/texture/tiff/",
        ],
    },
    Door {
        room: "bsdf",
        words: &[
            "MODEL_",
            "Model::Unlit",
            "Model::Lambert",
            "Model::Mirror",
            "Model::Dielectric",
            "Model::Phong",
        ],
        inside: &[
            "glsl/shared/bsdf/",
            "src/oracle/bsdf/",
            "src/scene/bsdf.rs",
            "glsl/shared/layout.glsl",
            "src/schema/",
        ],
    },
    Door {
        room: "filter",
        words: &[
            " FILTER_",
            "<< FILTER_",
            "Filter::Nearest",
            "Filter::Linear",
            "Filter::Cubic",
            "Filter::Stochastic",
            "Filter::Anisotropic",
            "Filter::Ewa",
            "Filter::SummedArea",
        ],
        inside: &[
            "glsl/shared/filter/",
            "src/oracle/filter/",
            "src/texture/filter.rs",
            "src/texture/sampler_spec.rs",
            "glsl/shared/layout.glsl",
            "src/schema/",
            // The default for a cone, and for both directions.
            "src/scene/cone.rs",
            "src/scene/validate.rs",
            // Names of the device's own samplers.
            "src/gpu/convert.rs",
            // The laboratory examines filters by name.
            "src/lab/",
        ],
    },
];

/// Returns the lines outside the room that use one of its words; comments and tests inside files are exempt.
fn trespasses(door: &Door, path: &str, text: &str) -> Vec<String> {
    if door.inside.iter().any(|inside| path.starts_with(inside)) {
        return Vec::new();
    }
    let code = text.split("#[cfg(test)]").next().unwrap_or(text);
    let lines = code.lines().map(|line| line.split("//").next().unwrap_or(line)).enumerate();
    let says = |line: &str| {
        let begins = |at: usize, word: &str| {
            let before = line[..at].chars().next_back();
            let after = line[at + word.len()..].chars().next();
            let part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
            let open = word.ends_with('_') || !part(after);
            let range = word.starts_with('.') && before == Some('.');
            open && !range && (word.starts_with(['.', ' ']) || !part(before))
        };
        door.words.iter().find(|word| line.match_indices(**word).any(|(at, _)| begins(at, word)))
    };
    let told = lines.filter_map(|(i, line)| {
        says(line).map(|word| format!("{path}:{}: {word} outside {}", i + 1, door.room))
    });
    told.collect()
}

#[test]
fn outside_its_room_nobody_names_a_shape_a_model_or_a_filter() {
    let mut found = Vec::new();
    for (folder, ending) in [("src", ".rs"), ("glsl", ".glsl")] {
        let Some(files) = texts(folder, ending) else { return };
        for (name, text) in files {
            let path = format!("{folder}/{name}{ending}");
            found.extend(DOORS.iter().flat_map(|door| trespasses(door, &path, &text)));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn planted_trespasses_are_found() {
    let [geometry, bsdf, filter] = DOORS else { panic!("three doors") };
    let bad = [
        (geometry, "glsl/shared/shade.glsl", "Plane p = plane_at(0u);"),
        (geometry, "src/render/session.rs", "let n = scene.triangles.len();"),
        (bsdf, "glsl/shared/shade.glsl", "if (MODE_IS(MODELS, MODEL_MIRROR, m)) x();"),
        (bsdf, "src/pack/mod.rs", "let m = Model::Phong;"),
        (filter, "glsl/shared/grid.glsl", "bool l = how.modes.z == FILTER_LINEAR;"),
        (filter, "src/render/images.rs", "x != Filter::Nearest"),
    ];
    for (door, path, line) in bad {
        assert_eq!(trespasses(door, path, line).len(), 1, "{line}");
        assert!(trespasses(door, door.inside[0], line).is_empty());
    }
    let good = [
        (geometry, "src/render/batches.rs", "let planes = (0..planes); self.planes_of(x); // scene.planes"),
        (bsdf, "src/pack/mod.rs", "let m = Model::PLAIN;"),
        (filter, "src/pack/mod.rs", "PixelFilter::Nearest; PIXEL_FILTER_BOX;"),
    ];
    for (door, path, line) in good {
        assert!(trespasses(door, path, line).is_empty(), "{line}");
    }
}
