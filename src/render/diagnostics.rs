//! Counters on the device: a buffer to which pipelines add if they are built to count, cleared before a render and read
//! after it.

use crate::core::error::Result;
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::pack::Diagnostic;

/// How often each event happened in a render.
pub type Counts = Vec<(Diagnostic, u64)>;

pub struct DiagnosticCounters {
    pub(super) buffer: Buffer,
}

impl DiagnosticCounters {
    pub fn new(gpu: &Gpu) -> Result<DiagnosticCounters> {
        Ok(DiagnosticCounters {
            buffer: gpu.upload_buffer("diagnostics", BufferUse::Storage, &[0; 8 * Diagnostic::ALL.len()])?,
        })
    }

    pub fn clear(&self, gpu: &Gpu) -> Result<()> {
        gpu.write_buffer(&self.buffer, 0, &[0; 8 * Diagnostic::ALL.len()])
    }

    /// Reads the counts, stored as low and high halves in the order of the diagnostics.
    pub fn read(&self, gpu: &Gpu) -> Result<Counts> {
        let mut halves = [[0u32; 2]; Diagnostic::ALL.len()];
        gpu.read_buffer(&self.buffer, 0, bytemuck::cast_slice_mut(&mut halves))?;
        let count = |[low, high]: [u32; 2]| u64::from(high) << 32 | u64::from(low);
        Ok(Diagnostic::ALL.iter().copied().zip(halves.map(count)).collect())
    }
}
