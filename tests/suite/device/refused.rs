//! Errors that the device layer returns before Vulkan is called: sizes over the limits, texels of
//! the wrong size, mismatched pipelines and dispatches, resources of another device. Each error
//! names the object.

use moire::internal::gpu::{
    BindingDesc, BindingKind, Bound, BufferUse, ImageDesc, ImageFormat, ImageShape, PipelineDesc, Swizzle,
};

use super::{Checked, error_of, fill, one};
use crate::device_shaders::FILL;

#[test]
fn sizes_over_the_limits_are_refused_by_name_and_limit() {
    let gpu = Checked::open();
    let limits = gpu.info().limits.clone();
    let wide = limits.max_image_2d + 1;
    let desc = ImageDesc {
        name: "ground",
        shape: ImageShape::Flat,
        depth: 1,
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
        shape: ImageShape::Flat,
        depth: 1,
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
        (&[(0, Bound::Texels(std::slice::from_ref(&texels)))][..], "texel buffer"),
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
    assert!(error_of(gpu.write_buffer(&foreign, 0, &[1])).contains("another open device"));
}
