//! Reads back bytes of a buffer: from memory of the host directly, else chunk by chunk through the staging buffer.

use ash::vk;

use super::buffer::Buffer;
use super::command::Commands;
use super::staging::{STAGING_BYTES, Staging};
use crate::core::error::Result;

pub(super) fn from_buffer(
    staging: &mut Staging,
    commands: &mut Commands,
    buffer: &Buffer,
    offset: u64,
    out: &mut [u8],
) -> Result<()> {
    buffer.check_range(offset, out.len())?;
    if let Some(bytes) = buffer.host_bytes(commands) {
        out.copy_from_slice(&bytes[offset as usize..][..out.len()]);
        return Ok(());
    }
    let mut src_offset = offset;
    for chunk in out.chunks_mut(STAGING_BYTES) {
        let target = staging.get(chunk.len())?;
        let handle = target.handle();
        let size = chunk.len() as u64;
        let region = vk::BufferCopy { src_offset, dst_offset: 0, size };
        commands.run(buffer.name(), |device, commands| {
            // SAFETY: both ranges were checked; submissions are waited for one by one, each with
            // a closing barrier that makes its writes visible to the host.
            unsafe { device.cmd_copy_buffer(commands, buffer.handle(), handle, &[region]) };
        })?;
        chunk.copy_from_slice(&target.mapped()?[..chunk.len()]);
        src_offset += size;
    }
    Ok(())
}
