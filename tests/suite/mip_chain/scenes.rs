//! Scenes whose mip levels are generated on the device: the same pictures from the texel buffer and
//! from images of every kind, and which levels stay on the host.

use std::path::Path;

use moire::internal::core::progress::NoProgress;
use moire::internal::lab::verify::queries::noise;
use moire::internal::oracle;
use moire::internal::pack::{self, MipPlacement, PackedScene};
use moire::internal::render::{TexelChoice, Tuning};
use moire::internal::scene::model::Scene;
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use serde_json::Value;
use tempfile::tempdir;

use crate::stage::{assert_same_bits, device_name, path, render_with};
use crate::support::{moire, told};

const VIEW: &str = "[camera]\neye = [0, 1, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 60\n\
    [image]\nwidth = 48\nheight = 40\n[sampling]\npattern = 'center'\nfootprint = 'cone'\n";

/// Far more texels than pixels: all look-ups read coarser levels.
fn textures() -> Vec<TextureData> {
    vec![
        noise(Dimension::Two, [128, 64, 1], TexelFormat::Grey8, ColorSpace::Srgb, 1),
        noise(Dimension::Two, [256, 256, 1], TexelFormat::Rgba8, ColorSpace::Linear, 2),
        noise(Dimension::Three, [32, 32, 32], TexelFormat::Grey8, ColorSpace::Linear, 3),
        noise(Dimension::Cube, [64, 64, 6], TexelFormat::Grey16, ColorSpace::Linear, 4),
    ]
}

/// A floor and a wall of flat textures, with `solids` a sphere of the volume and one of the cube besides.
fn scene(sampler: &str, solids: bool) -> Scene {
    let names = ["grey", "colour", "volume", "cube"];
    let kinds = ["surface", "surface", "solid", "cube"];
    let contents = ["file = 'a'", "file = 'a'", "slices = ['a']", "file = 'a'\ndimension = 'cube'"];
    let mut text = format!("{VIEW}[[sampler]]\nname = 's'\nmip = 'linear'\n{sampler}\n");
    for i in 0..if solids { 4 } else { 2 } {
        let (name, kind, content) = (names[i], kinds[i], contents[i]);
        text += &format!(
            "[[texture]]\nname = '{name}'\n{content}\n[[material]]\nname = '{name}'\nmodel = 'unlit'\n\
             texture = '{name}'\nsampler = 's'\nmapping = {{ kind = '{kind}' }}\n"
        );
    }
    text += "[[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'grey'\n\
        [[plane]]\norigin = [0, 0, -4]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'colour'\n";
    if solids {
        text += "[[sphere]]\ncenter = [-1, 0, 0]\nradius = 0.9\nmaterial = 'volume'\n\
            [[sphere]]\ncenter = [1, 0, 0]\nradius = 0.9\nmaterial = 'cube'\n";
    }
    parse(Path::new("levels.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn packed(scene: &Scene, mip_chains: MipPlacement) -> PackedScene {
    let count = scene.textures.len();
    pack::pack_with(scene, textures().into_iter().take(count).collect(), None, mip_chains).unwrap()
}

#[test]
fn pictures_with_levels_of_the_device_are_those_with_levels_of_the_host() {
    // A border makes images keep four channels for grey.
    let border = "method = 'hardware'\naddress = 'clamp-to-border'";
    // The tables of sums follow the levels, and are read from there.
    let sums = "filter = { mag = 'linear', min = 'summed-area' }";
    for (sampler, texels, solids) in [
        ("", TexelChoice::Buffer, true),
        ("", TexelChoice::Image, true),
        ("", TexelChoice::Image, false),
        (sums, TexelChoice::Image, false),
        ("method = 'hardware'", TexelChoice::Auto, true),
        (border, TexelChoice::Auto, false),
    ] {
        let what = format!("{sampler} {texels} {solids}");
        let scene = scene(sampler, solids);
        let (host, device) = (packed(&scene, MipPlacement::Host), packed(&scene, MipPlacement::DEVICE));
        let mut left = device.device_levels.clone();
        left.sort();
        assert_eq!(left, (0..scene.textures.len()).collect::<Vec<_>>(), "{what}");
        assert!(host.texels != device.texels, "{what}: the host has made the levels all the same");
        let tuning = Tuning { texels, ..Tuning::default() };
        let (expected, report) = render_with(&host, false, &tuning);
        assert_eq!(report.device_mips_seconds, None, "{what}");
        let (found, report) = render_with(&device, false, &tuning);
        assert!(report.device_mips_seconds.is_some_and(|s| s > 0.0), "{what}");
        assert_same_bits(&found, &expected, &what);
        // Without levels the picture would differ.
        let mut blank = device.clone();
        blank.device_levels.clear();
        let without = render_with(&blank, false, &tuning).0;
        assert_eq!(without.pixels != expected.pixels, sampler != sums, "{what}: are levels read?");
    }
}

#[test]
fn only_what_halves_and_fits_is_left_to_the_device() {
    let scene = scene("", true);
    let left = |scene: &Scene, mip_chains| packed(scene, mip_chains).device_levels;
    let some = |least_texels, most_bytes| MipPlacement::Device { least_texels, most_bytes };
    assert_eq!(left(&scene, MipPlacement::Host), [] as [usize; 0]);
    // In the order of the texel buffer: volume and cube first.
    assert_eq!(left(&scene, MipPlacement::DEVICE), [2, 3, 0, 1]);
    assert_eq!(left(&scene, some(32 * 32 * 32, u64::MAX)), [2, 1]);
    // The grey texture with four channels: (128 · 64 + … + 1) · 4 codes, (64 · 32 + 32 · 16) · 16 numbers.
    let texels: u64 = (0..8).map(|l| (128 >> l) * (64u64 >> l).max(1)).sum();
    assert_eq!(left(&scene, some(0, texels * 4)), [0]);
    assert_eq!(left(&scene, some(0, texels * 4 - 1)), [] as [usize; 0]);

    let mut sharper = scene.clone();
    sharper.textures[1].mip_kernel = moire::internal::texture::data::MipKernel::Kaiser;
    assert_eq!(left(&sharper, MipPlacement::DEVICE), [2, 3, 0]);
    let mut unfiltered = scene.clone();
    unfiltered.sampling.footprint = moire::internal::scene::model::Footprint::None;
    assert_eq!(left(&unfiltered, MipPlacement::DEVICE), [] as [usize; 0]);
    assert!(pack::reads_levels(&scene) && !pack::reads_levels(&unfiltered));

    let odd = |size, format, space| {
        let mut all = textures();
        all[0] = noise(Dimension::Two, size, format, space, 1);
        pack::pack_with(&scene, all, None, MipPlacement::DEVICE).unwrap().device_levels.contains(&0)
    };
    assert!(odd([8, 8, 1], TexelFormat::Grey8, ColorSpace::Srgb));
    assert!(!odd([6, 8, 1], TexelFormat::Grey8, ColorSpace::Srgb), "6 → 3 → 1");
    assert!(!odd([1, 1, 1], TexelFormat::Grey8, ColorSpace::Srgb));
    assert!(odd([8, 8, 1], TexelFormat::Grey16, ColorSpace::Srgb));
}

/// 16-bit sRGB is stored unchanged, unless the device's samplers read it.
#[test]
fn deep_srgb_is_left_to_the_device_as_codes_or_as_floats() {
    for (sampler, component) in
        [("", Component::Unorm16), ("method = 'hardware'\nfilter = 'nearest'", Component::Float32)]
    {
        let scene = scene(sampler, false);
        let film = |mip_chains| {
            let mut all: Vec<TextureData> = textures().into_iter().take(2).collect();
            all[0] = noise(Dimension::Two, [64, 64, 1], TexelFormat::Grey16, ColorSpace::Srgb, 7);
            let packed = pack::pack_with(&scene, all, None, mip_chains).unwrap();
            let format = packed.records.textures[0].format;
            assert_eq!(format.component(), component);
            render_with(&packed, false, &Tuning::default()).0
        };
        assert_same_bits(&film(MipPlacement::DEVICE), &film(MipPlacement::Host), "grey16 sRGB");
    }
}

#[test]
fn the_oracle_refuses_levels_that_nobody_has_made() {
    let packed = packed(&scene("", false), MipPlacement::DEVICE);
    let error = told(oracle::backend::render(&packed, &NoProgress));
    assert!(error.contains("grey8 srgb 128x64") && error.contains("left to a device"), "{error}");
}

#[test]
fn the_command_line_says_who_makes_levels_and_how_long_it_took() {
    let folder = tempdir().unwrap();
    let run = |mips: &str, device: &str| -> Value {
        let scene = std::path::absolute(path("filters")).unwrap();
        let mut command = moire();
        command.current_dir(folder.path()).env("MOIRE_VALIDATION", "1").arg("render").arg(scene);
        command.args(["--device", device, "--mips", mips, "--size", "32x24", "--json", "-v", "-o", "a.exr"]);
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("validation:"), "{said}");
        assert_eq!(said.contains("mip chains:"), mips == "device" && device != "oracle", "{said}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let made = run("device", &device_name());
    assert!(made["device_seconds"]["mips"].as_f64().is_some_and(|s| s > 0.0), "{made:#}");
    // A texture of 256×256 is too small to be worth compiling a pipeline.
    for mips in ["host", "auto"] {
        assert!(run(mips, &device_name())["device_seconds"]["mips"].is_null(), "{mips}");
    }
    assert!(run("device", "oracle")["device_seconds"]["mips"].is_null());
}
