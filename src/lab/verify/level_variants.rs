//! Variants other than level 0 of 2D textures: levels of textures of one, two and three dimensions
//! and of cubes, and anisotropy. Each address mode is paired with each other one on every two axes,
//! with all filters and mip modes; classes of formats, sizes and borders rotate.

use super::variants::{FormatClass, Reader, Scale, Variant};
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec};

/// Lengths that halve without remainder to the last level, and odd ones.
const SIZES: [[[u32; 3]; 4]; 4] = [
    [[16, 1, 1], [5, 1, 1], [64, 1, 1], [7, 1, 1]],
    [[8, 8, 1], [16, 4, 1], [5, 3, 1], [7, 20, 1]],
    [[4, 4, 4], [8, 4, 2], [5, 3, 6], [9, 2, 4]],
    [[4, 4, 6], [8, 8, 6], [5, 5, 6], [2, 2, 6]],
];

const BORDERS: [[f32; 4]; 3] = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4]];

const BASIC: [Filter; 2] = [Filter::Nearest, Filter::Linear];

/// Limits of anisotropy, in footprint widths.
pub const ANISOTROPIES: [u32; 4] = [2, 4, 8, 16];

/// Returns the variants of every reader that reads levels, and the device's anisotropic samplers.
pub fn all() -> Vec<Variant> {
    let mut all = Vec::new();
    for &dimension in Dimension::ALL {
        all.extend(level_variants(Reader::Sampler, dimension));
    }
    all.extend(anisotropic_variants());
    for &dimension in Dimension::ALL {
        all.extend(level_variants(Reader::ShaderBuffer, dimension));
    }
    // The texels of volumes and cubes are in the buffer, even beside images.
    for dimension in [Dimension::One, Dimension::Two] {
        all.extend(level_variants(Reader::ShaderImage, dimension));
    }
    all
}

/// Returns address modes of u, v and w: one each, all pairs, or triples in which every two axes
/// meet all pairs.
fn addresses(dimension: Dimension) -> Vec<[Address; 3]> {
    let modes = Address::ALL;
    let of = |u: usize, v: usize| [modes[u], modes[v], modes[(u + v) % modes.len()]];
    match dimension {
        Dimension::One => (0..modes.len()).map(|u| of(u, (u + 1) % modes.len())).collect(),
        Dimension::Two | Dimension::Three => {
            (0..modes.len()).flat_map(|u| (0..modes.len()).map(move |v| of(u, v))).collect()
        }
        Dimension::Cube => vec![of(0, 0)],
    }
}

/// Returns pairs of magnification and minification filters that the reader supports.
fn filters(reader: Reader, dimension: Dimension) -> Vec<[Filter; 2]> {
    let mut all: Vec<[Filter; 2]> = BASIC.iter().flat_map(|&mag| BASIC.map(|min| [mag, min])).collect();
    if reader != Reader::Sampler && matches!(dimension, Dimension::One | Dimension::Two) {
        all.push([Filter::Cubic; 2]);
    }
    all
}

pub fn level_variants(reader: Reader, dimension: Dimension) -> Vec<Variant> {
    let mut all = Vec::new();
    for (i, [u, v, address_w]) in addresses(dimension).into_iter().enumerate() {
        for (j, [mag, min]) in filters(reader, dimension).into_iter().enumerate() {
            for (k, &mip) in MipMode::ALL.iter().enumerate() {
                let spec = SamplerSpec {
                    address: [u, v],
                    address_w,
                    mag,
                    min,
                    mip,
                    border_color: BORDERS[(i + i / 5 + k) % BORDERS.len()],
                    method: reader.method(),
                    ..Default::default()
                };
                // Few enough variants to have all classes of formats each, or one of them.
                let few = matches!(dimension, Dimension::One | Dimension::Cube);
                let classes = if few { 0..FormatClass::ALL.len() } else { 0..1 };
                all.extend(classes.map(|class| {
                    let turn = i + i / 4 + j + 3 * k + class;
                    variant(reader, dimension, Scale::Levels, spec, turn)
                }));
            }
        }
    }
    all
}

/// Returns one variant. The number of channels follows the size: the shader's pipelines hold twelve
/// textures.
fn variant(reader: Reader, dimension: Dimension, scale: Scale, spec: SamplerSpec, turn: usize) -> Variant {
    let class = FormatClass::ALL[turn % FormatClass::ALL.len()];
    let channels = turn / FormatClass::ALL.len() % 3;
    let sizes = SIZES[dimension as usize];
    let size = sizes[(class as usize + channels) % sizes.len()];
    Variant { reader, spec, scale, class, format: class.formats()[channels], dimension, size }
}

/// Returns the variants with levels distinguished by colour: all formats except sRGB, whose codes
/// are not evenly spaced, and no borders, which long footprints reach.
pub fn anisotropic_variants() -> Vec<Variant> {
    let mut all = Vec::new();
    for max_anisotropy in ANISOTROPIES {
        let modes = Address::ALL.iter().filter(|&&a| a != Address::ClampToBorder);
        for (i, &address) in modes.enumerate() {
            for mip in [MipMode::Nearest, MipMode::Linear] {
                let spec = SamplerSpec {
                    address: [address; 2],
                    min: Filter::Anisotropic,
                    mip,
                    max_anisotropy,
                    method: Method::Hardware,
                    ..Default::default()
                };
                let class = [FormatClass::Unorm8, FormatClass::Unorm16, FormatClass::Float32][i % 3];
                all.push(Variant {
                    reader: Reader::Sampler,
                    spec,
                    scale: Scale::Anisotropic,
                    class,
                    format: class.formats()[2],
                    dimension: Dimension::Two,
                    size: [256, 256, 1],
                });
            }
        }
    }
    all
}
