//! Images and samplers of the device layer: a shader samples and fetches the uploaded texels, in
//! every format, at every level, with every sampler that the device supports.

use moire::internal::gpu::{
    BindGroup, BindingDesc, BindingKind, Bound, Buffer, BufferUse, Gpu, Image, ImageDesc, ImageFormat,
    ImageShape, Pipeline, PipelineDesc, Swizzle,
};
use moire::internal::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use super::{Checked, bytes_of, error_of, noise, one, read_u32};
use crate::device_shaders::LOOK;

pub struct Look {
    output: Buffer,
    pipeline: Pipeline,
    group: BindGroup,
}

impl Look {
    /// Looks `sampled` up through `spec` and fetches from `fetched`.
    fn new(gpu: &Gpu, sampled: &ImageDesc<'_>, fetched: &ImageDesc<'_>, spec: &SamplerSpec) -> Look {
        let (sampled, fetched) = (gpu.image(sampled).unwrap(), gpu.image(fetched).unwrap());
        Look::of(gpu, &sampled, &fetched, spec)
    }

    pub fn of(gpu: &Gpu, sampled: &Image, fetched: &Image, spec: &SamplerSpec) -> Look {
        let output = gpu.buffer("looked up", 48, BufferUse::Storage).unwrap();
        let texels = gpu.upload_buffer("texels", BufferUse::TexelUint, &bytes_of(&[41, 42, 43])).unwrap();
        let sampler = gpu.sampler(spec).unwrap();
        let pipeline = gpu
            .pipeline(&PipelineDesc {
                name: "look",
                spirv: LOOK,
                bindings: &[
                    one(0, BindingKind::StorageBuffer),
                    BindingDesc { binding: 1, kind: BindingKind::SampledImage, count: 2 },
                    one(4, BindingKind::TexelBuffer),
                ],
                push_constant_bytes: 16,
                constants: &[],
            })
            .unwrap();
        let group = gpu
            .bind(
                &pipeline,
                &[
                    (4, Bound::Texels(std::slice::from_ref(&texels))),
                    (0, Bound::Buffer(&output)),
                    (1, Bound::Images(&[(sampled, &sampler), (fetched, &sampler)])),
                ],
            )
            .unwrap();
        Look { output, pipeline, group }
    }

    /// The filtered look-up, the fetched texel, and the texel buffer's facts.
    pub fn at(&self, gpu: &Gpu, uv: [f32; 2], lod: f32, level: u32) -> [[f32; 4]; 3] {
        let push = bytes_of(&[uv[0].to_bits(), uv[1].to_bits(), lod.to_bits(), level]);
        gpu.run(&self.pipeline, &self.group, &push, [1, 1, 1]).unwrap();
        let values: Vec<f32> = read_u32(gpu, &self.output).into_iter().map(f32::from_bits).collect();
        [0, 4, 8].map(|i| values[i..i + 4].try_into().unwrap())
    }
}

pub fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

#[test]
fn images_are_sampled_and_fetched_at_every_level() {
    let gpu = Checked::open();
    let levels = [
        floats(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0]),
        floats(&[20.0, 30.0]),
        floats(&[40.0]),
    ];
    let levels = [&levels[0][..], &levels[1], &levels[2]];
    let ramp = ImageDesc {
        name: "ramp",
        shape: ImageShape::Flat,
        depth: 1,
        width: 5,
        height: 2,
        format: ImageFormat::R32f,
        swizzle: Swizzle::Grey,
        levels: &levels,
    };
    let spec = SamplerSpec {
        mag: Filter::Nearest,
        min: Filter::Nearest,
        mip: MipMode::Nearest,
        ..Default::default()
    };
    let look = Look::new(&gpu, &ramp, &ramp, &spec);
    let [sampled, fetched, facts] = look.at(&gpu, [0.5, 0.75], 0.0, 0);
    assert_eq!((sampled, fetched), ([8.0, 8.0, 8.0, 1.0], [8.0, 8.0, 8.0, 1.0]));
    assert_eq!(facts, [41.0, 42.0, 3.0, 3.0], "two texels, their number, and the levels of the image");
    let [sampled, fetched, _] = look.at(&gpu, [0.75, 0.5], 1.0, 1);
    assert_eq!((sampled, fetched), ([30.0, 30.0, 30.0, 1.0], [30.0, 30.0, 30.0, 1.0]));
    assert_eq!(look.at(&gpu, [0.5, 0.5], 2.0, 2), [[40.0, 40.0, 40.0, 1.0], [40.0, 40.0, 40.0, 1.0], facts]);
}

#[test]
fn an_image_larger_than_a_transfer_chunk_arrives_whole() {
    let gpu = Checked::open();
    let (width, height) = (2048usize, 2200usize);
    let mut texels = noise(width * height * 4);
    let last = texels.len() - 4;
    texels[last..].copy_from_slice(&[10, 20, 30, 40]);
    let big = ImageDesc {
        name: "big",
        shape: ImageShape::Flat,
        depth: 1,
        width: width as u32,
        height: height as u32,
        format: ImageFormat::Rgba8,
        swizzle: Swizzle::Rgba,
        levels: &[&texels],
    };
    let nearest = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    let look = Look::new(&gpu, &big, &big, &nearest);
    for (column, row) in [(0, 0), (17, 1023), (2047, 2047), (5, 2048), (width - 1, height - 1)] {
        let at = (row * width + column) * 4;
        let expected: Vec<f32> = texels[at..at + 4].iter().map(|&t| f32::from(t) / 255.0).collect();
        let uv = [(column as f32 + 0.5) / width as f32, (row as f32 + 0.5) / height as f32];
        let [_, fetched, _] = look.at(&gpu, uv, 0.0, 0);
        for (value, exact) in fetched.iter().zip(&expected) {
            // One ulp for the conversion from 8 bits.
            assert!((value - exact).abs() <= f32::EPSILON * exact, "({column}, {row}): {fetched:?}");
        }
    }
}

#[test]
fn formats_and_swizzles_read_as_named() {
    let gpu = Checked::open();
    let half = 0.5f32;
    let cases: [(ImageFormat, Swizzle, Vec<u8>, [f32; 4]); 9] = [
        (ImageFormat::R8, Swizzle::Grey, vec![51], [0.2, 0.2, 0.2, 1.0]),
        (ImageFormat::Rg8, Swizzle::GreyAlpha, vec![51, 102], [0.2, 0.2, 0.2, 0.4]),
        (ImageFormat::Rgba8, Swizzle::Rgba, vec![0, 51, 102, 255], [0.0, 0.2, 0.4, 1.0]),
        // sRGB 188 is (188/255 + 0.055)/1.055 to the power 2.4 (IEC 61966-2-1); alpha stays linear.
        (ImageFormat::Rgba8Srgb, Swizzle::Rgba, vec![0, 188, 255, 51], [0.0, 0.502_886_5, 1.0, 0.2]),
        (ImageFormat::R16, Swizzle::Grey, 13_107u16.to_ne_bytes().to_vec(), [0.2, 0.2, 0.2, 1.0]),
        (ImageFormat::Rg16, Swizzle::GreyAlpha, vec![0xff, 0xff, 0, 0], [1.0, 1.0, 1.0, 0.0]),
        (ImageFormat::Rgba16, Swizzle::Rgba, vec![0, 0, 0xff, 0xff, 0, 0, 0xff, 0xff], [0.0, 1.0, 0.0, 1.0]),
        (ImageFormat::Rg32f, Swizzle::GreyAlpha, floats(&[-2.0, half]), [-2.0, -2.0, -2.0, half]),
        (ImageFormat::Rgba32f, Swizzle::Rgba, floats(&[1e9, -1e-9, 0.0, 3.0]), [1e9, -1e-9, 0.0, 3.0]),
    ];
    let nearest = SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, ..Default::default() };
    for (format, swizzle, texel, expected) in cases {
        assert!(gpu.supports(format, false), "{format}");
        let desc = ImageDesc {
            name: "texel",
            shape: ImageShape::Flat,
            depth: 1,
            width: 1,
            height: 1,
            format,
            swizzle,
            levels: &[&texel],
        };
        let [sampled, fetched, _] = Look::new(&gpu, &desc, &desc, &nearest).at(&gpu, [0.5, 0.5], 0.0, 0);
        for (found, exact) in sampled.iter().chain(&fetched).zip(expected.iter().chain(&expected)) {
            // sRGB decoding by table or polynomial may err by half a step of 8 bits (Direct3D 11.3
            // functional specification, "SRGB" conversion rules); the others by two ulp.
            let tolerance = if format == ImageFormat::Rgba8Srgb { 0.5 / 255.0 } else { 2e-7 * exact.abs() };
            assert!(
                (found - exact).abs() <= tolerance,
                "{format}: {sampled:?} {fetched:?}, not {expected:?}"
            );
        }
    }
}

#[test]
fn every_sampler_variant_is_created_or_refused_for_a_feature() {
    let gpu = Checked::open();
    let limits = &gpu.info().limits;
    for spec in SamplerSpec::all() {
        let allowed = limits.mirror_clamp_to_edge || !spec.address.contains(&Address::MirrorClampToEdge);
        assert_eq!(gpu.sampler(&spec).is_ok(), allowed, "{}", spec.label());
    }
}

#[test]
fn border_colors_are_read_back_through_a_sampler() {
    let gpu = Checked::open();
    let white = ImageDesc {
        name: "white",
        shape: ImageShape::Flat,
        depth: 1,
        width: 1,
        height: 1,
        format: ImageFormat::Rgba32f,
        swizzle: Swizzle::Rgba,
        levels: &[&floats(&[2.0; 4])],
    };
    let colors = [[0.0; 4], [0.0, 0.0, 0.0, 1.0], [1.0; 4], [0.25, -3.0, 0.5, 0.75]];
    for (index, border_color) in colors.into_iter().enumerate() {
        let spec = SamplerSpec {
            address: [Address::ClampToBorder; 2],
            mag: Filter::Nearest,
            min: Filter::Nearest,
            border_color,
            ..Default::default()
        };
        if index == 3 && !gpu.info().limits.custom_border_color {
            let error = error_of(gpu.sampler(&spec));
            assert!(error.contains("[0, 0, 0, 1]"), "{error}");
            continue;
        }
        let look = Look::new(&gpu, &white, &white, &spec);
        assert_eq!(look.at(&gpu, [-1.0, 0.5], 0.0, 0)[0], border_color, "outside");
        assert_eq!(look.at(&gpu, [0.5, 0.5], 0.0, 0)[0], [2.0; 4], "inside");
    }
}

#[test]
fn without_mips_both_filters_stay_reachable() {
    let gpu = Checked::open();
    let step = ImageDesc {
        name: "step",
        shape: ImageShape::Flat,
        depth: 1,
        width: 2,
        height: 1,
        format: ImageFormat::R32f,
        swizzle: Swizzle::Grey,
        levels: &[&floats(&[0.0, 1.0])],
    };
    let spec =
        SamplerSpec { mag: Filter::Nearest, min: Filter::Linear, mip: MipMode::None, ..Default::default() };
    let look = Look::new(&gpu, &step, &step, &spec);
    assert_eq!(look.at(&gpu, [0.375, 0.5], -1.0, 0)[0][0], 0.0, "magnified: nearest");
    // A quarter, on any grid of sub-texel positions.
    assert_eq!(look.at(&gpu, [0.375, 0.5], 3.0, 0)[0][0], 0.25, "minified: linear, of level 0");
}
