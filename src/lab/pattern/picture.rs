//! Draws a point set and its spectrum. Upper row: the points in the pixel (y downwards, as in a
//! picture) with the pattern's strata and the projections on both axes as ticks; the power
//! spectrum, black for 0, middle grey for 1 and white from 2 on, frequency 0 at the centre; its
//! radial mean, from 0 to 2 upwards, with lines at 1 and at the frequency √N. Lower row: the points
//! of the next three pairs of dimensions, then the first pair's x with the next one's x, y with y
//! and x with y.

use super::canvas::{Canvas, Color};
use super::points::Set;
use super::spectrum::Spectrum;
use crate::core::film::Film;
use crate::oracle::patterns::HALTON_PAIRS;

const PANEL: usize = 258; // two pixels for each of 129 frequencies
const SMALL: usize = 126;
const TICKS: usize = 10;
const GAP: usize = 8;

const PAPER: Color = [1.0; 3];
const FRAME: Color = [0.55; 3];
const STRATA: Color = [0.86; 3];
const INK: Color = [0.1, 0.1, 0.14];
const CURVE: Color = [0.12, 0.35, 0.75];

pub fn picture(set: &Set, spectrum: &Spectrum) -> Film {
    let width = 3 * PANEL + TICKS + 4 * GAP;
    let mut canvas = Canvas::new(width, PANEL + TICKS + SMALL + 3 * GAP, [0.94; 3]);
    let points = set.realisation(0);
    pixel(&mut canvas, [GAP + TICKS, GAP], set, &points);
    power(&mut canvas, [2 * GAP + TICKS + PANEL, GAP], spectrum);
    radial(&mut canvas, [3 * GAP + TICKS + 2 * PANEL, GAP], spectrum, set.samples);

    let next = |by: u32| set.with_pair((set.pair + by) % HALTON_PAIRS).realisation(0);
    let others = [1, 2, 3].map(next);
    let join = |a: usize, b: usize| points.iter().zip(&others[0]).map(|(p, q)| [p[a], q[b]]).collect();
    let mixed: [Vec<[f64; 2]>; 3] = [join(0, 0), join(1, 1), join(0, 1)];
    let room = width - 2 * GAP - 6 * SMALL;
    for (i, projection) in others.iter().chain(&mixed).enumerate() {
        let left = GAP + i * SMALL + i * room / 5;
        panel(&mut canvas, [left, 2 * GAP + PANEL + TICKS], SMALL);
        scatter(&mut canvas, [left, 2 * GAP + PANEL + TICKS], SMALL, projection);
    }
    canvas.film()
}

fn panel(canvas: &mut Canvas, [x, y]: [usize; 2], side: usize) {
    canvas.rectangle([x - 1, y - 1], [side + 2, side + 2], FRAME);
    canvas.rectangle([x, y], [side, side], PAPER);
}

/// Draws dots whose size decreases with their number.
fn scatter(canvas: &mut Canvas, [x, y]: [usize; 2], side: usize, points: &[[f64; 2]]) {
    let apart = side as f64 / (points.len() as f64).sqrt();
    let radius = (0.12 * apart).clamp(0.5, 3.5);
    for p in points {
        let at = [x as f64 + p[0] * side as f64, y as f64 + p[1] * side as f64];
        canvas.dot(at, radius, INK);
    }
}

fn pixel(canvas: &mut Canvas, corner: [usize; 2], set: &Set, points: &[[f64; 2]]) {
    panel(canvas, corner, PANEL);
    let [x, y] = corner;
    for (axis, cells) in set.strata().into_iter().flatten().enumerate() {
        // Lines closer than four pixels would merge into grey.
        if cells as usize * 4 > PANEL {
            continue;
        }
        for line in 1..cells as usize {
            let at = line * PANEL / cells as usize;
            let (place, size) = if axis == 0 { ([x + at, y], [1, PANEL]) } else { ([x, y + at], [PANEL, 1]) };
            canvas.rectangle(place, size, STRATA);
        }
    }
    scatter(canvas, corner, PANEL, points);
    for p in points {
        let [across, down] = p.map(|c| (c * PANEL as f64) as usize);
        canvas.rectangle([x + across, y + PANEL + 2], [1, TICKS - 2], INK);
        canvas.rectangle([x - TICKS, y + down], [TICKS - 2, 1], INK);
    }
}

fn power(canvas: &mut Canvas, [x, y]: [usize; 2], spectrum: &Spectrum) {
    panel(canvas, [x, y], PANEL);
    let side = 2 * spectrum.limit + 1;
    for v in 0..PANEL {
        for u in 0..PANEL {
            let power = spectrum.power[v * side / PANEL * side + u * side / PANEL];
            canvas.rectangle([x + u, y + v], [1, 1], [(0.5 * power).min(1.0) as f32; 3]);
        }
    }
}

fn radial(canvas: &mut Canvas, [x, y]: [usize; 2], spectrum: &Spectrum, samples: u32) {
    panel(canvas, [x, y], PANEL);
    let across = |f: f64| x as f64 + f / spectrum.limit as f64 * (PANEL - 1) as f64;
    let down = |power: f64| y as f64 + (1.0 - 0.5 * power.min(2.0)) * (PANEL - 1) as f64;
    canvas.rectangle([x, down(1.0) as usize], [PANEL, 1], STRATA);
    canvas.rectangle([across(f64::from(samples).sqrt()) as usize, y], [1, PANEL], STRATA);
    let curve: Vec<[f64; 2]> =
        spectrum.radial_mean().iter().zip(1..).map(|(&p, f)| [across(f64::from(f)), down(p)]).collect();
    for pair in curve.windows(2) {
        canvas.line([pair[0], pair[1]], 0.7, CURVE);
    }
}
