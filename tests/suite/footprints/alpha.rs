//! Textures whose alpha varies with their colour: no material interprets alpha as coverage, so that
//! every filter returns the mean of many point samples.

use std::path::Path;

use moire::internal::pack;
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat, TextureData};

use crate::stage::{render, render_on_oracle};

/// Pixels and texels along a side; 4096 samples see each texel of a pixel 64 times.
const PIXELS: u32 = 6;
const TEXELS: u32 = 8 * PIXELS;

/// One third each of all texels is red and opaque, green and transparent, blue and half transparent, along
/// diagonals.
fn striped() -> TextureData {
    let color = |x: u32, y: u32| [[255, 0, 0, 255], [0, 255, 0, 0], [0, 0, 255, 128]][((x + y) % 3) as usize];
    let texels = (0..TEXELS).flat_map(|y| (0..TEXELS).flat_map(move |x| color(x, y)));
    TextureData {
        name: "t".into(),
        dimension: Dimension::Two,
        width: TEXELS,
        height: TEXELS,
        depth: 1,
        format: TexelFormat::Rgba8,
        color_space: ColorSpace::Linear,
        file_channels: 4,
        texels: texels.collect(),
        stored_levels: Vec::new(),
    }
}

/// Square pixels that look straight at the texture, with a fractional number of its periods each.
fn pixels(sampling: &str, sampler: &str, texture: &str, on_oracle: bool) -> Vec<[f32; 3]> {
    let text = format!(
        "[camera]\neye = [0, 0, 1]\nlook_at = [0, 0, 0]\northographic_height = 2\n\
         [image]\nwidth = {PIXELS}\nheight = {PIXELS}\n[sampling]\n{sampling}\n\
         [[texture]]\nname = 't'\nfile = 't'\n{texture}\n[[sampler]]\nname = 's'\n{sampler}\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
         mapping = {{ kind = 'surface', scale = [0.5, 0.5], offset = [0.5, 0.5] }}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 1, 0]\nmaterial = 'm'\n"
    );
    let scene = parse(Path::new("alpha.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let packed = pack::pack(&scene, vec![striped()], None).unwrap();
    if on_oracle { render_on_oracle(&packed).pixels } else { render(&packed).pixels }
}

#[test]
fn every_filter_shows_the_colours_that_samples_see_whatever_their_alpha() {
    let plain = pixels("spp = 4096", "filter = 'linear'", "", false);
    let one = "pattern = 'center'\nfootprint = 'differentials'";
    let min = |filter: &str| format!("mip = 'linear'\nfilter = {{ mag = 'linear', min = '{filter}' }}");
    for (what, sampling, sampler, texture) in [
        ("trilinear", one, min("linear"), ""),
        ("anisotropic", one, min("anisotropic"), ""),
        ("ewa", one, min("ewa"), ""),
        ("kaiser", one, min("linear"), "mip_filter = 'kaiser'"),
        ("summed-area", one, min("summed-area"), ""),
        ("cone", "algorithm = 'cone'", min("linear"), ""),
        ("beam", "algorithm = 'beam'", "filter = 'linear'".into(), ""),
    ] {
        for on_oracle in [false, true] {
            if on_oracle && !sampling.starts_with("pattern") {
                continue; // Tests of their own compare cones and beams on the device with the oracle.
            }
            let filtered = pixels(sampling, &sampler, texture, on_oracle);
            for (i, (a, b)) in filtered.iter().zip(&plain).enumerate() {
                for (a, b) in a.iter().zip(b) {
                    // A pixel of 8 × 8 texels holds 21 or 22 of a colour, where a wider filter holds a third:
                    // 0.0104. Of weights over stripes 3 / √2 texels apart a Gaussian as wide leaves less.
                    assert!((a - b).abs() <= 0.0125, "{what}, pixel {i}: {a}, of 4096 samples {b}");
                }
            }
        }
    }
}
