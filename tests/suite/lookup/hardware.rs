//! The hardware method: every `VkSampler` variant at level 0, by the interval rule.

use moire::internal::gpu::{DeviceKind, Gpu};
use moire::internal::lab::probe::{self, LookupQuery};
use moire::internal::lab::verify::judge::{Precision, messages as judge};
use moire::internal::lab::verify::variants::SIZES;
use moire::internal::pack::MAX_SLOTS;
use moire::internal::texture::data::{ColorSpace, TexelFormat, TextureData};
use moire::internal::texture::sampler_spec::{Address, Method, SamplerSpec, TexelCenter};

use super::assert_none;
use super::bench::{BASIC, Rng, coordinates, pairs, query, texture};
use crate::stage::device;
use crate::support::untested;

const FORMATS: [(TexelFormat, ColorSpace); 6] = [
    (TexelFormat::Rgba8, ColorSpace::Linear),
    (TexelFormat::Rgba8, ColorSpace::Srgb),
    (TexelFormat::Grey8, ColorSpace::Linear),
    (TexelFormat::Rgba16, ColorSpace::Linear),
    (TexelFormat::RgbaFloat, ColorSpace::Linear),
    (TexelFormat::GreyAlpha8, ColorSpace::Linear),
];

const STANDARD_BORDERS: [[f32; 4]; 3] = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4]];

fn precision(gpu: &Gpu) -> Precision {
    let step = (-f64::from(gpu.info().limits.sub_texel_bits)).exp2();
    // CPU drivers may filter 8-bit texels with weights and results of 8 bits: one step of 255. A
    // quarter of it fails 0.3 % of all look-ups on lavapipe. Elsewhere each of the four products of
    // two weights may be rounded to half a sub-texel step, which adds up to one step of the range.
    let eight_bits = if gpu.info().kind == DeviceKind::Cpu { 1.0 / 255.0 } else { step };
    Precision::Hardware {
        sub_texel: step, // VkPhysicalDeviceLimits::subTexelPrecisionBits
        level: 0.0,
        value: [eight_bits, if gpu.info().kind == DeviceKind::Cpu { 0.5 * step } else { step }],
        decode: 0.5 / 255.0, // half a step of the encoded value
    }
}

/// Sixteen pairs of sampler and format a dispatch; each read with half and with integer centres.
fn check(list: &[(SamplerSpec, usize)], seed: u64) {
    let gpu = device();
    let mut complaints = Vec::new();
    let mut count = 0;
    for (list, batch) in list.chunks(MAX_SLOTS).zip(seed..) {
        let [width, height] = SIZES[batch as usize % SIZES.len()];
        let make =
            |&(format, space): &(TexelFormat, ColorSpace)| texture(width, height, format, space, batch);
        let textures: Vec<TextureData> = FORMATS.iter().map(make).collect();
        let half = list.iter().map(|l| SamplerSpec { method: Method::Hardware, ..l.0 });
        let integer = half.clone().map(|s| SamplerSpec { texel_center: TexelCenter::Integer, ..s });
        let samplers: Vec<SamplerSpec> = half.clone().chain(integer).collect();
        let of: Vec<(usize, usize)> = list.iter().enumerate().map(|(i, l)| (l.1, i)).collect();
        let scene = pairs(textures, &samplers, &of);
        assert_eq!(scene.slots.len(), list.len());
        let mut rng = Rng::new(batch);
        let mut queries = Vec::new();
        for pair in 0..list.len() {
            for uv in coordinates(&mut rng, [width, height], 60, false) {
                let half = query(&scene, pair, uv);
                queries.push(half);
                queries.push(LookupQuery { sampler: half.sampler + list.len() as u32, ..half });
            }
        }
        let answers = probe::lookups(&gpu, &scene, true, false, &queries).unwrap();
        complaints.extend(judge(&scene, &queries, &answers, precision(&gpu)));
        count += queries.len();
    }
    assert_none(&complaints, count);
}

fn supported(spec: &SamplerSpec) -> bool {
    device().info().limits.mirror_clamp_to_edge || !spec.address.contains(&Address::MirrorClampToEdge)
}

/// The whole table once; the six variants of minification and mips, which level 0 does not read,
/// carry six formats.
#[test]
fn every_variant_of_the_devices_samplers() {
    let list: Vec<(SamplerSpec, usize)> = SamplerSpec::all()
        .enumerate()
        .map(|(i, s)| (s, i % FORMATS.len()))
        .filter(|(s, _)| supported(s))
        .collect();
    check(&list, 0);
}

#[test]
fn border_colours_of_the_devices_samplers() {
    let mut colors = STANDARD_BORDERS.to_vec();
    if device().info().limits.custom_border_color {
        colors.push([0.9, 0.1, 0.6, 0.3]);
    } else {
        untested("custom border colours: the device has none");
    }
    let mut list = Vec::new();
    for (i, &border_color) in colors.iter().enumerate() {
        for (j, &mag) in BASIC.iter().enumerate() {
            for format in 0..FORMATS.len() {
                let others = [Address::ClampToBorder, Address::Repeat, Address::ClampToEdge];
                let other = others[(i + j + format) % 3];
                let border = Address::ClampToBorder;
                let address = if format % 2 == 0 { [border, other] } else { [other, border] };
                list.push((
                    SamplerSpec { address, mag, min: mag, border_color, ..Default::default() },
                    format,
                ));
            }
        }
    }
    check(&list, 6);
}
