//! Rays on the device against the oracle: which shape, how far, the point, the normal and the
//! texture coordinate, each within the rounding that f32 arithmetic of that conditioning allows; and
//! no ray between two triangles that share an edge.

use glam::{DVec2, DVec3};
use moire::internal::lab::probe::{self, RayAnswer, RayQuery};
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::hit::Surface;
use moire::internal::oracle::geometry::rays::hit_surface;
use moire::internal::oracle::geometry::rays::{Hit, nearest_hit, occluded};
use moire::internal::oracle::mapping::{MapInput, texture_coordinate};
use moire::internal::pack::{MapKind, PackedScene};
use moire::internal::schema::layout::{NO_SHAPE, UvProjection};

use crate::lookup::bench::Rng;
use crate::stage::device;
use bounds::{Estimate, U, disc_of, disc_own_error, estimate};

mod bounds;
mod scenes;

fn widened(v: &[f32]) -> DVec3 {
    DVec3::new(v[0].into(), v[1].into(), v[2].into())
}

fn ray_of(query: &RayQuery) -> Ray {
    Ray { origin: widened(&query.origin), direction: widened(&query.direction), time: query.origin[3].into() }
}

/// The result of the comparison of one scene.
#[derive(Default, Debug)]
struct Tally {
    rays: usize,
    hits: usize,
    /// A different shape from the oracle's, if rounding decides: silhouettes, edges, equal distances.
    undecided: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn add(&mut self, scene: &PackedScene, query: &RayQuery, answer: &RayAnswer) {
        let ray = ray_of(query);
        let hit = nearest_hit(scene, &ray, NO_SHAPE);
        let estimates: Vec<Estimate> = (0..moire::internal::oracle::geometry::kinds::shape_count(scene))
            .map(|s| estimate(scene, s, &ray))
            .collect();
        self.rays += 1;
        self.hits += usize::from(hit.shape != NO_SHAPE);
        if let Some(what) = wrong_shape(&hit, answer, &estimates) {
            self.wrong.push(format!("{query:?}: {what}; {answer:?}"));
        } else if hit.shape != answer.shape {
            self.undecided += 1;
        } else if hit.shape != NO_SHAPE {
            self.wrong.extend(
                wrong_hit(scene, &ray, &hit, answer, estimates[hit.shape as usize])
                    .map(|what| format!("shape {} of {query:?}: {what}; {answer:?}", hit.shape)),
            );
        }
        let t_max = f64::from(query.direction[3]);
        let expected = occluded(scene, &ray, t_max, NO_SHAPE);
        let unsure = estimates
            .iter()
            .any(|e| e.unsure || (e.t - t_max).abs() <= e.error + U * t_max || e.t.abs() <= e.error);
        if (answer.occluded != 0) != expected && !unsure {
            self.wrong.push(format!("{query:?}: occluded {}, oracle {expected}", answer.occluded));
        }
    }
}

/// Returns the device's shape, if rounding cannot explain that it differs from the oracle's.
fn wrong_shape(hit: &Hit, answer: &RayAnswer, estimates: &[Estimate]) -> Option<String> {
    if hit.shape == answer.shape {
        return None;
    }
    let of = |shape: u32| estimates.get(shape as usize);
    let unsure = |shape: u32| of(shape).is_some_and(|e| e.unsure || e.t.abs() <= e.error);
    let tie = match (of(hit.shape), of(answer.shape)) {
        (Some(a), Some(b)) => (a.t - b.t).abs() <= a.error + b.error,
        _ => false,
    };
    let explained = tie || unsure(hit.shape) || unsure(answer.shape);
    (!explained).then(|| format!("shape {}, oracle {} at {}", answer.shape, hit.shape, hit.t))
}

fn wrong_hit(
    scene: &PackedScene,
    ray: &Ray,
    hit: &Hit,
    answer: &RayAnswer,
    estimate: Estimate,
) -> Option<String> {
    let t_error = (f64::from(answer.t) - hit.t).abs();
    if t_error > estimate.error {
        return Some(format!("t off by {t_error:e} from {}, {:e} allowed", hit.t, estimate.error));
    }
    let surface = hit_surface(scene, ray, hit);
    // The error of t along the ray; products and sums in o + t d, and on a sphere the way back to it.
    let reach = ray.origin.length() + hit.t * ray.direction.length() + surface.point.length();
    let point_error = 2.0 * estimate.error * ray.direction.length() + 16.0 * U * reach;
    let off = widened(&answer.point).distance(surface.point);
    if off > point_error {
        return Some(format!("point off by {off:e}, {point_error:e} allowed"));
    }
    let normal = widened(&answer.normal);
    if (normal.length() - 1.0).abs() > 8.0 * U {
        return Some(format!("normal of length {}", normal.length())); // 8 roundings of a unit vector
    }
    let shape_operator = estimate.curvature * point_error + estimate.weights + 16.0 * U; // turn of the normal by the error
    let grazing =
        surface.geometric_normal.dot(ray.direction).abs() <= shape_operator * ray.direction.length();
    let off = normal.distance(surface.normal);
    if off > shape_operator && !grazing {
        return Some(format!("normal off by {off:e} from {}, {shape_operator:e} allowed", surface.normal));
    }
    wrong_uv(scene, &surface, answer, point_error, estimate.weights)
}

fn wrong_uv(
    scene: &PackedScene,
    surface: &Surface,
    answer: &RayAnswer,
    point_error: f64,
    weights: f64,
) -> Option<String> {
    let map = &scene.records.uv_projections[surface.map as usize];
    let expected = texture_coordinate(
        map,
        &MapInput { entity: surface.point, own: surface.own_uv, ..Default::default() },
    );
    let expected = expected.at.truncate();
    let got = DVec2::new(answer.uv[0].into(), answer.uv[1].into());
    let rows = [map.x, map.y, map.z];
    let steep = rows.iter().map(|r| r.truncate().length()).fold(0.0, f64::max);
    // Products and sums of a row, on top of the error of the point.
    let row_error = rows
        .iter()
        .map(|r| 4.0 * U * ((r.truncate() * surface.point).abs().element_sum() + r.w.abs()))
        .fold(0.0, f64::max)
        + steep * point_error;
    let kind = map.kind;
    let (tolerance, turn) = match kind {
        MapKind::Affine => (DVec2::splat(row_error), DVec2::ZERO),
        MapKind::Plane if disc_of(scene, answer.shape).is_some() => {
            disc_uv_tolerance(scene, map, disc_of(scene, answer.shape).unwrap(), surface, point_error)
        }
        MapKind::Plane => {
            let plane = &scene.records.planes[answer.shape as usize];
            // Products and sums of an axis, then of the matrix, on top of the error of the point.
            let own = [plane.axis_u, plane.axis_v].map(|axis| {
                let size = (axis * surface.point).abs().element_sum();
                (size, 4.0 * U * size + axis.length() * point_error)
            });
            let m = [map.m00, map.m01, map.m10, map.m11].map(f64::abs);
            let offset = [0, 1].map(|i| map.offset[i].abs());
            let wide = [0, 1].map(|i| {
                let (a, b) = (m[2 * i], m[2 * i + 1]);
                a * own[0].1 + b * own[1].1 + 4.0 * U * (a * own[0].0 + b * own[1].0 + offset[i])
            });
            (DVec2::from_array(wide), DVec2::ZERO)
        }
        MapKind::VertexUv => (DVec2::splat(8.0 * weights + 16.0 * U), DVec2::ZERO), // uv up to 4
        MapKind::Solid | MapKind::Cube | MapKind::Box => {
            unreachable!("these rays meet 2d textures of other kinds")
        }
        MapKind::Cylindrical | MapKind::Spherical => {
            let at = rows.map(|r| r.truncate().dot(surface.point) + r.w);
            let across = at[0].hypot(at[2]);
            // The angle by an error across the axis; 2e-7 for the polynomial and its steps.
            let angle = (row_error / across).min(1.0) + 2e-7;
            let (own, turn) = match kind {
                MapKind::Cylindrical => (DVec2::new(angle, row_error), DVec2::X),
                _ => (DVec2::new(row_error / across.hypot(at[1]) + 2e-7, angle), DVec2::Y),
            };
            let m = [map.m00, map.m01, map.m10, map.m11];
            let times = |v: DVec2| DVec2::new(m[0] * v.x + m[1] * v.y, m[2] * v.x + m[3] * v.y);
            let wide =
                DVec2::new(m[0].abs() * own.x + m[1].abs() * own.y, m[2].abs() * own.x + m[3].abs() * own.y);
            (wide + 8.0 * U * (expected.abs() + 4.0), times(turn))
        }
    };
    let fits = |period: DVec2| (got - expected + period).abs().cmple(tolerance).all();
    let right = fits(DVec2::ZERO) || fits(turn) || fits(-turn);
    (!right).then(|| format!("{kind} uv {got}, oracle {expected}, {tolerance} allowed"))
}

/// Errors of both texture coordinates on a disc, and what a whole turn of the angle changes.
fn disc_uv_tolerance(
    scene: &PackedScene,
    map: &UvProjection,
    index: usize,
    surface: &Surface,
    point_error: f64,
) -> (DVec2, DVec2) {
    let own = disc_own_error(scene, index, surface.point, point_error);
    let m = [map.m00, map.m01, map.m10, map.m11];
    let times = |v: DVec2| DVec2::new(m[0] * v.x + m[1] * v.y, m[2] * v.x + m[3] * v.y);
    let wide = |v: DVec2| {
        DVec2::new(m[0].abs() * v.x + m[1].abs() * v.y, m[2].abs() * v.x + m[3].abs() * v.y)
            + 8.0 * U * (DVec2::ONE + map.offset.abs())
    };
    if !scene.records.discs[index].is_polar {
        return (wide(DVec2::splat(0.5 * own)), DVec2::ZERO);
    }
    // The angle by an error across the radius; 2e-7 for the polynomial and its steps.
    let angle = (own / (std::f64::consts::TAU * surface.own_uv.y)).min(1.0) + 2e-7;
    (wide(DVec2::new(angle, 1.5 * own)), times(DVec2::X))
}

fn compare(scene: &PackedScene, queries: &[RayQuery], keep_everything: bool) -> Tally {
    let answers = probe::rays(&device(), scene, keep_everything, queries).unwrap();
    let mut tally = Tally::default();
    for (query, answer) in queries.iter().zip(&answers) {
        tally.add(scene, query, answer);
    }
    tally
}

fn assert_agrees(what: &str, scene: &PackedScene, queries: &[RayQuery], keep_everything: bool) {
    let tally = compare(scene, queries, keep_everything);
    let first = tally.wrong.iter().take(4).cloned().collect::<Vec<_>>().join("\n");
    assert!(
        tally.wrong.is_empty(),
        "{what}: {} of {} rays are wrong:\n{first}",
        tally.wrong.len(),
        tally.rays
    );
    assert!(tally.hits * 10 > tally.rays, "{what}: only {} of {} rays hit", tally.hits, tally.rays);
    // Silhouettes and edges are thin: their share is about 1e-5 in these scenes.
    assert!(tally.undecided * 1000 <= tally.rays, "{what}: {} of {} undecided", tally.undecided, tally.rays);
}

#[test]
fn planes_bounded_and_infinite_with_skewed_axes() {
    for seed in 0..3 {
        let mut rng = Rng::new(seed + 100);
        let scene = scenes::planes(&mut rng);
        assert_agrees(&format!("planes {seed}"), &scene, &scenes::rays(&mut rng, 4000), seed == 0);
    }
}

#[test]
fn spheres_from_outside_inside_and_grazing() {
    for seed in 0..3 {
        let mut rng = Rng::new(seed + 200);
        let scene = scenes::spheres(&mut rng);
        let mut queries = scenes::rays(&mut rng, 3000);
        queries.extend(scenes::grazing(&mut rng, &scene, 1000));
        assert_agrees(&format!("spheres {seed}"), &scene, &queries, seed == 0);
    }
}

#[test]
fn triangles_flat_and_smooth() {
    for seed in 0..3 {
        let mut rng = Rng::new(seed + 300);
        let scene = scenes::triangles(&mut rng);
        assert_agrees(&format!("triangles {seed}"), &scene, &scenes::rays(&mut rng, 4000), seed == 0);
    }
}

#[test]
fn discs_planar_and_polar() {
    for seed in 0..3 {
        let mut rng = Rng::new(seed + 700);
        let scene = scenes::discs(&mut rng);
        assert_agrees(&format!("discs {seed}"), &scene, &scenes::rays(&mut rng, 4000), seed == 0);
    }
}

#[test]
fn all_shapes_together_with_every_mapping() {
    for keep_everything in [false, true] {
        let mut rng = Rng::new(400);
        let scene = scenes::everything(&mut rng);
        assert_agrees("everything", &scene, &scenes::rays(&mut rng, 6000), keep_everything);
    }
}

#[test]
fn no_ray_passes_between_triangles_that_share_an_edge() {
    for seed in 0..4 {
        let mut rng = Rng::new(seed + 500);
        let (scene, queries) = scenes::fan(&mut rng, 9, 5000);
        for keep_everything in [false, true] {
            let answers = probe::rays(&device(), &scene, keep_everything, &queries).unwrap();
            let missed: Vec<_> = queries.iter().zip(&answers).filter(|(_, a)| a.shape == NO_SHAPE).collect();
            assert!(missed.is_empty(), "{} rays pass, the first {:?}", missed.len(), missed[0]);
        }
    }
}

#[test]
fn planted_errors_of_rays_are_caught() {
    let mut rng = Rng::new(600);
    let scene = scenes::everything(&mut rng);
    let queries = scenes::rays(&mut rng, 1000);
    let right = probe::rays(&device(), &scene, false, &queries).unwrap();
    let caught = |plant: &dyn Fn(&mut RayAnswer)| {
        let mut tally = Tally::default();
        for (query, answer) in queries.iter().zip(&right).filter(|(_, a)| a.shape != NO_SHAPE) {
            let mut answer = *answer;
            plant(&mut answer);
            tally.add(&scene, query, &answer);
        }
        tally.wrong.len() as f64 / tally.rays as f64
    };
    assert_eq!(caught(&|_| {}), 0.0);
    type Plant<'a> = (&'a str, &'a dyn Fn(&mut RayAnswer));
    let plants: [Plant<'_>; 6] = [
        ("t 1e-4 too long", &|a| a.t *= 1.0001),
        ("another shape", &|a| a.shape = (a.shape + 1) % 12),
        ("normal away from the ray", &|a| a.normal = a.normal.map(|n| -n)),
        ("u and v swapped", &|a| a.uv.swap(0, 1)),
        ("u off by 1e-3", &|a| a.uv[0] += 1e-3),
        ("occlusion reversed", &|a| a.occluded = 1 - a.occluded),
    ];
    for (what, plant) in plants {
        let share = caught(plant);
        assert!(share > 0.9, "{what}: only {share} caught");
    }
}
