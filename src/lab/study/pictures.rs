//! Films as pictures in a page: crops, downscaled pictures, differences in false colour, all as
//! data URIs, so that the page is self-contained.

use base64::prelude::{BASE64_STANDARD, Engine};

use crate::core::color::srgb_to_linear;
use crate::core::error::Result;
use crate::core::film::Film;
use crate::output::{self, Format, WriteOptions};

/// A part of a film, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// A colour ramp from dark to light in even steps of lightness, readable without colour (after
/// matplotlib's magma), in sRGB.
const RAMP: [[u8; 3]; 6] =
    [[0, 0, 4], [59, 15, 112], [140, 41, 129], [222, 73, 104], [254, 159, 109], [252, 253, 191]];

pub fn crop(film: &Film, window: Window) -> Film {
    let row = |y: u32| {
        let first = (y * film.width + window.x) as usize;
        film.pixels[first..first + window.width as usize].iter().copied()
    };
    Film {
        width: window.width,
        height: window.height,
        pixels: (window.y..window.y + window.height).flat_map(row).collect(),
        samples: film.samples,
    }
}

/// Returns the window with the largest sum of squared errors, each relative to its picture's mean.
pub fn worst_window(films: &[(&Film, f64)], reference: &Film, side: u32) -> Window {
    let (width, height) = (reference.width as usize, reference.height as usize);
    let (w, h) = (width.min(side as usize), height.min(side as usize));
    let weight = |i: usize| -> f64 {
        let of = |&(film, rmse): &(&Film, f64)| {
            let square = |c: usize| f64::from(film.pixels[i][c] - reference.pixels[i][c]).powi(2);
            let sum: f64 = (0..3).map(square).sum();
            if sum.is_finite() && rmse > 0.0 && rmse.is_finite() { sum / (rmse * rmse) } else { 0.0 }
        };
        films.iter().map(of).sum()
    };
    // Summed-area table over all pixels above and to the left (Crow 1984).
    let mut sums = vec![0.0f64; (width + 1) * (height + 1)];
    for y in 0..height {
        let mut row = 0.0;
        for x in 0..width {
            row += weight(y * width + x);
            sums[(y + 1) * (width + 1) + x + 1] = sums[y * (width + 1) + x + 1] + row;
        }
    }
    let at = |x: usize, y: usize| sums[y * (width + 1) + x];
    let mut best = (f64::NEG_INFINITY, 0, 0);
    for y in 0..=height - h {
        for x in 0..=width - w {
            let inside = at(x + w, y + h) - at(x, y + h) - at(x + w, y) + at(x, y);
            if inside > best.0 {
                best = (inside, x, y);
            }
        }
    }
    Window { x: best.1 as u32, y: best.2 as u32, width: w as u32, height: h as u32 }
}

/// Returns |a − b|, the mean of three channels, by pixel.
pub fn differences(a: &Film, b: &Film) -> Vec<f32> {
    let one = |(p, q): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (p[c] - q[c]).abs()).sum::<f32>() / 3.0;
    a.pixels.iter().zip(&b.pixels).map(one).collect()
}

/// Returns the value below which all but half a per cent of the values lie.
pub fn scale(values: &[impl AsRef<[f32]>]) -> f32 {
    let mut all: Vec<f32> =
        values.iter().flat_map(AsRef::as_ref).copied().filter(|v| v.is_finite()).collect();
    all.sort_by(f32::total_cmp);
    let last = all.len().saturating_sub(1);
    all.get(last * 199 / 200).copied().unwrap_or(1.0).max(f32::MIN_POSITIVE)
}

/// Maps values from 0 to `scale` to the ramp.
pub fn false_color(values: &[f32], width: u32, scale: f32) -> Film {
    let color = |value: &f32| {
        let t = if value.is_finite() { (value / scale).clamp(0.0, 1.0) } else { 1.0 };
        let place = t * (RAMP.len() - 1) as f32;
        let low = (place as usize).min(RAMP.len() - 2);
        let part = place - low as f32;
        [0, 1, 2].map(|c: usize| {
            let [a, b] = [low, low + 1].map(|i| f32::from(RAMP[i][c]));
            srgb_to_linear(f64::from(a + (b - a) * part) / 255.0) as f32
        })
    };
    let pixels: Vec<[f32; 3]> = values.iter().map(color).collect();
    Film { width, height: (values.len() / width.max(1) as usize) as u32, pixels, samples: 0 }
}

/// Returns a CSS gradient of the same ramp.
pub fn ramp_css() -> String {
    let stops: Vec<String> = RAMP.iter().map(|[r, g, b]| format!("rgb({r},{g},{b})")).collect();
    format!("linear-gradient(to right,{})", stops.join(","))
}

/// Returns a picture at most `most` pixels wide, averaged over squares of whole pixels.
pub fn downscaled(film: &Film, most: u32) -> Film {
    averaged(film, film.width.div_ceil(most).max(1))
}

/// Returns a picture whose pixels are means over squares of `step` pixels.
pub fn averaged(film: &Film, step: u32) -> Film {
    if step == 1 {
        return film.clone();
    }
    let (width, height) = ((film.width / step).max(1), (film.height / step).max(1));
    let mean = |x: u32, y: u32| {
        let mut sum = [0f64; 3];
        let mut count = 0.0;
        for sy in (y * step..(y + 1) * step).take_while(|sy| *sy < film.height) {
            for sx in (x * step..(x + 1) * step).take_while(|sx| *sx < film.width) {
                let pixel = film.pixels[(sy * film.width + sx) as usize];
                (0..3).for_each(|c| sum[c] += f64::from(pixel[c]));
                count += 1.0;
            }
        }
        sum.map(|s| (s / count) as f32)
    };
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| mean(x, y))).collect();
    Film { width, height, pixels, samples: film.samples }
}

/// Returns a data URI: PNG keeps single pixels distinct, JPEG is small.
pub fn data_uri(film: &Film, format: Format) -> Result<String> {
    data_uri_with(film, format, &WriteOptions::default())
}

pub fn data_uri_with(film: &Film, format: Format, options: &WriteOptions<'_>) -> Result<String> {
    let media = if format == Format::Png { "png" } else { "jpeg" };
    let bytes = output::to_bytes_with(film, format, options)?;
    Ok(format!("data:image/{media};base64,{}", BASE64_STANDARD.encode(bytes)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn worst_window_finds_a_planted_error() {
        let reference = Film::new(50, 40, 1);
        let mut film = reference.clone();
        film.pixels[33 * 50 + 44] = [1.0; 3];
        let window = worst_window(&[(&film, 0.1)], &reference, 16);
        assert!((29..=34).contains(&window.x) && (18..=24).contains(&window.y), "{window:?}");
        assert_eq!(crop(&film, window).pixels.iter().filter(|p| p[0] > 0.0).count(), 1);
    }

    #[test]
    fn shrinking_keeps_the_mean() {
        let mut film = Film::new(64, 32, 1);
        film.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = [i as f32; 3]);
        let small = downscaled(&film, 16);
        let mean = |f: &Film| f.pixels.iter().map(|p| p[0]).sum::<f32>() / f.pixels.len() as f32;
        assert_eq!((small.width, small.height), (16, 8));
        assert!((mean(&small) - mean(&film)).abs() < 1e-2);
    }
}
