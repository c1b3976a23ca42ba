//! Textures of compressed blocks, BC1 to BC7 (Khronos Data Format Specification 1.3, chapters 18 to 20). Takes the blocks
//! of a slice and its size; returns texels, of which those beyond the right and lower edges are left out.

use rayon::prelude::*;

use super::normal;
use crate::texture::data::{Component, TexelFormat};

/// The texels along a side of a block.
pub(super) const SIDE: usize = 4;
const TEXELS: usize = SIDE * SIDE;

/// A kind of block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::texture) enum Block {
    /// Two colours of 16 bits and two between; without alpha its transparent texels are black.
    Bc1 {
        has_alpha: bool,
    },
    /// BC1 with alpha of 4 bits.
    Bc2,
    /// BC1 with alpha of two numbers and six between.
    Bc3,
    /// One channel.
    Bc4 {
        is_signed: bool,
    },
    /// Two channels: the x and y of normals.
    Bc5 {
        is_signed: bool,
    },
    /// Halves.
    Bc6h {
        is_signed: bool,
    },
    Bc7,
}

impl Block {
    /// Returns the bytes of a block.
    pub const fn bytes(self) -> usize {
        match self {
            Block::Bc1 { .. } | Block::Bc4 { .. } => 8,
            _ => 16,
        }
    }

    /// Returns the channels that the file holds.
    pub const fn channels(self) -> usize {
        match self {
            Block::Bc4 { .. } => 1,
            Block::Bc5 { .. } => 2,
            Block::Bc6h { .. } | Block::Bc1 { has_alpha: false } => 3,
            _ => 4,
        }
    }

    /// Returns the format of decoded texels. Values between two stored numbers of 8 bits need more than 8 bits, which
    /// one and two channels are given; those of colours are rounded to 8, as most devices do.
    pub fn texel_format(self) -> TexelFormat {
        match self {
            Block::Bc4 { is_signed: false } => TexelFormat::new(1, Component::Unorm16),
            Block::Bc4 { is_signed: true } => TexelFormat::new(1, Component::Float32),
            Block::Bc5 { .. } => TexelFormat::new(4, Component::Unorm16),
            Block::Bc6h { .. } => TexelFormat::new(4, Component::Float32),
            _ => TexelFormat::new(4, Component::Unorm8),
        }
    }

    /// Decodes a slice of `width` texels a row.
    pub fn decode(self, blocks: &[u8], width: usize, texels: &mut [u8]) {
        let size = self.texel_format().bytes_per_texel();
        let row = width * size;
        let across = blocks.par_chunks_exact(width.div_ceil(SIDE) * self.bytes());
        across.zip(texels.par_chunks_mut(SIDE * row)).for_each(|(blocks, rows)| {
            let mut decoded = [0; TEXELS * 16];
            for (x, block) in blocks.chunks_exact(self.bytes()).enumerate() {
                self.decode_one(block, &mut decoded[..TEXELS * size]);
                let start = x * SIDE * size;
                let length = (row - start).min(SIDE * size);
                for (from, to) in decoded.chunks_exact(SIDE * size).zip(rows.chunks_exact_mut(row)) {
                    to[start..start + length].copy_from_slice(&from[..length]);
                }
            }
        });
    }

    /// Decodes the sixteen texels of a block.
    fn decode_one(self, block: &[u8], texels: &mut [u8]) {
        const PITCH: usize = SIDE * 4;
        match self {
            Block::Bc1 { has_alpha } => {
                bcdec_rs::bc1(block, texels, PITCH);
                if !has_alpha {
                    texels.chunks_exact_mut(4).for_each(|texel| texel[3] = u8::MAX);
                }
            }
            Block::Bc2 => bcdec_rs::bc2(block, texels, PITCH),
            Block::Bc3 => bcdec_rs::bc3(block, texels, PITCH),
            Block::Bc7 => bcdec_rs::bc7(block, texels, PITCH),
            Block::Bc4 { is_signed } => {
                let mut values = [0.0; TEXELS];
                bcdec_rs::bc4_float(block, &mut values, SIDE, is_signed);
                let component = self.texel_format().component();
                let texels = texels.chunks_exact_mut(component.bytes());
                texels.zip(values).for_each(|(texel, value)| component.store(value.into(), texel));
            }
            Block::Bc5 { is_signed } => {
                let mut values = [0.0; TEXELS * 2];
                bcdec_rs::bc5_float(block, &mut values, SIDE * 2, is_signed);
                for (texel, [x, y]) in texels.chunks_exact_mut(8).zip(values.as_chunks::<2>().0) {
                    let stored = [*x, *y].map(f64::from);
                    let rgba = normal::with_z(if is_signed { stored.map(normal::unsigned) } else { stored });
                    let numbers = texel.chunks_exact_mut(2).zip(rgba);
                    numbers.for_each(|(number, value)| Component::Unorm16.store(value, number));
                }
            }
            Block::Bc6h { is_signed } => {
                let mut values = [0.0f32; TEXELS * 3];
                bcdec_rs::bc6h_float(block, &mut values, SIDE * 3, is_signed);
                for (texel, [r, g, b]) in
                    texels.as_chunks_mut::<16>().0.iter_mut().zip(values.as_chunks::<3>().0)
                {
                    texel.copy_from_slice(bytemuck::bytes_of(&[*r, *g, *b, 1.0]));
                }
            }
        }
    }
}
