//! Differences back to values (TIFF 6.0, section 14; Adobe's TIFF Technical Note 3): the plain bytes of a row
//! in, and in its place the samples with their bytes from the lowest to the highest.

use super::super::scalar::Kind;
use super::layout::{Layout, Predictor};

/// `samples` of each texel follow one another, and differ from those of the texel before.
pub(super) fn undo(layout: &Layout, row: &mut [u8], samples: usize) {
    let size = layout.scalar.bits as usize / 8;
    let whole_bytes = layout.scalar.bits.is_multiple_of(8);
    if layout.predictor == Predictor::FloatingPoint {
        return gather_floats(row, samples, size);
    }
    // Integers of 24 bits are packed from the highest bit on, as those of 10 or 12 are, in either byte order.
    let is_packed = layout.scalar.bits == 24 && layout.scalar.kind != Kind::Float;
    if whole_bytes && size > 1 && (is_packed || !layout.little_endian) {
        row.chunks_exact_mut(size).for_each(<[u8]>::reverse);
    }
    if layout.predictor == Predictor::Horizontal {
        match size {
            1 => add_up::<1>(row, samples),
            2 => add_up::<2>(row, samples),
            4 => add_up::<4>(row, samples),
            _ => add_up::<8>(row, samples),
        }
    }
}

fn add_up<const SIZE: usize>(row: &mut [u8], samples: usize) {
    let (values, _) = row.as_chunks_mut::<SIZE>();
    for i in samples..values.len() {
        let [before, value] = [values[i - samples], values[i]].map(|bytes| {
            let mut wide = [0; 8];
            wide[..SIZE].copy_from_slice(&bytes);
            u64::from_le_bytes(wide)
        });
        values[i].copy_from_slice(&value.wrapping_add(before).to_le_bytes()[..SIZE]);
    }
}

/// All highest bytes of a row come first, then all second ones, and so on; each differs from the byte
/// `samples` before.
fn gather_floats(row: &mut [u8], samples: usize, size: usize) {
    for i in samples..row.len() {
        row[i] = row[i].wrapping_add(row[i - samples]);
    }
    let planes = row.to_vec();
    let count = row.len() / size;
    for (i, value) in row.chunks_exact_mut(size).enumerate() {
        for (byte, place) in value.iter_mut().rev().enumerate() {
            *place = planes[byte * count + i];
        }
    }
}
