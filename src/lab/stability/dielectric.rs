//! Glass at its extremes: incidence up to grazing, the critical angle, indices of refraction close
//! to 1 and far from it. For rays, normals and ratios of indices in f32, the error of the Fresnel
//! reflectance and of the refracted direction (Snell) against the exact values for the same inputs
//! is divided by their change for half an ulp of 1.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::case::{Bench, Case, Point};
use super::scenes::{SCREEN, hashed_unit, packed};
use crate::core::error::Result;
use crate::lab::probe::{self, GlassQuery};

const GROUP: &str = "dielectric";
const UNIT: &str = "half ulps";
const REASON: &str = "the answer is to be exact to 8 roundings of 6e-8 for an angle or a ratio that is off by 8 of them: \
                      so many make a component of a cross product, a sine and a root";
const BOUND: f64 = 8.0;
/// Half an ulp of 1 in f32.
const H: f64 = 1.0 / 16_777_216.0;
/// The number of normals, the first along an axis; each has as many planes of incidence.
const NORMALS: u32 = 8;
const INDICES: [f64; 6] = [1.0, 1.000_001, 1.33, 1.5, 2.42, 10.0];

pub fn cases() -> Vec<Case> {
    let case = |name, parameter, run| Case {
        group: GROUP,
        name,
        parameter,
        unit: UNIT,
        bound: BOUND,
        reason: REASON,
        run,
    };
    vec![
        case("share-grazing", "degrees from grazing", share_grazing),
        case("share-critical", "degrees from the critical angle", share_critical),
        case("share-index", "index less 1", share_index),
        case("direction-grazing", "degrees from grazing", direction_grazing),
        case("direction-critical", "degrees from the critical angle", direction_critical),
        case("direction-index", "index less 1", direction_index),
    ]
}

/// Angles from the normal in radians with ratios of indices, queried at one value of a parameter.
type Meetings = Vec<(f64, f64)>;

fn decades(from: i32, to: i32) -> impl Iterator<Item = f64> {
    (from..=to).map(|e| 10f64.powi(e))
}

/// Returns external incidences; 90° is normal incidence.
fn grazing() -> Vec<(f64, Meetings)> {
    let angles = decades(-9, 1).chain([30.0, 60.0, 90.0]);
    let meetings = |degrees: f64| INDICES.map(|n| (FRAC_PI_2 - degrees.to_radians(), 1.0 / n)).to_vec();
    angles.map(|degrees| (degrees, meetings(degrees))).collect()
}

/// Returns internal incidences on both sides of the critical angle.
fn critical() -> Vec<(f64, Meetings)> {
    let sides = |degrees: f64| {
        let of = |n: f64| [-1.0, 1.0].map(|side| ((1.0 / n).asin() + side * degrees.to_radians(), n));
        INDICES[2..].iter().copied().flat_map(of).collect()
    };
    std::iter::once(0.0).chain(decades(-9, 0)).map(|degrees| (degrees, sides(degrees))).collect()
}

/// Returns angles from normal to grazing from both sides; internal ones only if light is refracted.
fn indices() -> Vec<(f64, Meetings)> {
    let meetings = |n: f64| {
        let outside = (0..=18).map(|i| (f64::from(i) * 5f64.to_radians(), 1.0 / n));
        let within = (0..19).map(|i| ((1.0 / n).asin() * f64::from(i) / 20.0, n));
        outside.chain(within).collect()
    };
    let indices = std::iter::once(0.0).chain(decades(-7, 2)).chain([999.0]);
    indices.map(|more| (more, meetings(1.0 + more))).collect()
}

fn share_grazing(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, grazing(), share_error)
}

fn share_critical(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, critical(), share_error)
}

fn share_index(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, indices(), share_error)
}

fn direction_grazing(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, grazing(), direction_error)
}

fn direction_critical(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, critical(), direction_error)
}

fn direction_index(bench: &Bench<'_>) -> Result<Vec<Point>> {
    points(bench, indices(), direction_error)
}

/// Evaluates each incidence about several normals.
fn points(
    bench: &Bench<'_>,
    values: Vec<(f64, Meetings)>,
    error: fn(&GlassQuery, [f32; 4]) -> f64,
) -> Result<Vec<Point>> {
    let scene = packed(&format!("{SCREEN}[image]\nwidth = 1\nheight = 1\n"), Vec::new(), None)?;
    let point = |(parameter, meetings): (f64, Meetings)| {
        bench.check_cancelled()?;
        let about = |&(angle, ratio): &(f64, f64)| (0..NORMALS).map(move |i| query(angle, ratio, i));
        let queries: Vec<GlassQuery> = meetings.iter().flat_map(about).collect();
        let answers = probe::glass(bench.gpu, &scene, &queries)?;
        let errors = queries.iter().zip(answers).map(|(q, a)| (error(q, a), place(q)));
        Ok(Point::worst(parameter, errors))
    };
    values.into_iter().map(point).collect()
}

fn query(angle: f64, ratio: f64, i: u32) -> GlassQuery {
    let random = |seed: u32| 2.0 * hashed_unit(i, seed) - 1.0;
    let (normal, across) = match i {
        0 => (DVec3::Z, DVec3::X),
        _ => {
            let normal = DVec3::new(random(1), random(2), random(3)).normalize();
            (normal, normal.cross(DVec3::new(random(4), random(5), random(6))).normalize())
        }
    };
    let direction = angle.sin() * across - angle.cos() * normal;
    GlassQuery {
        direction: direction.as_vec3().to_array(),
        ratio: ratio as f32,
        normal: normal.as_vec3().extend(0.0).to_array(),
    }
}

fn place(query: &GlassQuery) -> String {
    let meeting = Meeting::of(query);
    format!("{:.9}°, ratio {}, normal {:.3?}", meeting.angle.to_degrees(), query.ratio, &query.normal[..3])
}

/// A query in f64: the length of the ray, two unit vectors, the angle between ray and normal.
#[derive(Clone, Copy)]
struct Meeting {
    length: f64,
    normal: DVec3,
    across: DVec3,
    angle: f64,
    ratio: f64,
}

impl Meeting {
    fn of(query: &GlassQuery) -> Meeting {
        let [direction, normal] = [query.direction, [query.normal[0], query.normal[1], query.normal[2]]]
            .map(|v| DVec3::from_array(v.map(f64::from)));
        let normal = normal.normalize();
        let plane = normal.cross(direction.cross(normal));
        let angle = plane.length().atan2(-direction.dot(normal));
        Meeting {
            length: direction.length(),
            normal,
            across: plane.normalize_or_zero(),
            angle,
            ratio: f64::from(query.ratio),
        }
    }

    /// Returns the angle of refraction; `None` for total internal reflection.
    fn behind(&self) -> Option<f64> {
        let sine = self.ratio * self.angle.sin();
        // The cosine is the root of (1 - sine) (1 + sine).
        (sine < 1.0).then(|| sine.atan2(((1.0 - sine) * (1.0 + sine)).sqrt()))
    }

    /// Returns the reflectance by sines and tangents of sum and difference of both angles.
    fn share(&self) -> f64 {
        let Some(behind) = self.behind() else { return 1.0 };
        let (less, more) = (self.angle - behind, self.angle + behind);
        if more < 1e-7 {
            return ((self.ratio - 1.0) / (self.ratio + 1.0)).powi(2);
        }
        let s = less.sin() / more.sin();
        let p = less.tan() / more.tan();
        0.5 * (s * s + p * p)
    }

    fn direction(&self) -> Option<DVec3> {
        let behind = self.behind()?;
        Some(self.length * (behind.sin() * self.across - behind.cos() * self.normal))
    }

    /// Returns the incidences half an ulp away in angle or ratio.
    fn neighbours(&self) -> [Meeting; 4] {
        let turned = |by: f64| Meeting { angle: (self.angle + by).clamp(0.0, FRAC_PI_2), ..*self };
        let other = |by: f64| Meeting { ratio: self.ratio * (1.0 + by), ..*self };
        [turned(H), turned(-H), other(H), other(-H)]
    }
}

fn share_error(query: &GlassQuery, answer: [f32; 4]) -> f64 {
    let meeting = Meeting::of(query);
    let exact = meeting.share();
    let moved = meeting.neighbours().map(|m| (m.share() - exact).abs()).into_iter().fold(0.0, f64::max);
    (f64::from(answer[3]) - exact).abs() / (moved + H)
}

/// Returns the error of the direction. It is 0 where half an ulp decides whether a refracted
/// direction exists, and for total reflection, where the direction is not used.
fn direction_error(query: &GlassQuery, answer: [f32; 4]) -> f64 {
    if answer[3] == 1.0 {
        return 0.0;
    }
    let meeting = Meeting::of(query);
    let neighbours = meeting.neighbours().map(|m| m.direction());
    let (Some(exact), [Some(a), Some(b), Some(c), Some(d)]) = (meeting.direction(), neighbours) else {
        return 0.0;
    };
    let moved = [a, b, c, d].map(|n| n.distance(exact)).into_iter().fold(0.0, f64::max);
    let [x, y, z, _] = answer.map(f64::from);
    DVec3::new(x, y, z).distance(exact) / (moved + H * meeting.length)
}
