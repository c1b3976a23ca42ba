//! Statistics of a texture: range, mean and non-finite values of each channel, and whether it
//! tiles. Reads the texels row by row, in one pass and in f64, and returns an [`Analysis`].
//!
//! A step is the difference between two neighbouring columns (or rows); its size is the RMS of the
//! differences over all texel pairs and all channels of the file. The step from the last column to
//! the first is the seam. Steps are differences of stored values, which in an 8-bit picture are
//! spaced about evenly to the eye; alpha counts like a colour. For the verdict, float values v are
//! mapped to asinh(v ⁄ m) with m the median |v|, which is about even above m as well.

use super::analysis_period::{Period, period};
use super::analysis_rows::Rows;
use super::analysis_steps::Steps;
pub use super::analysis_verdict::{Seam, Verdict};
use super::analysis_verdict::{SeamRank, classify};
use super::data::TextureData;

/// Statistics of one channel of the file; minimum, maximum and mean are over its finite values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    pub name: &'static str,
    /// The minimum; absent, like `max` and `mean`, if no value is finite.
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// Σ values ⁄ their number; each row is summed first.
    pub mean: Option<f64>,
    pub nan: u64,
    pub infinite: u64,
}

/// The steps along one axis, and whether repeating the texture along it shows a seam.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisAnalysis {
    /// The RMS of the step from the last texels to the first.
    pub seam_rms: Option<f64>,
    /// The RMS of all interior steps; absent for an axis of one texel.
    pub interior_rms: Option<f64>,
    /// `seam_rms ⁄ interior_rms`; absent if the interior is constant.
    pub ratio: Option<f64>,
    /// The rank of the seam among the interior steps.
    pub rank: Option<SeamRank>,
    /// The period of the interior edges.
    pub period: Option<Period>,
    /// The smallest RMS of |seam step| − |interior step|, pair by pair, over the interior steps,
    /// relative to the seam's RMS: 0 for an edge that also occurs in the interior.
    pub recurrence: Option<f64>,
    pub seam: Seam,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// The channels in the order of the file, without an alpha that only the device format has.
    pub channels: Vec<Channel>,
    /// The number of texels with a NaN or an infinity in any channel.
    pub non_finite_texels: u64,
    /// Column and row of the first such texel; row 0 is the one at v = 0.
    pub first_non_finite: Option<[u32; 2]>,
    /// The axis along the rows, from column to column.
    pub u: AxisAnalysis,
    /// The axis along the columns, from row to row.
    pub v: AxisAnalysis,
}

/// Analyses a texture. Range and mean are those of the values a lookup returns: with
/// `ColorSpace::Srgb` they are in linear light.
pub fn analyse(texture: &TextureData) -> Analysis {
    analyse_along(texture, [true; 2])
}

/// Analyses a texture as [`analyse`] does, along the chosen of the axes u and v; the seam of another is unknown.
pub fn analyse_along(texture: &TextureData, [along_u, along_v]: [bool; 2]) -> Analysis {
    let count = texture.file_channels;
    let (width, height) = (texture.width as usize, texture.height as usize);
    let rows = Rows::new(texture);
    let mut channels: Vec<Channel> =
        channel_names(texture).iter().map(|&name| Channel { name, ..Channel::default() }).collect();
    let mut sums = vec![0.0; count];
    let (mut non_finite_texels, mut first_non_finite) = (0, None);

    let (seam_u, seam_v) = (rows.seam(width, height, true), rows.seam(height, width, false));
    let (mut u, mut v) = (Steps::new(width - 1, count, &seam_u), Steps::new(height - 1, count, &seam_v));
    let mut row = rows.stored(0);
    let mut mapped = rows.map_row(&row);
    for y in 0..height {
        if along_u {
            let seam = &seam_u.mapped[y * count..][..count];
            let (stored, mapped) =
                (neighbour_differences(&row, count), neighbour_differences(&mapped, count));
            for (x, (d, e)) in stored.chunks_exact(count).zip(mapped.chunks_exact(count)).enumerate() {
                u.add(x, d, e, seam);
            }
        }
        let mut row_sums = vec![0.0; count];
        for (x, texel) in row.chunks_exact(count).enumerate() {
            for (c, &stored) in texel.iter().enumerate() {
                row_sums[c] += channels[c].add(rows.lookup_value(stored, c));
            }
            if texel.iter().any(|value| !value.is_finite()) {
                non_finite_texels += 1;
                first_non_finite = first_non_finite.or(Some([x as u32, y as u32]));
            }
        }
        sums.iter_mut().zip(row_sums).for_each(|(sum, row_sum)| *sum += row_sum);
        if y + 1 < height {
            let next = rows.stored(y + 1);
            let next_mapped = rows.map_row(&next);
            if along_v {
                v.add(y, &differences(&next, &row), &differences(&next_mapped, &mapped), &seam_v.mapped);
            }
            (row, mapped) = (next, next_mapped);
        }
    }

    for (channel, sum) in channels.iter_mut().zip(sums) {
        let finite = (width * height) as u64 - channel.nan - channel.infinite;
        channel.mean = (finite > 0).then(|| sum / finite as f64);
    }
    let grain = rows.grain();
    let of = |is_chosen: bool, steps: &Steps, lines: &dyn Fn() -> Vec<Vec<f32>>| {
        if is_chosen { axis(steps, lines, grain) } else { AxisAnalysis::unknown() }
    };
    let u = of(along_u, &u, &|| rows.lines(width, height, true));
    let v = of(along_v, &v, &|| rows.lines(height, width, false));
    Analysis { channels, non_finite_texels, first_non_finite, u, v }
}

/// Returns the differences between neighbours of one row.
fn neighbour_differences(row: &[f64], count: usize) -> Vec<f64> {
    differences(&row[count..], &row[..row.len() - count])
}

fn differences(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

impl Channel {
    /// Adds a value to the statistics and returns its contribution to the sum.
    fn add(&mut self, value: f64) -> f64 {
        if value.is_nan() {
            self.nan += 1;
        } else if value.is_infinite() {
            self.infinite += 1;
        } else {
            self.min = Some(self.min.map_or(value, |min| min.min(value)));
            self.max = Some(self.max.map_or(value, |max| max.max(value)));
            return value;
        }
        0.0
    }
}

/// Returns the names of the channels of the file; two that are expanded to colours are red and green.
pub fn channel_names(texture: &TextureData) -> &'static [&'static str] {
    let is_grey = texture.file_channels < 3 && texture.format.channels() < 3;
    let names: &[&str] = if is_grey { &["grey", "alpha"] } else { &["red", "green", "blue", "alpha"] };
    &names[..texture.file_channels]
}

impl AxisAnalysis {
    /// Returns what is known of an axis that was not looked at.
    fn unknown() -> AxisAnalysis {
        AxisAnalysis {
            seam_rms: None,
            interior_rms: None,
            ratio: None,
            rank: None,
            period: None,
            recurrence: None,
            seam: Seam::Unknown,
        }
    }
}

/// `grain`: by how much roundings change the difference of two steps.
fn axis(steps: &Steps, lines: impl Fn() -> Vec<Vec<f32>>, grain: f32) -> AxisAnalysis {
    let (seam_rms, interior_rms) = (steps.seam_rms(), steps.interior_rms());
    let ratio = match (seam_rms, interior_rms) {
        (Some(seam), Some(interior)) if interior > 0.0 => Some(seam / interior),
        _ => None,
    };
    let rank = steps.sizes().map(|sizes| SeamRank::new(&sizes));
    let mut axis = AxisAnalysis { seam_rms, interior_rms, ratio, rank, ..AxisAnalysis::unknown() };
    axis.seam = match (seam_rms, rank) {
        _ if steps.is_empty() => Seam::Constant,
        (None, _) | (_, None) => Seam::Unknown,
        (Some(0.0), _) if ratio.is_none() => Seam::Constant,
        (Some(0.0), _) if steps.all_differ() => Seam::Doubled,
        (_, Some(rank)) => {
            let nearest = steps.nearest_to_seam();
            axis.period = period(&lines(), grain);
            axis.recurrence = nearest.map(|n| n[0]);
            classify(&rank, axis.period, nearest)
        }
    };
    axis
}
