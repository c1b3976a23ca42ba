//! glTF files as scenes and in scenes: where nodes put triangles, what materials, samplers and transforms of coordinates
//! become, cameras and lights, choices by name, and what is said of the rest.

use std::fs;
use std::path::Path;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use glam::{DVec2, DVec3};
use moire::internal::lab::metrics::compare;
use moire::internal::scene::load;
use moire::internal::scene::model::{BumpKind, Light, Material, Model, Projection, Scene, Triangle};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::load::load as load_texture;
use moire::internal::texture::sampler_spec::{Address, MipMode};
use tempfile::{TempDir, tempdir};

use super::trees::taken_apart;
use super::{close, scene_in};
use crate::stage::{packed, render};
use crate::support::told;

/// A triangle with corners on the axes, normals (0, 0, 1), two sets of coordinates.
fn buffer() -> String {
    let positions = [[1f32, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let normals = [[0f32, 0.0, 1.0]; 3];
    let uvs = [[[0f32, 0.0], [1.0, 0.0], [0.0, 1.0]], [[0.5, 0.5], [0.25, 0.5], [0.5, 0.25]]];
    let mut bytes = Vec::new();
    bytes.extend_from_slice(bytemuck::cast_slice(&positions));
    bytes.extend_from_slice(bytemuck::cast_slice(&normals));
    bytes.extend_from_slice(bytemuck::cast_slice(&uvs));
    BASE64_STANDARD.encode(bytes)
}

/// A file with one mesh, these nodes and these further members.
fn file(nodes: &str, more: &str) -> String {
    let view = |offset: usize, length: usize| {
        format!("{{\"buffer\":0,\"byteOffset\":{offset},\"byteLength\":{length}}}")
    };
    let accessor = |view: usize, kind: &str| {
        format!("{{\"bufferView\":{view},\"componentType\":5126,\"count\":3,\"type\":\"{kind}\"}}")
    };
    let other = if nodes == NODES { ",{\"name\":\"other\",\"nodes\":[1]}" } else { "" };
    format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"name\":\"main\",\"nodes\":[0]}}{other}],\
         \"nodes\":{nodes},{more}\
         \"meshes\":[{{\"primitives\":[{{\"attributes\":{{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"TEXCOORD_1\":3}},\"material\":0}}]}}],\
         \"accessors\":[{},{},{},{}],\"bufferViews\":[{},{},{},{}],\
         \"buffers\":[{{\"byteLength\":120,\"uri\":\"data:application/octet-stream;base64,{}\"}}]}}",
        accessor(0, "VEC3"),
        accessor(1, "VEC3"),
        accessor(2, "VEC2"),
        accessor(3, "VEC2"),
        view(0, 36),
        view(36, 36),
        view(72, 24),
        view(96, 24),
        buffer()
    )
}

const NODES: &str = "[{\"name\":\"a\",\"mesh\":0,\"children\":[2]},{\"name\":\"b\",\"mesh\":0},\
    {\"name\":\"c\",\"mesh\":0,\"translation\":[0,0,9]}]";
const PLAIN: &str = "\"materials\":[{\"name\":\"paint\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}}],";

fn folder_with(text: &str) -> TempDir {
    let folder = tempdir().unwrap();
    fs::write(folder.path().join("m.gltf"), text).unwrap();
    folder
}

fn loaded(text: &str) -> Scene {
    load(&folder_with(text).path().join("m.gltf")).unwrap()
}

fn triangles(scene: &Scene) -> Vec<Triangle> {
    taken_apart(scene).shapes.triangles
}

/// A PNG of four texels: red, green; blue, white.
fn four_texels() -> String {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 2);
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255]).unwrap();
    writer.finish().unwrap();
    BASE64_STANDARD.encode(bytes)
}

/// Textures 0 and 1 of the same embedded image, with these samplers, and a material with this base.
fn textured(sampler: &str, base: &str, material: &str) -> String {
    format!(
        "\"images\":[{{\"uri\":\"data:image/png;base64,{}\"}}],\"samplers\":[{sampler}],\
         \"textures\":[{{\"source\":0,\"sampler\":0}},{{\"source\":0}}],\
         \"materials\":[{{\"pbrMetallicRoughness\":{{\"metallicFactor\":0,\"baseColorTexture\":{{{base}}}}}{material}}}],",
        four_texels()
    )
}

fn material(scene: &Scene) -> &Material {
    &scene.materials[triangles(scene)[0].material]
}

#[test]
fn nodes_scale_then_rotate_then_translate_and_hand_on_to_their_children() {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let nodes = format!(
        "[{{\"children\":[1],\"translation\":[10,0,0]}},\
          {{\"mesh\":0,\"translation\":[0,5,0],\"rotation\":[0,0,{half},{half}],\"scale\":[2,3,4]}}]"
    );
    let [triangle] = triangles(&loaded(&file(&nodes, PLAIN)))[..] else { panic!() };
    // Scale, a quarter turn from x to y, then both translations.
    let wanted = [DVec3::new(10.0, 7.0, 0.0), DVec3::new(7.0, 5.0, 0.0), DVec3::new(10.0, 5.0, 4.0)];
    assert!(triangle.vertices.iter().zip(wanted).all(|(a, b)| (*a - b).length() < 1e-6), "{triangle:?}");
}

#[test]
fn a_mirroring_node_keeps_fronts_and_normals_stay_at_right_angles() {
    let nodes = "[{\"mesh\":0,\"scale\":[-1,1,1]}]";
    let [mirrored] = triangles(&loaded(&file(nodes, PLAIN)))[..] else { panic!() };
    let [plain] = triangles(&loaded(&file("[{\"mesh\":0}]", PLAIN)))[..] else { panic!() };
    let front = |t: &Triangle| (t.vertices[1] - t.vertices[0]).cross(t.vertices[2] - t.vertices[0]);
    let mirror = DVec3::new(-1.0, 1.0, 1.0);
    assert!(close(front(&mirrored), front(&plain) * mirror), "{mirrored:?}");
    let scaled = loaded(&file(
        "[{\"mesh\":0,\"rotation\":[0.7071067811865476,0,0,0.7071067811865476],\"scale\":[1,1,5]}]",
        PLAIN,
    ));
    let normal = triangles(&scaled)[0].normals.unwrap()[0];
    // (0, 0, 1) of the file is -y after a quarter turn about x, whatever the scale.
    assert!((normal - DVec3::NEG_Y).length() < 1e-6, "{normal}");
}

#[test]
fn what_a_sampler_leaves_open_repeats_and_is_trilinear() {
    let spec = |sampler: &str| {
        let scene = loaded(&file("[{\"mesh\":0}]", &textured(sampler, "\"index\":0", "")));
        scene.samplers[material(&scene).sampler]
    };
    let open = spec("{}");
    let blends = |filter| filter == moire::internal::texture::sampler_spec::basic_filter(true);
    assert!(blends(open.mag) && blends(open.min) && open.mip == MipMode::Linear);
    assert_eq!(open.address, [Address::Repeat; 2]);
    let absent = loaded(&file("[{\"mesh\":0}]", &textured("{}", "\"index\":1", "")));
    assert_eq!(absent.samplers[material(&absent).sampler], open);
    for (number, min, mip) in [
        (9728, false, MipMode::None),
        (9729, true, MipMode::None),
        (9984, false, MipMode::Nearest),
        (9985, true, MipMode::Nearest),
        (9986, false, MipMode::Linear),
        (9987, true, MipMode::Linear),
    ] {
        let found = spec(&format!("{{\"minFilter\":{number}}}"));
        assert_eq!((blends(found.min), found.mip), (min, mip), "{number}");
    }
    for (number, address) in
        [(10497, Address::Repeat), (33648, Address::MirroredRepeat), (33071, Address::ClampToEdge)]
    {
        let found = spec(&format!("{{\"magFilter\":9728,\"wrapS\":{number}}}"));
        assert_eq!((blends(found.mag), found.address), (false, [address, Address::Repeat]));
    }
}

/// KHR_texture_transform: u' = cos u + sin v, v' = cos v − sin u after the scale, then the offset.
#[test]
fn coordinates_are_those_of_their_set_scaled_turned_clockwise_and_moved() {
    let uvs = |base: &str| {
        let scene = loaded(&file("[{\"mesh\":0}]", &textured("{}", base, "")));
        triangles(&scene)[0].uvs
    };
    let near = |found: [DVec2; 3], wanted: [DVec2; 3]| {
        assert!(found.iter().zip(wanted).all(|(a, b)| (*a - b).length() < 1e-6), "{found:?}");
    };
    near(uvs("\"index\":0"), [DVec2::ZERO, DVec2::X, DVec2::Y]);
    near(uvs("\"index\":0,\"texCoord\":1"), [[0.5, 0.5], [0.25, 0.5], [0.5, 0.25]].map(DVec2::from_array));
    let transform = "\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"offset\":[0.5,0.25],\"rotation\":1.5707963267948966,\"scale\":[2,3]}}";
    near(uvs(transform), [DVec2::new(0.5, 0.25), DVec2::new(0.5, -1.75), DVec2::new(3.5, 0.25)]);
    let other = "\"index\":0,\"extensions\":{\"KHR_texture_transform\":{\"texCoord\":1}}";
    near(uvs(other), [[0.5, 0.5], [0.25, 0.5], [0.5, 0.25]].map(DVec2::from_array));
}

#[test]
fn embedded_images_are_colours_and_normal_maps_are_not() {
    let more = ",\"normalTexture\":{\"index\":1,\"scale\":0.5},\"name\":\"brick\"";
    let scene = loaded(&file("[{\"mesh\":0}]", &textured("{}", "\"index\":0", more)));
    let found = material(&scene);
    assert_eq!((found.name.as_str(), found.model), ("brick", Model::PHYSICAL));
    let color = &scene.textures[found.texture.unwrap()];
    assert_eq!(color.color_space, ColorSpace::Srgb);
    let texels = load_texture(color).unwrap();
    assert_eq!((texels.width, texels.height), (2, 2));
    assert_eq!(&texels.texels[..3], [255, 0, 0]);
    let bump = found.bump.unwrap();
    assert_eq!((bump.kind, bump.strength), (BumpKind::NormalDown, 0.5));
    assert_eq!(scene.textures[bump.texture].color_space, ColorSpace::Linear);
    let shown = render(&packed(scene.clone(), None));
    let background = shown.pixels[0];
    assert!(shown.pixels.iter().any(|pixel| *pixel != background));
    assert!(shown.pixels.iter().flatten().all(|value| value.is_finite()));
}

#[test]
fn unlit_materials_show_their_factor() {
    let unlit = "\"materials\":[{\"name\":\"sign\",\"extensions\":{\"KHR_materials_unlit\":{}},\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.2,0.3,1]}}],";
    let scene = loaded(&file("[{\"mesh\":0}]", unlit));
    let found = material(&scene);
    assert_eq!((found.model, found.color), (Model::PLAIN, DVec3::new(0.1, 0.2, 0.3)));
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn the_files_camera_and_lights_are_those_of_the_scene() {
    let nodes = "[{\"mesh\":0,\"children\":[1,2,3]},\
        {\"camera\":0,\"translation\":[0,0,7]},\
        {\"extensions\":{\"KHR_lights_punctual\":{\"light\":0}},\"rotation\":[-0.7071067811865476,0,0,0.7071067811865476]},\
        {\"extensions\":{\"KHR_lights_punctual\":{\"light\":1}},\"translation\":[1,2,3]}]";
    let more = format!(
        "{PLAIN}\"cameras\":[{{\"type\":\"perspective\",\"perspective\":{{\"yfov\":0.5,\"aspectRatio\":2,\"znear\":0.1}}}}],\
         \"extensionsUsed\":[\"KHR_lights_punctual\"],\"extensions\":{{\"KHR_lights_punctual\":{{\"lights\":[\
         {{\"type\":\"directional\",\"intensity\":2,\"color\":[1,0.5,0]}},{{\"type\":\"point\",\"intensity\":3}}]}}}},"
    );
    let scene = loaded(&file(nodes, &more));
    let camera = scene.camera;
    assert!(
        close(camera.eye, DVec3::Z * 7.0)
            && close(camera.look_at, DVec3::Z * 6.0)
            && close(camera.up, DVec3::Y)
    );
    assert!(
        matches!(camera.projection, Projection::VerticalFov(angle) if (angle - 0.5f64.to_degrees()).abs() < 1e-9)
    );
    assert_eq!((scene.width, scene.height), (1024, 512));
    let [Light::Directional { direction, irradiance }, Light::Point { position, intensity }] =
        scene.lights[..]
    else {
        panic!("{:?}", scene.lights);
    };
    // It shines along -z of a node that is turned from -z to -y.
    assert!(
        (direction - DVec3::Y).length() < 1e-6 && close(irradiance, DVec3::new(2.0, 1.0, 0.0)),
        "{direction}"
    );
    assert!(close(position, DVec3::new(1.0, 2.0, 3.0)) && close(intensity, DVec3::splat(3.0)));
    // Without either: seen whole, under lights.
    let plain = loaded(&file("[{\"mesh\":0}]", PLAIN));
    assert!((plain.width, plain.height) == (512, 512) && plain.lights.len() == 2);
}

fn in_scene(folder: &Path, keys: &str) -> moire::internal::core::error::Result<Scene> {
    scene_in(
        folder,
        &format!("[[material]]\nname = 'own'\ncolor = [0.5, 0.5, 0.5]\n[[mesh]]\nfile = 'm.gltf'\n{keys}\n"),
    )
}

#[test]
fn scenes_nodes_and_materials_are_chosen_by_name() {
    let folder = folder_with(&file(NODES, PLAIN));
    let count = |keys: &str| triangles(&in_scene(folder.path(), keys).unwrap()).len();
    assert_eq!([count(""), count("scene = 'other'"), count("node = 'c'"), count("node = 'a'")], [2, 1, 1, 2]);
    let color = |keys: &str| {
        let scene = in_scene(folder.path(), keys).unwrap();
        material(&scene).color
    };
    assert_eq!(color(""), DVec3::ONE);
    assert_eq!(color("material = 'own'"), DVec3::splat(0.5));
    assert_eq!(color("material = { paint = 'own' }"), DVec3::splat(0.5));
    for (keys, parts) in [
        ("scene = 'x'", ["mesh.scene", "\"main\", \"other\""]),
        ("node = 'x'", ["mesh.node", "\"a\", \"b\", \"c\""]),
        ("material = { x = 'own' }", ["mesh.material", "\"paint\""]),
        ("material = { paint = 'x' }", ["mesh.material", "\"x\""]),
        ("material = 3", ["mesh.material", "expected"]),
    ] {
        let said = told(in_scene(folder.path(), keys));
        assert!(parts.iter().all(|part| said.contains(part)), "{keys}: {said}");
    }
}

#[test]
fn a_model_shows_what_the_same_triangles_show_one_by_one() {
    let folder = folder_with(&file("[{\"mesh\":0}]", PLAIN));
    let light = "[[light]]\nkind = 'point'\nposition = [2, 2, 2]\nintensity = [9, 9, 9]\n";
    let model = scene_in(folder.path(), &format!("{light}[[mesh]]\nfile = 'm.gltf'\n")).unwrap();
    let normals = "normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1]]";
    let written = scene_in(
        folder.path(),
        &format!(
            "{light}[[material]]\nname = 'm'\nmodel = 'metallic-roughness'\nroughness = 1\nsides = 'front'\n\
             [[triangle]]\nvertices = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n{normals}\nmaterial = 'm'\n"
        ),
    )
    .unwrap();
    // Normals of meshes have 16 bits in each component.
    let apart = compare(&render(&packed(model, None)), &render(&packed(written, None))).unwrap();
    assert!(apart.rmse < 1e-4, "{apart:?}");
}

#[test]
fn files_that_cannot_be_drawn_are_refused_with_their_place() {
    let required = PLAIN.to_owned()
        + "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],";
    for (text, parts) in [
        (file("[{\"mesh\":7}]", PLAIN), ["/nodes/0/mesh", "7"]),
        (file(NODES, &required), ["/extensionsRequired/0", "KHR_draco_mesh_compression"]),
        ("{".to_owned(), ["as glTF", "line 1"]),
        (file("[{\"mesh\":0,\"children\":[0]}]", PLAIN), ["/nodes/0", "m.gltf"]),
        (file("[{\"mesh\":0}]", &textured("{}", "\"index\":9", "")), ["/materials/0", "9"]),
    ] {
        let said = told(load(&folder_with(&text).path().join("m.gltf")));
        assert!(parts.iter().all(|part| said.contains(part)), "{parts:?}: {said}");
    }
    let missing = "\"images\":[{\"uri\":\"none.png\"}],\"textures\":[{\"source\":0}],\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],";
    let said = told(load(&folder_with(&file("[{\"mesh\":0}]", missing)).path().join("m.gltf")));
    assert!(said.contains("none.png"), "{said}");
}
