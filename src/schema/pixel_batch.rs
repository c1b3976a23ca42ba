//! The packed words of a batch: its pixel, and the part of the pixel.

use super::blocks::PixelBatch;
use super::constants::BATCH_STREAM_SHIFT;

impl PixelBatch {
    /// Returns the `place` of a film's pixel by its index.
    pub fn place_of(index: u32, width: u32) -> u32 {
        (index / width) << 16 | (index % width)
    }

    /// Returns the `part` of a half of the film: its samples are the stream of the same number.
    pub fn part_of(half: u32) -> u32 {
        half | half << BATCH_STREAM_SHIFT
    }

    /// Returns the stream of samples.
    pub fn stream(&self) -> u32 {
        self.part >> BATCH_STREAM_SHIFT
    }

    /// Returns column and row.
    pub fn column_and_row(&self) -> [u32; 2] {
        [self.place & 0xFFFF, self.place >> 16]
    }
}
