//! A mirrored environment equals one whose pictures are mirrored, and for a cube the faces +x and −x exchanged; on
//! device and oracle, seen directly and in a ball, rotated or not.

use moire::internal::core::film::Film;
use moire::internal::texture::data::{Dimension, TextureData};

use super::{floats, scene};
use crate::stage;

/// Eight by four texels, or six faces of four by four, each of another colour.
fn sky(cube: bool) -> TextureData {
    let (width, height) = if cube { (4, 24) } else { (8, 4) };
    let tint = |n: u32, step: u32| (n * step % 17) as f32 / 16.0;
    let texels = floats(width, height, |x, y| {
        let n = y * width + x + 1;
        [tint(n, 5), tint(n, 7), tint(n, 11), 1.0]
    });
    let (dimension, depth) = if cube { (Dimension::Cube, 6) } else { (Dimension::Two, 1) };
    TextureData { dimension, depth, height: height / depth, ..texels }
}

fn with_mirrored_pictures(sky: &TextureData) -> TextureData {
    let row = sky.width as usize * sky.format.bytes_per_texel();
    let reversed = |row: &[u8]| row.rchunks(sky.format.bytes_per_texel()).flatten().copied().collect();
    let mut rows: Vec<Vec<u8>> = sky.texels.chunks(row).map(reversed).collect();
    if sky.dimension == Dimension::Cube {
        let (first, second) = rows.split_at_mut(sky.height as usize);
        first.swap_with_slice(&mut second[..sky.height as usize]);
    }
    TextureData { texels: rows.concat(), ..sky.clone() }
}

fn pictures(sky: TextureData, mirror: bool, rotate: f64) -> [Film; 2] {
    let file = if sky.dimension == Dimension::Cube { "file = 't'\ndimension = 'cube'" } else { "file = 't'" };
    let text = format!(
        "camera = {{ eye = [0, 0, 3], look_at = [0.4, 0.2, 0], vertical_fov = 100 }}\n\
         image = {{ width = 12, height = 8 }}\nsampling = {{ pattern = 'center' }}\n\
         [[texture]]\nname = 't'\n{file}\n[[sampler]]\nname = 's'\n\
         [background]\nenvironment = 't'\nsampler = 's'\nrotate = {rotate:?}\nmirror = {mirror}\n\
         [[material]]\nname = 'm'\nmodel = 'mirror'\n[[sphere]]\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n"
    );
    let packed = scene(&text, vec![sky]);
    [stage::render(&packed), stage::render_on_oracle(&packed)]
}

fn largest_difference(a: &Film, b: &Film) -> f32 {
    let pairs = a.pixels.iter().flatten().zip(b.pixels.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn a_mirrored_environment_is_one_of_mirrored_pictures() {
    for (cube, rotate) in [(false, 0.0), (false, 70.0), (true, 0.0), (true, 70.0)] {
        let by_key = pictures(sky(cube), true, rotate);
        let by_pictures = pictures(with_mirrored_pictures(&sky(cube)), false, rotate);
        let plain = pictures(sky(cube), false, rotate);
        for ((by_key, by_pictures), plain) in by_key.iter().zip(&by_pictures).zip(&plain) {
            let error = largest_difference(by_key, by_pictures);
            assert!(error < 2e-5, "cube: {cube}, turned by {rotate}: {error}"); // f32 angles over a few texels
            assert!(largest_difference(by_key, plain) > 0.1, "cube: {cube}, {rotate}: not mirrored");
        }
    }
}
