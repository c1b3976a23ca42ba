//! The part of a disc that lines or a circle cover, and its centroid. Twin of `glsl/shared/coverage.glsl`.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Fraction of the disc's area, and the centroid of the covered part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covered {
    pub share: f64,
    pub center: DVec2,
}

pub const NOTHING: Covered = Covered { share: 0.0, center: DVec2::ZERO };
pub const EVERYTHING: Covered = Covered { share: 1.0, center: DVec2::ZERO };

/// Smaller fractions count as 0.
pub const MIN_SHARE: f64 = 1e-5;

/// With more lines the oldest are left out.
const MAX_CUTS: usize = 6;

/// A line through the centre is moved by this distance, so that its fragment subtends an angle there.
const BESIDE: f64 = 1e-9;

/// Lines with a smaller sine between them count as parallel.
const PARALLEL: f64 = 1e-4;

/// The lines that cross the disc, the newest first: covered is a x + b y + c ≥ 0, where (a, b) has unit
/// length.
#[derive(Clone, Debug, Default)]
pub struct Cuts {
    lines: Vec<DVec3>,
    /// True if some line leaves nothing.
    pub away: bool,
}

impl Cuts {
    pub fn by(&mut self, line: DVec3) {
        let length = line.truncate().length();
        let mut unit = line / if length > 0.0 { length } else { 1.0 };
        if unit.z.abs() < BESIDE {
            unit.z = BESIDE;
        }
        // A line at infinity leaves everything or nothing.
        let beyond = match length > 0.0 {
            true => unit.z,
            false if line.z > 0.0 => 1.0,
            false => -1.0,
        };
        self.away |= beyond.is_nan() || beyond <= -1.0;
        if beyond > -1.0 && beyond < 1.0 {
            self.lines.insert(0, unit);
            self.lines.truncate(MAX_CUTS);
        }
    }

    /// Returns the part of the disc that the lines leave.
    pub fn covered(&self) -> Covered {
        if self.away {
            return NOTHING;
        }
        if self.lines.is_empty() {
            return EVERYTHING;
        }
        let (mut twice_area, mut turn, mut moment) = (0.0, 0.0, DVec2::ZERO);
        for (i, line) in self.lines.iter().enumerate() {
            let c = line.z;
            let way = DVec2::new(line.y, -line.x);
            let foot = -c * line.truncate();
            let rim = (1.0 - c * c).max(0.0).sqrt();
            let (from, to) = self.fragment(i, foot, way, rim);
            if from >= to {
                continue;
            }
            let (p, q) = (foot + from * way, foot + to * way);
            twice_area += c * (to - from);
            turn += (c * (to - from)).atan2(p.dot(q));
            moment += c * (to - from) * (p + q);
            if from == -rim {
                moment += 2.0 * DVec2::new(p.y, -p.x);
            }
            if to == rim {
                moment -= 2.0 * DVec2::new(q.y, -q.x);
            }
        }
        let holds_center = self.lines.iter().all(|line| line.z >= 0.0);
        let arcs = if holds_center { 2.0 * PI } else { 0.0 } - turn;
        let share = ((twice_area + arcs) / (2.0 * PI)).min(1.0);
        if share.is_nan() || share <= MIN_SHARE {
            return NOTHING;
        }
        Covered { share, center: moment / (6.0 * PI * share) }
    }

    /// Returns the interval in which line `i` bounds the covered part, from its foot point.
    fn fragment(&self, i: usize, foot: DVec2, way: DVec2, rim: f64) -> (f64, f64) {
        let (mut from, mut to) = (-rim, rim);
        let line = self.lines[i];
        for (j, other) in self.lines.iter().enumerate().filter(|(j, _)| *j != i) {
            let slope = other.truncate().dot(way);
            let alike = other.truncate().dot(line.truncate()) > 0.0;
            if slope.abs() < PARALLEL {
                // Of two equal lines the second has no interval; two opposite ones see the same gap.
                let gap = if alike { other.z - line.z } else { other.z + line.z };
                if gap < 0.0 || (j < i && gap == 0.0 && alike) {
                    to = from;
                }
                continue;
            }
            let end = -(other.truncate().dot(foot) + other.z) / slope;
            if slope > 0.0 {
                from = from.max(end);
            } else {
                to = to.min(end);
            }
        }
        (from, to)
    }
}

/// Returns φ - sin φ cos φ from sine and cosine in [0, 1].
pub fn segment(sine: f64, cosine: f64) -> f64 {
    let y = sine * sine;
    if y < 1e-4 {
        sine * y * (2.0 / 3.0 + y * (0.2 + y * (3.0 / 28.0 + y * (5.0 / 72.0))))
    } else {
        sine.atan2(cosine) - sine * cosine
    }
}

/// Returns the overlap of the disc with a circle around `middle`; `edge` is the radius less the distance of
/// `middle` from the disc's centre.
pub fn circle_overlap(middle: DVec2, radius: f64, edge: f64) -> Covered {
    if edge.is_nan() || edge <= -1.0 {
        return NOTHING;
    }
    if edge >= 1.0 {
        return EVERYTHING;
    }
    let apart = middle.length();
    let found = |share: f64, center: DVec2| {
        if share > MIN_SHARE { Covered { share, center } } else { NOTHING }
    };
    if radius + apart <= 1.0 {
        return found(radius * radius, middle);
    }
    let chord = (1.0 - edge * (radius + apart)) / (2.0 * apart);
    let half_length = (1.0 - chord * chord).max(0.0).sqrt();
    let own = segment(half_length, chord.abs());
    let own = if chord < 0.0 { PI - own } else { own };
    let sine = (half_length / radius).min(1.0);
    let other = segment(sine, ((apart - chord).abs() / radius).min(1.0));
    let other = if apart < chord { PI - other } else { other } * radius * radius;
    let share = ((own + other) / PI).min(1.0);
    found(share, middle * (other / (PI * share)))
}

/// Half the side of a square with the disc's area: √π / 2.
const SQUARE: f64 = 0.886_226_925_452_758;

/// Returns the overlap with a small circle, both replaced by squares of equal area.
pub fn small_overlap(middle: DVec2, radius: f64) -> Covered {
    let side = SQUARE * radius;
    let from = (middle - side).max(DVec2::splat(-SQUARE));
    let to = (middle + side).min(DVec2::splat(SQUARE));
    let share = (to - from).max(DVec2::ZERO).element_product() / PI;
    if share > MIN_SHARE { Covered { share, center: 0.5 * (from + to) } } else { NOTHING }
}

/// Returns the overlap with a circle of any size.
pub fn ball_overlap(middle: DVec2, radius: f64, edge: f64) -> Covered {
    let large = (2.0 * radius - 1.0).clamp(0.0, 1.0);
    let b = circle_overlap(middle, radius, edge);
    if large >= 1.0 {
        return b;
    }
    let a = small_overlap(middle, radius);
    let (from_a, from_b) = ((1.0 - large) * a.share, large * b.share);
    let share = from_a + from_b;
    if share > MIN_SHARE {
        Covered { share, center: (from_a * a.center + from_b * b.center) / share }
    } else {
        NOTHING
    }
}

/// Returns a line that leaves about as much as the circle.
pub fn circle_line(middle: DVec2, radius: f64, edge: f64) -> DVec3 {
    if edge.is_nan() || edge <= -1.0 || edge >= 1.0 {
        return DVec3::new(0.0, 0.0, edge);
    }
    let apart = middle.length();
    let chord = (1.0 - edge * (radius + apart)) / (2.0 * apart);
    let rise = (1.0 - chord * chord).max(0.0) / (3.0 * radius);
    (middle / apart).extend(rise - chord)
}
