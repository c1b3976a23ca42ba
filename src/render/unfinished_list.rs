//! The list of entries that a submission leaves unfinished (`glsl/shared/loops.glsl`), on devices where that occurs. Input:
//! nothing but the most entries of a submission. Output: the indices of those left, after each submission.

use crate::core::error::{Error, Result};
use crate::gpu::{Buffer, BufferUse, Gpu};

/// Most entries of a submission: halves of the pixels of a page, or pixels of a band.
const MOST: u64 = 1 << 22;
/// Batches that do not go to the film are as many at once, whatever the picture's size.
const LEAST: u64 = 1 << 20;

pub struct UnfinishedList {
    pub(super) buffer: Buffer,
    room: usize,
}

impl UnfinishedList {
    /// Returns an empty list for a picture of this size.
    pub fn new(gpu: &Gpu, [width, height]: [u32; 2]) -> Result<UnfinishedList> {
        let room = (2 * u64::from(width) * u64::from(height)).clamp(LEAST, MOST);
        let buffer = gpu.buffer("unfinished entries", 4 * (1 + room), BufferUse::Storage)?;
        let list = UnfinishedList { buffer, room: room as usize };
        list.clear(gpu)?;
        Ok(list)
    }

    /// Empties the list.
    pub fn clear(&self, gpu: &Gpu) -> Result<()> {
        gpu.write_buffer(&self.buffer, 0, bytemuck::bytes_of(&0u32))
    }

    /// Returns the indices of the entries, in ascending order, and empties the list.
    pub fn take(&self, gpu: &Gpu) -> Result<Vec<u32>> {
        let mut count = 0u32;
        gpu.read_buffer(&self.buffer, 0, bytemuck::bytes_of_mut(&mut count))?;
        if count == 0 {
            return Ok(Vec::new());
        }
        if count as usize > self.room {
            return Err(Error::new(format!("{count} entries are unfinished, with room for {}", self.room)));
        }
        let mut entries = vec![0u32; count as usize];
        gpu.read_buffer(&self.buffer, 4, bytemuck::cast_slice_mut(&mut entries))?;
        self.clear(gpu)?;
        entries.sort_unstable();
        Ok(entries)
    }
}

/// Returns the error of a sample whose loops the device ends, at a pixel of the picture.
pub fn too_long(gpu: &Gpu, [x, y]: [u32; 2]) -> Error {
    Error::with_help(
        format!(
            "device \"{}\" ends a shader's loops after 65535 iterations; one sample of pixel ({x}, {y}) takes more",
            gpu.info().name
        ),
        "use fewer shapes, lights or bounces, another device, or the device \"oracle\"",
    )
}
