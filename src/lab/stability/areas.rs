//! The mean of a repeated texture over a box, with texels as squares of constant colour, in f64 and
//! without a summed-area table.

use crate::lab::probe::LookupQuery;
use crate::texture::data::TextureData;

/// Returns the length of [from, to] that each texel of an axis covers, all of its repetitions
/// included.
fn covered(from: f64, to: f64, size: u32) -> Vec<f64> {
    let size_f = f64::from(size);
    // The covered length of [0, x], for any x.
    let up_to = |x: f64, texel: u32| {
        let whole = (x / size_f).floor();
        whole + (x - whole * size_f - f64::from(texel)).clamp(0.0, 1.0)
    };
    (0..size).map(|texel| up_to(to, texel) - up_to(from, texel)).collect()
}

/// Returns the mean over the footprint's bounding box, which is at least a texel wide.
pub fn box_mean(texels: &TextureData, query: &LookupQuery) -> f64 {
    let axis = |axis: usize, size: u32| {
        let wide = f64::from(query.dx[axis].abs()) + f64::from(query.dy[axis].abs());
        let reach = (0.5 * wide * f64::from(size)).max(0.5);
        let center = f64::from(query.uv[axis]) * f64::from(size);
        covered(center - reach, center + reach, size)
    };
    let (columns, rows) = (axis(0, texels.width), axis(1, texels.height));
    let mut sum = 0.0;
    for (y, row) in rows.iter().enumerate() {
        let along = columns.iter().enumerate().map(|(x, c)| c * texels.value(x as u32, y as u32, 0));
        sum += row * along.sum::<f64>();
    }
    sum / (columns.iter().sum::<f64>() * rows.iter().sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lab::stability::probing::grey;

    #[test]
    fn a_box_is_the_mean_of_what_it_covers() {
        let texels = grey(4, 2, |x, y| (x + 10 * y) as f32);
        let over = |u, v, wide: f32, high: f32| {
            let (dx, dy) = ([wide / 4.0, 0.0, 0.0, 0.0], [0.0, high / 2.0, 0.0, 0.0]);
            box_mean(&texels, &LookupQuery { uv: [u, v, 0.0, 0.0], dx, dy, ..LookupQuery::default() })
        };
        // One texel; two; half of the last column and half of the first; the whole texture, twice.
        assert_eq!(over(0.375, 0.25, 1.0, 1.0), 1.0);
        assert_eq!(over(0.5, 0.25, 2.0, 0.1), 1.5);
        assert_eq!(over(1.0, 0.75, 1.0, 1.0), 11.5);
        assert_eq!(over(0.3125, 0.5, 8.0, 2.0), 6.5);
    }
}
