//! The device layer on a real driver (`MOIRE_DEVICE`, else `cpu`): what goes up comes back, what
//! shaders read is what was bound, sizes over the limits are refused by name, and the validation
//! layer, where installed, has nothing to say about any of it.

use moire::gpu::{
    BindGroup, BindingDesc, BindingKind, Bound, Buffer, BufferUse, DeviceSelect, Gpu, ImageDesc, ImageFormat,
    MessageLog, OpenOptions, Pipeline, PipelineDesc, Swizzle, list_devices, validation_available,
};
use moire::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use crate::device_shaders::{FILL, LOOK};

/// An open device whose validation messages fail the test, also those of its closing.
struct Checked {
    gpu: Option<Gpu>,
    log: MessageLog,
}

impl Checked {
    fn open() -> Checked {
        let name = std::env::var("MOIRE_DEVICE").unwrap_or_else(|_| "cpu".into());
        let select = DeviceSelect::parse(&name).unwrap();
        let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
        assert_eq!(gpu.validation_active(), validation_available());
        if !gpu.validation_active() {
            eprintln!("the validation layer is not installed: its silence was not tested");
        }
        let log = gpu.message_log();
        Checked { gpu: Some(gpu), log }
    }
}

impl std::ops::Deref for Checked {
    type Target = Gpu;

    fn deref(&self) -> &Gpu {
        self.gpu.as_ref().unwrap()
    }
}

impl Drop for Checked {
    fn drop(&mut self) {
        self.gpu = None;
        let messages = self.log.to_vec();
        if !std::thread::panicking() {
            assert!(messages.is_empty(), "validation: {messages:#?}");
        }
    }
}

fn one(binding: u32, kind: BindingKind) -> BindingDesc {
    BindingDesc { binding, kind, count: 1 }
}

fn fill(gpu: &Gpu, factor: u32) -> Pipeline {
    gpu.pipeline(&PipelineDesc {
        name: "fill",
        spirv: FILL,
        bindings: &[one(0, BindingKind::StorageBuffer)],
        push_constant_bytes: 8,
        constants: &[(7, factor)],
    })
    .unwrap()
}

fn bytes_of(values: &[u32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

fn read_u32(gpu: &Gpu, buffer: &Buffer) -> Vec<u32> {
    let mut bytes = vec![0; buffer.bytes() as usize];
    gpu.read_buffer(buffer, 0, &mut bytes).unwrap();
    bytes.chunks_exact(4).map(|c| u32::from_ne_bytes(c.try_into().unwrap())).collect()
}

fn noise(len: usize) -> Vec<u8> {
    (0..len as u32).map(|i| (i.wrapping_mul(0x9E37_79B9) >> 24) as u8).collect()
}

fn error_of<T>(result: moire::error::Result<T>) -> String {
    result.err().expect("an error was expected").to_string()
}

#[test]
fn devices_are_listed_with_their_limits() {
    let devices = list_devices().unwrap();
    for (index, device) in devices.iter().enumerate() {
        assert_eq!(device.index, index);
        assert!(!device.name.is_empty() && !device.driver.is_empty());
        // Vulkan 1.2, "Limit Requirements".
        assert!(device.limits.max_image_2d >= 4096, "{device:?}");
        assert!(device.limits.max_push_constants >= 128, "{device:?}");
        assert!(device.limits.sub_texel_bits >= 4, "{device:?}");
        assert!(device.limits.heap_bytes > 0, "{device:?}");
    }
    let gpu = Checked::open();
    assert!(devices.iter().any(|device| device.uuid == gpu.info().uuid && device.name == gpu.info().name));
}

#[test]
fn buffers_come_back_as_uploaded_at_any_size() {
    let gpu = Checked::open();
    // Odd sizes, and more than one transfer chunk (16 MiB).
    for len in [1, 2, 3, 4, 5, 4095, 65_537, (16 << 20) + 12_345] {
        let data = noise(len);
        let buffer = gpu.upload_buffer("noise", BufferUse::Storage, &data).unwrap();
        let mut back = vec![0; len];
        gpu.read_buffer(&buffer, 0, &mut back).unwrap();
        assert!(back == data, "{len} bytes changed on the way");
        let tail = len.min(3);
        let mut back = vec![0; tail];
        gpu.read_buffer(&buffer, (len - tail) as u64, &mut back).unwrap();
        assert_eq!(back, data[len - tail..], "tail of {len} bytes");
    }
}

#[test]
fn parts_of_a_buffer_are_written_and_all_of_it_cleared() {
    let gpu = Checked::open();
    let buffer = gpu.upload_buffer("seven", BufferUse::Storage, &[9; 7]).unwrap();
    gpu.write_buffer(&buffer, 2, &[1, 2, 3]).unwrap();
    let mut back = [0; 7];
    gpu.read_buffer(&buffer, 0, &mut back).unwrap();
    assert_eq!(back, [9, 9, 1, 2, 3, 9, 9]);
    gpu.clear_buffer(&buffer).unwrap();
    gpu.read_buffer(&buffer, 0, &mut back).unwrap();
    assert_eq!(back, [0; 7]);
    let error = error_of(gpu.read_buffer(&buffer, 5, &mut back[..3]));
    assert!(error.contains("`seven`"), "{error}");
    assert!(gpu.write_buffer(&buffer, u64::MAX, &[1]).is_err());
}

#[test]
fn a_dispatch_sees_push_constants_specialization_and_earlier_dispatches() {
    let gpu = Checked::open();
    let count = 1000;
    let start: Vec<u32> = (0..count).map(|i| 5 * i).collect();
    let buffer = gpu.upload_buffer("values", BufferUse::Storage, &bytes_of(&start)).unwrap();
    for factor in [3, 11] {
        let pipeline = fill(&gpu, factor);
        let group = gpu.bind(&pipeline, &[(0, Bound::Buffer(&buffer))]).unwrap();
        let time = gpu.run(&pipeline, &group, &bytes_of(&[100, count]), [count.div_ceil(64), 1, 1]).unwrap();
        assert!(time.device_seconds > 0.0, "{time:?}");
        // The device works inside the host's interval; a millisecond for the clocks' difference.
        assert!(time.device_seconds < time.wall_seconds + 1e-3, "{time:?}");
    }
    let expected: Vec<u32> = (0..count).map(|i| 5 * i + (100 * 3 + i) + (100 * 11 + i)).collect();
    assert_eq!(read_u32(&gpu, &buffer), expected);
}

#[test]
fn a_bind_group_keeps_its_resources_and_objects_outlive_the_gpu() {
    let checked = Checked::open();
    let pipeline = fill(&checked, 2);
    let bound = checked.upload_buffer("bound", BufferUse::Storage, &[0; 256]).unwrap();
    let group = checked.bind(&pipeline, &[(0, Bound::Buffer(&bound))]).unwrap();
    drop(bound);
    checked.run(&pipeline, &group, &bytes_of(&[1, 64]), [1, 1, 1]).unwrap();
    let kept = checked.upload_buffer("kept", BufferUse::Storage, &[0; 16]).unwrap();
    drop(checked);
    drop((kept, group, pipeline));
}

#[test]
fn dropped_objects_give_their_memory_back() {
    let gpu = Checked::open();
    // The staging buffer stays: let it grow to its final size first.
    drop(gpu.upload_buffer("first", BufferUse::Storage, &noise(20 << 20)).unwrap());
    let before = gpu.memory_in_use();
    let buffer = gpu.upload_buffer("second", BufferUse::Storage, &noise(20 << 20)).unwrap();
    let small = gpu.buffer("third", 100, BufferUse::TexelUint).unwrap();
    assert!(gpu.memory_in_use() >= before + (20 << 20) + 100);
    drop((buffer, small));
    assert_eq!(gpu.memory_in_use(), before);
}

struct Look {
    output: Buffer,
    pipeline: Pipeline,
    group: BindGroup,
}

impl Look {
    /// Looks `sampled` up through `spec` and fetches from `fetched`.
    fn new(gpu: &Gpu, sampled: &ImageDesc<'_>, fetched: &ImageDesc<'_>, spec: &SamplerSpec) -> Look {
        let output = gpu.buffer("looked up", 48, BufferUse::Storage).unwrap();
        let texels = gpu.upload_buffer("texels", BufferUse::TexelUint, &bytes_of(&[41, 42, 43])).unwrap();
        let sampler = gpu.sampler(spec).unwrap();
        let (sampled, fetched) = (gpu.image(sampled).unwrap(), gpu.image(fetched).unwrap());
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
                    (4, Bound::Texels(&texels)),
                    (0, Bound::Buffer(&output)),
                    (1, Bound::Images(&[(&sampled, &sampler), (&fetched, &sampler)])),
                ],
            )
            .unwrap();
        Look { output, pipeline, group }
    }

    /// The filtered look-up, the fetched texel, and the texel buffer's facts.
    fn at(&self, gpu: &Gpu, uv: [f32; 2], lod: f32, level: u32) -> [[f32; 4]; 3] {
        let push = bytes_of(&[uv[0].to_bits(), uv[1].to_bits(), lod.to_bits(), level]);
        gpu.run(&self.pipeline, &self.group, &push, [1, 1, 1]).unwrap();
        let values: Vec<f32> = read_u32(gpu, &self.output).into_iter().map(f32::from_bits).collect();
        [0, 4, 8].map(|i| values[i..i + 4].try_into().unwrap())
    }
}

fn floats(values: &[f32]) -> Vec<u8> {
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
        let desc = ImageDesc { name: "texel", width: 1, height: 1, format, swizzle, levels: &[&texel] };
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

#[test]
fn sizes_over_the_limits_are_refused_by_name_and_limit() {
    let gpu = Checked::open();
    let limits = gpu.info().limits.clone();
    let wide = limits.max_image_2d + 1;
    let desc = ImageDesc {
        name: "ground",
        width: wide,
        height: 1,
        format: ImageFormat::R8,
        swizzle: Swizzle::Grey,
        levels: &[&vec![0; wide as usize]],
    };
    let error = error_of(gpu.image(&desc));
    assert!(error.contains(&format!("`ground` {wide}×1 r8")), "{error}");
    assert!(error.contains(&limits.max_image_2d.to_string()), "{error}");

    for (bytes, usage, word) in [
        (limits.max_storage_buffer_range + 1, BufferUse::Storage, "storage buffer"),
        (limits.max_texel_buffer_elements * 4 + 4, BufferUse::TexelUint, "texel buffer"),
        (0, BufferUse::Storage, "no bytes"),
    ] {
        let error = error_of(gpu.buffer("film", bytes, usage));
        assert!(error.contains("`film`") && error.contains(word), "{error}");
    }
    // Within the texel count, but not within the memory (where the limits leave room for that).
    if limits.max_texel_buffer_elements * 4 > limits.heap_bytes {
        let error = error_of(gpu.buffer("heap", limits.heap_bytes + 4, BufferUse::TexelUint));
        assert!(error.contains("`heap`") && error.contains("out of device memory"), "{error}");
    }
}

#[test]
fn wrong_texels_levels_and_sizes_are_refused() {
    let gpu = Checked::open();
    let texels = [0u8; 64];
    let desc = |width, height, levels| ImageDesc {
        name: "t",
        width,
        height,
        format: ImageFormat::Rgba8,
        swizzle: Swizzle::Rgba,
        levels,
    };
    for (width, height, levels, word) in [
        (0, 4, &[&texels[..]][..], "no texels"),
        (4, 4, &[&texels[..60]][..], "60 bytes"),
        (4, 4, &[&texels[..], &texels[..]][..], "level 1"),
        (4, 4, &[][..], "0 levels"),
        (1, 1, &[&texels[..4], &texels[..4]][..], "2 levels"),
    ] {
        let error = error_of(gpu.image(&desc(width, height, levels)));
        assert!(error.contains("`t`") && error.contains(word), "{error}");
    }
}

#[test]
fn pipelines_groups_and_runs_that_do_not_fit_are_refused() {
    let gpu = Checked::open();
    let pipeline = fill(&gpu, 1);
    let storage = gpu.buffer("storage", 256, BufferUse::Storage).unwrap();
    let texels = gpu.buffer("texels", 256, BufferUse::TexelUint).unwrap();
    for (resources, word) in [
        (&[][..], "missing"),
        (&[(0, Bound::Texels(&texels))][..], "texel buffer"),
        (&[(0, Bound::Buffer(&texels))][..], "`texels`"),
        (&[(0, Bound::Buffer(&storage)), (1, Bound::Buffer(&storage))][..], "no binding 1"),
        (&[(0, Bound::Buffer(&storage)), (0, Bound::Buffer(&storage))][..], "twice"),
    ] {
        let error = error_of(gpu.bind(&pipeline, resources));
        assert!(error.contains("`fill`") && error.contains(word), "{error}");
    }
    let group = gpu.bind(&pipeline, &[(0, Bound::Buffer(&storage))]).unwrap();
    let error = error_of(gpu.run(&pipeline, &group, &[0; 4], [1, 1, 1]));
    assert!(error.contains("8 bytes"), "{error}");
    let most = gpu.info().limits.max_workgroup_count[1];
    if let Some(many) = most.checked_add(1) {
        let error = error_of(gpu.run(&pipeline, &group, &[0; 8], [1, many, 1]));
        assert!(error.contains("workgroups"), "{error}");
    }
    let desc = PipelineDesc {
        name: "odd",
        spirv: FILL,
        bindings: &[one(0, BindingKind::StorageBuffer)],
        push_constant_bytes: gpu.info().limits.max_push_constants + 4,
        constants: &[],
    };
    assert!(error_of(gpu.pipeline(&desc)).contains("push constants"));
    assert!(
        error_of(gpu.pipeline(&PipelineDesc { push_constant_bytes: 8, spirv: &[1, 2], ..desc }))
            .contains("SPIR-V")
    );
    let many = [BindingDesc { binding: 0, kind: BindingKind::SampledImage, count: u32::MAX }];
    let error = error_of(gpu.pipeline(&PipelineDesc { push_constant_bytes: 8, bindings: &many, ..desc }));
    assert!(error.contains("sampled textures"), "{error}");
}

#[test]
fn a_resource_of_another_open_device_is_refused() {
    let (gpu, other) = (Checked::open(), Checked::open());
    let foreign = other.buffer("foreign", 256, BufferUse::Storage).unwrap();
    let pipeline = fill(&gpu, 1);
    assert!(error_of(gpu.bind(&pipeline, &[(0, Bound::Buffer(&foreign))])).contains("another open device"));
    assert!(error_of(gpu.clear_buffer(&foreign)).contains("another open device"));
}

#[test]
fn a_planted_mistake_reaches_the_messages() {
    let select = DeviceSelect::parse(&std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into())).unwrap();
    let gpu = Gpu::open_with(&select, OpenOptions { validation: true }).unwrap();
    // The shader has eight bytes of push constants, and the description denies it.
    let planted = gpu.pipeline(&PipelineDesc {
        name: "planted",
        spirv: FILL,
        bindings: &[one(0, BindingKind::StorageBuffer)],
        push_constant_bytes: 0,
        constants: &[],
    });
    drop(planted);
    let messages = gpu.messages();
    if gpu.validation_active() {
        assert!(messages.iter().any(|m| m.contains("VUID-VkComputePipelineCreateInfo")), "{messages:#?}");
    } else {
        assert!(messages.is_empty());
        eprintln!("the validation layer is not installed: the planted mistake was not reported");
    }
}

#[test]
fn without_validation_nothing_of_it_is_loaded() {
    let select = DeviceSelect::parse(&std::env::var("MOIRE_DEVICE").unwrap_or("cpu".into())).unwrap();
    let gpu = Gpu::open_with(&select, OpenOptions { validation: false }).unwrap();
    assert!(!gpu.validation_active());
    assert!(gpu.messages().is_empty());
}
