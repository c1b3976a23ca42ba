//! A texture in numbers: range, mean and non-finite values of each channel, and whether it tiles. In
//! go the texels, row by row, out comes an [`Analysis`]; all of it in f64 and in one pass.
//!
//! A step is the difference of neighbouring texels along an axis; its size is the root of the mean
//! square over all texel pairs between two neighbouring columns (rows) and all channels of the file.
//! The step from the last column to the first is the seam. Steps are taken of stored values, which
//! in an 8-bit picture are spaced about evenly to the eye; alpha counts like a colour. For the verdict floats
//! v are weighed as asinh(v ⁄ m), m the middle |v|: about evenly above m as well.

use super::analysis_period::{Period, period};
use super::analysis_rows::Rows;
use super::analysis_steps::Steps;
use super::analysis_verdict::{Rank, judge};
pub use super::analysis_verdict::{Seam, Verdict};
use super::data::TextureData;

/// Of one channel of the file; minimum, maximum and mean are those of its finite values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Channel {
    pub name: &'static str,
    /// None without a finite value; so are `max` and `mean`.
    pub min: Option<f64>,
    pub max: Option<f64>,
    /// Σ values ⁄ their number; rows are summed first.
    pub mean: Option<f64>,
    pub nan: u64,
    pub infinite: u64,
}

/// Whether repeating along one axis shows a seam.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// RMS of the step from the last texels to the first.
    pub seam_rms: Option<f64>,
    /// RMS of all steps between neighbours inside. None for an axis of one texel.
    pub interior_rms: Option<f64>,
    /// `seam_rms ⁄ interior_rms`; none where the interior is constant.
    pub ratio: Option<f64>,
    /// Where the seam stands among the steps inside.
    pub rank: Option<Rank>,
    /// Of the edges inside.
    pub period: Option<Period>,
    /// Smallest RMS of |seam step| − |interior step|, pair by pair, over the interior steps, relative
    /// to the seam's: 0 for an edge that is found inside.
    pub recurrence: Option<f64>,
    pub seam: Seam,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// In the order of the file, without an alpha that only the device's format has.
    pub channels: Vec<Channel>,
    /// Texels with a NaN or an infinity in any channel.
    pub non_finite_texels: u64,
    /// Column and row, the first row being the one that v = 0 reads.
    pub first_non_finite: Option<[u32; 2]>,
    /// Along the rows, from column to column.
    pub u: Axis,
    /// Along the columns, from row to row.
    pub v: Axis,
}

/// Range and mean are those of what a look-up returns: with `ColorSpace::Srgb` of linear light.
pub fn analyse(texture: &TextureData) -> Analysis {
    let count = texture.file_channels;
    let (width, height) = (texture.width as usize, texture.height as usize);
    let rows = Rows::new(texture);
    let mut channels: Vec<Channel> =
        names(count).iter().map(|&name| Channel { name, ..Channel::default() }).collect();
    let mut sums = vec![0.0; count];
    let (mut non_finite_texels, mut first_non_finite) = (0, None);

    let (seam_u, seam_v) = (rows.seam(width, height, true), rows.seam(height, width, false));
    let (mut u, mut v) = (Steps::new(width - 1, count, &seam_u), Steps::new(height - 1, count, &seam_v));
    let mut row = rows.stored(0);
    let mut weighed = rows.weigh(&row);
    for y in 0..height {
        let seam = &seam_u.weighed[y * count..][..count];
        let (stored, by_weight) = (across(&row, count), across(&weighed, count));
        for (x, (d, e)) in stored.chunks_exact(count).zip(by_weight.chunks_exact(count)).enumerate() {
            u.add(x, d, e, seam);
        }
        let mut prefix_sums = vec![0.0; count];
        for (x, texel) in row.chunks_exact(count).enumerate() {
            for (c, &stored) in texel.iter().enumerate() {
                prefix_sums[c] += channels[c].add(rows.seen(stored, c));
            }
            if texel.iter().any(|value| !value.is_finite()) {
                non_finite_texels += 1;
                first_non_finite = first_non_finite.or(Some([x as u32, y as u32]));
            }
        }
        sums.iter_mut().zip(prefix_sums).for_each(|(sum, of_row)| *sum += of_row);
        if y + 1 < height {
            let next = rows.stored(y + 1);
            let next_weighed = rows.weigh(&next);
            v.add(y, &minus(&next, &row), &minus(&next_weighed, &weighed), &seam_v.weighed);
            (row, weighed) = (next, next_weighed);
        }
    }

    for (channel, sum) in channels.iter_mut().zip(sums) {
        let finite = (width * height) as u64 - channel.nan - channel.infinite;
        channel.mean = (finite > 0).then(|| sum / finite as f64);
    }
    let u = axis(&u, || rows.lines(width, height, true));
    let v = axis(&v, || rows.lines(height, width, false));
    Analysis { channels, non_finite_texels, first_non_finite, u, v }
}

/// Differences between neighbours of one row.
fn across(row: &[f64], count: usize) -> Vec<f64> {
    minus(&row[count..], &row[..row.len() - count])
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

impl Channel {
    /// Returns what the value adds to the sum.
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

fn names(file_channels: usize) -> &'static [&'static str] {
    let names: &[&str] =
        if file_channels < 3 { &["grey", "alpha"] } else { &["red", "green", "blue", "alpha"] };
    &names[..file_channels]
}

fn axis(steps: &Steps, lines: impl Fn() -> Vec<Vec<f32>>) -> Axis {
    let (seam_rms, interior_rms) = (steps.seam_rms(), steps.interior_rms());
    let ratio = match (seam_rms, interior_rms) {
        (Some(seam), Some(interior)) if interior > 0.0 => Some(seam / interior),
        _ => None,
    };
    let rank = steps.sizes().map(|sizes| Rank::new(&sizes));
    let mut axis =
        Axis { seam_rms, interior_rms, ratio, rank, period: None, recurrence: None, seam: Seam::Unknown };
    axis.seam = match (seam_rms, rank) {
        _ if steps.is_empty() => Seam::Constant,
        (None, _) | (_, None) => Seam::Unknown,
        (Some(0.0), _) if ratio.is_none() => Seam::Constant,
        (Some(0.0), _) if steps.all_differ() => Seam::Doubled,
        (_, Some(rank)) => {
            let nearest = steps.nearest_to_seam();
            axis.period = period(&lines());
            axis.recurrence = nearest.map(|n| n[0]);
            judge(&rank, axis.period, nearest)
        }
    };
    axis
}
