//! Materials of glTF files as those of scenes: factors, the maps with their samplers and coordinates, alpha, sides, glass,
//! and what vertices and lights bring with them.

use std::fs;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DVec3, Vec4};
use moire::internal::lab::inspect::{Coordinates, readers};
use moire::internal::scene::load;
use moire::internal::scene::model::{AlphaMode, Light, Material, Model, Scene, Sides, TextureUse};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::Address;
use tempfile::tempdir;

use crate::stage::{packed, render, render_on_oracle};

/// One texel.
pub(super) const PNG: &str = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==";

/// A square of side 2 about the origin that faces +z, with two sets of coordinates and colours (u8, normalised), in this
/// material; `more`: further members of the file.
fn file(material: &str, more: &str) -> String {
    let positions = [[-1f32, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let normals = [[0f32, 0.0, 1.0]; 4];
    let first = [[0f32, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let second = [[0f32, 0.5], [0.5, 0.5], [0.5, 0.0], [0.0, 0.0]];
    let colors = [[128u8, 255, 0, 255]; 4];
    let indices = [0u16, 1, 2, 0, 2, 3];
    let mut bytes = Vec::new();
    bytes.extend_from_slice(bytemuck::cast_slice(&positions));
    bytes.extend_from_slice(bytemuck::cast_slice(&normals));
    bytes.extend_from_slice(bytemuck::cast_slice(&first));
    bytes.extend_from_slice(bytemuck::cast_slice(&second));
    bytes.extend_from_slice(bytemuck::cast_slice(&colors));
    bytes.extend_from_slice(bytemuck::cast_slice(&indices));
    let parts = [(0, 48), (48, 48), (96, 32), (128, 32), (160, 16), (176, 12)];
    let views: Vec<String> = parts
        .iter()
        .map(|(at, length)| format!("{{\"buffer\":0,\"byteOffset\":{at},\"byteLength\":{length}}}"))
        .collect();
    let float = |view: usize, kind: &str| {
        format!("{{\"bufferView\":{view},\"componentType\":5126,\"count\":4,\"type\":\"{kind}\"}}")
    };
    let colors = if more.contains("\"colors\"") { ",\"COLOR_0\":4" } else { "" };
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scenes\":[{{\"nodes\":[0,1]}}],\
         \"nodes\":[{{\"mesh\":0}},{{\"extensions\":{{\"KHR_lights_punctual\":{{\"light\":0}}}},\"translation\":[0,0,2]}}],\
         \"extensionsUsed\":[\"KHR_lights_punctual\"],{more}\
         \"extensions\":{{\"KHR_lights_punctual\":{{\"lights\":[{{\"type\":\"spot\",\"intensity\":4,\"range\":10,\
         \"spot\":{{\"innerConeAngle\":0.2,\"outerConeAngle\":0.4}}}}]}}}},\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"TEXCOORD_1\":3{colors}}},\
         \"indices\":5,\"material\":0}}]}}],\"materials\":[{material}],\
         \"accessors\":[{},{},{},{},\
         {{\"bufferView\":4,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC4\"}},\
         {{\"bufferView\":5,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}}],\
         \"bufferViews\":[{}],\
         \"buffers\":[{{\"byteLength\":188,\"uri\":\"data:application/octet-stream;base64,{}\"}}]}}",
        float(0, "VEC3"),
        float(1, "VEC3"),
        float(2, "VEC2"),
        float(3, "VEC2"),
        views.join(","),
        BASE64_STANDARD.encode(bytes)
    )
}

/// Two textures of one image: one that repeats, one that ends at its edges.
fn textures() -> String {
    format!(
        "\"images\":[{{\"uri\":\"{PNG}\"}}],\"samplers\":[{{}},{{\"wrapS\":33071,\"wrapT\":33071}}],\
         \"textures\":[{{\"source\":0,\"sampler\":0}},{{\"source\":0,\"sampler\":1}}],"
    )
}

fn loaded(material: &str, more: &str) -> Scene {
    let folder = tempdir().unwrap();
    let path = folder.path().join("m.gltf");
    fs::write(&path, file(material, more)).unwrap();
    load(&path).unwrap_or_else(|e| panic!("{e}\n{material}"))
}

fn only(scene: &Scene) -> &Material {
    assert_eq!(scene.materials.len(), 1);
    &scene.materials[0]
}

#[test]
fn factors_alpha_and_sides_are_those_of_the_file() {
    let text = "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,0.5],\"metallicFactor\":0.25,\"roughnessFactor\":0.75},\
        \"emissiveFactor\":[1,0.5,0],\"extensions\":{\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4},\
        \"KHR_materials_ior\":{\"ior\":2}},\"alphaMode\":\"BLEND\",\"doubleSided\":true}";
    let scene = loaded(text, "");
    let found = only(&scene);
    assert_eq!((found.model, found.color), (Model::PHYSICAL, DVec3::new(0.1, 0.2, 0.3)));
    assert_eq!((found.metallic, found.roughness, found.ior, found.opacity), (0.25, 0.75, 2.0, 0.5));
    assert_eq!(found.emission, DVec3::new(4.0, 2.0, 0.0));
    assert_eq!((found.alpha, found.sides), (AlphaMode::Blend, Sides::Both));
    let masked = loaded("{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.3}", "");
    let found = only(&masked);
    assert_eq!((found.alpha, found.alpha_cutoff, found.sides), (AlphaMode::Mask, 0.3, Sides::Front));
    // The defaults of the specification.
    assert_eq!((found.metallic, found.roughness, found.ior), (1.0, 1.0, 1.5));
    assert!(scene.notes.is_empty() && masked.notes.is_empty(), "{:?} {:?}", scene.notes, masked.notes);
}

#[test]
fn clear_glass_is_glass_and_other_bodies_let_their_share_through() {
    let of = |base: &str, transmission: &str| {
        let extension = format!("\"extensions\":{{\"KHR_materials_transmission\":{{{transmission}}}}}");
        let material = format!(
            "{{\"name\":\"pane\",\"pbrMetallicRoughness\":{{\"roughnessFactor\":0.1{base}}},{extension}}}"
        );
        let scene = loaded(&material, &textures());
        assert!(scene.notes.is_empty(), "{:?}", scene.notes);
        scene
    };
    let body = ",\"metallicFactor\":0";
    let all = "\"transmissionFactor\":1";
    let glass = of(body, all);
    assert_eq!((only(&glass).model, only(&glass).roughness), (Model::GLASS, 0.1));
    // Metals let nothing through, and what is mirrored has no colour.
    for (base, transmission) in [
        (body, "\"transmissionFactor\":0.25"),
        ("", all),
        (",\"metallicFactor\":0,\"baseColorFactor\":[1,0.5,1,1]", all),
        (",\"metallicFactor\":0,\"metallicRoughnessTexture\":{\"index\":1}", all),
    ] {
        let scene = of(base, transmission);
        let share = if transmission == all { 1.0 } else { 0.25 };
        assert_eq!((only(&scene).model, only(&scene).transmission), (Model::PHYSICAL, share), "{base}");
    }
    let scene = of(body, "\"transmissionFactor\":1,\"transmissionTexture\":{\"index\":1,\"texCoord\":1}");
    let map = only(&scene).transmission_texture.unwrap();
    assert_eq!(scene.textures[map.texture].color_space, ColorSpace::Linear);
    assert_eq!(scene.samplers[map.sampler].address[0], Address::ClampToEdge);
    assert!(
        only(&of(body, "\"transmissionTexture\":{\"index\":1}")).transmission_texture.is_none(),
        "of nothing"
    );
}

#[test]
fn each_map_has_its_own_sampler_coordinates_and_encoding() {
    let text = "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0},\
        \"metallicRoughnessTexture\":{\"index\":1,\"texCoord\":1}},\"normalTexture\":{\"index\":1,\"scale\":0.5},\
        \"occlusionTexture\":{\"index\":0,\"strength\":0.25,\"texCoord\":1},\"emissiveTexture\":{\"index\":0},\
        \"emissiveFactor\":[1,1,1]}";
    let scene = loaded(text, &textures());
    let found = only(&scene);
    let [rough, glow, shade] =
        [found.metallic_roughness_map, found.emission_map, found.occlusion_map].map(Option::unwrap);
    let bump = found.bump.unwrap();
    let address = |sampler: usize| scene.samplers[sampler].address[0];
    assert_eq!(address(found.sampler), Address::Repeat);
    assert_eq!(address(rough.sampler), Address::ClampToEdge);
    assert_eq!(address(bump.sampler.unwrap()), Address::ClampToEdge);
    assert_eq!([address(glow.sampler), address(shade.sampler)], [Address::Repeat; 2]);
    let seconds = [found.second_uv, bump.second_uv, rough.second_uv, glow.second_uv, shade.second_uv];
    assert_eq!(seconds, [false, false, true, false, true]);
    let space = |texture: usize| scene.textures[texture].color_space;
    assert_eq!(space(found.texture.unwrap()), ColorSpace::Srgb);
    assert_eq!(space(glow.texture), ColorSpace::Srgb);
    assert_eq!([rough.texture, bump.texture, shade.texture].map(space), [ColorSpace::Linear; 3]);
    assert_eq!((found.occlusion_strength, bump.strength), (0.25, 0.5));
    let records = packed(scene, None).records;
    assert!(records.meshes[0].has_second_uv && records.meshes[0].has_tangents);
}

#[test]
fn textures_of_specular_have_their_own_sampler_coordinates_and_encoding() {
    let text = "{\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0.5,\"specularTexture\":{\"index\":1},\
        \"specularColorFactor\":[2,1,0.5],\"specularColorTexture\":{\"index\":0,\"extensions\":\
        {\"KHR_texture_transform\":{\"texCoord\":1,\"offset\":[0.5,0]}}}}}}";
    let scene = loaded(text, &textures());
    let found = only(&scene);
    let [weight, tint] = [found.specular_weight_map, found.specular_tint_map].map(Option::unwrap);
    let address = |sampler: usize| scene.samplers[sampler].address[0];
    assert_eq!([weight, tint].map(|map| address(map.sampler)), [Address::ClampToEdge, Address::Repeat]);
    assert_eq!([weight, tint].map(|map| map.second_uv), [false, true]);
    let space = |texture: usize| scene.textures[texture].color_space;
    assert_eq!([weight, tint].map(|map| space(map.texture)), [ColorSpace::Linear, ColorSpace::Srgb]);
    assert_eq!((found.specular_weight, found.specular_tint), (0.5, DVec3::new(2.0, 1.0, 0.5)));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    let packed = packed(scene, None);
    assert!(packed.records.meshes[0].has_second_uv);
    let [device, oracle] = [render(&packed), render_on_oracle(&packed)]
        .map(|film| film.pixels[film.pixels.len() / 2 + film.width as usize / 2]);
    // f32 against f64.
    assert!(
        device.iter().zip(oracle).all(|(a, b)| (a - b).abs() < 1e-4 * b && b > 0.01),
        "{device:?} {oracle:?}"
    );
}

#[test]
fn third_coordinates_are_those_of_their_texture_alone() {
    let transform = |x: f64| format!("\"extensions\":{{\"KHR_texture_transform\":{{\"offset\":[{x},0]}}}}");
    let text = format!(
        "{{\"name\":\"three\",\"pbrMetallicRoughness\":{{\"baseColorTexture\":{{\"index\":0}},\
         \"metallicRoughnessTexture\":{{\"index\":0,{}}}}},\"emissiveTexture\":{{\"index\":0,{}}},\
         \"extensions\":{{\"KHR_materials_specular\":{{\"specularTexture\":{{\"index\":1,{}}},\
         \"specularColorTexture\":{{\"index\":1,{}}}}}}}}}",
        transform(0.125),
        transform(0.25),
        transform(0.375),
        transform(0.5)
    );
    let scene = loaded(&text, &textures());
    let found = only(&scene);
    let own = |map: Option<TextureUse>| map.unwrap().own_uv.unwrap().transform.translation.x;
    let Material { metallic_roughness_map, emission_map, specular_weight_map, specular_tint_map, .. } =
        *found;
    let maps = [metallic_roughness_map, emission_map, specular_weight_map, specular_tint_map];
    assert_eq!(maps.map(own), [0.125, 0.25, 0.375, 0.5]);
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    // Charts are those of the same coordinates.
    for map in maps.map(Option::unwrap) {
        assert!(readers(&scene, &[map.texture]).contains(&(0, Coordinates::Own(map.own_uv.unwrap()))));
    }
    // In the order of the bits of the maps.
    let records = packed(scene, None).records;
    let moved: Vec<f64> = records.map_uvs.iter().map(|own| own.offset.x).collect();
    assert_eq!(moved, [0.125, 0.25, 0.375, 0.5]);
}

/// Linear as they are, in 16 bits: 128/255 is not darkened.
#[test]
fn colours_of_vertices_multiply_the_base_colour() {
    let unlit = "{\"extensions\":{\"KHR_materials_unlit\":{}},\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0.5,1,1]}}";
    let scene = loaded(unlit, "\"extras\":{\"colors\":1},");
    let packed = packed(scene, None);
    for film in [render(&packed), render_on_oracle(&packed)] {
        let seen = film.pixels[film.pixels.len() / 2 + film.width as usize / 2];
        let wanted = [128.0 / 255.0, 0.5, 0.0];
        assert!(seen.iter().zip(wanted).all(|(a, b)| (f64::from(*a) - b).abs() < 1e-4), "{seen:?}");
    }
    let plain = crate::stage::packed(loaded(unlit, ""), None);
    assert!(!plain.records.meshes[0].has_colors);
}

#[test]
fn spots_keep_their_cone_and_range() {
    let scene = loaded("{}", "");
    let [Light::Spot { position, direction, intensity, inner, outer, range }] = scene.lights[..] else {
        panic!("{:?}", scene.lights);
    };
    assert_eq!((position, intensity, range), (DVec3::Z * 2.0, DVec3::splat(4.0), 10.0));
    assert!((direction - DVec3::NEG_Z).length() < 1e-12);
    assert!((inner - 0.2f64.to_degrees()).abs() < 1e-9 && (outer - 0.4f64.to_degrees()).abs() < 1e-9);
}

/// Complaint 4 of many viewers: a normal map over coordinates without extent.
#[test]
fn coordinates_without_extent_leave_the_normal_finite() {
    let text = "{\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"normalTexture\":{\"index\":0,\
        \"extensions\":{\"KHR_texture_transform\":{\"scale\":[0,0]}}}}";
    let film = render(&packed(loaded(text, &textures()), None));
    assert!(film.pixels.iter().flatten().all(|value| value.is_finite()));
    let middle = film.pixels[film.pixels.len() / 2 + film.width as usize / 2];
    assert!(Vec4::new(middle[0], middle[1], middle[2], 0.0).max_element() > 0.0, "{middle:?}");
}
