//! The mean of a repeated texture over a box, its texels being squares of one colour, in f64 and by no table.

use crate::lab::probe::LookUp;
use crate::texture::data::TextureData;

/// How much of [from, to] the texels of an axis cover, each with all of its repetitions.
fn covered(from: f64, to: f64, size: u32) -> Vec<f64> {
    let size_f = f64::from(size);
    // Of [0, x], for any x.
    let up_to = |x: f64, texel: u32| {
        let whole = (x / size_f).floor();
        whole + (x - whole * size_f - f64::from(texel)).clamp(0.0, 1.0)
    };
    (0..size).map(|texel| up_to(to, texel) - up_to(from, texel)).collect()
}

/// Of the box around the footprint, at least a texel wide.
pub fn box_mean(texels: &TextureData, query: &LookUp) -> f64 {
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
            box_mean(&texels, &LookUp { uv: [u, v, 0.0, 0.0], dx, dy, ..LookUp::default() })
        };
        // One texel; two; half of the last column and half of the first; everything, twice over.
        assert_eq!(over(0.375, 0.25, 1.0, 1.0), 1.0);
        assert_eq!(over(0.5, 0.25, 2.0, 0.1), 1.5);
        assert_eq!(over(1.0, 0.75, 1.0, 1.0), 11.5);
        assert_eq!(over(0.3125, 0.5, 8.0, 2.0), 6.5);
    }
}
