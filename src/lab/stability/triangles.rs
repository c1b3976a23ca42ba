//! Triangles: needles a million times as long as wide, and shared edges. Rays from a list are
//! traced as in a render; the expected hits follow from the construction of the rays.

use glam::{DVec2, DVec3};

use super::case::{Bench, Case, Point};
use super::coordinates::CENTER;
use super::scenes::{hashed_unit, on_device, packed};
use super::view::View;
use crate::core::error::Result;
use crate::lab::probe::{self, DoubleRay, RayQuery};
use crate::pack::PackedScene;
use crate::schema::layout::NO_SHAPE;

/// The number of rays at shared edges, in total and per dispatch.
const RAYS: u32 = 10_000_000;
const AT_ONCE: u32 = 500_000;
const SIDE: u32 = 64;

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, unit, bound, reason, run| Case {
        group: "triangles",
        name,
        parameter,
        unit,
        bound,
        reason,
        run,
    };
    vec![
        case(
            "shared-edges",
            "rays at edges and corners of a closed mesh, so far",
            "rays that slip through",
            0.0,
            SHARED,
            shared_edges,
        ),
        case(
            "shared-edges-far",
            "distance over the mesh's size",
            "rays that slip through",
            0.0,
            SHARED,
            far_edges,
        ),
        case(
            "ties",
            "rays exactly on an edge, so far",
            "rays that meet another than the lowest",
            0.0,
            TIES,
            ties,
        ),
        case("needles", "length over width", "pixels", 1.0 / 4.0, NEEDLES, needles),
    ]
}

const SHARED: &str = "the two triangles at an edge compute the same volume d·(p × q) with opposite sign";
const TIES: &str =
    "both triangles of an edge count it as theirs, at the same distance, and the first one stays";
const NEEDLES: &str =
    "the edges of a triangle are off by a quarter of a pixel at most, or the scene is computed in f64";

/// Returns the vertices of an icosahedron and its faces.
fn ball() -> ([DVec3; 12], [[usize; 3]; 20]) {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut vertices = [DVec3::ZERO; 12];
    let mut next = vertices.iter_mut();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        for v in [DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)] {
            if let Some(slot) = next.next() {
                *slot = v;
            }
        }
    }
    let mut faces = Vec::new();
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let near = |a: usize, b: usize| (vertices[a] - vertices[b]).length() < 2.1;
                if near(i, j) && near(j, k) && near(i, k) {
                    faces.push([i, j, k]);
                }
            }
        }
    }
    (vertices, std::array::from_fn(|i| faces[i]))
}

/// Returns the mesh around a centre whose distance from the eye is `distance` times its size.
fn mesh(distance: f64, precision: &str) -> Result<(PackedScene, [DVec3; 12], [[usize; 3]; 20])> {
    let (vertices, faces) = ball();
    let center = distance * DVec3::new(0.6, 0.48, -0.64);
    let placed = vertices.map(|v| v + center);
    let mut text = View::new(DVec3::ZERO, center, DVec3::Y, 1.0, 1).text()
        + &CENTER.replace("[background]", &format!("precision = \"{precision}\"\n[background]"));
    for face in faces {
        let [a, b, c] = face.map(|i| format!("[{:?}, {:?}, {:?}]", placed[i].x, placed[i].y, placed[i].z));
        text += &format!("[[triangle]]\nvertices = [{a}, {b}, {c}]\n");
    }
    Ok((packed(&text, vec![], None)?, placed, faces))
}

/// Returns the shapes hit by rays from the eye along `directions`.
fn hit_shapes(bench: &Bench<'_>, scene: &PackedScene, directions: &[DVec3]) -> Result<Vec<u32>> {
    bench.check_cancelled()?;
    if scene.double && !bench.rounded && bench.gpu.info().limits.float64 {
        let query =
            |direction: &DVec3| DoubleRay { origin: [0.0; 4], direction: direction.extend(1.0).to_array() };
        let queries: Vec<DoubleRay> = directions.iter().map(query).collect();
        return Ok(probe::double_rays(bench.gpu, scene, &queries)?.iter().map(|a| a.shape).collect());
    }
    let mut scene = scene.clone();
    scene.round_reals();
    let query = |direction: &DVec3| RayQuery {
        origin: [0.0; 4],
        direction: direction.as_vec3().extend(1.0).to_array(),
    };
    let queries: Vec<RayQuery> = directions.iter().map(query).collect();
    Ok(probe::rays(bench.gpu, &scene, false, &queries)?.iter().map(|a| a.shape).collect())
}

/// Returns a direction from within the mesh, from which every ray must hit it, towards an edge or,
/// for every eighth, a corner.
fn to_edge(vertices: &[DVec3; 12], faces: &[[usize; 3]; 20], i: u32) -> DVec3 {
    let face = faces[(hashed_unit(i, 1) * 20.0) as usize];
    let (from, to) = (vertices[face[0]], vertices[face[1 + (i & 1) as usize]]);
    let part = if i.is_multiple_of(8) { 0.0 } else { hashed_unit(i, 2) };
    from + part * (to - from)
}

fn shared_edges(bench: &Bench<'_>) -> Result<Vec<Point>> {
    // The eye is inside, off the centre.
    let (scene, vertices, faces) = mesh(0.3, "auto")?;
    let (mut lost, mut points, mut sent) = (0.0, Vec::new(), 0);
    let mut first = "none of them".to_string();
    while sent < RAYS {
        let directions: Vec<DVec3> = (sent..sent + AT_ONCE).map(|i| to_edge(&vertices, &faces, i)).collect();
        for (direction, shape) in directions.iter().zip(hit_shapes(bench, &scene, &directions)?) {
            if shape == NO_SHAPE {
                lost += 1.0;
                first = format!("first: direction {direction}");
            }
        }
        sent += AT_ONCE;
        points.push(Point { parameter: f64::from(sent), error: lost, place: first.clone() });
    }
    Ok(points)
}

/// Sweeps the distance: from outside, all edges except those of the silhouette are inside the mesh.
fn far_edges(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let distance = 3.0 * 10f64.powi(k);
        let (scene, vertices, faces) = mesh(distance, "auto")?;
        let center = vertices.iter().sum::<DVec3>() / 12.0;
        // The sphere inscribed in the mesh has a radius of 1.51: no ray misses it.
        let inside = |direction: &DVec3| center.cross(direction.normalize()).length() < 1.5;
        let directions: Vec<DVec3> =
            (0..100_000).map(|i| to_edge(&vertices, &faces, i)).filter(inside).collect();
        let shapes = hit_shapes(bench, &scene, &directions)?;
        let lost = directions.iter().zip(&shapes).filter(|(_, shape)| **shape == NO_SHAPE);
        let first = lost
            .clone()
            .next()
            .map_or(String::new(), |(direction, _)| format!("first: direction {direction}"));
        Ok(Point::worst(distance, [(lost.count() as f64, first)]))
    };
    (0..=6).map(run).collect()
}

/// Sweeps four triangles around a corner at integer coordinates, where all arithmetic is exact:
/// rays on an edge hit two, rays at the corner all four.
fn ties(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let corners = [[4.0, 0.0], [0.0, 4.0], [-4.0, 0.0], [0.0, -4.0]];
    let mut text = View::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, 60.0, 1).text() + CENTER;
    for i in 0..4 {
        let [[ax, ay], [bx, by]] = [corners[i], corners[(i + 1) % 4]];
        text += &format!(
            "[[triangle]]\nvertices = [[0.0, 0.0, -8.0], [{ax:?}, {ay:?}, -8.0], [{bx:?}, {by:?}, -8.0]]\n"
        );
    }
    let scene = packed(&text, vec![], None)?;
    let rays: Vec<(DVec3, u32)> = (0..4096u32)
        .map(|i| {
            let (edge, part) = ((i % 4) as usize, f64::from(i / 4) / 1024.0);
            let [x, y] = corners[edge];
            // The edge from the corner to vertex `edge` belongs to triangles `edge` and `edge` - 1.
            let lowest = if part == 0.0 || edge == 0 { 0 } else { edge as u32 - 1 };
            (DVec3::new(part * x, part * y, -8.0), lowest)
        })
        .collect();
    let directions: Vec<DVec3> = rays.iter().map(|r| r.0).collect();
    let shapes = hit_shapes(bench, &scene, &directions)?;
    let wrong = rays.iter().zip(&shapes).filter(|((_, lowest), shape)| **shape != *lowest);
    let first = wrong.clone().next().map_or(String::new(), |((direction, lowest), shape)| {
        format!("first: direction {direction} met {shape}, not {lowest}")
    });
    Ok(vec![Point::worst(rays.len() as f64, [(wrong.count() as f64, first)])])
}

/// Sweeps a needle along the view with its tip at the eye's feet: every pixel must be correct
/// unless its centre is closer to an edge than the error under measurement.
fn needles(bench: &Bench<'_>) -> Result<Vec<Point>> {
    let run = |k: i32| {
        let aspect = 10f64.powi(k);
        let turn = |x: f64, z: f64| DVec3::new(0.8 * x + 0.6 * z, 0.0, -0.6 * x + 0.8 * z);
        // The needle is a unit wide at its base and `aspect` long.
        let corners = [turn(-0.5, -2.0), turn(0.5, -2.0), turn(0.1, -2.0 - aspect)];
        let view = View::new(DVec3::new(0.0, 0.7, 0.0), turn(0.0, -3.0), DVec3::Y, 50.0, SIDE);
        let list = corners.map(|v| format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)).join(", ");
        let text = view.text()
            + CENTER
            + "[[material]]\nname = \"m\"\nmodel = \"unlit\"\n"
            + &format!("[[triangle]]\nvertices = [{list}]\nmaterial = \"m\"\n");
        let film = on_device(bench, &packed(&text, vec![], None)?)?;
        // The corners in the picture; all lie in front of the eye.
        let [right, up, ahead] = view.axes();
        let half = (0.5 * view.fov.to_radians()).tan();
        let seen = corners.map(|v| {
            let p = v - view.eye;
            let place = DVec2::new(p.dot(right), -p.dot(up)) / (p.dot(ahead) * half);
            (place + 1.0) * (0.5 * f64::from(SIDE))
        });
        let errors = view.pixels().filter_map(|(i, [x, y], middle)| {
            // Signed distances from the three edges, which have equal signs inside.
            let away = [0, 1, 2].map(|e| {
                let (p, q) = (seen[e], seen[(e + 1) % 3]);
                (q - p).normalize().perp_dot(middle - p)
            });
            let inside = away.iter().all(|d| *d > 0.0) || away.iter().all(|d| *d < 0.0);
            let nearest = away.iter().fold(f64::INFINITY, |least, d| least.min(d.abs()));
            let hit = film.pixels[i] != [0.0; 3];
            (hit != inside).then(|| (nearest, format!("pixel ({x}, {y})")))
        });
        Ok(Point::worst(aspect, errors))
    };
    (0..=6).map(run).collect()
}
