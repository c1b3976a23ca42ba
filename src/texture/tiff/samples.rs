//! Reads the samples of a decompressed strip or tile: whole bytes, lowest first as `predictor`
//! leaves them, or bits packed from the highest bit on.

use super::layout::Layout;

/// The numbers of one row of a chunk, by texel and sample.
pub(super) struct Samples<'a> {
    layout: &'a Layout,
    /// One plane, or one per sample; empty if no texel needs it.
    planes: Vec<&'a [u8]>,
}

impl<'a> Samples<'a> {
    pub fn of_row(layout: &'a Layout, planes: &'a [Vec<u8>], y: usize) -> Samples<'a> {
        let bytes = layout.row_bytes() as usize;
        let row = |plane: &'a Vec<u8>| plane.get(y * bytes..(y + 1) * bytes).unwrap_or(&[]);
        Samples { layout, planes: planes.iter().map(row).collect() }
    }

    /// Returns the bytes that hold a sample, and the number of samples before it.
    fn locate(&self, x: usize, sample: usize) -> (&'a [u8], usize) {
        match self.layout.planar {
            true => (self.planes[sample], x),
            false => (self.planes[0], x * self.layout.samples + sample),
        }
    }

    pub fn number(&self, x: usize, sample: usize) -> f64 {
        let (row, index) = self.locate(x, sample);
        self.layout.scalar.number(code(row, index, self.layout.scalar.bits as usize))
    }

    pub fn bytes<const SIZE: usize>(&self, x: usize, sample: usize) -> &'a [u8; SIZE] {
        let (row, index) = self.locate(x, sample);
        &row.as_chunks().0[index]
    }
}

/// Returns the code of a sample: whole bytes are stored lowest first, other sizes as bits from the
/// highest on.
fn code(row: &[u8], index: usize, bits: usize) -> u64 {
    match bits {
        8 => row[index].into(),
        16 => u16::from_le_bytes([row[2 * index], row[2 * index + 1]]).into(),
        24 | 32 | 64 => {
            let bytes = &row[index * bits / 8..(index + 1) * bits / 8];
            bytes.iter().rev().fold(0, |code, byte| code << 8 | u64::from(*byte))
        }
        _ => {
            let (first, end) = (index * bits, (index + 1) * bits);
            let bytes = &row[first / 8..end.div_ceil(8)];
            let held = bytes.iter().fold(0, |held, byte| held << 8 | u64::from(*byte));
            held >> (end.next_multiple_of(8) - end) & ((1 << bits) - 1)
        }
    }
}
