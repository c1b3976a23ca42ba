//! Colours of procedural textures in f64, from a point in texture space and a footprint. `dx` and `dy` span
//! the footprint (full widths; zero evaluates the point itself). Twin of `glsl/shared/procedural.glsl`.

use std::f64::consts::PI;

use glam::DVec3;

use super::math::sine_turns;
use super::noise::{cell_distance, cell_mean, kept, octave_sum};
use crate::schema::layout::Procedural;
use crate::texture::procedural::ProceduralKind;

/// Most boxes along a footprint's major axis.
pub const MAX_BOXES: f64 = 16.0;
/// Wider footprints are averaged as if they had this width.
pub const WIDEST: f64 = 1e9;

fn bounded_point(at: DVec3) -> DVec3 {
    DVec3::from_array(at.to_array().map(|x| if x.abs() <= 1e15 { x } else { 0.0 }))
}

fn bounded_width(d: DVec3) -> DVec3 {
    DVec3::from_array(d.to_array().map(|x| if x.abs() <= WIDEST { x } else { WIDEST }))
}

/// Returns orthogonal axes with the parallelogram's second moments, the longer first.
pub fn principal_axes(dx: DVec3, dy: DVec3) -> (DVec3, DVec3) {
    let (xx, yy, xy) = (dx.dot(dx), dy.dot(dy), dx.dot(dy));
    let mut t = 0.0;
    if xy.abs() > 1e-30 {
        let zeta = (yy - xx) / (2.0 * xy);
        t = (if zeta >= 0.0 { 1.0 } else { -1.0 }) / (zeta.abs() + (1.0 + zeta * zeta).sqrt());
    }
    let c = 1.0 / (1.0 + t * t).sqrt();
    let (a, b) = (c * dx - c * t * dy, c * dy + c * t * dx);
    if b.dot(b) > a.dot(a) { (b, a) } else { (a, b) }
}

/// Returns the number of boxes that approximate the footprint, not rounded up.
pub fn box_count(major: DVec3, minor: DVec3) -> f64 {
    let reach = major.abs();
    let oblique = reach.x.min(reach.y).max(reach.x.max(reach.y).min(reach.z));
    let ratio = oblique / minor.length().max(1e-20);
    ratio.min(1.0 + MAX_BOXES * oblique).clamp(1.0, MAX_BOXES)
}

/// Returns the mean over [x − w/2, x + w/2] of a pulse train: 1 within duty/2 of integer x, otherwise 0.
pub fn pulse_mean(x: f64, w: f64, duty: f64) -> f64 {
    let s = x - x.round_ties_even();
    let half_duty = 0.5 * duty;
    if w <= 1e-30 {
        return if (s >= -half_duty && s < half_duty) || duty >= 1.0 { 1.0 } else { 0.0 };
    }
    let periods = w.floor();
    let rest = w - periods;
    let q = if periods - 2.0 * (0.5 * periods).floor() != 0.0 { 0.5 - s.abs() } else { s.abs() };
    let first = (half_duty - q + 0.5 * rest).clamp(0.0, rest.min(duty));
    let second = (q - (1.0 - half_duty) + 0.5 * rest).max(0.0);
    (periods * duty + first + second) / w
}

/// Returns the figure's share in a box around `at`; bricks have x in units of bricks here.
fn box_share(what: &Procedural, kind: ProceduralKind, at: DVec3, w: DVec3) -> f64 {
    let Procedural { width, aspect, offset, .. } = *what;
    match kind {
        ProceduralKind::Checker => {
            let middle = 0.5 * (at - 1.5);
            let wave = |i: usize| 1.0 - 2.0 * pulse_mean(middle[i], 0.5 * w[i], 0.5);
            0.5 - 0.5 * wave(0) * wave(1) * wave(2)
        }
        ProceduralKind::Stripes => pulse_mean(at.x - 0.5 * width, w.x, width),
        ProceduralKind::Grid => {
            let between = |i: usize| 1.0 - pulse_mean(at[i], w[i], width);
            let depth = if what.dimensions == 3 { between(2) } else { 1.0 };
            1.0 - between(0) * between(1) * depth
        }
        _ => {
            let row = 0.5 * (at.y - 0.5);
            let column = at.x - 0.5;
            let (duty_x, duty_y) = (1.0 - width / aspect, 0.5 * (1.0 - width));
            pulse_mean(row, 0.5 * w.y, duty_y) * pulse_mean(column, w.x, duty_x)
                + pulse_mean(row - 0.5, 0.5 * w.y, duty_y) * pulse_mean(column - offset, w.x, duty_x)
        }
    }
}

/// Returns the figure's share in the footprint. A box has the second moments of its part of the footprint.
fn footprint_share(what: &Procedural, kind: ProceduralKind, at: DVec3, major: DVec3, minor: DVec3) -> f64 {
    let mut unit = DVec3::ONE;
    if kind == ProceduralKind::Brick {
        unit.x = what.aspect;
    }
    let p = at / unit;
    let p = p - 2.0 * DVec3::from_array((0.5 * p).to_array().map(f64::round_ties_even));
    let (major, minor) = (major / unit, minor / unit);
    let count = box_count(major, minor).ceil();
    let step = major / count;
    let squares = step * step + minor * minor;
    let w = DVec3::from_array(squares.to_array().map(f64::sqrt));
    let shares =
        (0..count as u32).map(|i| box_share(what, kind, p + step * (f64::from(i) + 0.5 - 0.5 * count), w));
    shares.sum::<f64>() / count
}

/// Returns the ratio of the mean of a sine of period 1 over a box of width w to its value at the centre.
pub fn box_attenuation(w: f64) -> f64 {
    let x = w.abs();
    if x < 1e-3 { 1.0 } else { sine_turns(0.5 * x) / (PI * x) }
}

/// Returns the attenuation of a sine by a random phase, in turns: exp(−2π² variance), by the start of its
/// series.
pub fn phase_attenuation(variance: f64) -> f64 {
    let v = 2.0 * PI * PI * variance;
    1.0 / (1.0 + v * (1.0 + v * (0.5 + v / 6.0)))
}

/// Veins at integer x + distortion · turbulence.
fn marble(what: &Procedural, at: DVec3, dx: DVec3, dy: DVec3, size: f64, widths: DVec3) -> f64 {
    let (turbulence, faded) = octave_sum(what, at, size, widths, true);
    let distortion = f64::from(what.distortion);
    let strength =
        box_attenuation(dx.x) * box_attenuation(dy.x) * phase_attenuation(distortion * distortion * faded);
    0.5 + 0.5 * strength * sine_turns(at.x + distortion * turbulence)
}

/// Returns the variation of the distance r from the z axis along d.
fn radial_width(at: DVec3, r: f64, d: DVec3) -> f64 {
    let along = (at.x * d.x + at.y * d.y) / r.max(1e-20);
    let square = d.x * d.x + d.y * d.y;
    let across = (square - along * along).max(0.0);
    (along * along + across * square / (square + 4.0 * r * r).max(1e-30)).sqrt()
}

/// Rings at integer distances from the z axis + distortion · noise.
fn wood(what: &Procedural, at: DVec3, dx: DVec3, dy: DVec3, size: f64, widths: DVec3) -> f64 {
    let (noise, faded) = octave_sum(what, at, size, widths, false);
    let distortion = f64::from(what.distortion);
    let r = at.x.hypot(at.y);
    let strength = box_attenuation(radial_width(at, r, dx))
        * box_attenuation(radial_width(at, r, dy))
        * phase_attenuation(distortion * distortion * faded);
    0.5 - 0.5 * strength * sine_turns(r + distortion * noise + 0.25)
}

/// Returns the weight of the figure's colour, 0 to 1.
pub fn figure_share(what: &Procedural, at: DVec3, dx: DVec3, dy: DVec3) -> f64 {
    let kind = what.kind;
    let (major, minor) = principal_axes(dx, dy);
    let size = major.length();
    let squares = major * major + minor * minor;
    let widths = DVec3::from_array(squares.to_array().map(f64::sqrt));
    match kind {
        ProceduralKind::Checker | ProceduralKind::Stripes | ProceduralKind::Grid | ProceduralKind::Brick => {
            footprint_share(what, kind, at, major, minor)
        }
        ProceduralKind::Turbulence => octave_sum(what, at, size, widths, true).0,
        ProceduralKind::Marble => marble(what, at, dx, dy, size, widths),
        ProceduralKind::Wood => wood(what, at, dx, dy, size, widths),
        ProceduralKind::Cellular => {
            let (keep, jitter) = (kept(size), what.jitter);
            keep * cell_distance(at, what.seed, jitter) + (1.0 - keep) * cell_mean(at, widths, jitter)
        }
        ProceduralKind::Noise | ProceduralKind::Fbm => {
            0.5 + 0.5 * octave_sum(what, at, size, widths, false).0
        }
    }
}

pub fn procedural_color(what: &Procedural, at: DVec3, dx: DVec3, dy: DVec3) -> DVec3 {
    let share = figure_share(what, bounded_point(at), bounded_width(dx), bounded_width(dy));
    (1.0 - share) * what.background.as_dvec3() + share * what.figure.as_dvec3()
}
