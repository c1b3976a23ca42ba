//! Reads back bytes of a buffer: from memory of the host directly, else chunk by chunk through the staging buffer, of
//! which one half is read while the device writes the other.

use std::ops::Range;

use ash::vk;
use rayon::prelude::*;

use super::buffer::Buffer;
use super::command::{Commands, barrier};
use super::staging::{STAGING_BYTES, Staging};
use super::timing::RunTime;
use super::{Dispatch, Pipeline};
use crate::core::error::{Error, Result};

/// The largest size of one half of the staging buffer: enough that the time of a submission does not show.
const HALF_BYTES: usize = 4 << 20;
/// Less is copied at once.
const SMALLEST_CHUNK: usize = 256 << 10;
/// Bytes that a thread copies at once.
const AT_ONCE: usize = 256 << 10;

/// Reads the bytes from `offset` on.
pub(super) fn from_buffer(
    staging: &mut Staging,
    commands: &mut Commands,
    buffer: &Buffer,
    offset: u64,
    out: &mut [u8],
) -> Result<()> {
    let mut done = 0;
    parts(staging, commands, buffer, &[offset], [out.len(), 1], &mut |read| {
        let read = read[0];
        let target = &mut out[done..][..read.len()];
        done += read.len();
        if read.len() <= AT_ONCE {
            return target.copy_from_slice(read);
        }
        let both = target.par_chunks_mut(AT_ONCE).zip(read.par_chunks(AT_ONCE));
        both.for_each(|(target, read)| target.copy_from_slice(read));
    })
}

/// Passes parts that begin at `starts`, each of `bytes` bytes, to `each`: some bytes of all parts at a time, in order,
/// whole multiples of `unit`.
pub(super) fn parts(
    staging: &mut Staging,
    commands: &mut Commands,
    buffer: &Buffer,
    starts: &[u64],
    [bytes, unit]: [usize; 2],
    each: &mut dyn FnMut(&[&[u8]]),
) -> Result<()> {
    starts.iter().try_for_each(|&start| buffer.check_range(start, bytes))?;
    if bytes == 0 || starts.is_empty() {
        return Ok(());
    }
    if let Some(all) = buffer.host_bytes(commands) {
        let read: Vec<&[u8]> = starts.iter().map(|&start| &all[start as usize..][..bytes]).collect();
        each(&read);
        return Ok(());
    }
    let step = (HALF_BYTES / starts.len()).min(bytes.div_ceil(2).max(SMALLEST_CHUNK)).next_multiple_of(unit);
    let half = step * starts.len();
    let target = staging.get(if step < bytes { 2 * half } else { bytes * starts.len() })?;
    let handle = target.handle();
    let mut previous: Option<Range<usize>> = None;
    for (index, first) in (0..bytes).step_by(step).enumerate() {
        let (base, size) = (index % 2 * half, step.min(bytes - first));
        let region = |(part, start): (usize, &u64)| vk::BufferCopy {
            src_offset: start + first as u64,
            dst_offset: (base + part * size) as u64,
            size: size as u64,
        };
        let regions: Vec<vk::BufferCopy> = starts.iter().enumerate().map(region).collect();
        let ready = previous.replace(base..base + size * starts.len());
        let ready = ready.map(|range| target.mapped().map(|bytes| &bytes[range])).transpose()?;
        commands.run_beside(
            buffer.name(),
            // SAFETY: both ranges were checked, and the host reads no bytes but those of the other half; submissions are
            // waited for one by one, each with a closing barrier that makes its writes visible to the host.
            |device, commands| unsafe {
                device.cmd_copy_buffer(commands, buffer.handle(), handle, &regions);
            },
            || ready.into_iter().for_each(|bytes| pass(bytes, starts.len(), each)),
        )?;
    }
    if let Some(range) = previous {
        pass(&target.mapped()?[range], starts.len(), each);
    }
    Ok(())
}

/// Runs dispatches, each of which sees the writes of the ones before it, and reads bytes of a buffer after them, all in one
/// submission.
pub(super) fn after(
    staging: &mut Staging,
    commands: &mut Commands,
    dispatches: &[Dispatch<'_>],
    buffer: &Buffer,
    offset: u64,
    out: &mut [u8],
) -> Result<RunTime> {
    buffer.check_range(offset, out.len())?;
    if out.len() > STAGING_BYTES {
        return Err(Error::new(format!("{} bytes are too many to be read with a dispatch", out.len())));
    }
    let is_hosts = buffer.host_bytes(commands).is_some();
    let target = staging.get(out.len())?;
    let handle = target.handle();
    let name = dispatches.first().map_or(buffer.name(), |first| Pipeline::name(first.pipeline));
    let time = commands.run(name, |device, commands| {
        for (index, dispatch) in dispatches.iter().enumerate() {
            if index > 0 {
                barrier(device, commands);
            }
            dispatch.pipeline.record(device, commands, dispatch.group, dispatch.push, dispatch.groups);
        }
        if !is_hosts {
            barrier(device, commands);
            let region = vk::BufferCopy { src_offset: offset, dst_offset: 0, size: out.len() as u64 };
            // SAFETY: both ranges were checked; the closing barrier of a submission makes its writes visible to the host.
            unsafe { device.cmd_copy_buffer(commands, buffer.handle(), handle, &[region]) };
        }
    })?;
    match buffer.host_bytes(commands) {
        Some(bytes) => out.copy_from_slice(&bytes[offset as usize..][..out.len()]),
        None => out.copy_from_slice(&target.mapped()?[..out.len()]),
    }
    Ok(time)
}

/// Passes the bytes of so many parts of equal length, one behind the other.
fn pass(bytes: &[u8], parts: usize, each: &mut dyn FnMut(&[&[u8]])) {
    each(&bytes.chunks_exact(bytes.len() / parts).collect::<Vec<_>>());
}
