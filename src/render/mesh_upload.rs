//! Uploads the buffer of meshes. Input: its texels as they were packed. Output: the buffer on the device, if there are
//! meshes; what the device has is freed on the host at once, as meshes may be most of a scene.

use std::sync::Arc;

use crate::core::error::Result;
use crate::gpu::{Buffer, BufferUse, Gpu};

/// Texels that are copied before their memory is freed.
const AT_ONCE: usize = 1 << 20;

/// Uploads texels; those that another device still needs stay.
pub fn upload(gpu: &Gpu, texels: Arc<Vec<[u32; 4]>>) -> Result<Option<Buffer>> {
    if texels.is_empty() {
        return Ok(None);
    }
    let buffer = gpu.buffer("meshes", size_of_val(texels.as_slice()) as u64, BufferUse::TexelUint4)?;
    let write = |first: usize, texels: &[[u32; 4]]| {
        gpu.write_buffer(&buffer, (first * size_of::<[u32; 4]>()) as u64, bytemuck::cast_slice(texels))
    };
    match Arc::try_unwrap(texels) {
        Err(shared) => write(0, &shared)?,
        // From the end, as a list can be cut there.
        Ok(mut own) => {
            while !own.is_empty() {
                let first = own.len().saturating_sub(AT_ONCE);
                write(first, &own[first..])?;
                own.truncate(first);
                own.shrink_to_fit();
            }
        }
    }
    Ok(Some(buffer))
}
