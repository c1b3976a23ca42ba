//! A sheet as one picture. Input: its content. Output: a film with heads, pictures, captions and notes. Sizes are measured
//! first, then everything is drawn from top to bottom.

use super::canvas::{Canvas, Color, LINE, Weight, lines, width};
use super::content::{Block, Body, Content, Entry, Row};
use crate::core::film::Film;

const GROUND: Color = [255, 255, 255];
const INK: Color = [27, 27, 31];
const SOFT: Color = [85, 85, 94];
const RAISED: Color = [240, 240, 244];
const MARGIN: u32 = 24;
const GAP: u32 = 20;
/// Between a picture and its texts.
const NEAR: u32 = 6;
/// The narrowest cell: captions need room beside each other.
const MIN_CELL: u32 = 208;
/// The widest head of a row.
const MAX_HEAD: u32 = 180;
/// The narrowest sheet: notes need room.
const MIN_WIDTH: u32 = 640;

/// The measures of a sheet.
struct Layout {
    cell: u32,
    head: u32,
    factor: u32,
    /// Between the margins.
    inner: u32,
}

pub fn compose(content: &Content) -> Film {
    let entries = || content.blocks.iter().flat_map(|block| &block.rows).flat_map(|row| &row.entries);
    let heads =
        || content.blocks.iter().flat_map(|block| &block.rows).filter_map(|row| row.heading.as_deref());
    let cell = entries().map(|entry| size(entry, content.factor)[0]).fold(MIN_CELL, u32::max);
    let head = heads().map(|head| width(head).min(MAX_HEAD) + GAP).max().unwrap_or(0);
    let columns = content.blocks.iter().flat_map(|block| &block.rows).map(|row| row.entries.len()).max();
    let columns = columns.unwrap_or(1) as u32;
    let inner = (head + columns * cell + (columns - 1) * GAP).max(MIN_WIDTH);
    let layout = Layout { cell, head, factor: content.factor, inner };
    let title = lines(&content.title, inner);
    let notes: Vec<String> = content.notes.iter().flat_map(|note| lines(note, inner)).collect();
    let tables: u32 = content.blocks.iter().map(|block| layout.height(block)).sum();
    let texts = (title.len() + notes.len()) as u32 * LINE;
    let size = [inner + 2 * MARGIN, 2 * MARGIN + texts + GAP + tables];

    let mut canvas = Canvas::new(size, GROUND);
    let mut at = MARGIN;
    for line in &title {
        canvas.text([MARGIN, at], line, Weight::Bold, INK);
        at += LINE;
    }
    at += GAP;
    for block in &content.blocks {
        at = layout.draw(&mut canvas, block, at);
    }
    for line in &notes {
        canvas.text([MARGIN, at], line, Weight::Regular, SOFT);
        at += LINE;
    }
    canvas.film
}

/// Returns the pixels of an entry's pictures.
fn size(entry: &Entry, factor: u32) -> [u32; 2] {
    match &entry.body {
        Body::Picture { film, difference } => {
            let more = difference.as_ref().map_or(0, |film| film.height * factor + NEAR);
            [film.width * factor, film.height * factor + more]
        }
        Body::Whole { film, .. } => [film.width, film.height],
        Body::Missing(_) => [0; 2],
    }
}

impl Layout {
    fn column(&self, index: usize) -> u32 {
        MARGIN + self.head + index as u32 * (self.cell + GAP)
    }

    fn captions(&self, entry: &Entry) -> Vec<String> {
        entry.caption.iter().flat_map(|text| lines(text, self.cell)).collect()
    }

    fn heading(&self, entry: &Entry) -> Vec<String> {
        entry.heading.iter().flat_map(|text| lines(text, self.cell)).collect()
    }

    /// Returns the heights of a row: of its heads, of its pictures, and of pictures with their captions.
    fn row(&self, row: &Row) -> [u32; 3] {
        let most = |height: &dyn Fn(&Entry) -> u32| row.entries.iter().map(height).max().unwrap_or(0);
        let why = |entry: &Entry| match &entry.body {
            Body::Missing(why) => (lines(why, self.cell - 2 * GAP).len() as u32 + 2) * LINE,
            _ => size(entry, self.factor)[1],
        };
        let heads = most(&|entry| self.heading(entry).len() as u32 * LINE);
        let captions = |entry: &Entry| self.captions(entry).len() as u32 * LINE;
        let head = row.heading.iter().map(|head| lines(head, self.head - GAP).len() as u32 * LINE).sum();
        [heads, most(&why), most(&|entry| why(entry) + NEAR + captions(entry)).max(head)]
    }

    fn title(&self, block: &Block) -> Vec<String> {
        block.heading.iter().flat_map(|text| lines(text, self.inner)).collect()
    }

    fn columns(&self, block: &Block) -> u32 {
        block.columns.iter().map(|head| lines(head, self.cell).len() as u32 * LINE).max().unwrap_or(0)
    }

    fn height(&self, block: &Block) -> u32 {
        let heading = self.title(block).len() as u32 * LINE;
        let near = if heading > 0 { NEAR } else { 0 };
        let row = |row: &Row| {
            let [heads, _, whole] = self.row(row);
            heads + whole + GAP
        };
        heading + near + self.columns(block) + block.rows.iter().map(row).sum::<u32>()
    }

    /// Draws a block from `at` on, and returns where the next one begins.
    fn draw(&self, canvas: &mut Canvas, block: &Block, mut at: u32) -> u32 {
        let title = self.title(block);
        if !title.is_empty() {
            self.text(canvas, [MARGIN, at], &title, Weight::Bold, INK);
            at += title.len() as u32 * LINE + NEAR;
        }
        for (index, head) in block.columns.iter().enumerate() {
            self.text(canvas, [self.column(index), at], &lines(head, self.cell), Weight::Bold, INK);
        }
        at += self.columns(block);
        for row in &block.rows {
            let [heads, pictures, whole] = self.row(row);
            if let Some(heading) = &row.heading {
                self.text(canvas, [MARGIN, at + heads], &lines(heading, self.head - GAP), Weight::Bold, INK);
            }
            for (index, entry) in row.entries.iter().enumerate() {
                let x = self.column(index);
                self.text(canvas, [x, at], &self.heading(entry), Weight::Bold, INK);
                let below = [x, at + heads + size(entry, self.factor)[1] + NEAR];
                self.text(canvas, below, &self.captions(entry), Weight::Regular, SOFT);
                self.picture(canvas, [x, at + heads], &entry.body, pictures);
            }
            at += heads + whole + GAP;
        }
        at
    }

    fn text(&self, canvas: &mut Canvas, [x, y]: [u32; 2], lines: &[String], weight: Weight, color: Color) {
        for (index, line) in lines.iter().enumerate() {
            canvas.text([x, y + index as u32 * LINE], line, weight, color);
        }
    }

    fn picture(&self, canvas: &mut Canvas, [x, y]: [u32; 2], body: &Body, height: u32) {
        match body {
            Body::Picture { film, difference } => {
                canvas.draw([x, y], film, self.factor);
                if let Some(difference) = difference {
                    canvas.draw([x, y + film.height * self.factor + NEAR], difference, self.factor);
                }
            }
            Body::Whole { film, full, part } => {
                canvas.draw([x, y], film, 1);
                let scaled = |pixels: u32, axis: usize| {
                    let shown = [film.width, film.height][axis];
                    (u64::from(pixels) * u64::from(shown) / u64::from(full[axis].max(1))) as u32
                };
                let corner = [x + scaled(part.x, 0), y + scaled(part.y, 1)];
                let size = [scaled(part.width, 0).max(6), scaled(part.height, 1).max(6)];
                canvas.outline(corner, size, 1, [0; 3]);
                canvas.outline([corner[0] + 1, corner[1] + 1], size.map(|s| s - 2), 2, [255; 3]);
            }
            Body::Missing(why) => {
                canvas.fill([x, y], [self.cell, height], RAISED);
                let lines = lines(why, self.cell - 2 * GAP);
                self.text(canvas, [x + GAP, y + LINE], &lines, Weight::Regular, INK);
            }
        }
    }
}
