//! Draws a legend under a picture: a bar of colours with numbers, or swatches with names, and a line that says what the
//! colours mean. Input: the picture's film. Output: a taller one.

use super::colors::{NOTHING, light};
use super::font;
use super::scale::Tick;
use crate::core::film::Film;

/// What stands under a picture.
pub struct Legend {
    /// What the colours mean.
    pub title: String,
    pub key: Key,
}

/// The colours and their values.
pub enum Key {
    /// A bar from left to right, by its colour at a place in [0, 1], with values under it.
    Bar { color: fn(f64) -> [u8; 3], ticks: Vec<Tick> },
    /// Colours with names.
    Swatches(Vec<Swatch>),
    /// The title says it all.
    None,
}

/// A colour and its name.
pub struct Swatch {
    pub color: [u8; 3],
    pub name: String,
}

const INK: [u8; 3] = [236, 236, 241];
/// Distances and sizes in pixels of the font.
const MARGIN: usize = 4;
const BAR: usize = 8;
/// The narrowest picture that has room for a legend; narrower ones get ground beside them.
const MIN_WIDTH: usize = 256;
/// Pictures from this width on have a font of twice the size.
const WIDE: usize = 640;

/// Returns the picture with its legend under it.
pub fn with_legend(film: &Film, legend: &Legend) -> Film {
    let size = if film.width as usize >= WIDE { 2 } else { 1 };
    let width = (film.width as usize).max(MIN_WIDTH);
    let rows = match &legend.key {
        Key::Bar { .. } => BAR + 2 + font::HEIGHT,
        Key::Swatches(_) => font::HEIGHT,
        Key::None => 0,
    };
    let gap = if rows > 0 { MARGIN } else { 0 };
    let height = (MARGIN + font::HEIGHT + gap + rows + MARGIN) * size;
    let mut canvas = Canvas::new(film, width, height, size);
    let line = MARGIN + font::HEIGHT + gap;
    canvas.text(&legend.title, MARGIN, MARGIN);
    match &legend.key {
        Key::Bar { color, ticks } => canvas.bar(*color, ticks, line),
        Key::Swatches(swatches) => canvas.swatches(swatches, line),
        Key::None => {}
    }
    canvas.film
}

/// A film with ground under the picture, addressed in pixels of the font.
struct Canvas {
    film: Film,
    /// First row under the picture.
    top: usize,
    /// Pixels of the film for each of the font.
    size: usize,
}

impl Canvas {
    fn new(picture: &Film, width: usize, height: usize, size: usize) -> Canvas {
        let top = picture.height as usize;
        let mut film = Film::new(width as u32, (top + height) as u32, picture.samples);
        film.pixels.fill(light(NOTHING));
        for (row, of) in film.pixels.chunks_mut(width).zip(picture.pixels.chunks(picture.width as usize)) {
            row[..of.len()].copy_from_slice(of);
        }
        Canvas { film, top, size }
    }

    /// Returns the width in pixels of the font.
    fn width(&self) -> usize {
        self.film.width as usize / self.size
    }

    fn dot(&mut self, x: usize, y: usize, color: [u8; 3]) {
        let width = self.film.width as usize;
        for row in y * self.size..(y + 1) * self.size {
            for column in (x * self.size..(x + 1) * self.size).filter(|&column| column < width) {
                if let Some(pixel) = self.film.pixels.get_mut((self.top + row) * width + column) {
                    *pixel = light(color);
                }
            }
        }
    }

    fn text(&mut self, text: &str, x: usize, y: usize) {
        font::draw(text, |column, row| self.dot(x + column, y + row, INK));
    }

    fn bar(&mut self, color: fn(f64) -> [u8; 3], ticks: &[Tick], y: usize) {
        let length = self.width() - 2 * MARGIN;
        for x in 0..length {
            let at = (x as f64 + 0.5) / length as f64;
            (0..BAR).for_each(|row| self.dot(MARGIN + x, y + row, color(at)));
        }
        let at = |tick: &Tick| MARGIN + (tick.at * (length - 1) as f64).round() as usize;
        // Names at the ends stay within the picture; of the others, those that would touch the last one are left out.
        let left = |tick: &Tick| {
            let width = font::width(&tick.text);
            let middle = at(tick).saturating_sub(width / 2);
            middle.max(MARGIN).min((MARGIN + length).saturating_sub(width))
        };
        let last = ticks.last().map_or(0, left);
        for (i, tick) in ticks.iter().enumerate() {
            self.dot(at(tick), y + BAR, INK);
            if i + 1 == ticks.len() || left(tick) + font::width(&tick.text) < last {
                self.text(&tick.text, left(tick), y + BAR + 2);
            }
        }
    }

    /// Draws as many swatches as there is room for.
    fn swatches(&mut self, swatches: &[Swatch], y: usize) {
        let mut x = MARGIN;
        for Swatch { color, name } in swatches {
            if x + 2 * font::ADVANCE + font::width(name) > self.width() {
                break;
            }
            for row in 0..font::HEIGHT - 1 {
                (0..font::HEIGHT - 1).for_each(|column| self.dot(x + column, y + row, *color));
            }
            self.text(name, x + font::HEIGHT + 2, y);
            x += font::HEIGHT + 2 + font::width(name) + font::ADVANCE;
        }
    }
}
