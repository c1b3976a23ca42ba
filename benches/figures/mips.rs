//! Mip chains of a texture of 4096² rgba8 texels: `cargo bench -- mips`. Measures seconds of the
//! host for both kernels, and of the device, by its timestamps, for the box kernel.

use std::hint::black_box;
use std::time::Instant;

use moire::internal::gpu::{DeviceSelect, Gpu};
use moire::internal::lab::probe::MipProbe;
use moire::internal::texture::data::{ColorSpace, Dimension, MipKernel, TexelFormat, TextureData};
use moire::internal::texture::mips;

use crate::{Bench, Outcome};

const SIDE: u32 = 4096;

/// Colours and alpha without a pattern.
fn texture(color_space: ColorSpace) -> TextureData {
    let texel = |i: u32| (i ^ i >> 15).wrapping_mul(0x9E37_79B9).to_ne_bytes();
    TextureData {
        name: "noise".into(),
        dimension: Dimension::Two,
        width: SIDE,
        height: SIDE,
        depth: 1,
        format: TexelFormat::Rgba8,
        color_space,
        file_channels: 4,
        texels: (0..SIDE * SIDE).flat_map(texel).collect(),
        stored_levels: Vec::new(),
    }
}

/// The median of as many runs as count, after one that does not.
fn median(bench: &Bench, mut seconds: impl FnMut() -> Outcome<f64>) -> Outcome<f64> {
    seconds()?;
    let mut all = (0..bench.runs).map(|_| seconds()).collect::<Outcome<Vec<f64>>>()?;
    all.sort_by(f64::total_cmp);
    Ok(all[all.len() / 2])
}

pub fn table(bench: &Bench) -> Outcome<()> {
    let gpu = Gpu::open(&DeviceSelect::parse(&bench.device)?)?;
    let mut made = MipProbe::new(&gpu);
    println!("\n| pyramid, {SIDE}² rgba8 | box, host s | Kaiser, host s | box, device ms |");
    println!("| --- | --- | --- | --- |");
    for &space in ColorSpace::ALL {
        let texture = texture(space);
        let host = |kernel| {
            median(bench, || {
                let clock = Instant::now();
                black_box(mips::mip_chain(&texture, kernel));
                Ok(clock.elapsed().as_secs_f64())
            })
        };
        let (box_host, kaiser_host) = (host(MipKernel::Box)?, host(MipKernel::Kaiser)?);
        let device = median(bench, || Ok(made.make(&texture)?.1))?;
        println!("| {space} | {box_host:.3} | {kaiser_host:.3} | {:.3} |", device * 1e3);
    }
    Ok(())
}
