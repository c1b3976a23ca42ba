//! The next level where lengths halve without remainder: a texel is the mean of two texels along
//! each axis that is halved. Takes a level and the new size and returns the values. Halves and
//! their sums are exact while they fit the f32 significand.

use rayon::prelude::*;

use super::Level;

pub(super) fn halve(level: &Level<'_>, to: [usize; 3], channels: usize) -> Vec<f32> {
    match channels {
        1 => halve_channels::<1>(level, to),
        2 => halve_channels::<2>(level, to),
        _ => halve_channels::<4>(level, to),
    }
}

fn halve_channels<const C: usize>(level: &Level<'_>, to: [usize; 3]) -> Vec<f32> {
    let [along_x, along_y, along_z] = [0, 1, 2].map(|a| level.size[a] / to[a]);
    let weight = 1.0 / (along_x * along_y * along_z) as f32;
    let mut out = vec![0.0; to[0] * to[1] * to[2] * C];
    let buffers = || (Vec::new(), vec![0.0; level.size[0] * C]);
    let rows = out.par_chunks_mut(to[0] * C).enumerate().with_min_len(1 + 2048 / to[0]);
    rows.for_each_init(buffers, |(scratch, sum), (index, out)| {
        let (y, z) = (index % to[1] * along_y, index / to[1] * along_z);
        let above = (0..along_z).flat_map(|k| (0..along_y).map(move |j| (z + k) * level.size[1] + y + j));
        for (n, row) in above.enumerate() {
            let row = level.row(row, scratch);
            if n == 0 {
                sum.iter_mut().zip(row).for_each(|(sum, value)| *sum = value * weight);
            } else {
                sum.iter_mut().zip(row).for_each(|(sum, value)| *sum += value * weight);
            }
        }
        if along_x == 1 {
            out.copy_from_slice(sum);
            return;
        }
        let pairs = sum.as_chunks::<C>().0.as_chunks::<2>().0;
        for ([left, right], out) in pairs.iter().zip(out.as_chunks_mut::<C>().0) {
            *out = std::array::from_fn(|c| left[c] + right[c]);
        }
    });
    out
}
