//! Texels together with their neighbours, as bilinear look-ups read them: one read in place of four. In: packed textures.
//! Out: whether that pays, and for each texel itself, the one to its right, the one below it and the one below that; the
//! first column and row follow the last ones.

use rayon::prelude::*;

use super::{PackedScene, Schedule, TextureKind};
use crate::schema::layout::Texture;
use crate::texture::data::TexelFormat;
use crate::texture::sampler_spec::{Address, SamplerSpec};

/// Texels with their neighbours.
pub struct TexelQuads {
    pub words: Vec<u32>,
    /// Each texel has four words, one for each of the four texels; else a byte of one word.
    pub wide: bool,
}

/// Largest number of words that pays.
const MOST_WORDS: usize = 1 << 20;

impl PackedScene {
    /// Returns true if bilinear look-ups may read their four texels at once: of flat textures with one level, which are
    /// tiled or clamped, by no other filter.
    pub fn allows_texel_quads(&self) -> bool {
        let flat =
            |t: &Texture| t.kind == TextureKind::Procedural || t.kind == TextureKind::Flat && t.levels == 1;
        let plain = |mode: Address| matches!(mode, Address::Repeat | Address::ClampToEdge);
        let samplers = &self.records.samplers;
        !self.texels.is_empty()
            && !self.summed_tables
            && self.records.textures.iter().all(flat)
            && samplers.iter().all(|s| plain(s.address_u) && plain(s.address_v) && !s.crosses_poles)
            && self.sampler_specs.iter().all(SamplerSpec::magnifies_linearly)
    }

    /// Returns the number of words of texels with their neighbours; `None` if they are not all grey or all of four channels,
    /// with 8 bits. A picture of fewer samples than texels would take longer to prepare than it gains, and more words than
    /// a core's cache holds take longer to read than four texels.
    pub fn texel_quad_words(&self) -> Option<usize> {
        let words = self.texels.len();
        let is_stored = matches!(self.quad_format()?, TexelFormat::Grey8 | TexelFormat::Rgba8);
        let pixels = u64::from(self.header.film_size.x) * u64::from(self.header.film_size.y);
        let samples = if self.schedule == Schedule::Batches { u64::MAX } else { u64::from(self.samples) };
        let pays = words <= MOST_WORDS && samples.saturating_mul(pixels) >= words as u64;
        (is_stored && pays).then_some(words)
    }

    /// Returns the format of all textures, if they have one in common.
    fn quad_format(&self) -> Option<TexelFormat> {
        let mut formats =
            self.records.textures.iter().filter(|t| t.kind == TextureKind::Flat).map(|t| t.format);
        let first = formats.next()?;
        formats.all(|format| format == first).then_some(first)
    }

    /// Returns the texels with their neighbours.
    pub fn texel_quads(&self) -> TexelQuads {
        let mut quads = vec![0; self.texel_quad_words().unwrap_or(0)];
        let bytes = self.quad_format().map_or(1, TexelFormat::bytes_per_texel);
        for (index, texture) in self.records.textures.iter().enumerate() {
            if texture.kind != TextureKind::Flat {
                continue;
            }
            let texels = self.level_texels(index, 0);
            let row_bytes = texture.size.x as usize * bytes;
            let height = texture.size.y as usize;
            let row = |y: usize| &texels[y * row_bytes..][..row_bytes];
            quads[texture.first_word as usize * 4..][..texels.len()]
                .par_chunks_mut(row_bytes)
                .enumerate()
                .for_each(|(y, quads)| {
                    let (own, below) = (row(y), row((y + 1) % height));
                    if bytes == 1 { fill_grey(quads, own, below) } else { fill_words(quads, own, below) }
                });
        }
        TexelQuads { words: quads, wide: bytes > 1 }
    }
}

fn fill_grey(quads: &mut [u32], row: &[u8], below: &[u8]) {
    let quad = |at: usize, right: usize| u32::from_le_bytes([row[at], row[right], below[at], below[right]]);
    let last = row.len() - 1;
    for (at, word) in quads[..last].iter_mut().enumerate() {
        *word = quad(at, at + 1);
    }
    quads[last] = quad(last, 0);
}

fn fill_words(quads: &mut [u32], row: &[u8], below: &[u8]) {
    let word = |row: &[u8], at: usize| {
        u32::from_ne_bytes([row[4 * at], row[4 * at + 1], row[4 * at + 2], row[4 * at + 3]])
    };
    let width = row.len() / 4;
    for (at, four) in quads.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        let right = if at + 1 == width { 0 } else { at + 1 };
        *four = [word(row, at), word(row, right), word(below, at), word(below, right)];
    }
}

#[cfg(test)]
mod tests {
    use super::{fill_grey, fill_words};

    #[test]
    fn a_word_has_the_texel_its_right_neighbour_and_both_below_and_the_last_column_is_followed_by_the_first()
    {
        let mut quads = [0; 3];
        fill_grey(&mut quads, &[1, 2, 3], &[4, 5, 6]);
        assert_eq!(quads, [0x0504_0201, 0x0605_0302, 0x0406_0103]);
        fill_grey(&mut quads[..1], &[7], &[8]);
        assert_eq!(quads[0], 0x0808_0707, "a single column follows itself");
        let mut quads = [0; 8];
        fill_words(&mut quads, &[1; 8], &[2, 2, 2, 2, 3, 3, 3, 3]);
        let [one, two, three] = [0x0101_0101, 0x0202_0202, 0x0303_0303];
        assert_eq!(quads, [one, one, two, three, one, one, three, two]);
    }
}
