//! The storage of texels on the device: in one texel buffer or, if it is too short, in images or in
//! several buffers, with the same picture; unchanged from the file; and once, however many names a
//! file has.

use std::fs;
use std::path::Path;

use image::{ImageBuffer, Luma, Rgb};
use moire::internal::core::color::srgb_table;
use moire::internal::core::progress::NoProgress;
use moire::internal::lab::probe;
use moire::internal::lab::verify::queries::noise;
use moire::internal::oracle::filter::sample_texture;
use moire::internal::oracle::mapping::Coordinate;
use moire::internal::pack::{self, MipPlacement, PackedScene};
use moire::internal::render::{TexelChoice, Tuning, render};
use moire::internal::scene::parse;
use moire::internal::scene::prune::prune;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Filter, SamplerSpec};
use serde_json::Value;
use tempfile::tempdir;

use crate::lookup::bench::{pairs, query};
use crate::stage::{assert_same_bits, device, device_name, render_with};
use crate::support::{moire, told};

const VIEW: &str = "[camera]\neye = [0, 1, 5]\nlook_at = [0, 0, 0]\nvertical_fov = 60\n\
    [image]\nwidth = 48\nheight = 40\n[sampling]\npattern = 'center'\nfootprint = 'cone'\n";

/// A floor and a wall of flat textures; with `solids` a sphere of a volume and one of a cube besides.
fn packed(sampler: &str, solids: bool, mip_chains: MipPlacement) -> PackedScene {
    let kinds = [("surface", "file = 'a'"), ("surface", "file = 'b'"), ("solid", "slices = ['a']")];
    let cube = ("cube", "file = 'a'\ndimension = 'cube'");
    let mut text = format!("{VIEW}[[sampler]]\nname = 's'\nmip = 'linear'\n{sampler}\n");
    for (i, (kind, content)) in kinds.into_iter().chain([cube]).take(if solids { 4 } else { 2 }).enumerate() {
        text += &format!(
            "[[texture]]\nname = 't{i}'\n{content}\n[[material]]\nname = 'm{i}'\nmodel = 'unlit'\n\
             texture = 't{i}'\nsampler = 's'\nmapping = {{ kind = '{kind}' }}\n"
        );
    }
    text += "[[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm0'\n\
        [[plane]]\norigin = [0, 0, -4]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm1'\n";
    if solids {
        text += "[[sphere]]\ncenter = [-1, 0, 0]\nradius = 0.9\nmaterial = 'm2'\n\
            [[sphere]]\ncenter = [1, 0, 0]\nradius = 0.9\nmaterial = 'm3'\n";
    }
    let scene = parse(Path::new("pool.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let textures = [
        noise(Dimension::Two, [128, 64, 1], TexelFormat::Rgba16, ColorSpace::Srgb, 1),
        noise(Dimension::Two, [128, 128, 1], TexelFormat::RgbaFloat, ColorSpace::Linear, 2),
        noise(Dimension::Three, [32, 32, 32], TexelFormat::Grey8, ColorSpace::Linear, 3),
        noise(Dimension::Cube, [32, 32, 6], TexelFormat::Rgba8, ColorSpace::Srgb, 4),
    ];
    let textures = textures.into_iter().take(scene.textures.len()).collect();
    pack::pack_with(&scene, textures, None, mip_chains).unwrap()
}

fn tuning(texels: TexelChoice, texel_words: u64) -> Tuning {
    Tuning { texels, texel_words: Some(texel_words), ..Tuning::default() }
}

#[test]
fn texels_in_several_buffers_give_the_picture_of_one() {
    let sums = "filter = { mag = 'linear', min = 'summed-area' }";
    let cubic = "filter = { mag = 'cubic', min = 'ewa' }";
    for (sampler, texels, solids) in [
        ("", TexelChoice::Buffer, true),
        ("", TexelChoice::Image, true),
        (sums, TexelChoice::Buffer, false),
        (sums, TexelChoice::Image, false),
        (cubic, TexelChoice::Buffer, false),
        ("method = 'hardware'", TexelChoice::Auto, true),
    ] {
        for mip_chains in [MipPlacement::Host, MipPlacement::DEVICE] {
            let scene = packed(sampler, solids, mip_chains);
            let pooled = if texels == TexelChoice::Buffer { scene.texels.len() } else { scene.solid_bytes };
            let words = pooled as u64 / 4;
            let one = render_with(&scene, false, &tuning(texels, words)).0;
            // Two buffers, the most there are, and some in between whose length is rounded to a power of two.
            for most in [words - 1, words.div_ceil(16).next_power_of_two(), words / 5] {
                let several = render_with(&scene, false, &tuning(texels, most)).0;
                assert_same_bits(
                    &several,
                    &one,
                    &format!("{sampler} {texels} {most} of {words} {mip_chains:?}"),
                );
            }
        }
    }
}

#[test]
fn words_of_the_wrong_buffer_would_show() {
    let scene = packed("", true, MipPlacement::Host);
    let words = scene.texels.len() as u64 / 4;
    let one = render_with(&scene, false, &tuning(TexelChoice::Buffer, words)).0;
    let mut swapped = scene.clone();
    let half = (words as usize).next_power_of_two() / 2 * 4;
    swapped.texels[half..].fill(0);
    assert_ne!(render_with(&swapped, false, &tuning(TexelChoice::Buffer, words - 1)).0.pixels, one.pixels);
}

#[test]
fn more_texels_than_the_buffers_hold_are_refused_once_with_figures_and_a_way_out() {
    let scene = packed("", true, MipPlacement::Host);
    let words = scene.texels.len() as u64 / 4;
    for texels in [TexelChoice::Buffer, TexelChoice::Auto] {
        // Volume and cube lie in buffers whatever the source.
        let few = tuning(texels, 128);
        let message = told(render(&device(), scene.clone(), false, &few, &NoProgress).map(|_| ()));
        for part in ["\"rgba16 srgb 128x64\"", "16 texel buffers", "use smaller or fewer textures"] {
            assert!(message.contains(part), "{texels}: {part} not in {message}");
        }
        assert!(!message.contains("--texels"), "{message}");
    }
    assert!(words > 16 * 128);
}

#[test]
fn texels_that_no_single_buffer_holds_are_read_from_images_where_those_hold_them() {
    let source = |scene: &PackedScene, tuning: &Tuning| {
        let left_out = render_with(scene, false, tuning).1.left_out;
        [!left_out.contains(&"texel buffer".into()), !left_out.contains(&"images and device samplers".into())]
    };
    let scene = packed("", false, MipPlacement::Host);
    let words = scene.texels.len() as u64 / 4;
    let first = source(&scene, &tuning(TexelChoice::Auto, words));
    if device_name() == "cpu" {
        assert_eq!(first, [true, false], "a buffer is first on a CPU");
    }
    assert_eq!(source(&scene, &tuning(TexelChoice::Auto, words - 1)), [false, true]);
    assert_eq!(source(&scene, &tuning(TexelChoice::Buffer, words - 1)), [true, false]);
    // Textures that no image can hold: longer than those, if a device has a limit within reach.
    let limit = device().info().limits.max_image_2d;
    let long = noise(Dimension::Two, [limit + 1, 1, 1], TexelFormat::Grey8, ColorSpace::Linear, 1);
    let text = format!(
        "{VIEW}[[texture]]\nname = 't'\nfile = 'a'\n[[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\n\
         [[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm'\n"
    );
    let scene = parse(Path::new("long.toml"), &text).unwrap();
    let scene = pack::pack(&scene, vec![long], None).unwrap();
    for words in [1 << 20, 4096] {
        assert_eq!(source(&scene, &tuning(TexelChoice::Auto, words)), [true, false], "{words}");
    }
}

/// All codes once.
fn deep_greys() -> TextureData {
    let texels = (0..=u16::MAX).flat_map(u16::to_ne_bytes).collect();
    TextureData { texels, ..noise(Dimension::Two, [256, 256, 1], TexelFormat::Grey16, ColorSpace::Srgb, 1) }
}

#[test]
fn every_deep_srgb_code_is_read_as_its_light_from_buffers_and_images() {
    let nearest = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let grey = deep_greys();
    let rgba: Vec<u8> = (0..=u16::MAX)
        .flat_map(|code| [code, code.wrapping_mul(40_503), !code, code ^ 0x5555])
        .flat_map(u16::to_ne_bytes)
        .collect();
    let pair: Vec<u8> = (0..=u16::MAX).flat_map(|code| [code, !code]).flat_map(u16::to_ne_bytes).collect();
    let of = |format, texels| TextureData { format, texels, ..grey.clone() };
    let textures =
        vec![grey.clone(), of(TexelFormat::Rgba16, rgba.clone()), of(TexelFormat::GreyAlpha16, pair)];
    let scene = pairs(textures, &[nearest], &[(0, 0), (1, 0), (2, 0)]);
    assert_eq!(scene.texels.len(), 65_536 * (2 + 8 + 4), "as the files have them, not as floats");
    let light = srgb_table(65_536);
    for image_source in [false, true] {
        for texture in 0..3 {
            let uv = |i: u32| [i % 256, i / 256].map(|n| (n as f32 + 0.5) / 256.0);
            let queries: Vec<_> = (0..65_536).map(|i| query(&scene, texture, uv(i))).collect();
            let answers = probe::lookups(&device(), &scene, image_source, false, &queries).unwrap();
            for (code, (answer, query)) in (0..=u16::MAX).zip(answers.iter().zip(&queries)) {
                let codes = match texture {
                    1 => [code, code.wrapping_mul(40_503), !code],
                    _ => [code; 3],
                };
                let expected = codes.map(|code| light[usize::from(code)].to_bits());
                let found = [answer[0], answer[1], answer[2]].map(f32::to_bits);
                assert_eq!(found, expected, "texture {texture}, code {code}, images: {image_source}");
                let (image, how) = (&scene.records.textures[texture], &scene.records.samplers[0]);
                let at = Coordinate::flat([query.uv[0].into(), query.uv[1].into()].into());
                let exact = sample_texture(&scene, image, how, &at, [0; 2]);
                for (found, exact) in answer.iter().zip(exact.to_array()) {
                    // A table entry is rounded once; a quotient of alpha by 2.5 ulp (Vulkan 1.3, precision).
                    let ulp = f64::from(f32::EPSILON) * exact;
                    assert!((f64::from(*found) - exact).abs() <= 2.5 * ulp, "{found}, oracle {exact}");
                }
            }
        }
    }
}

/// A scene of five textures that read `files`, each on a plane of its own.
fn five(folder: &Path, files: [&str; 5], more: &str) -> Value {
    let mut text = VIEW.to_string();
    for (i, file) in files.into_iter().enumerate() {
        let more = if i == 4 { more } else { "" };
        text += &format!(
            "[[texture]]\nname = 't{i}'\nfile = '{file}'\n{more}\n[[material]]\nname = 'm{i}'\nmodel = 'unlit'\n\
             texture = 't{i}'\n[[plane]]\norigin = [0, {i}, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\n\
             half_extent = 1\nmaterial = 'm{i}'\n"
        );
    }
    fs::write(folder.join("scene.toml"), text).unwrap();
    let mut command = moire();
    command.current_dir(folder).args(["render", "scene.toml", "--json", "-q", "-o", "out.exr"]);
    let output = command.args(["--device", &device_name()]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_file_of_five_names_is_held_once() {
    let folder = tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::create_dir(path("sub")).unwrap();
    let noisy = |seed: u32| {
        ImageBuffer::from_fn(512, 512, |x, y| {
            Rgb([x, y, x ^ y].map(|n| (n.wrapping_mul(seed).wrapping_mul(2_654_435_761) >> 24) as u8))
        })
    };
    for (seed, name) in (1..).zip(["a.png", "b.png", "c.png", "d.png", "e.png"]) {
        noisy(seed).save(path(name)).unwrap();
    }
    let absolute = path("a.png").canonicalize().unwrap();
    let same = ["a.png", "./a.png", "sub/../a.png", absolute.to_str().unwrap(), "a.png"];
    let bytes = |report: &Value| report["device_bytes"].as_u64().unwrap();
    let held = |report: &Value| {
        let left_out = report["left_out"].as_array().unwrap().iter();
        left_out.filter(|text| text.as_str().unwrap().contains("reads the texels of \"t0\"")).count()
    };
    // But for the alignment of what lies beside each other, which is a page at most.
    let texels = 512 * 512 * 4 - 4096;
    let different = five(folder.path(), ["a.png", "b.png", "c.png", "d.png", "e.png"], "");
    let once = five(folder.path(), same, "");
    assert_eq!((held(&different), held(&once)), (0, 4));
    assert!(bytes(&different) >= bytes(&once) + 4 * texels, "{different:#}\n{once:#}");
    // The same bytes read in another way are different texels.
    let twice = five(folder.path(), same, "color_space = 'srgb'");
    assert_eq!(held(&twice), 3);
    assert!(bytes(&twice) >= bytes(&once) + texels);
}

/// Materials, bump maps and environments show the same as before.
#[test]
fn what_reads_a_texture_of_two_names_reads_it_still() {
    let text = format!(
        "{VIEW}[[texture]]\nname = 'a'\nfile = 'x'\n[[texture]]\nname = 'b'\nfile = 'y'\n\
         [[texture]]\nname = 'c'\nfile = 'x'\n[[texture]]\nname = 'd'\nfile = 'y'\nflip_v = true\n\
         [[texture]]\nname = 'e'\nfile = 'y'\n[background]\nenvironment = 'e'\n\
         [[material]]\nname = 'm'\ntexture = 'c'\nnormal_map = 'd'\n\
         [[material]]\nname = 'n'\ntexture = 'a'\nbump_map = 'b'\n\
         [[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n\
         [[sphere]]\ncenter = [3, 0, 0]\nradius = 1\nmaterial = 'n'\n"
    );
    let mut scene = parse(Path::new("names.toml"), &text).unwrap();
    prune(&mut scene);
    let names: Vec<&str> = scene.textures.iter().map(|t| t.name.as_str()).collect();
    assert_eq!(names, ["a", "b", "d"]);
    let [m, n] = [&scene.materials[0], &scene.materials[1]];
    let read = |material: &moire::internal::scene::model::Material| {
        (material.texture, material.bump.unwrap().texture)
    };
    assert_eq!((read(m), read(n)), ((Some(0), 2), (Some(0), 1)));
    assert_eq!(scene.background.environment.unwrap().texture, 1);
}

#[test]
fn deep_srgb_files_take_their_own_size_on_the_device() {
    let folder = tempdir().unwrap();
    let scene = format!(
        "{VIEW}[[texture]]\nname = 't'\nfile = 't.png'\ncolor_space = 'srgb'\n[[material]]\nname = 'm'\n\
         model = 'unlit'\ntexture = 't'\n[[plane]]\norigin = [0, -1, 0]\ntangent = [1, 0, 0]\n\
         bitangent = [0, 0, 1]\nmaterial = 'm'\n"
    );
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let deep = ImageBuffer::from_fn(300, 200, |x, y| Luma([(x * 200 + y) as u16]));
    deep.save(folder.path().join("t.png")).unwrap();
    let mut command = moire();
    command.current_dir(folder.path()).args(["render", "scene.toml", "-v", "-o", "out.exr"]);
    let output = command.args(["--device", &device_name()]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && said.contains("held as grey16 (srgb), 118 KiB"), "{said}");
}

/// Checked before prefix sums are made, which may take more memory than there is.
#[test]
fn the_size_of_sums_along_rows_is_known_before_they_are_made() {
    let of = |size, format, seed| noise(Dimension::Two, size, format, ColorSpace::Linear, seed);
    let cube = noise(Dimension::Cube, [4, 4, 6], TexelFormat::Rgba8, ColorSpace::Linear, 3);
    let flat = [of([7, 5, 1], TexelFormat::Grey8, 1), of([64, 16, 1], TexelFormat::RgbaFloat, 2)];
    let [a, b] = flat;
    for textures in [vec![], vec![a.clone()], vec![b.clone(), cube.clone()], vec![cube, a, b]] {
        assert_eq!(pack::prefix_sum_words(&textures), pack::prefix_sums(&textures).len() as u64);
    }
}
