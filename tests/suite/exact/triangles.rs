//! Triangles: which of two a ray hits at their shared edge, by the exact sign of d·(p × q); distance and
//! barycentric coordinates, of needles too.

use glam::{DVec2, DVec3, Vec2Swizzles};
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::rays::hit_surface;
use moire::internal::oracle::geometry::rays::{Hit, nearest_hit};
use moire::internal::oracle::geometry::triangle::triangle_distance;
use moire::internal::pack::PackedScene;
use moire::internal::schema::layout::NO_SHAPE;
use moire::internal::schema::layout::Triangle;
use num_traits::{Signed, Zero};

use super::numbers::{approx, determinant, direction, v, vector};
use super::planes::meet;
use super::scenes::{TEXTURED, from, list, packed};
use super::{U, Worst};

fn scene(eye: DVec3, triangles: &[[DVec3; 3]]) -> PackedScene {
    let one = |corners: &[DVec3; 3]| {
        let [a, b, c] = corners.map(list);
        format!("[[triangle]]\nvertices = [{a}, {b}, {c}]\nmaterial = 'm'\n")
    };
    let all: String = triangles.iter().map(one).collect();
    let material = "[[material]]\nname = 'm'\ntexture = 't'\nsampler = 's'\nmodel = 'unlit'\n";
    packed(&format!("{}{TEXTURED}{material}{all}", from(eye))).1
}

/// Signs of the exact edge functions, and whether rounding may turn one: a corner is rounded once, a function
/// has 8 roundings.
fn sides(eye: DVec3, d: DVec3, triangle: [DVec3; 3]) -> ([i32; 3], bool) {
    let corners = triangle.map(|p| v(p).minus(&v(eye)));
    let mut unsure = false;
    let signs = [0, 1, 2].map(|i| {
        let (p, q) = (&corners[(i + 1) % 3], &corners[(i + 2) % 3]);
        let exact = determinant(&v(d), p, q);
        let size = d.length() * p.approx().length() * q.approx().length();
        unsure |= !exact.is_zero() && approx(&exact).abs() <= 12.0 * U * size;
        if exact.is_zero() {
            0
        } else if exact.is_positive() {
            1
        } else {
            -1
        }
    });
    (signs, unsure)
}

fn is_hit(signs: [i32; 3]) -> bool {
    (signs.iter().all(|&s| s >= 0) || signs.iter().all(|&s| s <= 0)) && signs != [0; 3]
}

/// Two triangles on either side of an edge, and rays that come ever nearer to it.
fn at_edges(choose: impl Fn(&PackedScene, &Ray) -> u32) -> (Worst, u32) {
    let mut rng = Rng::new(41);
    let mut worst = Worst::default();
    let mut open = 0;
    for i in 0..24 {
        let eye = if i % 2 == 0 { DVec3::ZERO } else { vector(&mut rng, 1e3) };
        let place = |rng: &mut Rng| eye + vector(rng, 1.0) - DVec3::new(0.0, 0.0, 4.0);
        let [a, b, c] = [place(&mut rng), place(&mut rng), place(&mut rng)];
        // On the other side of the edge, seen from the eye; a needle every third time.
        let narrow = [1.0, 1.0, 1e-5][i % 3];
        let middle = 0.5 * (a + b);
        let e = middle - narrow * (c - middle);
        let scene = scene(eye, &[[a, b, c], [b, a, e]]);
        for k in 0..30 {
            let along = rng.between(0.1, 0.9);
            let aside = [1.0, -1.0][k % 2] * 0.25f64.powi(k as i32 / 2) * 0.1 * narrow;
            let aim = (if k > 26 { 0.0 } else { aside }) * (c - middle) + a.lerp(b, along);
            let ray = Ray { origin: DVec3::ZERO, direction: aim - eye, time: 0.0 };
            let found = [[a, b, c], [b, a, e]].map(|t| sides(eye, ray.direction, t));
            let shape = choose(&scene, &ray);
            // Whatever the rounding, no ray passes between the two.
            worst.agree(shape != NO_SHAPE);
            if found.iter().any(|f| f.1) {
                open += 1;
                continue;
            }
            worst.agree(shape < 2 && is_hit(found[shape as usize].0));
        }
    }
    (worst, open)
}

fn nearest(scene: &PackedScene, ray: &Ray) -> u32 {
    nearest_hit(scene, ray, NO_SHAPE).shape
}

#[test]
fn at_a_shared_edge_the_exact_sides_say_which_triangle_is_hit() {
    let (worst, open) = at_edges(nearest);
    worst.holds("shared edges");
    println!("shared edges: {open} of 720 rays within rounding of the edge");
    assert!(open < 200, "{open} of 720 rays were not decided");
}

#[test]
fn planted_errors_at_edges_are_told() {
    at_edges(|scene, ray| 1 - nearest(scene, ray).min(1)).0.fails("the other triangle");
    let bent = |scene: &PackedScene, ray: &Ray| {
        nearest(scene, &Ray { direction: ray.direction + 1e-9 * DVec3::X, ..*ray })
    };
    at_edges(bent).0.fails("a ray bent by a billionth");
}

/// Whole numbers are exact, and so both triangles are hit: the one that comes first counts.
#[test]
fn on_the_edge_itself_the_first_of_two_triangles_is_hit() {
    let [a, b, c, e] =
        [[-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]].map(|[x, y]| DVec3::new(x, y, -1.0));
    for triangles in [[[a, b, c], [b, a, e]], [[b, a, e], [a, b, c]], [[a, c, b], [e, a, b]]] {
        let scene = scene(DVec3::ZERO, &triangles);
        for k in -7..8 {
            let direction = DVec3::new(f64::from(k) / 8.0, f64::from(k) / 8.0, -1.0);
            let ray = Ray { origin: DVec3::ZERO, direction, time: 0.0 };
            assert_eq!(nearest(&scene, &ray), 0, "at {k} of 8");
            assert!(triangles.iter().all(|t| sides(DVec3::ZERO, direction, *t).0.contains(&0)));
        }
    }
}

/// (t, barycentric weights of the second and third corner), which are u and v by default.
fn place(scene: &PackedScene, ray: &Ray) -> (f64, DVec2) {
    let t = triangle_distance(&scene.records.triangles[0], ray);
    let hit = Hit { t, shape: 0, local: DVec2::ZERO };
    (t, hit_surface(scene, ray, &hit).own_uv)
}

fn weights(read: impl Fn(&PackedScene, &Ray) -> (f64, DVec2)) -> Worst {
    let mut rng = Rng::new(42);
    let mut worst = Worst::default();
    for i in 0..120 {
        let size = 10f64.powf(rng.between(-6.0, 6.0));
        let eye = if i % 2 == 0 { DVec3::ZERO } else { vector(&mut rng, 1e3 * size) };
        let first = eye + size * 3.0 * direction(&mut rng);
        let edge = size * direction(&mut rng);
        // From equal sides to a needle a billion times as long as wide.
        let height = size * 10f64.powf(-[0.0, 1.0, 3.0, 5.0, 7.0, 9.0][i % 6]);
        let tip = first + rng.between(-0.5, 1.5) * edge + height * edge.normalize().any_orthonormal_vector();
        let corners = [first, first + edge, tip];
        let scene = scene(eye, &[corners]);
        let [a, b, c] = corners.map(v);
        let sides = [b.minus(&a), c.minus(&a)];
        let n = sides[0].cross(&sides[1]).approx();
        let longest =
            sides.iter().map(|s| s.approx().length()).fold((corners[2] - corners[1]).length(), f64::max);
        let reach = corners.map(|p| (p - eye).length()).into_iter().fold(0.0, f64::max);
        for _ in 0..5 {
            let (x, y) = (rng.between(0.1, 0.8), rng.between(0.05, 0.2));
            let d = first - eye + x * edge + y * (tip - first);
            if !is_hit(super::triangles::sides(eye, d, corners).0) {
                continue;
            }
            let ray = Ray { origin: DVec3::ZERO, direction: d, time: 0.0 };
            let [t, u, w] = meet(&v(eye), &v(d), [&a, &sides[0], &sides[1]]).unwrap();
            let (got, uv) = read(&scene, &ray);
            if got < 0.0 {
                continue;
            }
            // The normal turns by the corners' roundings over the least height, and 6 U of its own; a weight
            // moves by the point's error over a height, and by 8 U of the products of sides over the area.
            let turn = 4.0 * U * reach * longest / n.length() + 9.0 * U;
            let unit = n.normalize();
            let (up, slope) = (unit.dot(first - eye).abs(), unit.dot(d).abs());
            let t_bound = approx(&t) * (turn * reach / up + turn * d.length() / slope + 4.0 * U);
            let point = d.length() * t_bound + 2.0 * U * (approx(&t) * d.length() + reach);
            let bound = (longest * point + 8.0 * U * longest * longest) / n.length() + 4.0 * U;
            worst.add(got, &t, t_bound);
            worst.add(uv.x, &u, bound);
            worst.add(uv.y, &w, bound);
        }
    }
    worst
}

#[test]
fn needles_are_met_where_they_are_and_weighted_to_their_condition() {
    let worst = weights(place);
    worst.holds("triangles");
    assert!(worst.cases > 900, "only {} cases were hit", worst.cases);
}

#[test]
fn planted_errors_within_triangles_are_told() {
    let swapped = |scene: &PackedScene, ray: &Ray| {
        let (t, uv) = place(scene, ray);
        (t, uv.yx())
    };
    weights(swapped).fails("swapped corners");
    let moved = |scene: &PackedScene, ray: &Ray| {
        let mut other = scene.clone();
        other.records.triangles[0] = Triangle {
            normal: scene.records.triangles[0].normal.map(|x| x * (1.0 + 1e-9)),
            ..scene.records.triangles[0]
        };
        place(&other, ray)
    };
    weights(moved).fails("a plane moved by a billionth");
}
