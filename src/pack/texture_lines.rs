//! Describes the textures of a packed scene, one line each: size, channels of the file, and stored format.

use super::{PackedScene, TextureKind};
use crate::core::counted::counted;
use crate::schema::layout::Texture;

impl PackedScene {
    /// Returns one line per texture: size, the file's channels, and the stored format.
    pub fn texture_lines(&self) -> Vec<String> {
        let line = |(i, ((name, record), channels)): (usize, ((&String, &Texture), &usize))| {
            if record.kind == TextureKind::Procedural {
                return format!("\"{name}\": procedural, no texels");
            }
            let Texture { size, format, color_space: space, levels, kind, .. } = *record;
            let [width, height, depth] = size.to_array();
            let depth = if kind == TextureKind::Flat { String::new() } else { format!("×{depth}") };
            let bytes: usize = (0..levels).map(|level| self.level_texels(i, level).len()).sum();
            let kib = bytes.div_ceil(1024);
            let levels = if levels > 1 { format!(", {levels} levels") } else { String::new() };
            let nonfinite = match self.nonfinite_texels[i] {
                0 => String::new(),
                count => format!(", {} not finite", counted(count, "texel")),
            };
            format!(
                "\"{name}\": {width}×{height}{depth}{levels}, {channels}-channel file, held as {format} ({space}), {kib} KiB{nonfinite}"
            )
        };
        let records = self.texture_names.iter().zip(&self.records.textures).zip(&self.file_channels);
        records.enumerate().map(line).collect()
    }
}
