//! Pyramids that the device makes (`MOIRE_DEVICE`, else `cpu`) against those of the host: the same codes for
//! every format, kind and size; a comparison that lets a planted error through would not be one.

mod scenes;

use moire::probe::Pyramids;
use moire::texture::data::{ColorSpace, Component, Dimension, MipKernel, TexelFormat, TextureData};
use moire::texture::mips;
use moire::verify::queries::noise;

use crate::shared_gpu::gpu;

/// Kinds of textures with sizes whose lengths are powers of two.
const SHAPES: [(Dimension, [u32; 3]); 13] = [
    (Dimension::One, [1, 1, 1]),
    (Dimension::One, [128, 1, 1]),
    (Dimension::Two, [2, 1, 1]),
    (Dimension::Two, [1, 4, 1]),
    (Dimension::Two, [8, 8, 1]),
    (Dimension::Two, [64, 16, 1]),
    (Dimension::Two, [256, 256, 1]),
    (Dimension::Three, [1, 1, 8]),
    (Dimension::Three, [2, 16, 4]),
    (Dimension::Three, [16, 16, 16]),
    (Dimension::Cube, [1, 1, 6]),
    (Dimension::Cube, [2, 2, 6]),
    (Dimension::Cube, [32, 32, 6]),
];

/// All formats that devices make levels of: deeper sRGB than 8 bits is held as linear floats.
fn formats() -> impl Iterator<Item = (TexelFormat, ColorSpace)> {
    let spaces = |format: &TexelFormat| {
        let coded = format.component() == Component::Unorm8;
        let spaces = if coded { ColorSpace::ALL } else { &[ColorSpace::Linear][..] };
        spaces.iter().map(|&space| (*format, space)).collect::<Vec<_>>()
    };
    TexelFormat::ALL.iter().flat_map(spaces)
}

/// Each channel of each texel as an integer: codes, or the bits of a float in an order without jumps.
fn steps(texture: &TextureData) -> Vec<i64> {
    let ordered = |bits: i32| i64::from(if bits < 0 { i32::MIN.wrapping_sub(bits) } else { bits });
    match texture.format.component() {
        Component::Unorm8 => texture.texels.iter().map(|&c| i64::from(c)).collect(),
        Component::Unorm16 => {
            texture.texels.as_chunks::<2>().0.iter().map(|&c| i64::from(u16::from_ne_bytes(c))).collect()
        }
        Component::Float32 => {
            texture.texels.as_chunks::<4>().0.iter().map(|&c| ordered(i32::from_ne_bytes(c))).collect()
        }
    }
}

/// What differs between two pyramids by more than is allowed to the colours of texels with alpha, which a
/// division gives. All else must be equal.
fn difference(device: &[TextureData], host: &[TextureData], colours: i64) -> Option<String> {
    if device.len() != host.len() {
        return Some(format!("{} levels, not {}", device.len(), host.len()));
    }
    for (level, (device, host)) in device.iter().zip(host).enumerate() {
        let size = |t: &TextureData| [t.width, t.height, t.depth];
        if size(device) != size(host) {
            return Some(format!("level {}: {:?}, not {:?}", level + 1, size(device), size(host)));
        }
        let channels = host.format.channels();
        for (i, (found, exact)) in steps(device).into_iter().zip(steps(host)).enumerate() {
            let divided = channels > 1 && i % channels + 1 < channels;
            if (found - exact).abs() > if divided { colours } else { 0 } {
                let (texel, channel) = (i / channels, i % channels);
                return Some(format!(
                    "level {}, texel {texel}, channel {channel}: {found}, not {exact}",
                    level + 1
                ));
            }
        }
    }
    None
}

fn assert_same(made: &mut Pyramids<'_>, texture: &TextureData, colours: i64) {
    let (device, seconds) = made.make(texture).unwrap();
    let host = mips::pyramid(texture, MipKernel::Box);
    assert_eq!(seconds > 0.0, !host.is_empty(), "{}: {seconds} s", texture.name);
    let found = difference(&device, &host, colours);
    let kind = texture.dimension;
    assert!(found.is_none(), "{kind} {}: {}", texture.name, found.unwrap());
}

/// One step of an integer code; of floats, whose mean is divided unrounded, two ulp.
fn tolerance(format: TexelFormat) -> i64 {
    if format.component() == Component::Float32 { 2 } else { 1 }
}

#[test]
fn the_device_makes_the_codes_of_the_host_for_every_format_kind_and_size() {
    let gpu = gpu();
    let mut made = Pyramids::new(&gpu);
    for (format, space) in formats() {
        for (seed, (dimension, size)) in (1..).zip(SHAPES) {
            let texture = noise(dimension, size, format, space, seed);
            assert_same(&mut made, &texture, tolerance(format));
        }
    }
}

/// Every fourth mean of opaque texels lies right between two codes.
#[test]
fn opaque_texels_come_out_exactly() {
    let gpu = gpu();
    let mut made = Pyramids::new(&gpu);
    for (format, space) in formats().filter(|(format, _)| format.channels() > 1) {
        let (component, bytes) = (format.component(), format.bytes_per_texel());
        let mut texture = noise(Dimension::Two, [64, 64, 1], format, space, 5);
        for texel in texture.texels.chunks_mut(bytes) {
            texel[bytes - component.bytes()..].copy_from_slice(&component.one()[..component.bytes()]);
        }
        assert_same(&mut made, &texture, 0);
    }
}

/// Where nothing is seen at all, and where some texels are unseen.
#[test]
fn transparent_texels_keep_their_colour_and_lend_none() {
    let gpu = gpu();
    let mut made = Pyramids::new(&gpu);
    for (format, space) in formats().filter(|(format, _)| format.channels() > 1) {
        let (bytes, alpha) = (format.bytes_per_texel(), format.component().bytes());
        let mut texture = noise(Dimension::Two, [32, 32, 1], format, space, 6);
        for (i, texel) in texture.texels.chunks_mut(bytes).enumerate() {
            if i < 256 || i % 3 == 0 {
                texel[bytes - alpha..].fill(0);
            }
        }
        assert_same(&mut made, &texture, tolerance(format));
    }
}

/// Each of the 65536 codes of alpha once, neighbours far apart.
#[test]
fn every_code_of_alpha_is_read_as_on_the_host() {
    let gpu = gpu();
    let mut made = Pyramids::new(&gpu);
    let codes = (0..65536u32).map(|i| (i.wrapping_mul(40503) & 0xffff) as u16);
    let texels = codes.flat_map(|alpha| [1000, alpha]).flat_map(u16::to_ne_bytes).collect();
    let format = TexelFormat::GreyAlpha16;
    let texture = TextureData {
        name: "all codes of alpha".into(),
        texels,
        ..noise(Dimension::Two, [256, 256, 1], format, ColorSpace::Linear, 1)
    };
    assert_same(&mut made, &texture, 1);
    // As they are: pairs of equal texels.
    let pairs = texture.texels.as_chunks::<4>().0.iter().flat_map(|texel| [*texel, *texel]);
    let wide = TextureData { texels: pairs.collect::<Vec<_>>().concat(), width: 512, ..texture };
    assert_same(&mut made, &wide, 1);
}

/// Every pair of two sRGB codes; their mean is looked up in the table of middles.
#[test]
fn every_pair_of_srgb_codes_is_averaged_as_on_the_host() {
    let gpu = gpu();
    let texels = (0..=255u8).flat_map(|a| (0..=255u8).flat_map(move |b| [a, b])).collect();
    let texture = TextureData {
        name: "all pairs of codes".into(),
        texels,
        ..noise(Dimension::Two, [512, 256, 1], TexelFormat::Grey8, ColorSpace::Srgb, 1)
    };
    assert_same(&mut Pyramids::new(&gpu), &texture, 0);
}

#[test]
fn planted_errors_of_levels_are_seen() {
    let gpu = gpu();
    let texture = noise(Dimension::Two, [64, 16, 1], TexelFormat::Rgba8, ColorSpace::Srgb, 3);
    let (device, _) = Pyramids::new(&gpu).make(&texture).unwrap();
    let host = mips::pyramid(&texture, MipKernel::Box);
    assert_eq!(difference(&device, &host, 1), None);
    assert!(difference(&device, &mips::pyramid(&texture, MipKernel::Kaiser), 1).is_some());
    assert!(difference(&device[1..], &host, 1).is_some());
    let linear = TextureData { color_space: ColorSpace::Linear, ..texture };
    assert!(difference(&device, &mips::pyramid(&linear, MipKernel::Box), 1).is_some());
    // Two codes of a colour, one code of alpha, of the last level.
    for (at, by) in [(0, 2), (3, 1)] {
        let mut planted = host.clone();
        let code = &mut planted.last_mut().unwrap().texels[at];
        *code = if *code < 128 { *code + by } else { *code - by };
        assert!(difference(&device, &planted, 1).is_some(), "channel {at}");
    }
}

#[test]
fn what_devices_do_not_make_is_refused_by_name() {
    let gpu = gpu();
    let mut made = Pyramids::new(&gpu);
    for (size, format, space) in [
        ([5, 4, 1], TexelFormat::Grey8, ColorSpace::Linear),
        ([6, 2, 1], TexelFormat::Grey8, ColorSpace::Linear),
        ([4, 4, 1], TexelFormat::Grey16, ColorSpace::Srgb),
    ] {
        let texture = noise(Dimension::Two, size, format, space, 1);
        let error = made.make(&texture).unwrap_err().to_string();
        assert!(error.contains(&texture.name) && error.contains("powers of two"), "{error}");
    }
}
