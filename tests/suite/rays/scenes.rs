//! Random scenes of one kind of shape or all, each shape with its own mapping, and rays into them.

use std::fmt::Write as _;
use std::path::Path;

use glam::{DVec3, Vec3};
use moire::internal::lab::probe::RayQuery;
use moire::internal::pack::{self, PackedScene};
use moire::internal::scene;
use moire::internal::texture::data::{ColorSpace, TexelFormat};

use crate::lookup::bench::{Rng, Vectors, texture};

/// The eye is away from the world's origin, as packed values are relative to it.
const HEAD: &str = "camera = { eye = [3.0, -2.0, 5.0], look_at = [0.0, 0.0, 0.0], vertical_fov = 60.0 }
image = { width = 1, height = 1 }
[[texture]]
name = \"t\"
file = \"t.png\"
[[sampler]]
name = \"s\"
address = \"clamp-to-edge\"
";

pub fn pack_text(text: &str) -> PackedScene {
    let scene = scene::parse(Path::new("test.toml"), text).unwrap();
    let textures = scene.textures.iter().map(|_| texture(2, 2, TexelFormat::Rgba8, ColorSpace::Linear, 1));
    let textures = textures.collect();
    pack::pack(&scene, textures, None).unwrap()
}

fn three(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}

/// Materials m0, m1, …: the four kinds of mapping in turn, with scale, rotation and offset.
fn materials(rng: &mut Rng, count: usize) -> String {
    let mut text = HEAD.to_string();
    for i in 0..count {
        let kind = ["surface", "planar", "cylindrical", "spherical"][i % 4];
        let frame = if kind == "surface" {
            String::new()
        } else {
            let space = if i % 3 == 0 { "bounds" } else { "world" };
            format!(
                ", origin = {}, axis = {}, space = \"{space}\"",
                three(rng.vector(0.5)),
                three(rng.direction())
            )
        };
        let (sx, sy) = (rng.between(0.2, 2.0), rng.between(-2.0, -0.2));
        let (ox, oy, turn) = (rng.between(-1.0, 1.0), rng.between(-1.0, 1.0), rng.between(-180.0, 180.0));
        write!(
            text,
            "[[material]]\nname = \"m{i}\"\ntexture = \"t\"\nsampler = \"s\"\nmapping = {{ kind = \"{kind}\"{frame}, \
             scale = [{sx:?}, {sy:?}], offset = [{ox:?}, {oy:?}], rotate = {turn:?} }}\n"
        )
        .unwrap();
    }
    text
}

fn add_plane(text: &mut String, rng: &mut Rng, material: usize, bounded: bool) {
    let tangent = rng.direction() * rng.between(0.5, 2.0);
    let across = tangent.cross(rng.direction());
    let bitangent = across.normalize() * rng.between(0.5, 2.0) + 0.3 * tangent;
    let extent = if bounded { format!("half_extent = {:?}\n", rng.between(0.5, 2.0)) } else { String::new() };
    let (origin, tangent, bitangent) = (three(rng.vector(4.0)), three(tangent), three(bitangent));
    write!(
        text,
        "[[plane]]\norigin = {origin}\ntangent = {tangent}\nbitangent = {bitangent}\n{extent}material = \"m{material}\"\n"
    )
    .unwrap();
}

fn add_sphere(text: &mut String, rng: &mut Rng, material: usize) {
    let (center, radius) = (three(rng.vector(4.0)), rng.between(0.2, 2.5));
    write!(text, "[[sphere]]\ncenter = {center}\nradius = {radius:?}\nmaterial = \"m{material}\"\n").unwrap();
}

fn add_disc(text: &mut String, rng: &mut Rng, material: usize, uv: &str) {
    let (center, normal, radius) = (three(rng.vector(4.0)), three(rng.direction()), rng.between(0.2, 2.5));
    write!(
        text,
        "[[disc]]\ncenter = {center}\nnormal = {normal}\nradius = {radius:?}\nuv = \"{uv}\"\nmaterial = \"m{material}\"\n"
    )
    .unwrap();
}

fn add_triangle(text: &mut String, rng: &mut Rng, material: usize, smooth: bool) {
    let place = rng.vector(3.0);
    let vertices = [0, 1, 2].map(|_| three(place + rng.vector(2.5))).join(", ");
    write!(text, "[[triangle]]\nvertices = [{vertices}]\nmaterial = \"m{material}\"\n").unwrap();
    if smooth {
        let way = rng.direction();
        let normals = [0, 1, 2].map(|_| three(way + rng.vector(0.3))).join(", ");
        writeln!(text, "normals = [{normals}]").unwrap();
    }
}

pub fn planes(rng: &mut Rng) -> PackedScene {
    let mut text = materials(rng, 8);
    // World space for shapes without bounds: materials 1, 2, 4, 5, 7 are not in "bounds".
    add_plane(&mut text, rng, 4, false);
    add_plane(&mut text, rng, 7, false);
    for i in 0..8 {
        add_plane(&mut text, rng, i, true);
    }
    pack_text(&text)
}

pub fn spheres(rng: &mut Rng) -> PackedScene {
    let mut text = materials(rng, 8);
    for i in 0..8 {
        add_sphere(&mut text, rng, i);
    }
    pack_text(&text)
}

pub fn triangles(rng: &mut Rng) -> PackedScene {
    let mut text = materials(rng, 8);
    for i in 0..16 {
        add_triangle(&mut text, rng, i % 8, i % 2 == 0);
    }
    pack_text(&text)
}

pub fn discs(rng: &mut Rng) -> PackedScene {
    let mut text = materials(rng, 8);
    for i in 0..16 {
        add_disc(&mut text, rng, i % 8, ["planar", "polar"][i / 8]);
    }
    pack_text(&text)
}

/// Sixteen shapes.
pub fn everything(rng: &mut Rng) -> PackedScene {
    let mut text = materials(rng, 12);
    for i in 0..4 {
        add_plane(&mut text, rng, i, true);
        add_sphere(&mut text, rng, i + 4);
        add_triangle(&mut text, rng, i + 8, i % 2 == 0);
        add_disc(&mut text, rng, i, ["planar", "polar"][i % 2]);
    }
    pack_text(&text)
}

fn query(origin: DVec3, direction: DVec3, t_max: f64) -> RayQuery {
    let (o, d): (Vec3, Vec3) = (origin.as_vec3(), direction.as_vec3());
    RayQuery { origin: o.extend(0.0).to_array(), direction: d.extend(t_max as f32).to_array() }
}

/// From around the scene into it, the world's origin being at −eye; directions of any length.
pub fn rays(rng: &mut Rng, count: usize) -> Vec<RayQuery> {
    let world = DVec3::new(-3.0, 2.0, -5.0);
    let ray = |_| {
        let origin = world + rng.vector(6.0);
        let to = world + rng.vector(3.5);
        query(origin, (to - origin).normalize() * rng.between(0.3, 3.0), rng.between(0.5, 20.0))
    };
    (0..count).map(ray).collect()
}

/// Past the silhouettes of spheres, on either side by 1e-4 to 0.1 of the radius.
pub fn grazing(rng: &mut Rng, scene: &PackedScene, count: usize) -> Vec<RayQuery> {
    let ray = |i: usize| {
        let sphere = &scene.records.spheres[i % scene.records.spheres.len()];
        let way = rng.direction();
        let side = way.cross(rng.direction()).normalize();
        let off = 10f64.powf(rng.between(-4.0, -1.0)) * if rng.unit() < 0.8 { -1.0 } else { 1.0 };
        let origin = sphere.center + side * sphere.radius * (1.0 + off) - way * rng.between(3.0, 10.0);
        query(origin, way, rng.between(0.5, 20.0))
    };
    (0..count).map(ray).collect()
}

/// A bumpy fan of triangles around one vertex, and rays at points of its inner edges.
pub fn fan(rng: &mut Rng, blades: usize, count: usize) -> (PackedScene, Vec<RayQuery>) {
    let hub = rng.vector(0.3);
    let rim: Vec<DVec3> = (0..blades)
        .map(|i| {
            let angle = std::f64::consts::TAU * i as f64 / blades as f64;
            hub + DVec3::new(angle.cos(), angle.sin(), 0.0) * rng.between(0.7, 2.0)
                + DVec3::Z * rng.between(-0.2, 0.2)
        })
        .collect();
    let mut text = materials(rng, 1);
    for i in 0..blades {
        let vertices = [hub, rim[i], rim[(i + 1) % blades]].map(three).join(", ");
        write!(text, "[[triangle]]\nvertices = [{vertices}]\nmaterial = \"m0\"\n").unwrap();
    }
    let eye = DVec3::new(3.0, -2.0, 5.0);
    let ray = |i: usize| {
        let target = hub + (rim[i % blades] - hub) * rng.between(0.02, 0.98) - eye;
        let origin =
            target + DVec3::new(rng.between(-2.0, 2.0), rng.between(-2.0, 2.0), rng.between(4.0, 9.0));
        query(origin, (target - origin) * rng.between(0.2, 2.0), 1.0)
    };
    let queries = (0..count).map(ray).collect();
    (pack_text(&text), queries)
}
