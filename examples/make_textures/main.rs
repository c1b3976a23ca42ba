//! Writes the textures of `data/textures` that the library can make:
//! `cargo run --release --example make_textures [FOLDER]`. PNG files carry no gAMA, sRGB or iCCP
//! chunk: what the numbers mean is said by the scene (`color_space`), not guessed by a reader.

mod synth;

use std::error::Error;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ImageFormat};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("data/textures"), PathBuf::from);
    let mut total = 0;
    let mut files = Vec::new();
    for asset in synth::all() {
        let path = folder.join(asset.path);
        let bytes = encode(&path, &asset.image)?;
        files.push((path, bytes));
    }
    files.extend(synth::volumes().into_iter().map(|volume| (folder.join(volume.path), volume.bytes)));
    for (path, bytes) in files {
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(&path, &bytes)?;
        total += bytes.len();
        println!("{:>8} bytes  {}", bytes.len(), path.display());
    }
    println!("{total:>8} bytes in all");
    Ok(())
}

fn encode(path: &Path, image: &DynamicImage) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut out = Cursor::new(Vec::new());
    match ImageFormat::from_path(path)? {
        ImageFormat::Png => image.write_with_encoder(PngEncoder::new_with_quality(
            &mut out,
            CompressionType::Best,
            FilterType::Adaptive,
        ))?,
        format => image.write_to(&mut out, format)?,
    }
    Ok(out.into_inner())
}
