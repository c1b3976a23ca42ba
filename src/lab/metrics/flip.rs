//! FLIP (Andersson et al. 2020): the perceived difference of two pictures shown in alternation.
//! Takes linear RGB, shown clipped to [0, 1] on a screen of [`PIXELS_PER_DEGREE`], and returns one
//! value in [0, 1] per pixel, ΔE_c^(1 − ΔE_f): a colour difference after contrast sensitivity
//! filtering, raised where edges and points differ. The FLIP value of a picture is the mean.

use rayon::prelude::*;

use super::compare::check_sizes;
use super::flip_color::{difference, lab_hunt, linear_of, opponent};
use crate::core::error::Result;
use crate::core::film::Film;

/// The authors' default: 0.7 m away from a screen 0.7 m wide with 3840 pixels.
pub const PIXELS_PER_DEGREE: f64 = 3840.0 * std::f64::consts::PI / 180.0;
/// The width of a detected feature in degrees.
const FEATURE_WIDTH: f64 = 0.082;
const FEATURE_EXPONENT: f32 = 0.5;
/// The contrast sensitivity functions as Gaussians (a, b): achromatic, red-green, and the two of
/// blue-yellow.
const SENSITIVITY: [(f64, f64); 4] = [(1.0, 0.0047), (1.0, 0.0053), (34.1, 0.04), (13.5, 0.025)];
/// The opponent channel that each of them filters.
const CHANNEL: [usize; 4] = [0, 1, 2, 2];

/// The perceptual features of one picture, of which two are compared.
pub struct PerceptualFeatures {
    width: u32,
    height: u32,
    /// L*, and a* and b* with Hunt's adjustment.
    lab: Vec<[f32; 3]>,
    /// The strength of edge and point at each pixel.
    features: Vec<[f32; 2]>,
}

/// A symmetric row of weights around a pixel.
struct Kernel(Vec<f32>);

struct Plane {
    width: usize,
    values: Vec<f32>,
}

impl PerceptualFeatures {
    /// Computes the features of a film. A NaN counts as 0.
    pub fn of(film: &Film) -> PerceptualFeatures {
        let width = film.width.max(1) as usize;
        let clipped = |p: &[f32; 3]| opponent(p.map(|v| if v.is_nan() { 0.0 } else { v.clamp(0.0, 1.0) }));
        let opponents: Vec<[f32; 3]> = film.pixels.par_iter().map(clipped).collect();
        let plane = |c: usize| Plane { width, values: opponents.iter().map(|p| p[c]).collect() };
        let channels = [plane(0), plane(1), plane(2)];
        let blurred: Vec<Plane> = sensitivity_kernels()
            .iter()
            .zip(CHANNEL)
            .map(|(kernel, channel)| channels[channel].separable(kernel, kernel))
            .collect();
        let lab = |i: usize| {
            let [y, cx, cz, more_cz] = [0, 1, 2, 3].map(|b: usize| blurred[b].values[i]);
            lab_hunt(linear_of([y, cx, cz + more_cz]).map(|v| v.clamp(0.0, 1.0)))
        };
        let lab = (0..opponents.len()).into_par_iter().map(lab).collect();
        let grey = Plane { width, values: channels[0].values.iter().map(|y| (y + 16.0) / 116.0).collect() };
        PerceptualFeatures { width: film.width, height: film.height, lab, features: features(&grey) }
    }

    /// Returns the FLIP value of each pixel.
    pub fn map(&self, other: &PerceptualFeatures) -> Vec<f32> {
        let pixel = |i: usize| {
            let [edge, point] = [0, 1].map(|f| (self.features[i][f] - other.features[i][f]).abs());
            let feature = (edge.max(point) * std::f32::consts::FRAC_1_SQRT_2).powf(FEATURE_EXPONENT);
            difference(self.lab[i], other.lab[i]).powf(1.0 - feature)
        };
        (0..self.lab.len()).into_par_iter().map(pixel).collect()
    }

    pub fn mean(&self, other: &PerceptualFeatures) -> f64 {
        let map = self.map(other);
        map.iter().copied().map(f64::from).sum::<f64>() / map.len() as f64
    }
}

/// Returns the mean over the picture, which is symmetric in both films. It is NaN if a pixel of
/// either is NaN.
pub fn flip(a: &Film, b: &Film) -> Result<f64> {
    check_sizes(a, b)?;
    let nan = |film: &Film| film.pixels.iter().flatten().any(|v| v.is_nan());
    Ok(if nan(a) || nan(b) { f64::NAN } else { PerceptualFeatures::of(a).mean(&PerceptualFeatures::of(b)) })
}

impl PerceptualFeatures {
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }
}

/// Returns the kernels, normalised to a sum of 1 in two dimensions; the two of blue-yellow
/// together. b is in squared degrees: for exp(−π²x²/b) the weight in two dimensions is √(π/b)·a,
/// half of it in each.
fn sensitivity_kernels() -> [Kernel; 4] {
    let widest = SENSITIVITY.iter().map(|s| s.1).fold(0.0, f64::max);
    let pi2 = std::f64::consts::PI.powi(2);
    let radius = (3.0 * (widest / (2.0 * pi2)).sqrt() * PIXELS_PER_DEGREE).ceil() as i32;
    let gaussian = |(a, b): (f64, f64)| -> Vec<f64> {
        let height = (a * (std::f64::consts::PI / b).sqrt()).sqrt();
        let degrees = |x: i32| f64::from(x) / PIXELS_PER_DEGREE;
        (-radius..=radius).map(|x| height * (-pi2 * degrees(x).powi(2) / b).exp()).collect()
    };
    let rows = SENSITIVITY.map(gaussian);
    let total = |channel: usize| -> f64 {
        let of_channel = rows.iter().zip(CHANNEL).filter(|(_, c)| *c == channel);
        of_channel.map(|(row, _)| row.iter().sum::<f64>().powi(2)).sum::<f64>().sqrt()
    };
    let [y, cx, cz] = [0, 1, 2].map(total);
    let sums = [y, cx, cz, cz];
    std::array::from_fn(|i| Kernel(rows[i].iter().map(|w| (w / sums[i]) as f32).collect()))
}

/// Returns a Gaussian and its first and second derivatives, normalised so that positive weights sum
/// to 1 and negative ones to −1.
fn feature_kernels() -> [Kernel; 3] {
    let deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
    let radius = (3.0 * deviation).ceil() as i32;
    let scaled = |weights: Vec<f64>| {
        let positive: f64 = weights.iter().filter(|w| **w > 0.0).sum();
        let negative: f64 = -weights.iter().filter(|w| **w < 0.0).sum::<f64>();
        Kernel(weights.iter().map(|w| (w / if *w > 0.0 { positive } else { negative }) as f32).collect())
    };
    let g = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
    let row = |f: &dyn Fn(f64) -> f64| (-radius..=radius).map(|x| f(f64::from(x))).collect::<Vec<f64>>();
    let mut slope = row(&|x| -x * g(x));
    // The centre is zero and has neither sign; it must not be divided by a sum of either.
    slope[radius as usize] = 0.0;
    [scaled(row(&g)), scaled(slope), scaled(row(&|x| (x * x / (deviation * deviation) - 1.0) * g(x)))]
}

fn features(grey: &Plane) -> Vec<[f32; 2]> {
    let [g, d, dd] = feature_kernels();
    let across = [grey.separable(&d, &g), grey.separable(&g, &d)];
    let twice = [grey.separable(&dd, &g), grey.separable(&g, &dd)];
    let length = |pair: &[Plane; 2], i: usize| pair[0].values[i].hypot(pair[1].values[i]);
    (0..grey.values.len()).into_par_iter().map(|i| [length(&across, i), length(&twice, i)]).collect()
}

impl Plane {
    /// Convolves with weights along x, then along y; border pixels are extended.
    fn separable(&self, along_x: &Kernel, along_y: &Kernel) -> Plane {
        let (width, radius) = (self.width, along_x.0.len() / 2);
        let mut rows = vec![0f32; self.values.len()];
        rows.par_chunks_mut(width).zip(self.values.par_chunks(width)).for_each(|(out, row)| {
            let mut padded = vec![row[0]; radius];
            padded.extend_from_slice(row);
            padded.resize(width + 2 * radius, row[width - 1]);
            for (k, weight) in along_x.0.iter().enumerate() {
                add(out, &padded[k..k + width], *weight);
            }
        });
        let (height, radius) = (rows.len() / width, along_y.0.len() / 2);
        let mut values = vec![0f32; rows.len()];
        values.par_chunks_mut(width).enumerate().for_each(|(y, out)| {
            for (k, weight) in along_y.0.iter().enumerate() {
                let from = (y + k).saturating_sub(radius).min(height - 1);
                add(out, &rows[from * width..][..width], *weight);
            }
        });
        Plane { width, values }
    }
}

fn add(out: &mut [f32], row: &[f32], weight: f32) {
    out.iter_mut().zip(row).for_each(|(sum, value)| *sum += weight * value);
}
