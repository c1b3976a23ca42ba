//! Room in memory for what is made of a texture. Input: the texture, and what is to be made. Output: an error where the
//! allocator has not so much, in place of the end of the program; the memory is not touched.

use super::data::{MipKernel, TextureData};
use super::mips;
use crate::core::error::{Error, ErrorKind, Result};

/// Checks that there is room for so many bytes of a texture.
pub fn check_room(texture: &TextureData, what: &str, bytes: usize) -> Result<()> {
    Vec::<u8>::new().try_reserve_exact(bytes).map_err(|_| no_room(&texture.name, what, bytes))
}

/// Returns the error for memory that is not there.
pub fn no_room(name: &str, what: &str, bytes: usize) -> Error {
    Error::with_help(
        format!("texture \"{name}\": no room in memory for {what}, {} MiB", bytes.div_ceil(1 << 20)),
        "scale the picture down, or use fewer and smaller textures",
    )
    .of_kind(ErrorKind::Scene)
}

/// Returns the most bytes that making the levels of a texture takes at once, with the levels themselves.
pub fn bytes_of_levels(texture: &TextureData, kernel: MipKernel) -> usize {
    let texels = |level| mips::level_size(texture, level).map(|n| n as usize).iter().product::<usize>();
    let count = mips::level_count(texture);
    // Of levels that halve, the floats of two are there at once, of others those of all.
    let is_chain = kernel == MipKernel::Kaiser || mips::halves_throughout(texture);
    let last_floats = if is_chain { count.min(3) } else { count };
    let floats: usize = (1..last_floats).map(texels).sum();
    let stored: usize = (1..count).map(texels).sum();
    floats * texture.format.channels() * size_of::<f32>() + stored * texture.format.bytes_per_texel()
}
