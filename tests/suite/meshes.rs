//! Meshes of files in scenes and by themselves: against the same triangles written one by one, under transforms, with
//! the materials of their libraries, and what is said of files that are none.

mod gltf;
mod gltf_materials;
mod instances;
mod interlocked;
mod left_out;
mod libraries;
mod lists;
mod mutated;
mod told;
mod trees;
mod whole;
mod winding;

use std::fs;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};
use moire::internal::mesh::FORMATS;
use moire::internal::scene::model::{AlphaMode, MappingKind, Model, Scene, Triangle};
use moire::internal::scene::{advice, load, parse};
use moire::internal::texture::data::ColorSpace;
use moire::internal::texture::sampler_spec::{Address, MipMode};
use tempfile::{TempDir, tempdir};

use crate::stage::{assert_same_bits, packed, render};
use crate::support::{data, moire, told};

const HEAD: &str =
    "[camera]\neye = [0, 0, 4]\nlook_at = [0, 0, 0]\nvertical_fov = 40\n[image]\nwidth = 24\nheight = 24\n";
const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The path of one of the repository's files, from any folder.
fn absolute(file: &str) -> PathBuf {
    std::path::absolute(data().join(file)).unwrap()
}

fn scene_in(folder: &Path, body: &str) -> moire::internal::core::error::Result<Scene> {
    parse(&folder.join("scene.toml"), &format!("{HEAD}{body}"))
}

fn triangles(folder: &Path, body: &str) -> Vec<Triangle> {
    scene_in(folder, body).unwrap().shapes.triangles
}

fn close(a: DVec3, b: DVec3) -> bool {
    (a - b).length() < 1e-12
}

#[test]
fn triangles_of_a_mesh_are_those_that_are_written_one_by_one() {
    let folder = folder(&[("quad.obj", &format!("{QUAD}f 1/1/1 2/2/1 3/3/1\nf 1/1/1 3/3/1 4/4/1\n"))]);
    let mesh = triangles(folder.path(), "[[mesh]]\nfile = 'quad.obj'\nmotion = [1, 2, 3]\n");
    let normals = "normals = [[0, 0, 1], [0, 0, 1], [0, 0, 1]]\nmotion = [1, 2, 3]\n";
    let written = triangles(
        folder.path(),
        &format!(
            "[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]\nuvs = [[0, 1], [1, 1], [1, 0]]\n{normals}\
             [[triangle]]\nvertices = [[0, 0, 0], [1, 1, 0], [0, 1, 0]]\nuvs = [[0, 1], [1, 0], [0, 0]]\n{normals}"
        ),
    );
    assert_eq!(format!("{mesh:?}"), format!("{written:?}"));
}

/// Positions by T R S, R about x, then y, then z; the same by twelve numbers.
#[test]
fn transforms_scale_then_rotate_then_translate() {
    let folder = folder(&[("t.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")]);
    let of = |transform: &str| {
        triangles(folder.path(), &format!("[[mesh]]\nfile = 't.obj'\ntransform = {transform}\n"))[0].vertices
    };
    // x: (2, 0, 0) stays under the first turn and goes to z = -2; y: (0, 3, 0) goes to z, then to x.
    let [x, y, z] = of("{ translate = [10, 20, 30], rotate = [90, 90, 0], scale = [2, 3, 4] }");
    assert!(close(x, DVec3::new(10.0, 20.0, 28.0)), "{x}");
    assert!(close(y, DVec3::new(13.0, 20.0, 30.0)), "{y}");
    assert!(close(z, DVec3::new(10.0, 16.0, 30.0)), "{z}");
    let rows = of("[0, 3, 0, 10, 0, 0, -4, 20, -2, 0, 0, 30]");
    assert!([x, y, z].iter().zip(rows).all(|(a, b)| close(*a, b)), "{rows:?}");
    assert_eq!(of("{ scale = 2.0 }"), [2.0 * DVec3::X, 2.0 * DVec3::Y, 2.0 * DVec3::Z]);
}

/// Fronts and normals stay on their side whatever the sign of the determinant, and normals stay at right angles to their
/// surface when scales differ.
#[test]
fn mirrored_and_stretched_meshes_keep_front_and_normals() {
    let folder = folder(&[("t.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nvn 1 1 1\nf 1//1 2//1 3//1\n")]);
    for scale in ["[1, 1, 1]", "[-1, 1, 1]", "[1, 3, 1]", "[2, -3, 0.5]", "[-1, -2, -3]"] {
        let body =
            format!("[[mesh]]\nfile = 't.obj'\ntransform = {{ scale = {scale}, rotate = [20, 30, 40] }}\n");
        let triangle = triangles(folder.path(), &body)[0];
        let [a, b, c] = triangle.vertices;
        let flat = (b - a).cross(c - a).normalize();
        let outward = (a + b + c).dot(flat);
        assert!(outward > 0.0, "scale {scale}: inside out");
        for normal in triangle.normals.unwrap() {
            assert!(close(normal, flat), "scale {scale}: normal {normal}, surface {flat}");
        }
    }
}

#[test]
fn materials_of_a_library_become_materials_of_the_scene() {
    let library = "newmtl shiny\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 80\nillum 2\nnewmtl wood\nKd 0.8 0.8 0.8\n\
                   map_Kd -clamp on -s 2 3 -o 0.25 0.5 sub\\wood grain.png\nnewmtl unused\nKd 1 0 0\n";
    let mesh = format!(
        "mtllib a lib.mtl\n{QUAD}usemtl wood\nf 1/1 2/2 3/3\nusemtl shiny\nf 1/1 3/3 4/4\nf 4/4 3/3 1/1\n"
    );
    let folder = folder(&[("quad.obj", &mesh), ("a lib.mtl", library)]);
    fs::create_dir(folder.path().join("sub")).unwrap();
    fs::copy(absolute("textures/tiles.png"), folder.path().join("sub/wood grain.png")).unwrap();
    let scene = scene_in(folder.path(), "[[mesh]]\nfile = 'quad.obj'\n").unwrap();
    let names: Vec<&str> =
        scene.shapes.triangles.iter().map(|t| scene.materials[t.material].name.as_str()).collect();
    assert_eq!(names, ["wood", "shiny", "shiny"]);
    let of = |name: &str| scene.materials.iter().find(|m| m.name == name).unwrap();
    let (shiny, wood) = (of("shiny"), of("wood"));
    assert_eq!((shiny.model, shiny.exponent), (Model::Phong, 80.0));
    assert_eq!(shiny.color, DVec3::new(0.1, 0.2, 0.3));
    assert_eq!((wood.model, wood.mapping.kind), (Model::Lambert, MappingKind::Surface));
    let texture = &scene.textures[wood.texture.unwrap()];
    let file = format!("{:?}", texture.content);
    assert!(file.contains("wood grain.png") && file.contains("sub/"), "{file}");
    assert_eq!(texture.color_space, ColorSpace::Srgb);
    let sampler = scene.samplers[wood.sampler];
    assert_eq!((sampler.address, sampler.mip), ([Address::ClampToEdge; 2], MipMode::Linear));
    // What the library says of (u, v) upwards, said of (u, 1 - v).
    let triangle = &scene.shapes.triangles[0];
    for (given, uv) in [DVec2::ZERO, DVec2::X, DVec2::ONE].into_iter().zip(triangle.uvs) {
        let wanted = DVec2::new(2.0 * given.x + 0.25, 1.0 - (3.0 * given.y + 0.5));
        let found = uv * wood.mapping.scale + wood.mapping.offset;
        assert!((found - wanted).length() < 1e-12, "{given}: {found}, not {wanted}");
    }
    assert!(advice::of_scene(&scene).iter().all(|told| !told.contains("quad.obj")));
    // A study measures anew when one of them changes.
    assert_eq!(scene.sources, ["quad.obj", "a lib.mtl"].map(|file| folder.path().join(file)));
}

#[test]
fn a_material_of_the_scene_replaces_those_of_the_file() {
    let mesh = format!("mtllib none.mtl\n{QUAD}usemtl wood\nf 1/1 2/2 3/3\n");
    let folder = folder(&[("quad.obj", &mesh)]);
    let body =
        "[[material]]\nname = 'a'\n[[material]]\nname = 'b'\n[[mesh]]\nfile = 'quad.obj'\nmaterial = 'b'\n";
    let scene = scene_in(folder.path(), body).unwrap();
    assert_eq!(scene.materials[scene.shapes.triangles[0].material].name, "b");
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
}

#[test]
fn glass_and_physically_based_materials_of_a_library() {
    let library = "newmtl pane\nKd 0 0 0\nTf 0.5 1 1\nNi 1.33\nillum 7\nd 1\nmap_Kd a.png\n\
                   newmtl tinted\nNi 1.5\nillum 4\nd 0.1\nnewmtl opaque\nKs 1 1 1\nNi 1.5\nillum 4\nd 1\n\
                   newmtl veil\nKd 1 0 0\nTr 0.75\nnewmtl steel\nKd 0.5 0.5 0.5\nPr 0.25\nPm 1\nNi 1\n\
                   newmtl orm\nmap_Pr orm.png\nmap_Pm orm.png\nnewmtl two\nPr 0.5\nPm 0.5\nmap_Pr r.png\nmap_Pm m.png\n";
    let names = ["pane", "tinted", "opaque", "veil", "steel", "orm", "two"];
    let faces: String = names.iter().map(|name| format!("usemtl {name}\nf 1/1 2/2 3/3\n")).collect();
    let folder = folder(&[("quad.obj", &format!("mtllib lib.mtl\n{QUAD}{faces}")), ("lib.mtl", library)]);
    fs::copy(absolute("textures/tiles.png"), folder.path().join("orm.png")).unwrap();
    let scene = scene_in(folder.path(), "[[mesh]]\nfile = 'quad.obj'\n").unwrap();
    let of = |name: &str| scene.materials.iter().find(|m| m.name == name).unwrap();
    let pane = of("pane");
    assert_eq!((pane.model, pane.ior, pane.texture), (Model::GLASS, 1.33, None));
    assert_eq!((pane.color, pane.alpha), (DVec3::new(0.5, 1.0, 1.0), AlphaMode::Opaque));
    assert_eq!((of("tinted").model, of("tinted").color), (Model::GLASS, DVec3::ONE));
    assert_eq!((of("opaque").model, of("opaque").alpha), (Model::Phong, AlphaMode::Opaque));
    let veil = of("veil");
    assert_eq!((veil.model, veil.alpha, veil.opacity), (Model::Lambert, AlphaMode::Blend, 0.25));
    let steel = of("steel");
    assert_eq!((steel.model, steel.roughness, steel.metallic, steel.ior), (Model::PHYSICAL, 0.25, 1.0, 1.5));
    let orm = of("orm");
    assert_eq!((orm.roughness, orm.metallic), (1.0, 1.0));
    let map = orm.metallic_roughness_map.unwrap();
    assert_eq!(scene.textures[map.texture].color_space, ColorSpace::Linear);
    assert_eq!(scene.samplers[map.sampler].mip, MipMode::Linear);
    let two = of("two");
    assert_eq!((two.roughness, two.metallic, two.metallic_roughness_map), (0.5, 0.5, None));
    assert!(
        scene.notes.iter().any(|note| note.contains("two") && note.contains("map_Pr")),
        "{:?}",
        scene.notes
    );
}

#[test]
fn missing_libraries_and_materials_are_warnings() {
    let mesh = format!("mtllib none.mtl\n{QUAD}usemtl wood\nf 1/1 2/2 3/3\n");
    let folder = folder(&[("quad.obj", &mesh), ("other.obj", &mesh.replace("none", "lib"))]);
    fs::write(folder.path().join("lib.mtl"), "newmtl steel\n").unwrap();
    for (file, what) in
        [("quad.obj", "none.mtl"), ("other.obj", "1 of its materials are not defined, the first \"wood\"")]
    {
        let scene = scene_in(folder.path(), &format!("[[mesh]]\nfile = '{file}'\n")).unwrap();
        let told = advice::of_scene(&scene).join("\n");
        assert!(told.contains(file) && told.contains(what), "{told}");
        assert_eq!(scene.materials[scene.shapes.triangles[0].material].color, DVec3::ONE);
    }
}

/// The quad of an OBJ file with the upper edge of its picture at v = 1 is the plane with it at v = 0.
#[test]
fn pictures_stand_upright_on_meshes() {
    let tiles = absolute("textures/tiles.png");
    let plane = format!(
        "[[texture]]\nname = 't'\nfile = '{}'\ncolor_space = 'srgb'\n[[sampler]]\nname = 's'\n\
         mip = 'linear'\n[[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n",
        tiles.display()
    );
    let folder = folder(&[("quad.obj", &format!("{QUAD}f 1/1 2/2 3/3 4/4\n"))]);
    let seen =
        |shape: &str| render(&packed(scene_in(folder.path(), &format!("{plane}{shape}")).unwrap(), None));
    let mesh = seen("[[mesh]]\nfile = 'quad.obj'\nmaterial = 'm'\n");
    let written = seen(
        "[[triangle]]\nvertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0]]\nuvs = [[0, 1], [1, 1], [1, 0]]\nmaterial = 'm'\n\
         [[triangle]]\nvertices = [[0, 0, 0], [1, 1, 0], [0, 1, 0]]\nuvs = [[0, 1], [1, 0], [0, 0]]\nmaterial = 'm'\n",
    );
    assert!(mesh.pixels.iter().any(|p| p[0] > 0.1), "nothing is seen");
    assert_same_bits(&mesh, &written, "the quad");
}

/// Every corner is in the picture, and little of it is empty on all sides.
#[test]
fn a_mesh_file_is_a_scene_that_shows_it_whole() {
    for name in ["crate.obj", "gem.stl", "ball.ply"] {
        let scene = load(&data().join("models").join(name)).unwrap();
        let camera = scene.camera;
        let forward = (camera.look_at - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let up = right.cross(forward);
        let half = (0.5 * 35f64.to_radians()).tan();
        let corners = trees::taken_apart(&scene).shapes.triangles.into_iter().flat_map(|t| t.vertices);
        let farthest = corners.fold(0.0f64, |most, corner| {
            let to = corner - camera.eye;
            let depth = to.dot(forward) * half;
            most.max((to.dot(right) / depth).abs()).max((to.dot(up) / depth).abs())
        });
        assert!((0.5..=1.0).contains(&farthest), "{name}: {farthest} of the picture's half");
    }
}

#[test]
fn render_takes_a_mesh_file_in_place_of_a_scene() {
    let folder = tempdir().unwrap();
    let file = absolute("models/crate.obj");
    let mut command = moire();
    command
        .current_dir(folder.path())
        .args(["render", "--spp", "1", "--size", "32x32", "--device", "oracle"]);
    let output = command.arg(&file).args(["-o", "crate.png"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(folder.path().join("crate.png").is_file());
}

#[test]
fn what_is_no_mesh_is_refused_with_its_place() {
    let folder = folder(&[
        ("bad.obj", "v 0 0 0\nv 1 0 x\n"),
        ("index.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n"),
        ("far.obj", "v 0 0 0\nv 1e29 0 0\nv 0 1 0\nf 1 2 3\n"),
        (
            "points.ply",
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n",
        ),
        ("short.stl", "solid\nfacet normal 0 0 1\n"),
        ("mesh.fbx", ""),
    ]);
    for (file, more, parts) in [
        ("bad.obj", "", &["bad.obj as OBJ", "line 2", "\"x\""][..]),
        ("index.obj", "", &["line 3", "9"]),
        ("far.obj", "transform = { scale = 100.0 }", &["position 1", "between -1e30 and 1e30"]),
        ("points.ply", "", &["points.ply as PLY", "no faces"]),
        ("short.stl", "", &["short.stl as STL"]),
        ("mesh.fbx", "", &["mesh.fbx", ".ply, .obj, .stl, .glb, .gltf"]),
        ("none.obj", "", &["none.obj"]),
        ("", "", &["mesh.file"]),
        ("bad.obj", "transform = [1, 2]", &["mesh.transform", "translate, rotate, scale", "12 numbers"]),
        ("bad.obj", "transform = { turn = 1 }", &["turn", "translate, rotate, scale"]),
    ] {
        let body = format!("[[mesh]]\nfile = '{file}'\n{more}\n");
        let said = told(scene_in(folder.path(), &body));
        assert!(parts.iter().all(|part| said.contains(part)), "{file} {more}: {said}");
        assert!(said.contains("scene.toml"), "no place in the scene: {said}");
    }
    let alone = told(load(&folder.path().join("bad.obj")));
    assert!(alone.contains("bad.obj") && alone.contains("line 2"), "{alone}");
}

#[test]
fn more_triangles_than_a_scene_may_have_are_refused() {
    let [ply, obj, stl] = FORMATS;
    let text = format!("{QUAD}f 1 2 3\nf 1 2 4\nf 1 3 4\n");
    let said = (obj.read)(text.as_bytes(), 2).unwrap_err().to_string();
    assert!(said.contains("more than 2 triangles"), "{said}");
    assert!((obj.read)(text.as_bytes(), 3).is_ok());
    for (format, file) in [(ply, "ball.ply"), (stl, "gem.stl")] {
        let bytes = fs::read(data().join("models").join(file)).unwrap();
        let count = (format.read)(&bytes, 1000).unwrap().triangles.len();
        assert!((format.read)(&bytes, count).is_ok());
        let said = (format.read)(&bytes, count - 1).unwrap_err().to_string();
        assert!(said.contains(&format!("more than {} triangles", count - 1)), "{said}");
    }
}

#[test]
fn a_file_of_few_bytes_with_many_triangles_is_refused_by_its_limit() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("many.stl");
    let mut bytes = vec![0; 80];
    bytes.extend_from_slice(&(u32::MAX).to_le_bytes());
    fs::write(&path, bytes).unwrap();
    let error = load(&path).unwrap_err().to_string();
    assert!(error.contains("many.stl"), "{error}");
}
