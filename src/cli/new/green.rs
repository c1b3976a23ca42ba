//! Where the green of a normal map points, by its texels. Input: a texture of normals. Output: up or down in the picture, if
//! they tell. Slopes of a surface along the columns change along the rows as those along the rows do along the columns (both
//! are one second derivative of its height), and for the wrong direction the two have opposite signs.

use rayon::prelude::*;

use crate::texture::data::TextureData;

/// Correlations of less tell nothing.
const TELLING: f64 = 0.2;
/// Most rows that are looked at.
const ROWS: u32 = 512;
/// Normals closer to the surface have no slope.
const FLATTEST: f64 = 0.1;

/// Returns true if green points up (OpenGL), false if it points down (DirectX).
pub(super) fn is_up(texture: &TextureData) -> Option<bool> {
    if texture.format.channels() < 4 || texture.width < 3 || texture.height < 3 {
        return None;
    }
    let slopes = |y: u32| -> Vec<[f64; 2]> {
        let row = texture.row_values(y as usize);
        let slope = |texel: &[f64]| {
            let [x, y, z] = [0, 1, 2].map(|c| 2.0 * texel[c] - 1.0);
            [x, y].map(|n| n / z.max(FLATTEST))
        };
        row.chunks_exact(4).map(slope).collect()
    };
    let of_row = |y: u32| {
        let [above, own, below] = [slopes(y - 1), slopes(y), slopes(y + 1)];
        let mut sums = [0.0; 3];
        for x in 1..own.len() - 1 {
            let (a, b) = (below[x][0] - above[x][0], own[x + 1][1] - own[x - 1][1]);
            if a.is_finite() && b.is_finite() {
                sums.iter_mut().zip([a * b, a * a, b * b]).for_each(|(sum, product)| *sum += product);
            }
        }
        sums
    };
    let step = (texture.height / ROWS).max(1) as usize;
    let rows: Vec<u32> = (1..texture.height - 1).step_by(step).collect();
    let sums = rows.into_par_iter().map(of_row).reduce(|| [0.0; 3], |a, b| [0, 1, 2].map(|i| a[i] + b[i]));
    let correlation = sums[0] / (sums[1] * sums[2]).sqrt();
    (correlation.abs() >= TELLING).then_some(correlation < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{ColorSpace, Dimension, TexelFormat};

    /// Returns the normals of waves; `up` is 1 for green that points up in the picture, -1 for down.
    fn normals(up: f64) -> TextureData {
        let texel = |i: u32| {
            let (x, y) = (f64::from(i % 32) * 0.4, f64::from(i / 32) * 0.3);
            // Of the height sin(x) cos(y), y downwards.
            let slopes = [x.cos() * y.cos(), -x.sin() * y.sin()];
            let normal = [-slopes[0], up * slopes[1], 1.0];
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let code = |n: f64| ((0.5 * n / length + 0.5) * 255.0).round() as u8;
            [code(normal[0]), code(normal[1]), code(normal[2]), 255]
        };
        TextureData {
            name: "t".into(),
            dimension: Dimension::Two,
            width: 32,
            height: 32,
            depth: 1,
            format: TexelFormat::Rgba8,
            color_space: ColorSpace::Linear,
            file_channels: 3,
            texels: (0..1024).flat_map(texel).collect(),
            stored_levels: Vec::new(),
        }
    }

    #[test]
    fn green_that_points_up_is_told_from_green_that_points_down() {
        assert_eq!((is_up(&normals(1.0)), is_up(&normals(-1.0))), (Some(true), Some(false)));
    }

    #[test]
    fn flat_normals_tell_nothing() {
        let flat = TextureData { texels: [128, 128, 255, 255].repeat(1024), ..normals(1.0) };
        assert_eq!(is_up(&flat), None);
    }
}
