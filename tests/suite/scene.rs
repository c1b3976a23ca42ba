//! Parsing of scene text into `Scene`: defaults, every key of the vocabulary, and files that cannot
//! be read.

mod errors;
mod set;
mod settings;
mod shapes;
mod surfaces;
mod text;

use std::path::Path;

use glam::{DVec2, DVec3};
use moire::internal::core::error::Error;
use moire::internal::scene::model::*;
use moire::internal::scene::{load, parse};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec, TexelCenter};
use moire::internal::texture::source::{OrientationUse, ProfileUse, ReadOptions};

use crate::support::thread_seconds;

const HEAD: &str = "\
[camera]
eye = [0, 1, 5]
look_at = [0, 1, 0]
vertical_fov = 60

[image]
width = 64
height = 48
";

const FULL: &str = r#"
[camera]
eye = [2.0, 1.5, 2]
look_at = [0.0, 0.5, 0.0]
up = [0.0, 0.0, 1.0]
camera_constant = 1

[image]
width = 512
height = 256

[sampling]
algorithm = "samples"
pattern = "stratified"
spp = 25
shared = true
seed = 0xffff_ffff
max_depth = 64
footprint = "none"

[background]
color = [0.1, 0.3, 0.6]

[[texture]]
name = "ground"
file = "textures/grass.png"
color_space = "srgb"
orientation = "ignore"
color_profile = "ignore"
layer = "diffuse"
flip_v = true

[[texture]]
name = "plain"
file = "/absolute/plain.png"

[[sampler]]
name = "per-axis"
address = ["mirrored-repeat", "clamp-to-border"]
filter = { min = "nearest" }
border_color = [1, 0.5, 0.25, 1]
mip = "linear"
method = "hardware"
texel_center = "integer"

[[sampler]]
name = "near"
address = "mirror-clamp-to-edge"
filter = "nearest"

[[material]]
name = "m"
model = "unlit"
color = [1.0, 2.0, 3.0]
texture = "plain"
sampler = "near"
mapping = { kind = "cylindrical", entity = "position", space = "bounds", origin = [1, 2, 3], axis = [0, 0, 2], scale = [0.2, -0.5], offset = [7, 8], rotate = 90 }

[[material]]
name = "glass"
model = "mirror"
mapping.scale = 0.5

[[material]]
name = "no sampler named"
texture = "ground"

[[plane]]
origin = [0, -1, 0]
tangent = [-2, 0, 0]
bitangent = [0, 0, 1]
half_extent = 1000
material = "glass"

[[sphere]]
center = [0, 0.5, 0]
radius = 0.3

[[triangle]]
vertices = [[-0.2, 0.1, 0.9], [0.2, 0.1, 0.9], [-0.2, 0.1, -0.1]]
uvs = [[0, 1], [2, 3], [4, 5]]
normals = [[0, 1, 0], [0, 2, 0], [0, 3, 0]]
material = "no sampler named"

[[light]]
kind = "point"
position = [0, 1, 0]
intensity = [2.5, 2.5, 2.5]

[[light]]
kind = "directional"
direction = [1, 1, 1]
irradiance = [0, 0, 3]
"#;

fn parsed(text: &str) -> Scene {
    parse(Path::new("scenes/a.toml"), text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[test]
fn keys_left_out_have_the_documented_defaults() {
    let triangle = "[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n";
    let textured = "[[texture]]\nname = 't'\nfile = 't.png'\n[[material]]\nname = 'm'\ntexture = 't'\n";
    let scene = parsed(&format!("{HEAD}{triangle}{textured}[[sampler]]\nname = 's'\n"));

    assert_eq!(scene.path, Path::new("scenes/a.toml"));
    assert_eq!((scene.width, scene.height), (64, 48));
    assert_eq!(scene.camera.up, DVec3::Y);
    assert_eq!(scene.camera.projection, Projection::VerticalFov(60.0));
    let sampling = Sampling {
        algorithm: Algorithm::Samples,
        pattern: Pattern::Stratified,
        spp: 16,
        shared: false,
        seed: 1,
        max_depth: 5,
        footprint: Footprint::None,
        precision: Precision::Auto,
        quantity: Default::default(),
    };
    assert_eq!(scene.sampling, sampling);
    assert_eq!(scene.background.color, DVec3::ZERO);
    assert!(scene.lights.is_empty());

    let texture = &scene.textures[0];
    assert_eq!(texture.content.files(), ["scenes/t.png"].map(Path::new));
    assert_eq!((texture.color_space, texture.flip_v), (ColorSpace::Linear, false));
    assert_eq!((texture.color_space_stated, &texture.reading), (false, &ReadOptions::default()));
    assert_eq!(texture.reading.orientation, OrientationUse::Apply);
    let sampler = SamplerSpec {
        address: [Address::Repeat; 2],
        mag: Filter::Linear,
        min: Filter::Linear,
        mip: MipMode::None,
        stored_levels: false,
        min_lod: 0.0,
        border_color: [0.0; 4],
        method: Method::Shader,
        texel_center: TexelCenter::Half,
        address_w: Address::Repeat,
        max_anisotropy: 16,
        cubic: [0.0, 0.5],
    };
    assert_eq!(scene.samplers, [sampler; 2], "the scene's own and an appended default one");
    assert_eq!(scene.materials[0].sampler, 1, "a texture without sampler gets the appended one");

    let triangle = &scene.shapes.triangles[0];
    assert_eq!(triangle.uvs, [DVec2::ZERO, DVec2::X, DVec2::Y]);
    assert!(triangle.normals.is_none());
    let material = &scene.materials[triangle.material];
    assert_eq!((material.name.as_str(), material.model), ("default", Model::Lambert));
    assert_eq!((material.color, material.texture), (DVec3::ONE, None));
    assert_eq!(material.mapping.kind, MappingKind::Surface);
    assert_eq!((material.mapping.scale, material.mapping.offset), (DVec2::ONE, DVec2::ZERO));
}

#[test]
fn a_scene_without_shapes_has_only_a_background() {
    let scene = parsed(HEAD);
    assert!(
        scene.shapes.planes.is_empty()
            && scene.shapes.spheres.is_empty()
            && scene.shapes.triangles.is_empty()
    );
    assert!(scene.materials.is_empty(), "no default material without a shape that needs it");
    assert!(scene.samplers.is_empty(), "no default sampler without a texture that needs it");
}

#[test]
fn every_key_of_a_full_scene_arrives() {
    let scene = parsed(FULL);
    assert_eq!(scene.camera.eye, DVec3::new(2.0, 1.5, 2.0));
    assert_eq!(scene.camera.look_at, DVec3::new(0.0, 0.5, 0.0));
    assert_eq!(scene.camera.up, DVec3::Z);
    assert_eq!(scene.camera.projection, Projection::CameraConstant(1.0));
    assert_eq!((scene.width, scene.height), (512, 256));
    let Sampling { spp, shared, seed, max_depth, .. } = scene.sampling;
    assert_eq!((spp, shared, seed, max_depth), (25, true, u32::MAX, 64));
    assert_eq!(scene.background.color, DVec3::new(0.1, 0.3, 0.6));

    let [ground, plain] = scene.textures.as_slice() else { panic!("two textures") };
    assert_eq!(ground.content.files(), ["scenes/textures/grass.png"].map(Path::new));
    assert_eq!((ground.color_space, ground.flip_v), (ColorSpace::Srgb, true));
    let reading = ReadOptions {
        orientation: OrientationUse::Ignore,
        color_profile: ProfileUse::Ignore,
        layer: Some("diffuse".into()),
    };
    assert_eq!((ground.color_space_stated, &ground.reading), (true, &reading));
    assert_eq!(plain.content.files(), ["/absolute/plain.png"].map(Path::new));

    let [per_axis, near, appended] = scene.samplers.as_slice() else { panic!("three samplers") };
    assert_eq!(per_axis.address, [Address::MirroredRepeat, Address::ClampToBorder]);
    assert_eq!(
        (per_axis.mag, per_axis.min, per_axis.mip),
        (Filter::Linear, Filter::Nearest, MipMode::Linear)
    );
    assert_eq!(per_axis.border_color, [1.0, 0.5, 0.25, 1.0]);
    assert_eq!((per_axis.method, per_axis.texel_center), (Method::Hardware, TexelCenter::Integer));
    assert_eq!((near.address, near.mag), ([Address::MirrorClampToEdge; 2], Filter::Nearest));
    assert_eq!((near.min, *appended), (Filter::Nearest, SamplerSpec::default()));

    let [m, glass, ground_material, default] = scene.materials.as_slice() else { panic!("four materials") };
    assert_eq!((m.model, m.color), (Model::Unlit, DVec3::new(1.0, 2.0, 3.0)));
    assert_eq!((m.texture, m.sampler), (Some(1), 1));
    let Mapping { kind, entity, space, origin, axis, scale, offset, rotate, scale_w, offset_w } = m.mapping;
    assert_eq!((kind, entity, space), (MappingKind::Cylindrical, Entity::Position, Space::Bounds));
    assert_eq!((origin, axis), (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 0.0, 2.0)));
    assert_eq!((scale, offset, rotate), (DVec2::new(0.2, -0.5), DVec2::new(7.0, 8.0), 90.0));
    assert_eq!((scale_w, offset_w), (1.0, 0.0));
    assert_eq!((glass.model, glass.mapping.scale), (Model::Mirror, DVec2::splat(0.5)));
    assert_eq!((ground_material.texture, ground_material.sampler), (Some(0), 2));
    assert_eq!(default.name, "default");

    let plane = scene.shapes.planes[0];
    assert_eq!((plane.origin, plane.tangent, plane.bitangent), (-DVec3::Y, -2.0 * DVec3::X, DVec3::Z));
    assert_eq!((plane.half_extent, plane.material), (Some(1000.0), 1));
    let sphere = scene.shapes.spheres[0];
    assert_eq!((sphere.center, sphere.radius, sphere.material), (DVec3::new(0.0, 0.5, 0.0), 0.3, 3));
    let triangle = scene.shapes.triangles[0];
    assert_eq!(triangle.vertices[2], DVec3::new(-0.2, 0.1, -0.1));
    assert_eq!(triangle.uvs, [DVec2::new(0.0, 1.0), DVec2::new(2.0, 3.0), DVec2::new(4.0, 5.0)]);
    assert_eq!(triangle.normals, Some([DVec3::Y, DVec3::Y * 2.0, DVec3::Y * 3.0]));
    assert_eq!(triangle.material, 2);
    let [Light::Point { position, intensity }, Light::Directional { direction, irradiance }] =
        scene.lights[..]
    else {
        panic!("a point light, then a directional one")
    };
    assert_eq!((position, intensity), (DVec3::Y, DVec3::splat(2.5)));
    assert_eq!((direction, irradiance), (DVec3::ONE, DVec3::Z * 3.0));
}

#[test]
fn orthographic_cameras_and_every_name_of_the_vocabulary_parse() {
    let scene = parsed(&HEAD.replace("vertical_fov = 60", "orthographic_height = 2"));
    assert_eq!(scene.camera.projection, Projection::Orthographic(2.0));
    let body = |section: &str, key: &str, name: &str| {
        parsed(&format!("{HEAD}[[{section}]]\nname = 'x'\n{key} = '{name}'\n"))
    };
    for pattern in Pattern::ALL {
        let scene = parsed(&format!("{HEAD}[sampling]\npattern = '{pattern}'\nspp = 4\n"));
        assert_eq!(scene.sampling.pattern, *pattern);
    }
    for model in Model::ALL {
        assert_eq!(body("material", "model", model.name()).materials[0].model, *model);
    }
    for kind in MappingKind::ALL {
        assert_eq!(body("material", "mapping.kind", kind.name()).materials[0].mapping.kind, *kind);
    }
    for address in Address::ALL {
        assert_eq!(body("sampler", "address", address.name()).samplers[0].address, [*address; 2]);
    }
    for mip in MipMode::ALL {
        assert_eq!(body("sampler", "mip", mip.name()).samplers[0].mip, *mip);
    }
}

/// The keys that a message lists as allowed are those that the section reads: each is refused by its name if its value
/// is a date, a type that no key accepts.
#[test]
fn every_key_listed_as_allowed_is_read() {
    let material = "[[texture]]\nname = 't'\nfile = 't'\n[[material]]\nname = 'm'\n";
    let sections = [
        ("[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 60\n", 10),
        ("[[texture]]\nname = 'x'\nfile = 'x'\n", 26),
        ("[[texture]]\nname = 'x'\n[texture.volume]\nfile = 'x'\nsize = [1, 1, 1]\nformat = 'grey8'\n", 5),
        ("[[sampler]]\nname = 'x'\n", 9),
        ("[[material]]\nname = 'x'\n", 30),
        ("[sampling]\n", 8),
        ("[background]\n", 6),
        ("[image]\nwidth = 1\nheight = 1\n", 5),
        ("[[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\n", 6),
        ("[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\n", 4),
        ("[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]\n", 5),
        ("[[light]]\nkind = 'point'\nposition = [0, 0, 0]\nintensity = [0, 0, 0]\n", 13),
        ("[[material]]\nname = 'y'\n[material.mapping]\nkind = 'planar'\n", 8),
        ("[[sampler]]\nname = 'y'\n[sampler.filter]\n", 2),
    ];
    for (section, count) in sections {
        let header = section.split('\n').next().unwrap();
        let camera = "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\nvertical_fov = 60\n";
        let others = match header {
            "[camera]" => format!("[image]\nwidth = 1\nheight = 1\n{material}"),
            "[image]" => format!("{camera}{material}"),
            _ => format!("{HEAD}{material}"),
        };
        let fails = |text: &str| {
            let text = format!("{others}{text}");
            parse(Path::new("a.toml"), &text).expect_err(&text).to_string()
        };
        let message = fails(&format!("{section}qqqqqqqq = 1\n"));
        let (_, allowed) = message.split_once("allowed: ").unwrap_or_else(|| panic!("{message}"));
        let allowed: Vec<&str> = allowed.split(", ").collect();
        assert_eq!(allowed.len(), count, "{message}");
        for key in allowed {
            // A pattern stands in place of a file.
            let replaced = if key == "procedural" { "file" } else { key };
            let kept: String = section
                .lines()
                .filter(|line| !line.starts_with(&format!("{replaced} =")))
                .map(|line| format!("{line}\n"))
                .collect();
            let message = fails(&format!("{kept}{key} = 1979-05-27\n"));
            let named = message.contains(&format!(".{key}\"")) || message.contains(&format!("\"{key}\""));
            assert!(named, "{header} {key}: {message}");
        }
    }
}

#[test]
fn loading_reads_a_file_and_joins_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, format!("{HEAD}[[texture]]\nname = 't'\nfile = 'sub/t.png'\n")).unwrap();
    let scene = load(&path).unwrap();
    assert_eq!(
        scene.textures[0].content.files(),
        [folder.path().join("sub/t.png")],
        "not opened, only joined"
    );
    let beside = parse(Path::new("a.toml"), FULL).unwrap();
    assert_eq!(beside.textures[0].content.files(), ["textures/grass.png"].map(Path::new));
}

#[test]
fn unreadable_scene_files_say_which_and_why() {
    let folder = tempfile::tempdir().unwrap();
    let missing = folder.path().join("missing.toml");
    let message = load(&missing).unwrap_err().to_string();
    assert!(message.contains("missing.toml") && message.contains("No such file"), "{message}");

    let message = load(folder.path()).unwrap_err().to_string();
    assert!(message.contains(&folder.path().display().to_string()), "{message}");
    assert!(message.contains("folder"), "{message}");

    let latin = folder.path().join("latin.toml");
    std::fs::write(&latin, b"[camera]\n# caf\xe9\n").unwrap();
    let error = load(&latin).unwrap_err();
    let message = error.to_string();
    assert!(message.contains("latin.toml: not UTF-8 text (byte 0xe9 at offset 14, line 2)"), "{message}");
    assert!(matches!(error, Error::Plain { help: Some(help), .. } if help.contains("UTF-8")));
}

/// Returns a scene of this many triangles and materials, each of which is looked up by its name.
fn of_names(count: usize) -> String {
    let mut text = HEAD.to_owned();
    for i in 0..count {
        text += &format!(
            "[[triangle]]\nvertices = [[{i}, 0, 0], [1, {i}.5, 0], [0, 1, {i}]]\n\
             uvs = [[0, 0], [1, 0], [0, 1]]\nmaterial = 'm{}'\n[[material]]\nname = 'm{i}'\n",
            count - 1 - i
        );
    }
    text
}

/// Look-ups of quadratic cost in the number of names take more than 30 times as long for eight times as many names.
/// CPU time is compared, and the least of some measurements, so that a busy machine changes nothing.
#[test]
fn eight_times_as_many_triangles_and_names_take_no_more_than_sixteen_times_as_long() {
    let [few, many] = [5_000, 40_000].map(of_names);
    let scene = parsed(&many);
    assert_eq!((scene.shapes.triangles.len(), scene.shapes.triangles[0].material), (40_000, 39_999));
    let seconds = |text: &str| {
        let before = thread_seconds();
        drop(parsed(text));
        thread_seconds() - before
    };
    let mut least = [f64::INFINITY; 2];
    for _ in 0..20 {
        for (least, text) in least.iter_mut().zip([&few, &many]) {
            *least = least.min(seconds(text));
        }
        if least[1] < 16.0 * least[0] {
            return;
        }
    }
    panic!("{} s for 5000 names, {} s for 40000", least[0], least[1]);
}
