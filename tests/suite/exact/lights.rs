//! Lambert's radiometry to 256 bits: albedo/π · I · cosθ / r² of a point light, albedo/π · E · cosθ of a directional
//! one, on planes and triangles rendered as a whole, from either side.

use glam::DVec3;
use moire::internal::lab::verify::queries::Rng;
use moire::internal::oracle::render::pixel;
use num_traits::{Signed, Zero};

use super::numbers::{Q, approx, direction, frac, pi, q, v, vector};
use super::planes::meet;
use super::scenes::{list, packed_as};
use super::{U, Worst};

const COLOR: [f32; 3] = [0.5, 0.3, 1.0];
const POWER: [f32; 3] = [3.0, 0.7, 11.0];

struct Case {
    origin: DVec3,
    axes: [DVec3; 2],
    triangle: bool,
    light: DVec3,
    point: bool,
}

fn cases() -> Vec<Case> {
    let mut rng = Rng::new(111);
    let mut all = Vec::new();
    for i in 0..80 {
        let origin = DVec3::new(0.0, 0.0, -5.0) + vector(&mut rng, 1.0);
        let axes = [direction(&mut rng), direction(&mut rng)];
        if axes[0].cross(axes[1]).z.abs() < 0.2 {
            continue;
        }
        let point = i % 2 == 0;
        let light = if point { origin + vector(&mut rng, 4.0) } else { direction(&mut rng) * 7.0 };
        all.push(Case { origin, axes, triangle: i % 3 == 0, light, point });
    }
    all
}

impl Case {
    fn text(&self) -> String {
        let [r, g, b] = COLOR;
        let power = format!("[{:?}, {:?}, {:?}]", POWER[0], POWER[1], POWER[2]);
        let light = if self.point {
            format!("kind = 'point'\nposition = {}\nintensity = {power}\n", list(self.light))
        } else {
            format!("kind = 'directional'\ndirection = {}\nirradiance = {power}\n", list(self.light))
        };
        let [t, b_axis] = self.axes;
        let shape = if self.triangle {
            let corners = [-20.0 * t - 20.0 * b_axis, 40.0 * t, 40.0 * b_axis].map(|p| list(self.origin + p));
            format!("[[triangle]]\nvertices = [{}]\nmaterial = 'm'\n", corners.join(", "))
        } else {
            let [t, b] = self.axes.map(list);
            format!(
                "[[plane]]\norigin = {}\ntangent = {t}\nbitangent = {b}\nmaterial = 'm'\n",
                list(self.origin)
            )
        };
        format!(
            "[camera]\neye = [0, 0, 0]\nlook_at = [0, 0, -1]\northographic_height = 1\n[[light]]\n{light}[[material]]\nname = 'm'\ncolor = [{r:?}, {g:?}, {b:?}]\n{shape}"
        )
    }

    /// Radiance over albedo and power, and its relative error. The ray is the one along −z from the eye.
    fn exact(&self) -> (Q, f64) {
        let [origin, t, b] = [self.origin, self.axes[0], self.axes[1]].map(v);
        let ahead = v(DVec3::NEG_Z);
        let zero = v(DVec3::ZERO);
        let [distance, ..] = meet(&zero, &ahead, [&origin, &t, &b]).unwrap();
        let place = ahead.times(&distance);
        let n = t.cross(&b);
        let n = if n.0[2].is_negative() { n.times(&frac(-1, 1)) } else { n }.unit();
        let way = if self.point { v(self.light).minus(&place) } else { v(self.light) };
        let far = way.length();
        let cosine = n.dot(&way) / &far;
        if !cosine.is_positive() {
            return (Q::zero(), 0.0);
        }
        let share = if self.point { &cosine / (&far * &far) } else { cosine.clone() };
        // Where the ray meets the plane, over the distance: three times of the way, once of the cosine; corners
        // of the triangle 40 away; 20 roundings of norms and products.
        let slope = approx(&n.0[2]).abs();
        let place_error = 40.0 * U * (approx(&distance) + 40.0) / slope;
        let near = if self.point { place_error / approx(&far) } else { 0.0 };
        let relative = 3.0 * near + (20.0 * U + near) / approx(&cosine) + 20.0 * U;
        (share / pi(), relative)
    }
}

fn compare(change: impl Fn(&Case, f64) -> f64) -> Worst {
    let mut worst = Worst::default();
    for case in cases() {
        let rest = "[image]\nwidth = 1\nheight = 1\n[sampling]\npattern = 'center'\nprecision = 'double'\n";
        let (_, scene) = packed_as(&case.text(), rest);
        let seen = pixel(&scene, 0, 0);
        let (share, relative) = case.exact();
        for k in 0..3 {
            let exact = &share * q(COLOR[k].into()) * q(POWER[k].into());
            worst.add(change(&case, seen[k]), &exact, relative * approx(&exact));
        }
    }
    worst
}

#[test]
fn surfaces_under_lights_have_the_radiance_of_lamberts_law() {
    compare(|_, seen| seen).holds("lights");
    let lit = cases().iter().filter(|c| c.exact().0.is_positive()).count();
    assert!(lit > 20 && cases().len() - lit > 10, "{lit} of {} are lit", cases().len());
}

#[test]
fn planted_errors_of_lights_are_told() {
    compare(|_, seen| seen * std::f64::consts::PI).fails("no division by π");
    compare(|case, seen| if case.point { seen * 1.000_000_001 } else { seen }).fails("a billionth more");
    compare(|case, seen| if case.triangle { seen.max(1e-9) } else { seen }).fails("ambient light");
}
