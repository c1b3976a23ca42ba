//! A small drawing surface in display values (sRGB-encoded, 0 to 1) for rectangles, dots and lines
//! with antialiased edges, which becomes a film in linear light.

use crate::core::color::srgb_to_linear;
use crate::core::film::Film;

pub type Color = [f32; 3];

pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Color>,
}

impl Canvas {
    pub fn new(width: usize, height: usize, color: Color) -> Canvas {
        Canvas { width, height, pixels: vec![color; width * height] }
    }

    /// Blends the colour over the fraction `cover` of the pixel; pixels outside are ignored.
    fn mix(&mut self, x: i64, y: i64, color: Color, cover: f32) {
        let inside = (0..self.width as i64).contains(&x) && (0..self.height as i64).contains(&y);
        if inside && cover > 0.0 {
            let pixel = &mut self.pixels[y as usize * self.width + x as usize];
            *pixel = std::array::from_fn(|c| pixel[c] + cover.min(1.0) * (color[c] - pixel[c]));
        }
    }

    pub fn rectangle(&mut self, [x, y]: [usize; 2], [width, height]: [usize; 2], color: Color) {
        for v in y..y + height {
            for u in x..x + width {
                self.mix(u as i64, v as i64, color, 1.0);
            }
        }
    }

    /// Draws a disc around a point in pixel coordinates from the top left corner.
    pub fn dot(&mut self, [x, y]: [f64; 2], radius: f64, color: Color) {
        let span = |c: f64| (c - radius - 1.0).floor() as i64..=(c + radius + 1.0).ceil() as i64;
        for v in span(y) {
            for u in span(x) {
                let distance = (u as f64 + 0.5 - x).hypot(v as f64 + 0.5 - y);
                self.mix(u, v, color, (radius + 0.5 - distance).clamp(0.0, 1.0) as f32);
            }
        }
    }

    /// Draws a line as a row of overlapping dots.
    pub fn line(&mut self, [a, b]: [[f64; 2]; 2], radius: f64, color: Color) {
        let steps = (2.0 * (b[0] - a[0]).hypot(b[1] - a[1])).ceil().max(1.0) as u32;
        for i in 0..=steps {
            let share = f64::from(i) / f64::from(steps);
            self.dot([0, 1].map(|c| a[c] + share * (b[c] - a[c])), radius, color);
        }
    }

    pub fn film(self) -> Film {
        let linear = |p: &Color| p.map(|v| srgb_to_linear(f64::from(v)) as f32);
        Film {
            width: self.width as u32,
            height: self.height as u32,
            pixels: self.pixels.iter().map(linear).collect(),
            samples: 0,
        }
    }
}
