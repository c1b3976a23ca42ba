//! Generates box mip chains on the device. Input: level 0. Output: a buffer with all levels one after the other, each
//! aligned to a word, as in the texel buffer. One dispatch per level, all in one submission; values between levels stay
//! unrounded f32, as in `texture::mips`, which produces the same codes.

use std::sync::Arc;

use crate::core::color::srgb_table;
use crate::core::error::Result;
use crate::gpu::shaders;
use crate::gpu::{Bound, Buffer, BufferUse, Gpu, Pipeline};
use crate::pack::{PackedScene, SlotCounts};
use crate::schema::bindings;
use crate::schema::layout::Halving;
use crate::schema::specialization::Constant;
use crate::texture::data::{ColorSpace, TexelFormat};
use crate::texture::mips;

const GROUP: u32 = 64;
/// Workgroups in a row; every device supports 65535.
const LONGEST_ROW: u32 = 1 << 15;

/// The input of a mip chain.
pub struct MipSource<'a> {
    pub name: &'a str,
    pub format: TexelFormat,
    pub space: ColorSpace,
    /// The sizes of all levels, at least two, each length equal to that of the previous level or half of it.
    pub sizes: &'a [[u32; 3]],
    /// The texels of level 0.
    pub texels: &'a [u8],
}

pub struct MipChain {
    pub buffer: Buffer,
    /// Byte offset of each level.
    pub starts: Vec<u64>,
}

/// Returns the sizes of all levels of a texture.
pub fn sizes(packed: &PackedScene, texture: usize) -> Vec<[u32; 3]> {
    (0..packed.records.textures[texture].levels).map(|level| packed.level_size(texture, level)).collect()
}

/// Generates mip chains; textures of one format share a pipeline.
pub struct MipGenerator<'a> {
    gpu: &'a Gpu,
    /// Tables for each number of sRGB codes, and one for textures without any.
    tables: Vec<(usize, Buffer)>,
    /// Device time of all passes so far, if there were any.
    pub seconds: Option<f64>,
}

impl<'a> MipGenerator<'a> {
    pub fn new(gpu: &'a Gpu) -> MipGenerator<'a> {
        MipGenerator { gpu, tables: Vec::new(), seconds: None }
    }

    pub fn make(&mut self, top: &MipSource<'_>) -> Result<MipChain> {
        let channels = top.format.channels() as u64;
        let texels: Vec<u64> = top.sizes.iter().map(|size| size.map(u64::from).iter().product()).collect();
        let mut starts = Vec::with_capacity(texels.len());
        let mut end = 0;
        for count in &texels {
            starts.push(end);
            end += (count * top.format.bytes_per_texel() as u64).next_multiple_of(4);
        }
        let gpu = self.gpu;
        let buffer = gpu.buffer(top.name, end, BufferUse::Storage)?;
        gpu.write_buffer(&buffer, 0, top.texels)?;
        let numbers: u64 = texels.iter().skip(1).take(2).sum::<u64>() * channels;
        let numbers = gpu.buffer("numbers of two levels", numbers * 4, BufferUse::Storage)?;
        let tables = self.tables(codes(top.format, top.space))?;
        let pipeline = build(gpu, top.format, top.space)?;
        let bound = [
            (bindings::MIP_WORDS, Bound::Buffer(&buffer)),
            (bindings::MIP_NUMBERS, Bound::Buffer(&numbers)),
            (bindings::MIP_TABLES, Bound::Buffer(&tables)),
        ];
        let group = gpu.bind(&pipeline, &bound)?;
        let passes = passes(top, &texels, &starts);
        let dispatches: Vec<(&[u8], [u32; 3])> =
            passes.iter().map(|(pass, groups)| (bytemuck::bytes_of(pass), *groups)).collect();
        let time = gpu.run_all(&pipeline, &group, &dispatches)?;
        self.seconds = Some(self.seconds.unwrap_or(0.0) + time.device_seconds);
        Ok(MipChain { buffer, starts })
    }

    fn tables(&mut self, codes: usize) -> Result<Buffer> {
        if let Some((_, tables)) = self.tables.iter().find(|(other, _)| *other == codes) {
            return Ok(tables.clone());
        }
        // A binding must not be empty.
        let tables =
            if codes == 0 { vec![0.0] } else { [srgb_table(codes), &mips::srgb_midpoints(codes)].concat() };
        let buffer =
            self.gpu.upload_buffer("sRGB codes", BufferUse::Storage, bytemuck::cast_slice(&tables))?;
        self.tables.push((codes, buffer.clone()));
        Ok(buffer)
    }
}

/// Returns the number of sRGB codes of a colour channel; 0 if it is linear.
fn codes(format: TexelFormat, space: ColorSpace) -> usize {
    if space == ColorSpace::Srgb { format.component().codes() } else { 0 }
}

fn build(gpu: &Gpu, format: TexelFormat, space: ColorSpace) -> Result<Arc<Pipeline>> {
    let shader = &shaders::MIPS;
    let values = [
        (Constant::GroupX, GROUP),
        (Constant::GroupY, 1),
        (Constant::MipChannels, format.channels() as u32),
        (Constant::MipComponentBytes, format.component().bytes() as u32),
        (Constant::MipSrgb, u32::from(codes(format, space) > 0)),
    ];
    let constants = shader.values(values);
    super::build_pipeline(gpu, shader, &constants, SlotCounts::default(), size_of::<Halving>())
}

/// Returns one pass per level, each from the previous level. Values of odd levels start at 0, those of even levels
/// after level 1.
fn passes(top: &MipSource<'_>, texels: &[u64], starts: &[u64]) -> Vec<(Halving, [u32; 3])> {
    let texel_bytes = top.format.bytes_per_texel() as u64;
    let number = |level: usize| if level % 2 == 1 { 0 } else { texels[1] * top.format.channels() as u64 };
    let pass = |level: usize| {
        let (from, to) = (top.sizes[level - 1], top.sizes[level]);
        let halved = (0..3).filter(|&axis| from[axis] != to[axis]).map(|axis| 1 << axis).sum();
        let halving = Halving {
            from_codes: u32::from(level == 1),
            above: if level == 1 { 0 } else { number(level - 1) as u32 },
            word: (starts[level] / 4) as u32,
            number: number(level) as u32,
            texels: texels[level] as u32,
            columns_log2: to[0].ilog2(),
            rows_log2: to[1].ilog2(),
            halved,
        };
        let threads = (texels[level] * texel_bytes).div_ceil(texel_bytes.max(4)) as u32;
        let groups = threads.div_ceil(GROUP);
        let row = groups.min(LONGEST_ROW);
        (halving, [row, groups.div_ceil(row), 1])
    };
    (1..top.sizes.len()).map(pass).collect()
}
