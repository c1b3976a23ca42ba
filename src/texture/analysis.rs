//! A texture in numbers: range, mean and non-finite values of each channel, and whether it tiles. In
//! go the texels, row by row, out comes an [`Analysis`]; all of it in f64 and in one pass.
//!
//! A step is the difference of neighbouring texels along an axis; its size is the root of the mean
//! square over all texel pairs between two neighbouring columns (rows) and all channels of the file.
//! The step from the last column to the first is the seam. Steps are taken of stored values, which
//! in an 8-bit picture are spaced about evenly to the eye; alpha counts like a colour.

use super::analysis_steps::Steps;
use super::data::{ColorSpace, Component, TextureData};
use crate::color::srgb_to_linear;
use crate::named::named_enum;

/// A seam up to this many times the RMS of the interior steps counts as one more interior step.
/// Steps of a texture that does tile vary along the axis: those of one sinusoid reach √2 times
/// their RMS at the steepest place, where the seam may happen to lie. One lost column of a smooth
/// texture makes its seam two steps, ratio 2 where the contrast is average. 1.5 lies between.
pub const LARGEST_RATIO: f64 = 1.5;
/// A larger seam still belongs to the pattern if the same edge is found inside: the sizes of the
/// steps, pair by pair, differ from those of some interior step by at most this part of the seam.
/// A checkerboard has 0 (up to noise of compression); `grass`, `tiles` and `noise` of the bundled
/// textures, cut shorter by a column or by up to half, 0.26 or more.
pub const LARGEST_RECURRENCE: f64 = 0.1;

named_enum! {
    /// What the seam of one axis is.
    pub enum Seam {
        /// No larger than steps inside.
        Smooth = "smooth",
        /// An edge, but one that the picture has inside as well.
        Pattern = "pattern",
        /// Last and first are equal where no neighbours inside are: each repeat stutters by a texel.
        Doubled = "doubled",
        /// All texels along the axis are equal, or there is one.
        Constant = "constant",
        /// An edge that the picture does not have inside.
        Visible = "visible",
        /// Every pair of the seam, or of the interior, has a value that is not finite.
        Unknown = "unknown",
    }
}

impl Seam {
    /// None: it cannot be told.
    pub fn tiles(self) -> Option<bool> {
        match self {
            Seam::Smooth | Seam::Pattern | Seam::Doubled | Seam::Constant => Some(true),
            Seam::Visible => Some(false),
            Seam::Unknown => None,
        }
    }
}

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
    /// Smallest RMS of |seam step| − |interior step|, pair by pair, over the interior steps, relative
    /// to `seam_rms`: 0 for an edge that is found inside.
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
    let rows = Rows { texture, table: linear_table(texture) };
    let mut channels: Vec<Channel> =
        names(count).iter().map(|&name| Channel { name, ..Channel::default() }).collect();
    let mut sums = vec![0.0; count];
    let (mut non_finite_texels, mut first_non_finite) = (0, None);

    let first = rows.stored(0);
    let last = rows.stored(height - 1);
    let seam_v: Vec<f64> = last.iter().zip(&first).map(|(a, b)| b - a).collect();
    let (mut u, mut v) = (Steps::new(width - 1), Steps::new(height - 1));
    let mut row = first;
    for y in 0..height {
        let seam_u: Vec<f64> = (0..count).map(|c| row[c] - row[(width - 1) * count + c]).collect();
        u.add_seam(&seam_u);
        for (x, pair) in row.windows(2 * count).step_by(count).enumerate() {
            u.add(x, pair[..count].iter().zip(&pair[count..]).map(|(a, b)| b - a).zip(&seam_u));
        }
        let mut row_sums = vec![0.0; count];
        for (x, texel) in row.chunks_exact(count).enumerate() {
            for (c, &stored) in texel.iter().enumerate() {
                row_sums[c] += channels[c].add(rows.seen(stored, c));
            }
            if texel.iter().any(|value| !value.is_finite()) {
                non_finite_texels += 1;
                first_non_finite = first_non_finite.or(Some([x as u32, y as u32]));
            }
        }
        sums.iter_mut().zip(row_sums).for_each(|(sum, of_row)| *sum += of_row);
        if y + 1 < height {
            let next = rows.stored(y + 1);
            v.add(y, row.iter().zip(&next).map(|(a, b)| b - a).zip(&seam_v));
            row = next;
        }
    }
    v.add_seam(&seam_v);

    for (channel, sum) in channels.iter_mut().zip(sums) {
        let finite = (width * height) as u64 - channel.nan - channel.infinite;
        channel.mean = (finite > 0).then(|| sum / finite as f64);
    }
    Analysis { channels, non_finite_texels, first_non_finite, u: axis(&u), v: axis(&v) }
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

fn axis(steps: &Steps) -> Axis {
    let (seam_rms, interior_rms) = (steps.seam_rms(), steps.interior_rms());
    let ratio = match (seam_rms, interior_rms) {
        (Some(seam), Some(interior)) if interior > 0.0 => Some(seam / interior),
        _ => None,
    };
    let recurrence = match (seam_rms, steps.nearest_to_seam()) {
        (Some(seam), Some(nearest)) if seam > 0.0 => Some(nearest / seam),
        _ => None,
    };
    let seam = match (seam_rms, ratio) {
        _ if steps.is_empty() => Seam::Constant,
        (None, _) => Seam::Unknown,
        _ if interior_rms.is_none() => Seam::Unknown,
        (Some(0.0), None) => Seam::Constant,
        (Some(0.0), _) if steps.all_differ() => Seam::Doubled,
        (_, Some(ratio)) if ratio <= LARGEST_RATIO => Seam::Smooth,
        _ if recurrence.is_some_and(|r| r <= LARGEST_RECURRENCE) => Seam::Pattern,
        _ => Seam::Visible,
    };
    Axis { seam_rms, interior_rms, ratio, recurrence, seam }
}

/// The texels of a texture row by row, without channels that the file does not have.
struct Rows<'a> {
    texture: &'a TextureData,
    /// Linear light of every stored integer; empty where stored values are linear.
    table: Vec<f64>,
}

impl Rows<'_> {
    fn stored(&self, y: usize) -> Vec<f64> {
        let (t, count) = (self.texture, self.texture.file_channels);
        let mut row = Vec::with_capacity(t.width as usize * count);
        for x in 0..t.width {
            row.extend((0..count).map(|channel| t.value(x, y as u32, channel)));
        }
        row
    }

    /// Alpha is never encoded.
    fn seen(&self, stored: f64, channel: usize) -> f64 {
        let is_alpha =
            self.texture.file_channels.is_multiple_of(2) && channel + 1 == self.texture.file_channels;
        if self.table.is_empty() || is_alpha {
            return stored;
        }
        self.table[(stored * (self.table.len() - 1) as f64).round() as usize]
    }
}

fn linear_table(texture: &TextureData) -> Vec<f64> {
    let largest = match (texture.color_space, texture.format.component()) {
        (ColorSpace::Linear, _) | (_, Component::Float32) => return Vec::new(),
        (ColorSpace::Srgb, Component::Unorm8) => u8::MAX.into(),
        (ColorSpace::Srgb, Component::Unorm16) => u16::MAX,
    };
    (0..=largest).map(|i| srgb_to_linear(f64::from(i) / f64::from(largest))).collect()
}
