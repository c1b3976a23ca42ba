//! Meshes of many triangles, through which rays find their way by a tree: the oracle against all triangles tested one by
//! one, the device against the oracle, closed surfaces without a gap, and pictures by every algorithm.

use std::fmt::Write as _;
use std::fs;

use fastrand::Rng;
use glam::{DVec3, Vec3};
use moire::internal::core::film::Film;
use moire::internal::lab::probe::{self, RayQuery};
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::rays::{Hit, hit_surface, nearest_hit, occluded};
use moire::internal::pack::PackedScene;
use moire::internal::scene::model::{Algorithm, Pattern, Scene, Triangle};
use moire::internal::schema::layout::NO_SHAPE;
use moire::internal::tree::{Child, Tree, check};

use super::{folder, scene_in};
use crate::stage::{device, packed, render, render_on_oracle};

const RINGS: usize = 24;
const SPOKES: usize = 48;

/// A closed, bumpy ball around the origin of 2208 triangles, with texture coordinates and, if asked for, normals.
pub fn ball(is_smooth: bool) -> String {
    let mut text = String::new();
    let at = |ring: usize, spoke: usize| {
        let (down, around) = (
            std::f64::consts::PI * ring as f64 / RINGS as f64,
            std::f64::consts::TAU * (spoke % SPOKES) as f64 / SPOKES as f64,
        );
        let way = DVec3::new(down.sin() * around.cos(), down.cos(), down.sin() * around.sin());
        let bumps = 1.0 + 0.1 * (7.0 * way.x).sin() * (5.0 * way.y + 1.0).cos() * (6.0 * way.z).sin();
        (way * bumps, way)
    };
    for ring in 0..=RINGS {
        for spoke in 0..SPOKES {
            // One corner at each pole: equal ones would leave gaps if they were rounded apart.
            let (p, n) = at(ring, if ring % RINGS == 0 { 0 } else { spoke });
            writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
            writeln!(text, "vt {} {}", spoke as f64 / SPOKES as f64, ring as f64 / RINGS as f64).unwrap();
            writeln!(text, "vn {} {} {}", n.x, n.y, n.z).unwrap();
        }
    }
    for ring in 0..RINGS {
        for spoke in 0..SPOKES {
            let index = |ring: usize, spoke: usize| ring * SPOKES + spoke % SPOKES + 1;
            let (a, b) = (index(ring, spoke), index(ring, spoke + 1));
            let (c, d) = (index(ring + 1, spoke + 1), index(ring + 1, spoke));
            let corner = |i: usize| if is_smooth { format!("{i}/{i}/{i}") } else { format!("{i}/{i}") };
            let mut face = |p, q, r| writeln!(text, "f {} {} {}", corner(p), corner(q), corner(r)).unwrap();
            if ring > 0 {
                face(a, b, c);
            }
            if ring + 1 < RINGS {
                face(a, c, d);
            }
        }
    }
    text
}

const SECTION: &str = "[[mesh]]\nfile = 'ball.obj'\n";

fn loaded(is_smooth: bool, body: &str) -> Scene {
    let folder = folder(&[("ball.obj", &ball(is_smooth))]);
    scene_in(folder.path(), body).unwrap()
}

/// The scene with the triangles of its meshes one by one.
pub fn taken_apart(scene: &Scene) -> Scene {
    let mut apart = scene.clone();
    for mesh in std::mem::take(&mut apart.shapes.meshes) {
        mesh.for_each(1, |triangle: Triangle| apart.shapes.triangles.push(triangle));
    }
    apart
}

pub fn ray_of(query: &RayQuery) -> Ray {
    let part = |v: [f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    Ray { origin: part(query.origin), direction: part(query.direction), time: query.origin[3].into() }
}

/// Rays from around the ball, which is at `center` as seen from the eye, and from within it, some along the axes, some
/// through corners and edges, of any length.
pub fn queries(center: DVec3, corners: &[DVec3], count: usize) -> Vec<RayQuery> {
    let mut random = Rng::with_seed(5);
    let mut vector =
        |scale: f64| DVec3::new(random.f64() - 0.5, random.f64() - 0.5, random.f64() - 0.5) * (2.0 * scale);
    (0..count)
        .map(|i| {
            let origin = center + vector(if i % 3 == 0 { 0.4 } else { 3.0 });
            let corner = corners[i * 7919 % corners.len()];
            let target = match i % 5 {
                0 => corner,
                1 => 0.5 * (corner + corners[(i * 7919 + 1) % corners.len()]),
                2 => origin + DVec3::AXES[i / 5 % 3] * if i % 2 == 0 { 1.0 } else { -1.0 },
                _ => center + vector(1.2),
            };
            let direction = (target - origin) * (0.1 + 3.0 * vector(0.5).x.abs());
            let all = |v: DVec3, w: f64| v.extend(w).as_vec4().to_array();
            RayQuery { origin: all(origin, 0.0), direction: all(direction, 2.0) }
        })
        .collect()
}

/// The corners of all triangles as seen from the eye.
pub fn corners_of(scene: &Scene) -> Vec<DVec3> {
    let apart = taken_apart(scene);
    apart.shapes.triangles.iter().flat_map(|t| t.vertices).map(|v| v - scene.camera.eye).collect()
}

#[test]
fn few_triangles_stay_single_and_many_become_one_shape_of_each_material() {
    let library = "newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n";
    let lines: Vec<String> = ball(false).lines().map(String::from).collect();
    let (vertices, faces): (Vec<_>, Vec<_>) = lines.iter().partition(|line| line.starts_with('v'));
    let join = |lines: &[&String]| lines.iter().map(|l| format!("{l}\n")).collect::<String>();
    let vertices = join(&vertices);
    let text = format!(
        "mtllib two.mtl\n{vertices}usemtl a\n{}usemtl b\n{}usemtl a\n{}f 1 1 2\n",
        join(&faces[..1000]),
        join(&faces[1000..1500]),
        join(&faces[1500..])
    );
    let folder = folder(&[("ball.obj", &text), ("two.mtl", library)]);
    let scene = scene_in(folder.path(), SECTION).unwrap();
    let counts: Vec<usize> = scene.shapes.meshes.iter().map(|mesh| mesh.triangle_count()).collect();
    assert_eq!((counts, scene.shapes.triangles.len()), (vec![faces.len() - 500, 500], 0));
    assert!(
        scene.notes.iter().any(|note| note.contains("left out 1 triangle that has no area")),
        "{:?}",
        scene.notes
    );
    fs::write(folder.path().join("ball.obj"), format!("{vertices}{}", join(&faces[..64]))).unwrap();
    let scene = scene_in(folder.path(), SECTION).unwrap();
    assert_eq!((scene.shapes.meshes.len(), scene.shapes.triangles.len()), (0, 64));
}

#[test]
fn the_packed_tree_holds_every_triangle_in_boxes_that_contain_it() {
    let scene = packed(loaded(true, SECTION), None);
    let mesh = scene.records.meshes[0];
    let count = (scene.mesh_texels.len() - mesh.attributes as usize) / 4;
    let texels = |from: u32, to: u32| &scene.mesh_texels[from as usize..to as usize];
    let corners = texels(mesh.corners, mesh.attributes);
    let boxes: Vec<_> = corners
        .chunks(3)
        .map(|triangle| {
            let [a, b, c] = [0, 1, 2].map(|k| {
                let [x, y, z, _] = triangle[k].map(f32::from_bits);
                Vec3::new(x, y, z)
            });
            [a.min(b).min(c), a.max(b).max(c)]
        })
        .collect();
    // Nodes and triangles are named by their first texel.
    let numbered = |child: &Child| Child {
        reference: match child.count {
            _ if !child.is_used() => child.reference,
            0 => (child.reference - mesh.nodes) / 2,
            _ => (child.reference - mesh.corners) / 3,
        },
        ..*child
    };
    let children: &[Child] = bytemuck::cast_slice(texels(mesh.nodes, mesh.corners));
    let children: Vec<Child> = children.iter().map(numbered).collect();
    // In the order of the leaves already.
    let order = (0..boxes.len() as u32).collect();
    let depth = depth_of(&children, 0);
    let tree = Tree { children, order, width: 4, depth };
    check(&tree, &boxes).unwrap();
    assert_eq!((count, boxes.len()), (2208, 2208));
}

fn depth_of(children: &[Child], node: usize) -> u32 {
    let own = &children[node..node + 4];
    let below = own.iter().filter(|child| child.count == 0 && child.is_used());
    1 + below.map(|child| depth_of(children, child.reference as usize)).max().unwrap_or(0)
}

#[test]
fn the_oracle_meets_by_the_tree_what_it_meets_one_by_one() {
    let scene = loaded(false, SECTION);
    let corners = corners_of(&scene);
    let (by_tree, one_by_one) = (packed(scene.clone(), None), packed(taken_apart(&scene), None));
    assert_eq!((by_tree.records.meshes.len(), one_by_one.records.triangles.len()), (1, 2208));
    let mut met = 0;
    for query in queries(-scene.camera.eye, &corners, 6000) {
        let ray = ray_of(&query);
        let [found, wanted] = [&by_tree, &one_by_one].map(|scene| nearest_hit(scene, &ray, NO_SHAPE));
        // Rays through corners and edges may be on either side of a silhouette.
        let near = (found.t - wanted.t).abs() <= 1e-5 * wanted.t;
        let by_silhouette = || {
            let aside = Ray {
                direction: ray.direction + 1e-6 * ray.direction.length() * DVec3::new(1.0, -0.7, 0.4),
                ..ray
            };
            let t = nearest_hit(&one_by_one, &aside, NO_SHAPE).t;
            (t - found.t).abs() <= 1e-4 * t.min(1e6)
        };
        assert!(near || by_silhouette(), "{query:?}: {found:?}, one by one {wanted:?}");
        met += usize::from(found.shape != NO_SHAPE);
        if near && found.shape != NO_SHAPE {
            let [found, wanted] =
                [(&by_tree, found), (&one_by_one, wanted)].map(|(s, h)| hit_surface(s, &ray, &h));
            assert!((found.point - wanted.point).length() < 1e-4, "{query:?}");
            let t_max = f64::from(query.direction[3]);
            assert_eq!(
                occluded(&by_tree, &ray, t_max, NO_SHAPE),
                nearest_hit(&by_tree, &ray, NO_SHAPE).t < t_max,
                "{query:?}"
            );
        }
    }
    assert!(met > 3000, "{met}");
}

pub fn compare_device(scene: &PackedScene, queries: &[RayQuery], keep_everything: bool) {
    let answers = probe::rays(&device(), scene, keep_everything, queries).unwrap();
    let (mut undecided, mut beside, mut met) = (0, 0, 0);
    for (query, answer) in queries.iter().zip(&answers) {
        let ray = ray_of(query);
        let hit: Hit = nearest_hit(scene, &ray, NO_SHAPE);
        let t = f64::from(answer.t);
        if (hit.shape != answer.shape) || (hit.shape != NO_SHAPE && (t - hit.t).abs() > 1e-4 * hit.t) {
            // By the silhouette.
            undecided += 1;
            continue;
        }
        if hit.shape == NO_SHAPE {
            continue;
        }
        met += 1;
        let surface = hit_surface(scene, &ray, &hit);
        let point = DVec3::new(answer.point[0].into(), answer.point[1].into(), answer.point[2].into());
        let normal = DVec3::new(answer.normal[0].into(), answer.normal[1].into(), answer.normal[2].into());
        // Where a ray grazes a triangle, roundings reach far along it.
        let cosine = surface.geometric_normal.dot(ray.direction).abs() / ray.direction.length();
        let error = 4e-6 * surface.size / cosine;
        assert!((point - surface.point).length() < error, "{query:?}: {answer:?}, {surface:?}");
        beside += usize::from((normal - surface.normal).length() > 1e-3);
    }
    let count = queries.len();
    // Two fifths of the rays go through corners and edges, where the next triangle has another normal.
    assert!(undecided * 50 < count && beside * 5 < count, "{undecided} and {beside} of {count}");
    assert!(met * 3 > count, "{met} of {count}");
}

#[test]
fn the_device_meets_what_the_oracle_meets() {
    for (is_smooth, section) in
        [(true, SECTION), (false, "[[mesh]]\nfile = 'ball.obj'\nmotion = [0.5, 0, 0]\n")]
    {
        let scene = loaded(is_smooth, section);
        let queries = queries(-scene.camera.eye, &corners_of(&scene), 4000);
        let scene = packed(scene, None);
        for keep_everything in [false, true] {
            compare_device(&scene, &queries, keep_everything);
        }
    }
}

#[test]
fn no_ray_leaves_a_closed_mesh_without_meeting_it() {
    let scene = loaded(false, SECTION);
    let corners = corners_of(&scene);
    let center = -scene.camera.eye;
    let scene = packed(scene, None);
    let mut random = Rng::with_seed(9);
    let queries: Vec<RayQuery> = (0..20_000)
        .map(|i| {
            let mut part = || random.f64() - 0.5;
            let origin = center + 0.8 * DVec3::new(part(), part(), part());
            // Half of them through edges, where a ray may pass between two triangles.
            let (a, b) = (corners[i % corners.len()], corners[(i + 1) % corners.len()]);
            let target = if i % 2 == 0 {
                a + (b - a) * (part() + 0.5)
            } else {
                center + DVec3::new(part(), part(), part())
            };
            let all = |v: DVec3, w: f64| v.extend(w).as_vec4().to_array();
            RayQuery { origin: all(origin, 0.0), direction: all(target - origin, 1e3) }
        })
        .collect();
    let answers = probe::rays(&device(), &scene, false, &queries).unwrap();
    for (query, answer) in queries.iter().zip(&answers) {
        assert_eq!((answer.shape, answer.occluded), (0, 1), "{query:?}");
        assert_ne!(nearest_hit(&scene, &ray_of(query), NO_SHAPE).shape, NO_SHAPE, "{query:?}");
    }
}

/// The root of the mean square of the differences.
pub fn apart(a: &Film, b: &Film) -> f64 {
    let differences =
        a.pixels.iter().zip(&b.pixels).flat_map(|(a, b)| (0..3).map(move |i| f64::from(a[i] - b[i])));
    let (sum, count) = differences.fold((0.0, 0), |(sum, count), d| (sum + d * d, count + 1));
    (sum / f64::from(count)).sqrt()
}

#[test]
fn every_algorithm_shows_a_mesh() {
    let lit = "[[light]]\nkind = 'directional'\ndirection = [1, 1, 1]\nirradiance = [3, 3, 3]\n[[mesh]]\nfile = 'ball.obj'\n";
    let mut scene = loaded(true, lit);
    scene.sampling.spp = 256;
    scene.sampling.pattern = Pattern::SobolOwen;
    let wanted = render_on_oracle(&packed(taken_apart(&scene), None));
    for (algorithm, bound) in [
        (Algorithm::Samples, 0.01),
        (Algorithm::Adaptive, 0.02),
        (Algorithm::Beam, 0.01),
        (Algorithm::Cone, 0.2),
    ] {
        scene.sampling.algorithm = algorithm;
        let found = apart(&render(&packed(scene.clone(), None)), &wanted);
        assert!(found < bound, "{algorithm}: {found}");
    }
}
