//! Stored mip levels used as written: each level has a colour of its own, so that the picture shows which one is read, on
//! the device and by the oracle; chains that end early, and scenes in which there is nothing to read.

use std::fs;
use std::path::Path;

use moire::internal::core::error::Result;
use moire::internal::core::film::Film;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene::changes::Changes;
use moire::internal::scene::parse;
use moire::internal::texture::data::{Dimension, TexelFormat};
use moire::internal::texture::load::load;
use moire::internal::texture::sampler_spec::{LevelUse, MipMode};
use tempfile::{TempDir, tempdir};

use super::write::{DXGI_RGBA8, Dds, Ktx2, VK_RGBA8, solid_levels};
use crate::stage::{render, render_on_oracle};
use crate::support::told;

const COLORS: [[u8; 4]; 4] = [[255, 0, 0, 255], [0, 255, 0, 255], [0, 0, 255, 255], [255, 255, 0, 255]];

/// 8 × 8 texels and all their levels, or the first of them.
fn chain(count: usize) -> Vec<u8> {
    let data = solid_levels(8, |side| side * side, &COLORS[..count]).concat();
    Dds { levels: count as u32, ..Dds::flat(DXGI_RGBA8, [8, 8], &data) }.bytes()
}

/// A folder with a texture file.
fn folder(file: &[u8]) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("a.dds"), file).unwrap();
    folder
}

/// A wall of which a pixel covers 2 `scale` texels of 8.
fn wall(folder: &Path, texture: &str, sampler: &str, scale: f64) -> Result<PackedScene> {
    let text = format!(
        "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\northographic_height = 2\n\
         [image]\nwidth = 8\nheight = 8\n[sampling]\npattern = 'center'\nfootprint = 'differentials'\n\
         [[texture]]\nname = 't'\nfile = 'a.dds'\ncolor_space = 'linear'\n{texture}\n\
         [[sampler]]\nname = 's'\n{sampler}\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
         mapping = {{ kind = 'surface', scale = {scale:?} }}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n"
    );
    packed(folder, &text)
}

fn packed(folder: &Path, text: &str) -> Result<PackedScene> {
    let scene = parse(&folder.join("a.toml"), text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let textures = scene.textures.iter().map(load).collect::<Result<Vec<_>>>()?;
    pack::pack(&scene, textures, None)
}

/// The same picture by the device and by the oracle, up to f32.
fn pictures(scene: &PackedScene) -> Film {
    let (device, oracle) = (render(scene), render_on_oracle(scene));
    for (a, b) in device.pixels.iter().zip(&oracle.pixels) {
        assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-4), "{a:?} on the device, {b:?} by the oracle");
    }
    device
}

fn only_color(film: &Film) -> [f32; 3] {
    let first = film.pixels[0];
    assert!(film.pixels.iter().all(|p| (0..3).all(|c| (p[c] - first[c]).abs() < 1e-4)), "{:?}", film.pixels);
    first
}

fn is(found: [f32; 3], level: usize) -> bool {
    (0..3).all(|c| (found[c] - f32::from(COLORS[level][c]) / 255.0).abs() < 1e-4)
}

#[test]
fn pictures_show_the_stored_level_of_their_footprint() {
    let folder = folder(&chain(4));
    for (texture, sampler) in [
        ("mip_filter = 'stored'", "mip = 'nearest'"),
        ("mip_filter = 'stored'", "mip = 'linear'"),
        ("", "mip = 'stored'"),
        ("", "mip = 'stored'\nmethod = 'hardware'"),
        ("mip_filter = 'stored'", "filter = { mag = 'linear', min = 'ewa' }"),
    ] {
        for (scale, level) in [(0.25, 0), (1.0, 1), (2.0, 2), (4.0, 3), (16.0, 3)] {
            let ewa = sampler.contains("ewa");
            let found = only_color(&pictures(&wall(folder.path(), texture, sampler, scale).unwrap()));
            // An ellipse reads finer levels than its width.
            let levels = if ewa { 0..=level } else { level..=level };
            assert!(levels.clone().any(|l| is(found, l)) || ewa, "{texture} {sampler} {scale}: {found:?}");
        }
    }
    let between = only_color(&pictures(&wall(folder.path(), "", "mip = 'stored'", 2f64.sqrt()).unwrap()));
    assert!((between[1] - 0.5).abs() < 1e-3 && (between[2] - 0.5).abs() < 1e-3, "{between:?}");
}

/// As the command line sets it for all samplers.
#[test]
fn an_override_reads_the_stored_levels_or_makes_them() {
    for (levels, parts) in [
        (LevelUse::Stored, (MipMode::Linear, true)),
        (LevelUse::Linear, (MipMode::Linear, false)),
        (LevelUse::None, (MipMode::None, false)),
    ] {
        let text = "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 9\n[image]\nwidth = 1\nheight = 1\n\
                    [[sampler]]\nname = 'a'\nmip = 'stored'\n[[sampler]]\nname = 'b'\nmip = 'nearest'\n";
        let mut scene = parse(Path::new("levels.toml"), text).unwrap();
        Changes { mip: Some(levels), ..Changes::default() }.apply(&mut scene).unwrap();
        assert!(scene.samplers.iter().all(|s| (s.mip, s.stored_levels) == parts), "{levels}");
    }
}

#[test]
fn levels_are_made_anew_unless_the_scene_asks_for_the_stored_ones() {
    let folder = folder(&chain(4));
    for scale in [1.0, 4.0] {
        let made = wall(folder.path(), "", "mip = 'linear'", scale).unwrap();
        assert!(is(only_color(&pictures(&made)), 0), "{scale}");
    }
}

#[test]
fn of_a_chain_that_ends_early_the_last_level_is_read() {
    let folder = folder(&chain(2));
    let scene = wall(folder.path(), "mip_filter = 'stored'", "mip = 'linear'", 8.0).unwrap();
    assert_eq!(scene.records.textures[0].levels, 2);
    assert!(is(only_color(&pictures(&scene)), 1));
}

#[test]
fn a_file_without_levels_and_samplers_that_disagree_are_refused() {
    let single = folder(&chain(1));
    for (texture, sampler, key) in
        [("mip_filter = 'stored'", "mip = 'linear'", "mip_filter"), ("", "mip = 'stored'", "mip")]
    {
        let message = told(wall(single.path(), texture, sampler, 1.0));
        let says = format!(
            "texture \"t\": {key} = \"stored\" asks for the mip levels of its file, which stores none"
        );
        assert!(message.contains(&says) && message.contains("DDS or KTX2"), "{message}");
    }
    // Where no levels are read, there is nothing to ask for.
    assert!(wall(single.path(), "mip_filter = 'stored'", "mip = 'none'", 1.0).is_ok());
    let whole = folder(&chain(4));
    let two = "mip = 'stored'\n[[sampler]]\nname = 'made'\nmip = 'linear'\n\
               [[material]]\nname = 'other'\ntexture = 't'\nsampler = 'made'";
    let message = told(wall(whole.path(), "", two, 1.0));
    assert!(message.contains("one sampler that reads it has mip = \"stored\""), "{message}");
    assert!(wall(whole.path(), "mip_filter = 'stored'", two, 1.0).is_ok());
}

#[test]
fn grey_levels_are_stored_as_grey_only_if_all_are() {
    let grey = |colors: &[[u8; 4]]| {
        let data = solid_levels(2, |side| side * side, colors).concat();
        let folder = folder(&Dds { levels: 2, ..Dds::flat(DXGI_RGBA8, [2, 2], &data) }.bytes());
        let scene = wall(folder.path(), "mip_filter = 'stored'", "mip = 'linear'", 8.0).unwrap();
        (scene.records.textures[0].format, scene.level_texels(0, 1).to_vec())
    };
    assert_eq!(grey(&[[7, 7, 7, 255], [9, 9, 9, 255]]), (TexelFormat::Grey8, vec![9]));
    assert_eq!(grey(&[[7, 7, 7, 255], [9, 8, 9, 255]]), (TexelFormat::Rgba8, vec![9, 8, 9, 255]));
}

#[test]
fn flipped_textures_flip_their_levels() {
    let first: Vec<u8> = (0..16).flat_map(|i| [i, i, i, 255]).collect();
    let second: Vec<u8> = (0..4).flat_map(|i| [i, 0, 0, 255]).collect();
    let folder = folder(&Ktx2::flat(VK_RGBA8, [4, 4], &[first, second]).bytes());
    let mut source = super::source(&folder.path().join("a.dds"), Dimension::Two);
    source.flip_v = true;
    let texture = load(&source).unwrap();
    let reds: Vec<u8> = texture.stored_levels[0].texels.chunks(4).map(|t| t[0]).collect();
    assert_eq!((texture.texels[0], reds), (12, vec![2, 3, 0, 1]));
}

/// A scene of a sphere under a texture of this dimension, small and far.
fn sphere(folder: &Path, dimension: &str, kind: &str, radius: f64) -> PackedScene {
    let text = format!(
        "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\northographic_height = 2\n\
         [image]\nwidth = 8\nheight = 8\n[sampling]\npattern = 'center'\nfootprint = 'differentials'\n\
         [[texture]]\nname = 't'\nfile = 'a.dds'\ndimension = '{dimension}'\nmip_filter = 'stored'\n\
         [[sampler]]\nname = 's'\nmip = 'nearest'\naddress = 'clamp-to-edge'\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\nmapping = {{ kind = '{kind}' }}\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = {radius:?}\nmaterial = 'm'\n"
    );
    packed(folder, &text).unwrap()
}

#[test]
fn cubes_and_volumes_read_their_stored_levels() {
    let face = solid_levels(8, |side| side * side, &COLORS).concat();
    let cube = Dds { levels: 4, is_cube: true, ..Dds::flat(DXGI_RGBA8, [8, 8], &face.repeat(6)) }.bytes();
    let volume = solid_levels(8, |side| side * side * side, &COLORS).concat();
    let volume = Dds { size: [8, 8, 8], levels: 4, ..Dds::flat(DXGI_RGBA8, [8, 8], &volume) }.bytes();
    for (file, dimension, kind) in [(cube, "cube", "cube"), (volume, "3d", "solid")] {
        let folder = folder(&file);
        let scene = sphere(folder.path(), dimension, kind, 0.9);
        let texture = &scene.records.textures[0];
        assert_eq!((texture.levels, texture.size.x), (4, 8), "{dimension}");
        for (level, color) in COLORS.iter().enumerate() {
            let texels = scene.level_texels(0, level as u32);
            assert!(texels.chunks(4).all(|t| t == color), "{dimension} {level}");
        }
        let film = pictures(&scene);
        let shown = film.pixels.iter().filter(|p| (1..4).any(|level| is(**p, level))).count();
        assert!(shown > 8, "{dimension}: {:?}", film.pixels);
    }
}
