//! Limit values on the device: lights, bounces, image slots, volumes and cubes; and one step
//! beyond.

use std::path::Path;

use glam::DVec3;
use moire::internal::gpu::{ImageDesc, ImageFormat, ImageShape, Swizzle};
use moire::internal::lab::verify::queries::texture;
use moire::internal::pack::{self, MAX_SLOTS, PackedScene};
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, TexelFormat};

use super::{HEAD, IMAGE};
use crate::stage::{device, render, render_on_oracle};
use crate::support::told;

fn packed(text: &str) -> PackedScene {
    let scene =
        parse(Path::new("a.toml"), &format!("{HEAD}{IMAGE}{text}")).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let count = scene.textures.len();
    let textures = (0..count).map(|i| texture(4, 4, TexelFormat::Rgba8, ColorSpace::Linear, i as u64));
    pack::pack(&scene, textures.collect(), None).unwrap()
}

fn device_is_oracle(scene: &PackedScene, what: &str) {
    let (device, oracle) = (render(scene), render_on_oracle(scene));
    for (a, b) in device.pixels.iter().flatten().zip(oracle.pixels.iter().flatten()) {
        // 16 samples of sums of a thousand f32 terms.
        assert!((a - b).abs() <= 1e-4 * b.abs().max(1.0), "{what}: {a} on the device, {b} in float64");
    }
}

#[test]
fn a_scene_of_nothing_shows_its_background() {
    let scene = packed("background = { color = [0.25, 0.5, 1.0] }\n");
    for film in [render(&scene), render_on_oracle(&scene)] {
        assert!(film.pixels.iter().all(|p| *p == [0.25, 0.5, 1.0]));
    }
}

#[test]
fn without_a_light_surfaces_are_black_and_a_thousand_lights_add_up() {
    let sphere = "sphere = [{ center = [0, 1, 0], radius = 2 }]\n";
    let scene = packed(sphere);
    assert!(render(&scene).pixels.iter().all(|p| *p == [0.0; 3]));
    let light = |i: usize| {
        let place = DVec3::new((i as f64).sin(), (i as f64 * 0.7).cos() + 1.0, 4.0);
        format!(
            "{{ kind = 'point', position = [{}, {}, {}], intensity = [0.01, 0.01, 0.01] }}",
            place.x, place.y, place.z
        )
    };
    for count in [1, 1000] {
        let lights: Vec<String> = (0..count).map(light).collect();
        device_is_oracle(
            &packed(&format!("{sphere}light = [{}]\n", lights.join(", "))),
            &format!("{count} lights"),
        );
    }
}

/// Between two mirrors: as many bounces as asked for, then black.
#[test]
fn no_bounce_one_and_the_most_end_where_the_count_says() {
    let mirrors = "material = [{ name = 'm', model = 'mirror', color = [0.9, 0.9, 0.9] }]\n\
                   plane = [{ origin = [0, 0, -2], tangent = [1, 0, 0], bitangent = [0, 1, 0], material = 'm' },\n\
                            { origin = [0, 0, 7], tangent = [1, 0, 0], bitangent = [0, 1, 0], material = 'm', half_extent = 60 }]\n\
                   background = { color = [1, 1, 1] }\n";
    let mut lit = Vec::new();
    for depth in [0, 1, 64] {
        let scene = packed(&format!("{mirrors}sampling = {{ max_depth = {depth}, pattern = 'center' }}\n"));
        device_is_oracle(&scene, &format!("{depth} bounces"));
        lit.push(render(&scene).pixels.iter().filter(|p| p[0] > 0.0).count());
    }
    assert_eq!(lit[..2], [0, 0], "black where the bounces are used up");
    assert!(lit[2] > 0, "64 bounces lead past the smaller mirror");
}

#[test]
fn as_many_images_as_there_are_slots_are_read_and_one_more_is_told_or_read_from_a_buffer() {
    let scene = |count: usize, method: &str| {
        let list = |f: &dyn Fn(usize) -> String| (0..count).map(f).collect::<Vec<_>>().join(", ");
        let textures = list(&|i| format!("{{ name = 't{i}', file = 'f{i}' }}"));
        let materials =
            list(&|i| format!("{{ name = 'm{i}', model = 'unlit', texture = 't{i}', sampler = 's' }}"));
        let spheres = list(&|i| {
            let (x, y) = (i % 5, i / 5);
            format!(
                "{{ center = [{}, {}, 0], radius = 0.5, material = 'm{i}' }}",
                x as f64 - 2.0,
                y as f64 - 0.5
            )
        });
        packed(&format!(
            "texture = [{textures}]\nsampler = [{{ name = 's', filter = 'nearest', method = '{method}' }}]\n\
             material = [{materials}]\nsphere = [{spheres}]\n"
        ))
    };
    device_is_oracle(&scene(MAX_SLOTS + 1, "shader"), "one texture more than slots, in a buffer");
    render(&scene(MAX_SLOTS, "hardware"));
    let over = scene(MAX_SLOTS + 1, "hardware");
    let tuning = moire::internal::render::Tuning::default();
    let refused = moire::internal::render::render(
        &device(),
        over,
        false,
        &tuning,
        &moire::internal::core::progress::NoProgress,
    );
    let message = told(refused.map(|_| ()));
    assert!(message.contains(&MAX_SLOTS.to_string()) && message.contains("17"), "{message}");
}

fn solid(shape: ImageShape, [width, height, depth]: [u32; 3], texels: &[u8]) -> Result<(), String> {
    let desc = ImageDesc {
        name: "t",
        shape,
        width,
        height,
        depth,
        format: ImageFormat::R8,
        swizzle: Swizzle::Grey,
        levels: &[texels],
    };
    let made = device().image(&desc);
    if made.is_ok() { Ok(()) } else { Err(told(made.map(|_| ()))) }
}

/// The full length along each axis of a volume; a cube as large as memory allows, beyond that only the check.
#[test]
fn volumes_and_cubes_are_as_long_as_the_device_says_and_no_texel_longer() {
    let limits = device().info().limits.clone();
    let (deep, wide) = (limits.max_image_3d, limits.max_image_cube);
    for axis in 0..3 {
        let mut size = [1, 1, 1];
        size[axis] = deep;
        assert_eq!(solid(ImageShape::Volume, size, &vec![7; deep as usize]), Ok(()), "axis {axis}");
        size[axis] = deep + 1;
        let message = solid(ImageShape::Volume, size, &vec![7; deep as usize + 1]).unwrap_err();
        assert!(
            message.contains("too large") && message.contains(&format!("{deep}×{deep}×{deep}")),
            "{message}"
        );
        size[axis] = 0;
        assert!(solid(ImageShape::Volume, size, &[]).unwrap_err().contains("no texels"));
    }
    // The largest face passes the check of sizes, and then fails because these are not its texels.
    let message = solid(ImageShape::Cube, [wide, wide, 6], &[7; 6]).unwrap_err();
    let bytes = u64::from(wide) * u64::from(wide) * 6;
    assert!(message.contains(&bytes.to_string()) && !message.contains("too large"), "{message}");
    let message = solid(ImageShape::Cube, [wide + 1, wide + 1, 6], &[7; 6]).unwrap_err();
    assert!(message.contains("too large") && message.contains(&format!("{wide}×{wide}")), "{message}");
    for depth in [0, 1, 5, 7] {
        let message = solid(ImageShape::Cube, [1, 1, depth], &vec![7; depth as usize]).unwrap_err();
        assert!(message.contains(if depth == 0 { "no texels" } else { "six" }), "{message}");
    }
    let side = wide.min(2048);
    assert_eq!(solid(ImageShape::Cube, [side, side, 6], &vec![7; (side * side * 6) as usize]), Ok(()));
}
