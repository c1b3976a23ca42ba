//! Parts of a large picture that tell what the whole is like. Input: a texture. Output: a smaller one, of bands of its rows or
//! columns that are spread over it; small ones stay whole.

use std::borrow::Cow;

use crate::texture::data::TextureData;

/// Lines of a band, as the analysis of seams averages over runs of so many, and the bands of a part.
const LINES: usize = 16;
const BANDS: usize = 24;

/// Returns bands of rows, each of full width.
pub(super) fn rows(texture: &TextureData) -> Cow<'_, TextureData> {
    let length = texture.width as usize * texture.format.bytes_per_texel();
    part(texture, texture.height as usize, |starts| {
        let bands = starts.iter().map(|start| &texture.texels[start * length..][..LINES * length]);
        (texture.width, (starts.len() * LINES) as u32, bands.collect::<Vec<_>>().concat())
    })
}

/// Returns bands of columns, each of full height.
pub(super) fn columns(texture: &TextureData) -> Cow<'_, TextureData> {
    let size = texture.format.bytes_per_texel();
    part(texture, texture.width as usize, |starts| {
        let rows = texture.texels.chunks_exact(texture.width as usize * size);
        let bands = rows.flat_map(|row| starts.iter().map(|start| &row[start * size..][..LINES * size]));
        ((starts.len() * LINES) as u32, texture.height, bands.collect::<Vec<_>>().concat())
    })
}

fn part(
    texture: &TextureData,
    lines: usize,
    of_bands: impl Fn(&[usize]) -> (u32, u32, Vec<u8>),
) -> Cow<'_, TextureData> {
    if lines <= LINES * BANDS {
        return Cow::Borrowed(texture);
    }
    let starts: Vec<usize> = (0..BANDS).map(|band| band * (lines - LINES) / (BANDS - 1)).collect();
    let (width, height, texels) = of_bands(&starts);
    let name = texture.name.clone();
    Cow::Owned(TextureData { name, width, height, texels, stored_levels: Vec::new(), ..*texture })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::data::{ColorSpace, Dimension, TexelFormat};

    fn texture(width: u32, height: u32) -> TextureData {
        TextureData {
            name: "t".into(),
            dimension: Dimension::Two,
            width,
            height,
            depth: 1,
            format: TexelFormat::Grey16,
            color_space: ColorSpace::Linear,
            file_channels: 1,
            texels: (0..width * height).flat_map(|i| (i as u16).to_ne_bytes()).collect(),
            stored_levels: Vec::new(),
        }
    }

    #[test]
    fn bands_have_the_first_and_the_last_lines_and_whole_runs() {
        let tall = texture(3, 1000);
        let part = rows(&tall);
        assert_eq!((part.width, part.height), (3, 384));
        assert_eq!(part.texels[..96], tall.texels[..96]);
        assert_eq!(part.texels[384 * 6 - 96..], tall.texels[984 * 6..]);
        assert_eq!(columns(&tall).texels, tall.texels, "three columns are all");
        let wide = texture(1000, 2);
        let part = columns(&wide);
        assert_eq!((part.width, part.height), (384, 2));
        assert_eq!(part.texels[..32], wide.texels[..32]);
        assert_eq!(part.texels[384 * 4 - 32..], wide.texels[984 * 2 + 2000..]);
    }
}
