//! The scene buffer on the host: records, blocks of words, and the constants that both sides share.

pub use super::blocks::{CellRange, Halving, PixelBatch, Slice};
pub use super::constants::*;
pub use super::header::*;
pub use super::record::{RealBits, Record, bytes_of};
pub use super::records::*;

/// Bytes at the front of the scene buffer that are also bound as uniforms.
pub const HEAD_BYTES: usize = HEAD_UNITS as usize * 16;

/// Most samples that are summed in f32 before the sum is added to the film. Further ones are added in several
/// such sums with compensation (Kahan 1965).
pub const MAX_SAMPLES_AT_ONCE: u32 = 256;

impl Plane {
    /// Returns the half extent of a plane with bounds, in tangents; `None` if it is infinite.
    pub fn bounds(&self) -> Option<f64> {
        (self.half_extent.0 >= 0.0).then_some(self.half_extent.0)
    }
}
