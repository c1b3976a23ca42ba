//! Specialised shaders: valid modules without branches on constants, smaller the less a scene uses,
//! and with the workgroup size still to be specialised. The tests of lean against full pipelines
//! show that pictures do not change.

use std::io::Write;
use std::process::{Command, Stdio};

use moire::internal::gpu::shaders::{self, Shader, specialise};
use moire::internal::pack::features::{Features, widest};
use moire::internal::pack::{self, PackedScene, SlotCounts};
use moire::internal::render::specialization::constants;
use moire::internal::scene;
use moire::internal::texture::load::load;

use crate::support::{data, untested};

fn packed(name: &str) -> PackedScene {
    let mut scene = scene::load(&data().join("scenes").join(name)).unwrap();
    scene::prune::prune(&mut scene);
    let textures = scene.textures.iter().map(|t| load(t).unwrap()).collect();
    pack::pack(&scene, textures, None).unwrap()
}

fn specialised(shader: &Shader, scene: &PackedScene, keep_everything: bool) -> Vec<u32> {
    let features = Features::new(scene, shader.name.contains("image"), keep_everything);
    let (_, sections) = scene.scene_bytes();
    specialise(shader.spirv, &constants(shader, &features, &sections, [64, 1], SlotCounts::default()))
}

/// (opcode, operands) of each instruction.
fn instructions(words: &[u32]) -> Vec<(u32, &[u32])> {
    let mut all = Vec::new();
    let mut at = 5;
    while at < words.len() {
        let length = (words[at] >> 16) as usize;
        all.push((words[at] & 0xFFFF, &words[at + 1..at + length]));
        at += length;
    }
    all
}

const CONSTANT_TRUE: u32 = 41;
const CONSTANT_FALSE: u32 = 42;
const SPEC_CONSTANTS: std::ops::RangeInclusive<u32> = 48..=50;
const DECORATE: u32 = 71;
const BRANCH_CONDITIONAL: u32 = 250;

fn validator() -> bool {
    let found = Command::new("spirv-val").arg("--version").stdout(Stdio::null()).status().is_ok();
    if !found {
        untested("specialised modules by themselves: spirv-val is not installed");
    }
    found
}

fn assert_valid(words: &[u32], what: &str) {
    let mut module = tempfile::NamedTempFile::new().unwrap();
    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
    module.write_all(&bytes).unwrap();
    let output =
        Command::new("spirv-val").args(["--target-env", "vulkan1.2"]).arg(module.path()).output().unwrap();
    let told =
        String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{what}: {told}");
}

const SCENES: [&str; 4] = ["bench/s1a.toml", "bench/s2.toml", "lecture.toml", "samplers.toml"];

#[test]
fn specialised_modules_are_valid() {
    if !validator() {
        return;
    }
    for name in SCENES {
        let scene = packed(name);
        assert_valid(&specialised(&shaders::RENDER_BUFFER, &scene, false), name);
        assert_valid(&specialised(&shaders::RENDER_SOLIDS, &scene, false), name);
    }
    assert_valid(&specialised(&shaders::RENDER_SOLIDS, &packed("lecture.toml"), true), "everything");
    // With everything, every third feature removed, and with the others every third.
    let shader = &shaders::RENDER_SOLIDS;
    for third in 0..3 {
        for narrow in [0, 1, 4] {
            let values = widest().enumerate().filter_map(|(i, (constant, value))| {
                let value = if i % 3 == third { narrow.min(value) } else { value };
                shader.has(constant).then(|| (constant.id(), value))
            });
            let values: Vec<(u32, u32)> = values.collect();
            assert_valid(
                &specialise(shader.spirv, &values),
                &format!("{narrow} for {third}, {third} + 3, …"),
            );
        }
    }
}

#[test]
fn no_branch_on_a_constant_is_left() {
    for name in SCENES {
        let words = specialised(&shaders::RENDER_BUFFER, &packed(name), false);
        let all = instructions(&words);
        let booleans: Vec<u32> = all
            .iter()
            .filter(|(op, _)| [CONSTANT_TRUE, CONSTANT_FALSE].contains(op))
            .map(|(_, w)| w[1])
            .collect();
        assert!(!booleans.is_empty());
        let decided = all.iter().filter(|(op, w)| *op == BRANCH_CONDITIONAL && booleans.contains(&w[0]));
        assert_eq!(decided.count(), 0, "{name}");
    }
}

#[test]
fn only_the_workgroups_size_is_left_open() {
    let words = specialised(&shaders::RENDER_BUFFER, &packed("lecture.toml"), false);
    let all = instructions(&words);
    assert_eq!(all.iter().filter(|(op, _)| SPEC_CONSTANTS.contains(op)).count(), 2);
    let ids: Vec<u32> =
        all.iter().filter(|(op, w)| *op == DECORATE && w[1] == 1).map(|(_, w)| w[2]).collect();
    assert_eq!(ids, [0, 1]);
}

/// As `glsl/shared` is written, no driver may fuse a product with a sum: pictures would depend on the other
/// features of a pipeline.
#[test]
fn all_float_arithmetic_is_uncontracted() {
    const NO_CONTRACTION: u32 = 42;
    const SUMS_AND_PRODUCTS: [u32; 8] = [129, 131, 133, 142, 143, 144, 145, 148];
    for shader in [&shaders::RENDER_BUFFER, &shaders::RENDER_SOLIDS, &shaders::PROBE_RAYS] {
        for words in [shader.spirv.to_vec(), specialised(shader, &packed("lecture.toml"), false)] {
            let all = instructions(&words);
            let decorated: std::collections::HashSet<u32> = all
                .iter()
                .filter(|(op, w)| *op == DECORATE && w[1] == NO_CONTRACTION)
                .map(|(_, w)| w[0])
                .collect();
            let arithmetic: Vec<u32> =
                all.iter().filter(|(op, _)| SUMS_AND_PRODUCTS.contains(op)).map(|(_, w)| w[1]).collect();
            assert!(arithmetic.len() > 20, "{}: {} operations", shader.name, arithmetic.len());
            let loose = arithmetic.iter().filter(|id| !decorated.contains(id)).count();
            assert_eq!(loose, 0, "{} of {} operations in {}", loose, arithmetic.len(), shader.name);
        }
    }
}

/// A flat unlit scene keeps a small part of the shader, and more features keep more.
#[test]
fn a_small_scene_has_a_small_shader() {
    let size = |name: &str, all| specialised(&shaders::RENDER_BUFFER, &packed(name), all).len();
    let (s1a, lecture, everything) =
        (size("bench/s1a.toml", false), size("lecture.toml", false), size("lecture.toml", true));
    assert!(s1a < lecture && lecture < everything, "{s1a} {lecture} {everything}");
    assert!(s1a * 2 < everything, "{s1a} of {everything} words");
}
