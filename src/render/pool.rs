//! Texels of all textures → one texel buffer. Levels that the host left out do not cross the bus: they are
//! made on the device and copied to their places.

use super::pyramids::{Maker, Top, sizes};
use crate::error::{Error, Result};
use crate::gpu::{Buffer, BufferUse, Gpu};
use crate::pack::PackedScene;
use crate::texture::data::{ColorSpace, TexelFormat};

/// The first `bytes` of the scene's texels.
pub fn upload(gpu: &Gpu, packed: &PackedScene, bytes: usize, maker: &mut Maker<'_>) -> Result<Buffer> {
    let texels = &packed.texels[..bytes];
    check(gpu, packed, texels.len() / 4, "use smaller textures, or --texels image (up to 16 textures)")?;
    let starts = packed.device_levels.iter().map(|&t| (t, packed.textures[t].place[0] as usize * 4));
    let mut made = starts.filter(|&(_, start)| start < bytes).peekable();
    if made.peek().is_none() {
        // A binding has to hold something.
        let texels = if texels.is_empty() { &[0; 4] } else { texels };
        return gpu.upload_buffer("texels", BufferUse::TexelUint, texels);
    }
    let buffer = gpu.buffer("texels", bytes as u64, BufferUse::TexelUint)?;
    let mut written = 0;
    for (texture, start) in made {
        gpu.write_buffer(&buffer, written as u64, &texels[written..start])?;
        let record = &packed.textures[texture];
        let pyramid = maker.make(&Top {
            name: &packed.texture_names[texture],
            format: TexelFormat::ALL[record.place[3] as usize],
            space: ColorSpace::ALL[record.link[0] as usize],
            sizes: &sizes(packed, texture),
            texels: packed.level_texels(texture, 0),
        })?;
        let length = pyramid.buffer.bytes();
        gpu.copy_buffer(&pyramid.buffer, 0, &buffer, start as u64, length)?;
        written = start + length as usize;
    }
    gpu.write_buffer(&buffer, written as u64, &texels[written..])?;
    Ok(buffer)
}

/// The sums along rows that beams read.
pub fn upload_row_sums(gpu: &Gpu, packed: &PackedScene, words: &[u32]) -> Result<Buffer> {
    check(gpu, packed, words.len(), "use smaller textures, or --algorithm adaptive")?;
    gpu.upload_buffer("row sums", BufferUse::TexelUint, bytemuck::cast_slice(words))
}

/// Whether a texel buffer holds so many words.
pub fn fits(gpu: &Gpu, words: usize) -> bool {
    words as u64 <= most_words(gpu)
}

/// The shader's index is an `int`, whatever the device allows.
fn most_words(gpu: &Gpu) -> u64 {
    gpu.info().limits.max_texel_buffer_elements.min(i32::MAX as u64)
}

fn check(gpu: &Gpu, packed: &PackedScene, words: usize, help: &str) -> Result<()> {
    if fits(gpu, words) {
        return Ok(());
    }
    let (words, limit) = (words as u64, most_words(gpu));
    Err(Error::with_help(
        format!(
            "the textures {} together take {} MiB, over the {} MiB of a texel buffer on device \"{}\"",
            packed.texture_names.join(", "),
            words >> 18,
            (limit * 4) >> 20,
            gpu.info().name
        ),
        help,
    ))
}
