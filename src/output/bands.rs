//! Encodes a picture band by band on all threads, and writes the bands in order while the next ones are encoded. In: the
//! rows of a picture, and how some of them are encoded. Out: calls that write. Buffers are used again, so that large
//! pictures take no more memory than small ones.

use std::ops::Range;

use rayon::prelude::*;

/// Bytes of a band before it is compressed: enough that threads are handed work rarely, few enough for a cache.
pub(super) const BAND_BYTES: usize = 256 << 10;

/// Encodes `rows` rows of `row_bytes` bytes each by `encode`, into slots that `slot` makes, and passes the slots to
/// `write` in order.
pub(super) fn write_bands<S: Send + Sync, E>(
    rows: usize,
    row_bytes: usize,
    slot: impl Fn() -> S,
    encode: impl Fn(Range<usize>, &mut S) + Sync,
    mut write: impl FnMut(&S) -> Result<(), E>,
) -> Result<(), E> {
    let step = (BAND_BYTES / row_bytes.max(1)).max(1);
    let bands: Vec<Range<usize>> =
        (0..rows).step_by(step).map(|first| first..rows.min(first + step)).collect();
    let at_once = rayon::current_num_threads().min(bands.len());
    let mut slots = [(); 2].map(|()| (0..at_once).map(|_| slot()).collect::<Vec<S>>());
    let mut ready = 0;
    for bands in bands.chunks(at_once.max(1)) {
        let [done, next] = &mut slots;
        let encode = &encode;
        rayon::in_place_scope(|scope| {
            scope.spawn(move |_| {
                let both = next.par_iter_mut().zip(bands);
                both.for_each(|(slot, rows)| encode(rows.clone(), slot));
            });
            done[..ready].iter().try_for_each(&mut write)
        })?;
        slots.swap(0, 1);
        ready = bands.len();
    }
    slots[0][..ready].iter().try_for_each(write)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_are_written_in_order_and_cover_all_rows_once() {
        for (rows, row_bytes) in [(0, 9), (1, 9), (1000, 1000), (77, BAND_BYTES), (3, 5 * BAND_BYTES)] {
            let mut written = Vec::new();
            let encode = |rows: Range<usize>, slot: &mut Vec<usize>| {
                slot.clear();
                slot.extend(rows);
            };
            let write = |slot: &Vec<usize>| {
                written.extend_from_slice(slot);
                Ok::<(), ()>(())
            };
            write_bands(rows, row_bytes, Vec::new, encode, write).unwrap();
            assert_eq!(written, (0..rows).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_first_failure_ends_the_writing() {
        let mut calls = 0;
        let failed = write_bands(
            5000,
            BAND_BYTES,
            || 0,
            |rows, slot| *slot = rows.start,
            |&first| {
                calls += 1;
                if first == 2 { Err(first) } else { Ok(()) }
            },
        );
        assert_eq!((failed, calls), (Err(2), 3));
    }
}
