//! The layout contract from both sides: structs and strides of `glsl/shared/layout.glsl` against
//! their Rust mirrors, numbers of modes against the enums' order, and the specialization constants
//! of the compiled shaders against the table of features.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use moire::internal::gpu::shaders::{self, Shader};
use moire::internal::pack::features::TextureSize;
use moire::internal::pack::{
    Diagnostic, EntityKind, LightKind, MapKind, ProjectionKind, SampleDimension, Schedule, TextureKind,
};
use moire::internal::scene::model::{BumpKind, Footprint, Model, Pattern, PixelFilterKind};
use moire::internal::schema::layout::{self as mirror, Record};
use moire::internal::texture::data::{ColorSpace, TexelFormat};
use moire::internal::texture::procedural::ProceduralKind;
use moire::internal::texture::sampler_spec::{Address, Filter, Method, MipMode, TexelCenter};
use moire::internal::{oracle, pack::features};

use crate::layering::source_root;

/// (type, name) of each field, in order.
type Fields = Vec<(String, String)>;

/// `struct NAME {` … `}` of GLSL, or a block `uniform NAME {`.
fn glsl_struct(text: &str, opening: &str) -> Option<Fields> {
    let body = text.split_once(&format!("{opening} {{"))?.1.split_once('}')?.0;
    let code = body.lines().map(|line| line.split("//").next().unwrap_or(""));
    let code: String = code.collect::<Vec<_>>().join(" ");
    let field = |f: &str| {
        let mut words = f.split_whitespace();
        Some((words.next()?.to_string(), words.next()?.to_string()))
    };
    code.split(';').filter(|f| !f.trim().is_empty()).map(field).collect()
}

/// The fields of `opening … {` in Rust, with the types that GLSL gives such members.
fn rust_struct(text: &str, opening: &str) -> Option<Fields> {
    let body = text.split_once(opening)?.1.split_once('{')?.1.split_once('}')?.0;
    let lines = body.lines().map(str::trim).filter(|l| !l.is_empty() && !l.starts_with("//"));
    let field = |line: &str| {
        let (name, kind) = line.trim_start_matches("pub ").trim_end_matches(',').split_once(": ")?;
        let kind = match kind {
            "[f32; 4]" => "vec4",
            "[f64; 4]" => "real4",
            "[u32; 4]" => "uvec4",
            "u32" => "uint",
            "f32" => "float",
            other => other,
        };
        Some((kind.to_string(), name.to_string()))
    };
    lines.map(field).collect()
}

/// `const uint NAME = 3u;` lines: name and number.
fn glsl_numbers(text: &str) -> BTreeMap<String, u32> {
    let number = |line: &str| {
        let (name, value) = line.strip_prefix("const uint ")?.split_once(" = ")?;
        // Where reals are f32.
        let value = value.split(';').next()?;
        if let Some((reals, others)) = value.split_once("u * REAL_UNITS") {
            let others = others
                .strip_prefix(" + ")
                .map_or(Some(0), |n| n.trim_end_matches('u').parse::<u32>().ok())?;
            return Some((name.to_string(), reals.parse::<u32>().ok()? + others));
        }
        let value = value.trim_end_matches('u');
        let value = match value.strip_prefix("0x") {
            Some(hex) => u32::from_str_radix(hex, 16).ok()?,
            None => value.parse().ok()?,
        };
        Some((name.to_string(), value))
    };
    text.lines().filter_map(number).collect()
}

/// Every number that layout.glsl must define, and no other: modes, and strides in units of 16 bytes.
fn expected_numbers() -> BTreeMap<String, u32> {
    let tables: [(&str, &[&str]); 22] = [
        ("DIAGNOSTIC", Diagnostic::NAMES),
        ("PROJECTION", ProjectionKind::NAMES),
        ("PATTERN", Pattern::NAMES),
        ("SCHEDULE", Schedule::NAMES),
        ("PIXEL_FILTER", PixelFilterKind::NAMES),
        ("DIMENSION", SampleDimension::NAMES),
        ("MODEL", Model::NAMES),
        ("FOOTPRINT", Footprint::NAMES),
        ("ENTITY", EntityKind::NAMES),
        ("BUMP", BumpKind::NAMES),
        ("LIGHT", LightKind::NAMES),
        ("MAP", MapKind::NAMES),
        ("METHOD", Method::NAMES),
        ("ADDRESS", Address::NAMES),
        ("FILTER", Filter::NAMES),
        ("MIP", MipMode::NAMES),
        ("TEXTURE_KIND", TextureKind::NAMES),
        ("TEXEL_CENTER", TexelCenter::NAMES),
        ("TEXEL_FORMAT", TexelFormat::NAMES),
        ("COLOR_SPACE", ColorSpace::NAMES),
        ("TEXTURE_SIZE", TextureSize::NAMES),
        ("PROCEDURAL", ProceduralKind::NAMES),
    ];
    let mut all: BTreeMap<String, u32> = tables
        .iter()
        .flat_map(|(prefix, names)| {
            let constant = |name: &str| format!("{prefix}_{}", name.replace('-', "_").to_uppercase());
            names.iter().zip(0..).map(move |(name, i)| (constant(name), i)).collect::<Vec<_>>()
        })
        .collect();
    all.insert("NO_TEXTURE".into(), mirror::NO_TEXTURE);
    all.insert("NO_SHAPE".into(), mirror::NO_SHAPE);
    all.insert("DIAGNOSTICS".into(), Diagnostic::ALL.len() as u32);
    all.insert("JOB_BARE".into(), mirror::JOB_BARE);
    all.insert("JOB_APART".into(), mirror::JOB_APART);
    all.insert("JOB_STREAM_SHIFT".into(), mirror::JOB_STREAM_SHIFT);
    all.insert("CELL_WORDS".into(), mirror::CELL_WORDS);
    all.insert("MAX_LISTED".into(), mirror::MAX_LISTED);
    all.insert("CELL_EMPTY".into(), mirror::CELL_EMPTY);
    all.insert("CELL_UNIFORM".into(), mirror::CELL_UNIFORM);
    all.insert("CELL_BUSY".into(), mirror::CELL_BUSY);
    all.insert("NO_LIST".into(), mirror::NO_LIST);
    all.insert("NO_MATERIAL".into(), mirror::NO_MATERIAL);
    all.insert("PIXEL_FILTER_CELLS".into(), mirror::PIXEL_FILTER_CELLS);
    all.insert("HEAD_UNITS".into(), mirror::HEAD_BYTES as u32 / 16);
    let strides = MIRRORS.iter().filter(|(name, _)| *name != "Header");
    all.extend(strides.map(|(name, units)| (format!("{}_UNITS", name.to_uppercase()), units.iter().sum())));
    all
}

const fn units<R: Record>() -> [u32; 2] {
    [R::REALS, R::OTHERS]
}

/// (struct, vectors of reals and others, of 16 bytes each where reals are f32)
const MIRRORS: &[(&str, [u32; 2])] = &[
    ("Header", units::<mirror::Header>()),
    ("Plane", units::<mirror::Plane>()),
    ("Sphere", units::<mirror::Sphere>()),
    ("Triangle", units::<mirror::Triangle>()),
    ("Light", units::<mirror::Light>()),
    ("Material", units::<mirror::Material>()),
    ("UvProjection", units::<mirror::UvProjection>()),
    ("Texture", units::<mirror::Texture>()),
    ("Sampler", units::<mirror::Sampler>()),
    ("Procedural", units::<mirror::Procedural>()),
    ("Motion", units::<mirror::Motion>()),
];

/// What differs between the shader's layout and its Rust mirror.
fn differences(glsl: &str, rust: &str) -> Vec<String> {
    let mut found = Vec::new();
    for &(name, units) in MIRRORS {
        let here = glsl_struct(glsl, &format!("struct {name}"));
        let there = rust_struct(rust, &format!("mirror!({name}, "));
        if here.is_none() || here != there {
            found.push(format!("{name}: GLSL {here:?}, Rust {there:?}"));
        }
        if here.is_some_and(|fields| fields.len() as u32 != units.iter().sum::<u32>()) {
            found.push(format!("{name}: not {units:?} vectors"));
        }
    }
    let (numbers, expected) = (glsl_numbers(glsl), expected_numbers());
    for name in numbers.keys().chain(expected.keys()).collect::<BTreeSet<_>>() {
        if numbers.get(name) != expected.get(name) {
            found.push(format!("{name}: GLSL {:?}, Rust {:?}", numbers.get(name), expected.get(name)));
        }
    }
    found
}

#[test]
fn shader_structs_strides_and_mode_numbers_equal_their_mirrors() {
    let Some(root) = source_root() else { return };
    let glsl = fs::read_to_string(root.join("glsl/shared/layout.glsl")).unwrap();
    let rust = fs::read_to_string(root.join("src/schema/layout.rs")).unwrap();
    let found = differences(&glsl, &rust);
    assert!(found.is_empty(), "{}", found.join("\n"));
    let far = glsl.split_once("const float FAR = ").unwrap().1.split(';').next().unwrap();
    assert_eq!(far.parse::<f64>().unwrap(), oracle::geometry::rays::FAR);
}

#[test]
fn planted_differences_of_layout_are_found() {
    let Some(root) = source_root() else { return };
    let glsl = fs::read_to_string(root.join("glsl/shared/layout.glsl")).unwrap();
    let rust = fs::read_to_string(root.join("src/schema/layout.rs")).unwrap();
    let plants = [
        ("real4 axis_u;", "real4 axis_w;", "Plane"),
        ("    real4 axis_u;", "    vec4 axis_u;", "Plane"),
        ("uvec4 modes;", "vec4 modes;", "Sampler"),
        ("    real4 step_x;", "    real4 step_z; real4 step_x;", "Header"),
        ("TRIANGLE_UNITS = 8u * REAL", "TRIANGLE_UNITS = 7u * REAL", "TRIANGLE_UNITS"),
        ("ADDRESS_CLAMP_TO_EDGE = 2u", "ADDRESS_CLAMP_TO_EDGE = 3u", "ADDRESS_CLAMP_TO_EDGE"),
        ("const uint MODEL_MIRROR = 2u;", "", "MODEL_MIRROR"),
        (
            "const uint FILTER_LINEAR = 1u;",
            "const uint FILTER_LINEAR = 1u;\nconst uint FILTER_BILINEAR = 1u;",
            "FILTER_BILINEAR",
        ),
    ];
    for (from, to, name) in plants {
        assert!(glsl.contains(from), "nothing to plant at: {from}");
        let found = differences(&glsl.replace(from, to), &rust);
        assert!(found.iter().any(|f| f.starts_with(name)), "{from} → {to} gave {found:?}");
    }
}

#[test]
fn push_constants_equal_their_mirrors() {
    let Some(root) = source_root() else { return };
    let glsl = fs::read_to_string(root.join("glsl/shared/slice.glsl")).unwrap();
    let rust = fs::read_to_string(root.join("src/schema/layout.rs")).unwrap();
    let here = glsl_struct(&glsl, "uniform Slice").unwrap();
    assert_eq!(Some(&here), rust_struct(&rust, "pub struct Slice").as_ref());
    assert_eq!(size_of::<mirror::Slice>(), here.len() * 4);
    let glsl = fs::read_to_string(root.join("glsl/shared/mip_chain.glsl")).unwrap();
    let here = glsl_struct(&glsl, "uniform Halving").unwrap();
    assert_eq!(Some(&here), rust_struct(&rust, "pub struct Halving").as_ref());
    assert_eq!(size_of::<mirror::Halving>(), here.len() * 4);
    let glsl = fs::read_to_string(root.join("glsl/shared/tile_culling_main.glsl")).unwrap();
    let here = glsl_struct(&glsl, "uniform Part").unwrap();
    assert_eq!(Some(&here), rust_struct(&rust, "pub struct Part").as_ref());
    assert_eq!(size_of::<mirror::Part>(), here.len() * 4);
}

const SHADERS: [&Shader; 24] = [
    &shaders::BEAM,
    &shaders::BEAM_WIDE,
    &shaders::TILE_CULLING,
    &shaders::TILE_CULLING_WIDE,
    &shaders::RENDER_NONE_DOUBLE,
    &shaders::RENDER_TEXELS_DOUBLE,
    &shaders::RENDER_IMAGES_DOUBLE,
    &shaders::RENDER_SOLIDS_DOUBLE,
    &shaders::RENDER_NONE,
    &shaders::RENDER_TEXELS,
    &shaders::RENDER_IMAGES,
    &shaders::RENDER_SOLIDS,
    &shaders::CONE_NONE,
    &shaders::CONE_TEXELS,
    &shaders::CONE_IMAGES,
    &shaders::CONE_SOLIDS,
    &shaders::PROBE_TEXELS,
    &shaders::PROBE_IMAGES,
    &shaders::PROBE_SOLIDS,
    &shaders::PROBE_RAYS,
    &shaders::PROBE_RAYS_DOUBLE,
    &shaders::PROBE_DISK_SAMPLING,
    &shaders::PROBE_GLASS,
    &shaders::PROBE_PROCEDURAL,
];

/// Constants that say where lists begin and how work is divided.
fn is_place(name: &str) -> bool {
    let others = ["GROUP_X", "GROUP_Y", "TEXEL_BLOCKS", "BLOCK_LOG2", "TABLES_IN_HEAD", "OPAQUE_UNIFORMS"];
    name.ends_with("_AT") || name.ends_with("SLOTS") || others.contains(&name)
}

#[test]
fn every_specialization_constant_is_a_feature_or_a_place() {
    let features: BTreeSet<&str> = features::names().collect();
    assert_eq!(features.len(), features::names().count(), "a feature stands twice in the table");
    let mut seen = BTreeSet::new();
    let mut ids: BTreeMap<&str, u32> = BTreeMap::new();
    for shader in SHADERS.into_iter().chain([&shaders::STRATA]) {
        let own: BTreeSet<u32> = shader.constants.iter().map(|c| c.id).collect();
        assert_eq!(own.len(), shader.constants.len(), "{}: one id for two constants", shader.name);
        for constant in shader.constants {
            let name = constant.name;
            assert!(features.contains(name) || is_place(name), "{}: {name} is in no table", shader.name);
            assert_eq!(*ids.entry(name).or_insert(constant.id), constant.id, "{}: id of {name}", shader.name);
            seen.insert(name);
        }
    }
    let unknown: Vec<_> = features.difference(&seen).collect();
    assert!(unknown.is_empty(), "features that no shader has: {unknown:?}");
}

#[test]
fn defaults_of_the_shaders_keep_everything() {
    for shader in SHADERS {
        for (name, widest) in features::widest() {
            if let Some(constant) = shader.constant(name) {
                assert_eq!(constant.default, widest, "{}: {name}", shader.name);
            }
        }
    }
}
