//! A film to draw on: rectangles, films with enlarged pixels, and text. Input: places and colours. Output: pixels. The
//! letters are Noto Sans Mono as bitmaps with soft edges; what it does not have is drawn by a like letter.

use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

use crate::core::color::{linear_to_srgb, srgb_to_linear};
use crate::core::film::Film;

const HEIGHT: RasterHeight = RasterHeight::Size16;
/// Pixels between the base lines of text.
pub(super) const LINE: u32 = 20;

pub(super) type Color = [u8; 3];

#[derive(Clone, Copy)]
pub(super) enum Weight {
    Regular,
    Bold,
}

impl Weight {
    fn font(self) -> FontWeight {
        match self {
            Weight::Regular => FontWeight::Regular,
            Weight::Bold => FontWeight::Bold,
        }
    }
}

pub(super) struct Canvas {
    pub(super) film: Film,
}

impl Canvas {
    pub(super) fn new([width, height]: [u32; 2], ground: Color) -> Canvas {
        let mut film = Film::new(width, height, 0);
        film.pixels.fill(linear(ground));
        Canvas { film }
    }

    pub(super) fn fill(&mut self, [x, y]: [u32; 2], [width, height]: [u32; 2], color: Color) {
        for row in y..(y + height).min(self.film.height) {
            let first = row as usize * self.film.width as usize;
            let end = (x + width).min(self.film.width) as usize;
            self.film.pixels[first + (x as usize).min(end)..first + end].fill(linear(color));
        }
    }

    /// Draws the outline of a rectangle, `thickness` pixels wide to the inside.
    pub(super) fn outline(
        &mut self,
        [x, y]: [u32; 2],
        [width, height]: [u32; 2],
        thickness: u32,
        color: Color,
    ) {
        let thickness = thickness.min(width).min(height);
        self.fill([x, y], [width, thickness], color);
        self.fill([x, y + height - thickness], [width, thickness], color);
        self.fill([x, y], [thickness, height], color);
        self.fill([x + width - thickness, y], [thickness, height], color);
    }

    /// Draws a film, each of its pixels as a square of `factor` pixels.
    pub(super) fn draw(&mut self, [x, y]: [u32; 2], film: &Film, factor: u32) {
        for row in 0..film.height * factor {
            let from = (row / factor) as usize * film.width as usize;
            let to = (y + row) as usize * self.film.width as usize + x as usize;
            for column in 0..(film.width * factor) as usize {
                self.film.pixels[to + column] = film.pixels[from + column / factor as usize];
            }
        }
    }

    /// Draws a line of text with its upper left corner at a place.
    pub(super) fn text(&mut self, [x, y]: [u32; 2], text: &str, weight: Weight, color: Color) {
        let advance = get_raster_width(weight.font(), HEIGHT);
        for (place, letter) in text.chars().enumerate() {
            let Some(glyph) = glyph(letter, weight) else { continue };
            for (row, values) in glyph.rows().enumerate() {
                for (column, value) in values.iter().enumerate() {
                    let at = [x as usize + place * advance + column, y as usize + row];
                    if *value > 0 && at[0] < self.film.width as usize && at[1] < self.film.height as usize {
                        let pixel = &mut self.film.pixels[at[1] * self.film.width as usize + at[0]];
                        *pixel = blended(*pixel, color, f64::from(*value) / 255.0);
                    }
                }
            }
        }
    }
}

fn glyph(letter: char, weight: Weight) -> Option<noto_sans_mono_bitmap::RasterizedChar> {
    let like = match letter {
        '−' | '–' => '-',
        '…' => '.',
        '“' | '”' => '"',
        '’' => '\'',
        other => other,
    };
    get_raster(like, weight.font(), HEIGHT).or_else(|| get_raster('?', weight.font(), HEIGHT))
}

/// Returns the width of a text in pixels.
pub(super) fn width(text: &str) -> u32 {
    (text.chars().count() * get_raster_width(FontWeight::Regular, HEIGHT)) as u32
}

/// Breaks a text into lines of at most `width` pixels, within words only where one is longer than that.
pub(super) fn lines(text: &str, width: u32) -> Vec<String> {
    let most = (width as usize / get_raster_width(FontWeight::Regular, HEIGHT)).max(1);
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        let mut word: Vec<char> = word.chars().collect();
        if let Some(line) = lines.last_mut()
            && line.chars().count() + 1 + word.len() <= most
        {
            line.push(' ');
            line.extend(word);
            continue;
        }
        while word.len() > most {
            lines.push(word.drain(..most).collect());
        }
        lines.push(word.into_iter().collect());
    }
    lines
}

/// Mixes encoded values, for which the coverage of letters is meant.
fn blended(ground: [f32; 3], ink: Color, part: f64) -> [f32; 3] {
    [0, 1, 2].map(|c: usize| {
        let under = linear_to_srgb(f64::from(ground[c]));
        srgb_to_linear(under + part * (f64::from(ink[c]) / 255.0 - under)) as f32
    })
}

fn linear(color: Color) -> [f32; 3] {
    color.map(|code| srgb_to_linear(f64::from(code) / 255.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_letter_of_captions_is_drawn_and_no_two_alike() {
        let drawn = |letter: char| {
            let mut canvas = Canvas::new([16, 20], [255; 3]);
            canvas.text([0, 0], &letter.to_string(), Weight::Regular, [0; 3]);
            canvas.film.pixels
        };
        let letters: Vec<char> = ('!'..='~').chain("×·²µ−".chars()).collect();
        for (i, letter) in letters.iter().enumerate() {
            assert!(drawn(*letter).iter().any(|p| p[0] < 0.9), "{letter} covers nothing");
            for other in letters[..i].iter().filter(|other| !(**other == '-' && *letter == '−')) {
                assert_ne!(drawn(*letter), drawn(*other), "{letter} looks like {other}");
            }
        }
    }

    #[test]
    fn lines_break_between_words_and_words_only_where_they_must() {
        let eight = width("12345678");
        assert_eq!(lines("one two three", eight), ["one two", "three"]);
        assert_eq!(lines("abcdefghijkl m", eight), ["abcdefgh", "ijkl m"]);
        assert!(lines(" ", eight).is_empty());
    }

    #[test]
    fn films_are_drawn_with_square_pixels_at_their_place() {
        let mut film = Film::new(2, 1, 0);
        film.pixels[1] = [1.0, 0.5, 0.25];
        let mut canvas = Canvas::new([8, 4], [255; 3]);
        canvas.draw([1, 1], &film, 2);
        let row = |y: usize| canvas.film.pixels[y * 8..y * 8 + 6].iter().map(|p| p[1]).collect::<Vec<_>>();
        assert_eq!(row(0), [1.0; 6]);
        assert_eq!(row(1), [1.0, 0.0, 0.0, 0.5, 0.5, 1.0]);
        assert_eq!(row(2), row(1));
    }
}
