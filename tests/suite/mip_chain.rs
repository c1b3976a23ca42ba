//! Mip chains generated on the device (`MOIRE_DEVICE`, else `cpu`) against those of the host: the
//! same codes for every format, kind and size; the comparison must detect a planted error.

mod scenes;

use moire::internal::lab::probe::MipProbe;
use moire::internal::lab::verify::queries::noise;
use moire::internal::texture::data::{ColorSpace, Component, Dimension, MipKernel, TexelFormat, TextureData};
use moire::internal::texture::mips;

use crate::stage::device;

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

/// Floats are linear.
fn formats() -> impl Iterator<Item = (TexelFormat, ColorSpace)> {
    let spaces = |format: &TexelFormat| {
        let coded = format.component() != Component::Float32;
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

/// The first code in which two mip chains differ.
fn difference(device: &[TextureData], host: &[TextureData]) -> Option<String> {
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
            if found != exact {
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

fn assert_same(made: &mut MipProbe<'_>, texture: &TextureData) {
    let (device, seconds) = made.make(texture).unwrap();
    let host = mips::mip_chain(texture, MipKernel::Box);
    assert_eq!(seconds > 0.0, !host.is_empty(), "{}: {seconds} s", texture.name);
    let found = difference(&device, &host);
    let kind = texture.dimension;
    assert!(found.is_none(), "{kind} {}: {}", texture.name, found.unwrap());
}

#[test]
fn the_device_makes_the_codes_of_the_host_for_every_format_kind_and_size() {
    let gpu = device();
    let mut made = MipProbe::new(&gpu);
    for (format, space) in formats() {
        for (seed, (dimension, size)) in (1..).zip(SHAPES) {
            let texture = noise(dimension, size, format, space, seed);
            assert_same(&mut made, &texture);
        }
    }
}

/// Each of the 65536 sRGB codes of 16 bits beside one far from it, and beside itself.
#[test]
fn every_deep_srgb_code_is_averaged_as_on_the_host() {
    let gpu = device();
    let mut made = MipProbe::new(&gpu);
    let codes =
        |width: u32| (0..65536 * width).map(move |i| ((i / width).wrapping_mul(40503) & 0xffff) as u16);
    for (width, what) in [(1, "far neighbours"), (2, "pairs of equal codes")] {
        let texture = TextureData {
            name: what.into(),
            texels: codes(width).flat_map(u16::to_ne_bytes).collect(),
            ..noise(Dimension::Two, [256 * width, 256, 1], TexelFormat::Grey16, ColorSpace::Srgb, 1)
        };
        assert_same(&mut made, &texture);
    }
}

/// Every pair of two sRGB codes; their mean is looked up in the table of midpoints.
#[test]
fn every_pair_of_srgb_codes_is_averaged_as_on_the_host() {
    let gpu = device();
    let texels = (0..=255u8).flat_map(|a| (0..=255u8).flat_map(move |b| [a, b])).collect();
    let texture = TextureData {
        name: "all pairs of codes".into(),
        texels,
        ..noise(Dimension::Two, [512, 256, 1], TexelFormat::Grey8, ColorSpace::Srgb, 1)
    };
    assert_same(&mut MipProbe::new(&gpu), &texture);
}

#[test]
fn planted_errors_of_levels_are_seen() {
    let gpu = device();
    let texture = noise(Dimension::Two, [64, 16, 1], TexelFormat::Rgba8, ColorSpace::Srgb, 3);
    let (device, _) = MipProbe::new(&gpu).make(&texture).unwrap();
    let host = mips::mip_chain(&texture, MipKernel::Box);
    assert_eq!(difference(&device, &host), None);
    assert!(difference(&device, &mips::mip_chain(&texture, MipKernel::Kaiser)).is_some());
    assert!(difference(&device[1..], &host).is_some());
    let linear = TextureData { color_space: ColorSpace::Linear, ..texture };
    assert!(difference(&device, &mips::mip_chain(&linear, MipKernel::Box)).is_some());
    // One code of a colour, and of alpha, of the last level.
    for at in [0, 3] {
        let mut planted = host.clone();
        let code = &mut planted.last_mut().unwrap().texels[at];
        *code = if *code < 128 { *code + 1 } else { *code - 1 };
        assert!(difference(&device, &planted).is_some(), "channel {at}");
    }
}

#[test]
fn what_devices_do_not_make_is_refused_by_name() {
    let gpu = device();
    let mut made = MipProbe::new(&gpu);
    for (size, format, space) in [
        ([5, 4, 1], TexelFormat::Grey8, ColorSpace::Linear),
        ([6, 2, 1], TexelFormat::Grey8, ColorSpace::Linear),
    ] {
        let texture = noise(Dimension::Two, size, format, space, 1);
        let error = made.make(&texture).unwrap_err().to_string();
        assert!(error.contains(&texture.name) && error.contains("powers of two"), "{error}");
    }
}
