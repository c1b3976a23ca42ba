//! The levels of a texture, each by itself: size, means, alpha coverage; and whether the values are those of a normal map.
//! Reads the texels in f64 and returns numbers. Means are those of the values that a look-up returns.

use rayon::prelude::*;

use super::data::{Component, TextureData};

/// Alpha from here on covers, as masks of materials have it.
const COVERS: f64 = 0.5;
/// Of how many texels a normal map may have lengths other than 1, and how far off they may be.
const ODD_SHARE: f64 = 0.1;
const UNIT_TOLERANCE: f64 = 0.12;

/// One level.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelAnalysis {
    /// Width, height, and slices or faces.
    pub size: [u32; 3],
    /// The mean of each channel of the file over its finite values.
    pub means: Vec<Option<f64>>,
    /// The part of the texels whose alpha is at least one half, if there is alpha.
    pub coverage: Option<f64>,
}

/// Red, green and blue as normals, 2 c - 1.
#[derive(Clone, Debug, PartialEq)]
pub struct NormalAnalysis {
    /// The part of the texels whose normal has length 1, up to the rounding of 8 bits and of filters.
    pub unit_share: f64,
    /// The mean length.
    pub mean_length: f64,
    /// The length of the mean normal: 1 for a flat surface, less for rougher ones.
    pub mean_normal: [f64; 3],
    /// The part of the texels whose normal points into the surface.
    pub inward_share: f64,
}

impl NormalAnalysis {
    /// Returns true if nearly all values are normals that point outwards.
    pub fn is_normal_map(&self) -> bool {
        self.unit_share >= 1.0 - ODD_SHARE && self.inward_share <= ODD_SHARE
    }
}

/// Analyses level 0 and each stored level.
pub fn analyse_levels(texture: &TextureData) -> Vec<LevelAnalysis> {
    std::iter::once(texture).chain(&texture.stored_levels).map(level).collect()
}

fn level(texture: &TextureData) -> LevelAnalysis {
    let count = texture.file_channels;
    let alpha = match (count, texture.format.channels()) {
        (4, _) => Some(3),
        (2, 2) => Some(1),
        _ => None,
    };
    let rows = texture.height * texture.depth;
    let row = |y: u32| {
        let (mut sums, mut finite, mut covering) = (vec![0.0; count], vec![0u64; count], 0u64);
        for x in 0..texture.width {
            for (c, (sum, finite)) in sums.iter_mut().zip(&mut finite).enumerate() {
                let value = texture.linear_value(x, y, c);
                if value.is_finite() {
                    *sum += value;
                    *finite += 1;
                }
                covering += u64::from(Some(c) == alpha && value >= COVERS);
            }
        }
        (sums, finite, covering)
    };
    // Rows are added in their order, so that the sums do not depend on threads.
    let all: Vec<_> = (0..rows).into_par_iter().map(row).collect();
    let (mut sums, mut finite, mut covering) = (vec![0.0; count], vec![0u64; count], 0u64);
    for (row, valid, covers) in all {
        sums.iter_mut().zip(row).for_each(|(sum, row)| *sum += row);
        finite.iter_mut().zip(valid).for_each(|(sum, row)| *sum += row);
        covering += covers;
    }
    let mean = |(sum, count): (f64, u64)| (count > 0).then(|| sum / count as f64);
    let texels = u64::from(texture.width) * u64::from(rows);
    LevelAnalysis {
        size: [texture.width, texture.height, texture.depth],
        means: sums.into_iter().zip(finite).map(mean).collect(),
        coverage: alpha.map(|_| covering as f64 / texels as f64),
    }
}

/// Returns the values of level 0 as normals; `None` for textures without three colours or of floats, which have no such
/// encoding, and for grey ones.
pub fn analyse_normals(texture: &TextureData) -> Option<NormalAnalysis> {
    if texture.format.channels() < 4 || texture.format.component() == Component::Float32 {
        return None;
    }
    let none = NormalAnalysis { unit_share: 0.0, mean_length: 0.0, mean_normal: [0.0; 3], inward_share: 0.0 };
    let row = |y: u32| {
        let (mut sums, mut is_grey) = (none.clone(), true);
        for x in 0..texture.width {
            let stored = [0, 1, 2].map(|c| texture.value(x, y, c));
            is_grey &= stored[0] == stored[1] && stored[1] == stored[2];
            let normal = stored.map(|c| 2.0 * c - 1.0);
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            sums.mean_length += length;
            sums.unit_share += f64::from((length - 1.0).abs() <= UNIT_TOLERANCE);
            // Half of 8 bits is 127 or 128, of which one is below 0.
            sums.inward_share += f64::from(normal[2] < -0.01);
            sums.mean_normal.iter_mut().zip(normal).for_each(|(sum, n)| *sum += n);
        }
        (sums, is_grey)
    };
    let rows: Vec<_> = (0..texture.height * texture.depth).into_par_iter().map(row).collect();
    let (mut found, mut is_grey) = (none, true);
    for (sums, row_is_grey) in rows {
        found.mean_length += sums.mean_length;
        found.unit_share += sums.unit_share;
        found.inward_share += sums.inward_share;
        found.mean_normal.iter_mut().zip(sums.mean_normal).for_each(|(sum, n)| *sum += n);
        is_grey &= row_is_grey;
    }
    let texels = f64::from(texture.width) * f64::from(texture.height) * f64::from(texture.depth);
    found.unit_share /= texels;
    found.mean_length /= texels;
    found.inward_share /= texels;
    found.mean_normal = found.mean_normal.map(|sum| sum / texels);
    (!is_grey).then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{ColorSpace, Dimension, TexelFormat};

    fn texture(width: u32, texels: Vec<u8>) -> TextureData {
        TextureData {
            name: "t".into(),
            dimension: Dimension::Two,
            width,
            height: texels.len() as u32 / 4 / width,
            depth: 1,
            format: TexelFormat::Rgba8,
            color_space: ColorSpace::Linear,
            file_channels: 4,
            texels,
            stored_levels: Vec::new(),
        }
    }

    #[test]
    fn means_and_coverage_are_those_of_each_level() {
        let mut first = texture(2, vec![255, 0, 0, 255, 0, 0, 0, 127, 255, 255, 0, 128, 0, 0, 0, 0]);
        first.stored_levels = vec![texture(1, vec![51, 0, 0, 255])];
        let levels = analyse_levels(&first);
        assert_eq!(
            (levels[0].size, levels[0].means[0], levels[0].coverage),
            ([2, 2, 1], Some(0.5), Some(0.5))
        );
        assert_eq!(
            (levels[1].size, levels[1].means[0], levels[1].coverage),
            ([1, 1, 1], Some(0.2), Some(1.0))
        );
    }

    #[test]
    fn normal_maps_are_told_from_pictures_and_inward_ones_from_others() {
        let of = |texels: &[[u8; 4]]| analyse_normals(&texture(1, texels.concat()));
        let flat = [[128, 128, 255, 255], [218, 128, 218, 255]];
        let found = of(&flat).expect("colours");
        assert!(found.is_normal_map() && found.unit_share == 1.0 && found.inward_share == 0.0, "{found:?}");
        let inward = of(&[[128, 128, 0, 255]]).expect("colours");
        assert!(
            !inward.is_normal_map() && inward.unit_share == 1.0 && inward.inward_share == 1.0,
            "{inward:?}"
        );
        assert!(!of(&[[200, 40, 40, 255]]).expect("colours").is_normal_map());
        assert_eq!(of(&[[9, 9, 9, 255]]), None);
    }
}
