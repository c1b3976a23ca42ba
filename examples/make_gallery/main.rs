//! Writes the glTF files of `data/gallery`, one for each feature:
//! `cargo run --release --example make_gallery [FOLDER]`. The page `docs/gallery.md` shows what they look like.

mod gallery;

use std::error::Error;
use std::fs;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("data/gallery"), PathBuf::from);
    fs::create_dir_all(&folder)?;
    let mut total = 0;
    for file in gallery::all() {
        let path = folder.join(file.name);
        fs::write(&path, &file.bytes)?;
        total += file.bytes.len();
        println!("{:>8} bytes  {}", file.bytes.len(), path.display());
    }
    println!("{total:>8} bytes in all");
    Ok(())
}
