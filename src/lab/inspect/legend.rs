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
/// From one line of swatches to the next one, and how many lines there are at most.
const LINE: usize = font::HEIGHT + 2;
const MOST_LINES: usize = 24;
/// The narrowest picture that has room for a legend; narrower ones get ground beside them.
const MIN_WIDTH: usize = 256;
/// Pictures from this width on have a font of twice the size.
const WIDE: usize = 640;

/// Returns the picture with its legend under it.
pub fn with_legend(film: &Film, legend: &Legend) -> Film {
    let size = if film.width as usize >= WIDE { 2 } else { 1 };
    let width = (film.width as usize).max(MIN_WIDTH);
    let lines = match &legend.key {
        Key::Swatches(swatches) => lines(swatches, width / size, film.height as usize / size),
        _ => Vec::new(),
    };
    let rows = match &legend.key {
        Key::Bar { .. } => BAR + 2 + font::HEIGHT,
        Key::Swatches(_) => lines.len() * LINE,
        Key::None => 0,
    };
    let gap = if rows > 0 { MARGIN } else { 0 };
    let height = (MARGIN + font::HEIGHT + gap + rows + MARGIN) * size;
    let mut canvas = Canvas::new(film, width, height, size);
    let line = MARGIN + font::HEIGHT + gap;
    canvas.text(&legend.title, MARGIN, MARGIN);
    match &legend.key {
        Key::Bar { color, ticks } => canvas.bar(*color, ticks, line),
        Key::Swatches(_) => {
            lines.iter().enumerate().for_each(|(i, own)| canvas.swatches(own, line + i * LINE))
        }
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

    fn swatches(&mut self, line: &Line<'_>, y: usize) {
        let mut x = MARGIN;
        for Swatch { color, name } in line.swatches {
            for row in 0..font::HEIGHT - 1 {
                (0..font::HEIGHT - 1).for_each(|column| self.dot(x + column, y + row, *color));
            }
            self.text(name, x + font::HEIGHT + 2, y);
            x += width_of(name);
        }
        self.text(&line.rest, x, y);
    }
}

/// A line of swatches, and what stands behind them.
struct Line<'a> {
    swatches: &'a [Swatch],
    rest: String,
}

/// Returns the width of a swatch with its name and the gap behind it.
fn width_of(name: &str) -> usize {
    font::HEIGHT + 2 + font::width(name) + font::ADVANCE
}

/// Returns swatches in lines within a width, in pixels of the font. Of more than have room under a picture of that height,
/// the last line says how many are left out.
fn lines(swatches: &[Swatch], width: usize, height: usize) -> Vec<Line<'_>> {
    let most = (height / LINE).clamp(1, MOST_LINES);
    let mut lines = Vec::new();
    let mut rest = swatches;
    while !rest.is_empty() {
        let is_last = lines.len() + 1 == most;
        let told = |left: usize| if left > 0 { format!("and {left} more") } else { String::new() };
        let fit = |reserved: usize| {
            let mut x = MARGIN + reserved;
            let fits = |own: &&Swatch| {
                x += width_of(&own.name);
                x <= width + font::ADVANCE
            };
            rest.iter().take_while(fits).count()
        };
        let all = fit(0);
        if is_last && all < rest.len() {
            let count = fit(font::width(&told(rest.len())));
            lines.push(Line { swatches: &rest[..count], rest: told(rest.len() - count) });
            break;
        }
        // A name that is wider than the picture is cut at its edge.
        let (line, others) = rest.split_at(all.max(1));
        lines.push(Line { swatches: line, rest: String::new() });
        rest = others;
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    fn swatches(count: usize) -> Vec<Swatch> {
        (0..count).map(|i| Swatch { color: [0; 3], name: format!("{i:02}") }).collect()
    }

    fn counts(count: usize, height: usize) -> (Vec<usize>, String) {
        let swatches = swatches(count);
        let found = lines(&swatches, 256, height);
        let last = found.last().map_or(String::new(), |line| line.rest.clone());
        (found.iter().map(|line| line.swatches.len()).collect(), last)
    }

    #[test]
    fn swatches_fill_lines_and_what_has_no_room_is_counted() {
        // A name of two letters takes 28 pixels.
        assert_eq!(counts(10, 200), (vec![9, 1], String::new()));
        assert_eq!(counts(20, 200), (vec![9, 9, 2], String::new()));
        assert_eq!(counts(9, 8), (vec![9], String::new()));
        let (lines, rest) = counts(200, 40);
        let shown: usize = lines.iter().sum();
        assert_eq!((lines.len(), rest), (4, format!("and {} more", 200 - shown)));
        assert_eq!(counts(5, 1).0, [5], "there is one line at least");
    }

    #[test]
    fn a_name_without_room_has_a_line_of_its_own() {
        let mut all = swatches(3);
        all[1].name = "x".repeat(100);
        let found = lines(&all, 256, 200);
        assert_eq!(found.iter().map(|line| line.swatches.len()).collect::<Vec<_>>(), [1, 1, 1]);
    }
}
