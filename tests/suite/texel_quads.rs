//! Bilinear look-ups that read their four texels at once: the same picture, bit for bit, as by four reads, whatever the
//! size, format and address mode; and which scenes have them.

use std::path::Path;

use moire::internal::lab::verify::queries::noise;
use moire::internal::pack::{self, PackedScene};
use moire::internal::render::{TexelChoice, Tuning};
use moire::internal::scene::parse;
use moire::internal::texture::data::{ColorSpace, Dimension, TexelFormat};

use crate::stage::{assert_same_bits, render_with};

const SIZES: [[u32; 2]; 6] = [[1, 1], [1, 7], [6, 1], [2, 2], [5, 3], [16, 32]];

/// A floor that shows some tiles on both sides of the origin, and what lies between them up to the horizon.
fn packed(sampler: &str, [width, height]: [u32; 2], format: TexelFormat, space: ColorSpace) -> PackedScene {
    let text = format!(
        "[camera]\neye = [0.1, 1, 0.2]\nlook_at = [0.3, 0.2, -2]\nvertical_fov = 70\n\
         [image]\nwidth = 40\nheight = 32\n[sampling]\npattern = 'random'\nspp = 16\n\
         [[texture]]\nname = 't'\nfile = 'a'\n[[sampler]]\nname = 's'\n{sampler}\n\
         [[material]]\nname = 'm'\nmodel = 'unlit'\ntexture = 't'\nsampler = 's'\n\
         mapping = {{ kind = 'surface', scale = [0.4, 0.3] }}\n\
         [[plane]]\norigin = [0, 0, 0]\ntangent = [1, 0, 0]\nbitangent = [0, 0, 1]\nmaterial = 'm'\nhalf_extent = 30\n"
    );
    let scene = parse(Path::new("quads.toml"), &text).unwrap_or_else(|e| panic!("{e}\n{text}"));
    let texels = noise(Dimension::Two, [width, height, 1], format, space, u64::from(7 * width + height));
    pack::pack(&scene, vec![texels], None).unwrap()
}

fn from(texels: TexelChoice, texel_words: Option<u64>) -> Tuning {
    Tuning { texels, texel_words, ..Tuning::default() }
}

#[test]
fn four_texels_at_once_give_the_bits_of_four_reads() {
    for (i, size) in SIZES.into_iter().enumerate() {
        for (format, space) in [
            (TexelFormat::Grey8, ColorSpace::Linear),
            (TexelFormat::Grey8, ColorSpace::Srgb),
            (TexelFormat::Rgba8, ColorSpace::Linear),
            (TexelFormat::Rgba8, ColorSpace::Srgb),
        ] {
            let modes = ["'repeat'", "'clamp-to-edge'", "['repeat', 'clamp-to-edge']"];
            let address = format!("address = {}", modes[i % modes.len()]);
            let scene = packed(&address, size, format, space);
            let what = format!("{address} {size:?} {format:?} {space}");
            assert!(scene.allows_texel_quads() && scene.texel_quad_words().is_some(), "{what}");
            // A buffer just long enough for the texels alone.
            let words = Some(scene.texels.len() as u64 / 4);
            let apart = render_with(&scene, false, &from(TexelChoice::Buffer, words)).0;
            let at_once = render_with(&scene, false, &from(TexelChoice::Buffer, None)).0;
            assert_same_bits(&at_once, &apart, &what);
            let image = render_with(&scene, false, &from(TexelChoice::Image, None)).0;
            for (p, q) in apart.pixels.iter().flatten().zip(image.pixels.iter().flatten()) {
                assert!((p - q).abs() <= 4.0 * f32::EPSILON, "{what}: {p} and {q} from an image");
            }
        }
    }
}

#[test]
fn a_wrong_neighbour_would_show() {
    let scene = packed("address = 'repeat'", [5, 3], TexelFormat::Grey8, ColorSpace::Linear);
    let film = |scene: &PackedScene| render_with(scene, false, &from(TexelChoice::Buffer, None)).0;
    let right = film(&scene);
    for texel in 0..15 {
        let mut wrong = scene.clone();
        wrong.texels[texel] ^= 1;
        assert_ne!(film(&wrong).pixels, right.pixels, "texel {texel}");
    }
}

#[test]
fn only_plain_bilinear_samplers_of_textures_that_a_cache_holds_have_them() {
    let of = |sampler: &str| packed(sampler, [16, 16], TexelFormat::Rgba8, ColorSpace::Linear);
    assert!(of("").allows_texel_quads());
    for sampler in [
        "address = 'mirrored-repeat'",
        "address = ['repeat', 'clamp-to-border']",
        "filter = 'nearest'",
        "filter = 'cubic'",
    ] {
        assert!(!of(sampler).allows_texel_quads(), "{sampler}");
    }
    let words = |size, format| packed("", size, format, ColorSpace::Linear).texel_quad_words();
    assert_eq!(words([64, 64], TexelFormat::Rgba8), Some(4 * 64 * 64));
    assert_eq!(words([64, 64], TexelFormat::Rgba16), None, "of 8 bits");
    assert_eq!(words([256, 128], TexelFormat::Grey8), None, "more texels than 40 × 32 × 16 samples");
    let mut long = packed("", [1024, 1024], TexelFormat::Grey8, ColorSpace::Linear);
    long.samples = 4096;
    assert_eq!(long.texel_quad_words(), Some(1 << 20));
    let mut longer = packed("", [1024, 1025], TexelFormat::Grey8, ColorSpace::Linear);
    longer.samples = 4096;
    assert_eq!(longer.texel_quad_words(), None, "beyond a cache");
}
