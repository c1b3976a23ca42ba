//! Where the green of a normal map points, by its texels. Input: a texture of normals. Output: up or down in the picture, if
//! they tell. Slopes of a surface along the columns change along the rows as those along the rows do along the columns (both
//! are one second derivative of its height), and for the wrong direction the two have opposite signs.

use rayon::prelude::*;

use crate::texture::data::TextureData;

/// Correlations of less tell nothing.
const TELLING: f64 = 0.2;
/// Normals closer to the surface have no slope.
const FLATTEST: f32 = 0.1;
/// Most mean normals along a side.
const SIDE: u32 = 1024;
/// Below this side single texels are looked at; in larger pictures the noise of compression hides what they tell.
const SMALL: u32 = 64;
/// Sizes of means, each double the one before.
const SIZES: usize = 3;

/// Mean normals of squares of texels.
struct Grid {
    width: usize,
    normals: Vec<[f32; 3]>,
}

/// Returns true if green points up (OpenGL), false if it points down (DirectX).
pub(super) fn is_up(texture: &TextureData) -> Option<bool> {
    if texture.format.channels() < 4 {
        return None;
    }
    let (shorter, longer) = (texture.width.min(texture.height), texture.width.max(texture.height));
    let square = if shorter < SMALL { 1 } else { longer.div_ceil(SIDE).max(2) };
    let mut grid = Grid::new(texture, square as usize);
    let mut strongest = 0.0;
    for _ in 0..SIZES {
        let found = grid.correlation();
        strongest = if found.abs() > f64::abs(strongest) { found } else { strongest };
        grid = grid.halved();
    }
    (strongest.abs() >= TELLING).then_some(strongest < 0.0)
}

impl Grid {
    fn new(texture: &TextureData, square: usize) -> Grid {
        let (width, height) = (texture.width as usize / square, texture.height as usize / square);
        let of_row = |y: usize| {
            let mut sums = vec![[0.0f32; 3]; width];
            for line in 0..square {
                let row = texture.row_values(y * square + line);
                for (x, texel) in row.chunks_exact(4).take(width * square).enumerate() {
                    let sum = &mut sums[x / square];
                    sum.iter_mut().zip(texel).for_each(|(sum, value)| *sum += 2.0 * *value as f32 - 1.0);
                }
            }
            sums
        };
        Grid { width, normals: (0..height).into_par_iter().flat_map_iter(of_row).collect() }
    }

    /// Returns the grid of squares twice as wide.
    fn halved(&self) -> Grid {
        let rows: Vec<&[[f32; 3]]> = self.normals.chunks_exact(self.width.max(1)).collect();
        let mean = |pair: &[&[[f32; 3]]], x: usize| {
            let four = [pair[0][x], pair[0][x + 1], pair[1][x], pair[1][x + 1]];
            [0, 1, 2].map(|c| four.iter().map(|normal| normal[c]).sum())
        };
        let width = self.width / 2;
        let of_pair = |pair: &[&[[f32; 3]]]| (0..width).map(|x| mean(pair, 2 * x)).collect::<Vec<_>>();
        Grid { width, normals: rows.chunks_exact(2).flat_map(of_pair).collect() }
    }

    /// Returns the correlation of the two mixed derivatives; 0 of a grid that has none.
    fn correlation(&self) -> f64 {
        let slope = |[x, y, z]: [f32; 3]| {
            // Sums of many are as long as these are many.
            let length = (x * x + y * y + z * z).sqrt();
            [x, y].map(|n| f64::from(n / z.max(FLATTEST * length)))
        };
        let rows: Vec<&[[f32; 3]]> = self.normals.chunks_exact(self.width.max(1)).collect();
        let mut sums = [0.0; 3];
        for three in rows.windows(3) {
            for x in 1..self.width.saturating_sub(1) {
                let a = slope(three[2][x])[0] - slope(three[0][x])[0];
                let b = slope(three[1][x + 1])[1] - slope(three[1][x - 1])[1];
                if a.is_finite() && b.is_finite() {
                    sums.iter_mut().zip([a * b, a * a, b * b]).for_each(|(sum, product)| *sum += product);
                }
            }
        }
        if sums[1] * sums[2] > 0.0 { sums[0] / (sums[1] * sums[2]).sqrt() } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{ColorSpace, Dimension, TexelFormat};

    /// Returns the normals of waves; `up` is 1 for green that points up in the picture, -1 for down.
    fn normals(side: u32, up: f64) -> TextureData {
        let texel = |i: u32| {
            let (x, y) = (f64::from(i % side) * 0.4, f64::from(i / side) * 0.3);
            // Of the height sin(x) cos(y), y downwards.
            let slopes = [x.cos() * y.cos(), -x.sin() * y.sin()];
            let normal = [-slopes[0], up * slopes[1], 1.0];
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            let code = |n: f64| ((0.5 * n / length + 0.5) * 255.0).round() as u8;
            // Noise that is as large as that of compression.
            let noise = (i.wrapping_mul(2_654_435_761) >> 28) as u8;
            [code(normal[0]).saturating_add(noise), code(normal[1]), code(normal[2]), 255]
        };
        TextureData {
            name: "t".into(),
            dimension: Dimension::Two,
            width: side,
            height: side,
            depth: 1,
            format: TexelFormat::Rgba8,
            color_space: ColorSpace::Linear,
            file_channels: 3,
            texels: (0..side * side).flat_map(texel).collect(),
            stored_levels: Vec::new(),
        }
    }

    #[test]
    fn green_that_points_up_is_told_from_green_that_points_down() {
        for side in [32, 128] {
            assert_eq!(is_up(&normals(side, 1.0)), Some(true), "{side}");
            assert_eq!(is_up(&normals(side, -1.0)), Some(false), "{side}");
        }
    }

    #[test]
    fn flat_normals_and_few_of_them_tell_nothing() {
        let flat = TextureData { texels: [128, 128, 255, 255].repeat(1024), ..normals(32, 1.0) };
        assert_eq!(is_up(&flat), None);
        assert_eq!(is_up(&normals(1, 1.0)), None);
        assert_eq!(is_up(&normals(2, 1.0)), None);
    }
}
