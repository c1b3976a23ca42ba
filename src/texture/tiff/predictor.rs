//! Reverses horizontal differencing (TIFF 6.0, section 14; Adobe's TIFF Technical Note 3) in a
//! decompressed row, in place, and leaves the samples' bytes in order from lowest to highest.

use super::super::scalar::NumberKind;
use super::layout::{Layout, Predictor};

/// Undoes the predictor. The `samples` of a texel are adjacent and are differences to those of the
/// previous texel.
pub(super) fn undo(layout: &Layout, row: &mut [u8], samples: usize) {
    let size = layout.scalar.bits as usize / 8;
    let whole_bytes = layout.scalar.bits.is_multiple_of(8);
    if layout.predictor == Predictor::FloatingPoint {
        return gather_floats(row, samples, size);
    }
    // Integers of 24 bits are packed from the highest bit on, like those of 10 or 12 bits, in
    // either byte order.
    let is_packed = layout.scalar.bits == 24 && layout.scalar.kind != NumberKind::Float;
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

/// Reorders floats: all highest bytes of a row come first, then all second ones, and so on; each is
/// a difference to the byte `samples` before.
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
