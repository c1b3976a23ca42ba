//! The scene buffer as the host sees it: records, blocks of words, and the numbers that both sides share.

pub use super::blocks::{CellRange, Halving, Job, Slice};
pub use super::constants::*;
pub use super::record::{RealBits, Record, bytes_of};
pub use super::records::*;

/// Bytes at the front of the scene buffer that are also bound as uniforms.
pub const HEAD_BYTES: usize = HEAD_UNITS as usize * 16;

/// Samples that are summed in f32 before the sum goes to the film, at most. More samples arrive in chunks
/// and are added with compensation (Kahan 1965).
pub const CHUNK: u32 = 256;

impl Plane {
    /// Returns how many tangents a plane with bounds reaches.
    pub fn bounds(&self) -> Option<f64> {
        (self.half_extent.0 >= 0.0).then_some(self.half_extent.0)
    }
}
