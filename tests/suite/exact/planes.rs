//! Planes: distance and (u, v) by Cramer's rule from eye + t·d = origin + u·tangent + v·bitangent, for axes
//! of any length and nearly any angle.

use glam::{DVec2, DVec3, Vec2Swizzles};
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::camera::Ray;
use moire::internal::oracle::geometry::hit::FAR;
use moire::internal::oracle::geometry::kinds::{Search, Shape};
use moire::internal::pack::PackedScene;
use moire::internal::schema::layout::Plane;
use num_traits::{Signed, Zero};

use super::numbers::{Q, V, approx, determinant, direction, frac, q, v, vector};
use super::scenes::{from, list, packed};
use super::{U, Worst};

/// t, u and v where eye + t·d lies in the plane; none for a ray along it.
pub fn meet(from: &V, d: &V, [origin, tangent, bitangent]: [&V; 3]) -> Option<[Q; 3]> {
    let m = from.minus(origin);
    let back = d.times(&frac(-1, 1));
    let below = determinant(tangent, bitangent, &back);
    if below.is_zero() {
        return None;
    }
    let over = |x: Q| x / &below;
    Some([
        over(determinant(tangent, bitangent, &m)),
        over(determinant(&m, bitangent, &back)),
        over(determinant(tangent, &m, &back)),
    ])
}

pub struct Case {
    pub eye: DVec3,
    pub origin: DVec3,
    pub axes: [DVec3; 2],
    pub extent: Option<f64>,
}

impl Case {
    pub fn pack(&self) -> Plane {
        let extent = self.extent.map_or(String::new(), |e| format!("half_extent = {e:?}\n"));
        let [t, b] = self.axes.map(list);
        let origin = list(self.origin);
        let plane = format!("[[plane]]\norigin = {origin}\ntangent = {t}\nbitangent = {b}\n{extent}");
        packed(&format!("{}{plane}", from(self.eye))).1.records.planes[0]
    }

    /// Of t, and of u and v: with n's error of 6 U, h = n·(origin − eye) has 12 U of the longest product, the
    /// slope n·d 9 U; a row is off by 20 U of its length, which multiplies p and the way to the origin.
    fn bounds(&self, d: DVec3, t: f64) -> (f64, DVec2) {
        let [tangent, bitangent] = self.axes;
        let n = v(tangent).cross(&v(bitangent)).approx();
        let unit = n.normalize();
        let reach = (self.origin - self.eye).length();
        let height = unit.dot(self.origin - self.eye).abs();
        let slope = unit.dot(d).abs();
        let t_error = U * t.abs() * (12.0 * reach / height.max(1e-300) + 9.0 * d.length() / slope + 2.0);
        let rows = DVec2::new(bitangent.length(), tangent.length()) / n.length();
        let p = t.abs() * d.length();
        (t_error, rows * (26.0 * U * (p + reach) + d.length() * t_error))
    }
}

/// Angles between the axes down to twice the least that scenes may have.
fn cases() -> Vec<Case> {
    let mut rng = Rng::new(21);
    let mut all = Vec::new();
    for i in 0..48 {
        let tangent = direction(&mut rng) * 10f64.powf(rng.between(-6.0, 6.0));
        let sine = [1.0, 0.3, 1e-3, 1e-6, 1e-8, 2e-9][i % 6];
        let other = direction(&mut rng) * 10f64.powf(rng.between(-6.0, 6.0));
        let along = tangent.normalize() * other.length();
        let aside = along.any_orthogonal_vector().normalize() * other.length();
        let bitangent = if i % 6 == 0 { other } else { along + sine * aside };
        let eye = vector(&mut rng, [1.0, 1e3, 1e9][i % 3]);
        let near = [1.0, 1e6, 1e-3][i / 3 % 3];
        let origin = eye + vector(&mut rng, near);
        all.push(Case { eye, origin, axes: [tangent, bitangent], extent: None });
    }
    all
}

fn compare(solve: impl Fn(&Plane, &Ray) -> (f64, DVec2)) -> Worst {
    let mut worst = Worst::default();
    let mut rng = Rng::new(22);
    for case in cases() {
        let plane = case.pack();
        let [origin, tangent, bitangent] = [case.origin, case.axes[0], case.axes[1]].map(v);
        for i in 0..6 {
            let aim = case.origin - case.eye + rng.between(-3.0, 3.0) * case.axes[0];
            // Towards the plane, anywhere, and nearly along it.
            let d = match i % 3 {
                0 => aim + rng.between(-3.0, 3.0) * case.axes[1],
                1 => direction(&mut rng),
                _ => case.axes[0] + 1e-7 * direction(&mut rng) * case.axes[0].length(),
            };
            let ray = Ray { origin: DVec3::ZERO, direction: d, time: 0.0 };
            let Some([t, u, w]) = meet(&v(case.eye), &v(d), [&origin, &tangent, &bitangent]) else {
                continue;
            };
            let (got, local) = solve(&plane, &ray);
            let (t_bound, bounds) = case.bounds(d, approx(&t));
            worst.add(got, &t, t_bound);
            worst.add(local.x + plane.eye_u, &u, bounds.x);
            worst.add(local.y + plane.eye_v, &w, bounds.y);
        }
    }
    worst
}

#[test]
fn planes_of_any_axes_are_met_where_they_are() {
    compare(|plane: &Plane, ray: &Ray| plane.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest))
        .holds("planes");
}

#[test]
fn planted_errors_of_planes_are_told() {
    let swapped = |plane: &Plane, ray: &Ray| {
        let (t, local) = plane.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
        (t, local.yx())
    };
    compare(swapped).fails("swapped axes");
    let shifted = |plane: &Plane, ray: &Ray| {
        let (t, local) = plane.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
        (t, local * (1.0 + 1e-12))
    };
    compare(shifted).fails("a trillionth more");
    // (x − origin)·tangent, which is right for unit orthogonal axes alone.
    let projected = |plane: &Plane, ray: &Ray| {
        let across = plane.axis_u.cross(plane.normal);
        let (t, local) = plane.distance_to(&PackedScene::default(), ray, FAR, Search::Nearest);
        (t, DVec2::new(local.x, across.normalize().dot(t * ray.direction)))
    };
    compare(projected).fails("a projection in place of a solution");
}

/// At half an extent the exact u or v decides between hit and miss, unless rounding leaves that open.
#[test]
fn a_plane_ends_where_its_half_extent_says() {
    let mut rng = Rng::new(23);
    let mut worst = Worst::default();
    let mut open = 0;
    for (i, case) in cases().into_iter().enumerate().filter(|(i, _)| i % 6 < 3) {
        let extent = [1.0, 0.7, 1e3][i % 3];
        let case = Case { extent: Some(extent), ..case };
        let plane = case.pack();
        let [origin, tangent, bitangent] = [case.origin, case.axes[0], case.axes[1]].map(v);
        for k in 0..24 {
            let rim = extent * (1.0 + [1.0, -1.0][k % 2] * 0.5f64.powi(1 + k as i32));
            let other = rng.between(-0.5, 0.5) * extent;
            let (u, w) = if k % 4 < 2 { (rim, other) } else { (other, -rim) };
            let d = case.origin - case.eye + u * case.axes[0] + w * case.axes[1];
            let Some([t, u, w]) = meet(&v(case.eye), &v(d), [&origin, &tangent, &bitangent]) else {
                continue;
            };
            let (_, bounds) = case.bounds(d, approx(&t));
            let margin = [&u, &w].map(|x| approx(&(x.abs() - q(extent)).abs()));
            if margin[0] <= bounds.x || margin[1] <= bounds.y || !t.is_positive() {
                open += 1;
                continue;
            }
            let inside = u.abs() <= q(extent) && w.abs() <= q(extent);
            let ray = Ray { origin: DVec3::ZERO, direction: d, time: 0.0 };
            worst.agree(
                (plane.distance_to(&PackedScene::default(), &ray, FAR, Search::Nearest).0 > 0.0) == inside,
            );
        }
    }
    worst.holds("half extents");
    assert!(worst.cases > open, "{open} undecided, {} compared", worst.cases);
}
