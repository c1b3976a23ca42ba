//! The filters of PNG (PNG 3rd edition, 9 "Filtering"): a row of bytes becomes the differences from a prediction by the
//! bytes to the left and above. In: a row and the one above. Out: the row by the filter that leaves the least.

/// The number of filters; each is the byte before its rows.
const FILTERS: u8 = 5;

/// The best row so far, and the one that is compared with it.
#[derive(Default)]
pub(super) struct Filters {
    best: Vec<u8>,
    next: Vec<u8>,
}

impl Filters {
    /// Appends the number of the filter and the filtered row whose bytes, as signed numbers, have the smallest sum of
    /// magnitudes (12.7 "Filter selection").
    pub(super) fn append_best(&mut self, above: &[u8], row: &[u8], pixel_bytes: usize, to: &mut Vec<u8>) {
        let mut least = None;
        for filter in 0..FILTERS {
            apply(filter, above, row, pixel_bytes, &mut self.next);
            let sum: u64 = self.next.iter().map(|&byte| u64::from((byte as i8).unsigned_abs())).sum();
            if least.is_none_or(|(_, least)| sum < least) {
                least = Some((filter, sum));
                std::mem::swap(&mut self.best, &mut self.next);
            }
        }
        to.extend(least.map(|(filter, _)| filter));
        to.extend_from_slice(&self.best);
    }
}

/// Filters a row.
fn apply(filter: u8, above: &[u8], row: &[u8], pixel_bytes: usize, to: &mut Vec<u8>) {
    to.clear();
    match filter {
        0 => to.extend_from_slice(row),
        1 => subtract(above, row, pixel_bytes, to, |left, _, _| left),
        2 => subtract(above, row, pixel_bytes, to, |_, up, _| up),
        3 => {
            subtract(above, row, pixel_bytes, to, |left, up, _| ((u16::from(left) + u16::from(up)) / 2) as u8)
        }
        _ => subtract(above, row, pixel_bytes, to, paeth),
    }
}

/// Subtracts predictions by the bytes to the left, above, and to the left above. To the left of the first pixel, all
/// bytes are 0.
#[inline(always)]
fn subtract(
    above: &[u8],
    row: &[u8],
    pixel_bytes: usize,
    to: &mut Vec<u8>,
    predict: impl Fn(u8, u8, u8) -> u8,
) {
    to.resize(row.len(), 0);
    let first = pixel_bytes.min(row.len());
    for i in 0..first {
        to[i] = row[i].wrapping_sub(predict(0, above[i], 0));
    }
    for i in first..row.len().min(above.len()).min(to.len()) {
        to[i] = row[i].wrapping_sub(predict(row[i - first], above[i], above[i - first]));
    }
}

/// Returns the one of three bytes that is closest to `left + up − corner`; of equally close ones the first.
#[inline(always)]
fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let [from_left, from_up, from_corner] = [(b - c).abs(), (a - c).abs(), (a + b - 2 * c).abs()];
    if from_left <= from_up && from_left <= from_corner {
        left
    } else if from_up <= from_corner {
        up
    } else {
        corner
    }
}
