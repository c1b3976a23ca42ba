//! Ray differentials on planes: the exact difference quotient of where two rays meet the plane, at a distance
//! of 2^-200, where a quotient of rationals cancels nothing.

use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::camera::camera_ray;
use moire::internal::oracle::footprint::{Footprint, camera_differential, footprint_at};
use moire::internal::oracle::geometry::hit::FAR;
use moire::internal::oracle::geometry::kinds::{Search, Shape};
use moire::internal::pack::PackedScene;
use num_bigint::BigInt;

use super::numbers::{Q, V, approx, direction, v, vector};
use super::planes::meet;
use super::scenes::packed_as;
use super::{U, Worst};

fn compare(change: impl Fn(Footprint) -> Footprint) -> Worst {
    let mut rng = Rng::new(141);
    let mut worst = Worst::default();
    let camera = "[camera]\neye = [1, 2, 3]\nlook_at = [0.3, 0.1, -1]\nvertical_fov = 50\n";
    // Something that asks for footprints.
    let texture =
        "[[texture]]\nname = 't'\nprocedural = 'checker'\n[[material]]\nname = 'm'\ntexture = 't'\n";
    for i in 0..60 {
        let eye = DVec3::new(1.0, 2.0, 3.0);
        let [origin, t, b] = [vector(&mut rng, 3.0), direction(&mut rng), direction(&mut rng)];
        let list = super::scenes::list;
        let plane = format!(
            "[[plane]]\norigin = {}\ntangent = {}\nbitangent = {}\nmaterial = 'm'\n",
            list(origin),
            list(t),
            list(b)
        );
        let rest = "[image]\nwidth = 64\nheight = 48\n[sampling]\nspp = 4\nfootprint = 'differentials'\nprecision = 'double'\n";
        let (_, scene) = packed_as(&format!("{camera}{texture}{plane}"), rest);
        let ray = camera_ray(&scene.header, [i % 64, i * 7 % 48], glam::DVec2::new(0.3, 0.6));
        let (distance, _) =
            scene.records.planes[0].distance_to(&PackedScene::default(), &ray, FAR, Search::Nearest);
        let n = v(t).cross(&v(b)).unit().approx();
        let n = if n.dot(ray.direction) > 0.0 { -n } else { n };
        let beam = camera_differential(&scene.header, &ray);
        let print = change(footprint_at(&scene.header, &beam, &ray, distance, n));
        let slope = n.dot(ray.direction).abs();
        if distance <= 0.0 || slope < 1e-3 {
            continue;
        }
        let shape = [v(origin), v(t), v(b)];
        let place = |d: &V| {
            let [t, ..] = meet(&v(eye), d, [&shape[0], &shape[1], &shape[2]]).unwrap();
            d.times(&t)
        };
        let d = v(ray.direction);
        let huge = Q::from(BigInt::from(1) << 200);
        for k in 0..2 {
            let side = v(beam.direction[k]);
            let exact = place(&d.plus(&side.times(&huge.recip()))).minus(&place(&d)).times(&huge);
            // The distance, normal and slope over the slope, twice.
            let size = approx(&side.length()) * distance * ray.direction.length() / slope;
            for axis in 0..3 {
                let near = 1.0 + eye.distance(origin) / (n.dot(origin - eye).abs());
                worst.add(
                    print.point[k][axis],
                    &exact.0[axis],
                    40.0 * U * size * (near + ray.direction.length() / slope),
                );
            }
        }
    }
    worst
}

#[test]
fn differentials_on_planes_are_the_exact_derivatives() {
    let worst = compare(|print| print);
    worst.holds("differentials");
    assert!(worst.cases > 60, "only {} met", worst.cases);
}

#[test]
fn planted_errors_of_differentials_are_told() {
    compare(|print| Footprint { point: [print.point[1], print.point[0]], ..print }).fails("swapped sides");
    compare(|print| Footprint { point: print.point.map(|p| p * (1.0 + 1e-9)), ..print })
        .fails("a billionth more");
}
