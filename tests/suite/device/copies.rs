//! Copies on the device and several dispatches in one submission.

use moire::internal::gpu::{Bound, BufferUse, ImageDesc, ImageFormat, ImageShape, Swizzle};
use moire::internal::texture::sampler_spec::{Filter, MipMode, SamplerSpec};

use super::images::{Look, floats};
use super::{Checked, bytes_of, error_of, fill, read_u32};

#[test]
fn each_dispatch_of_a_submission_sees_what_came_before() {
    let gpu = Checked::open();
    let count = 10_000;
    let start = vec![0; count as usize * 4];
    let buffer = gpu.upload_buffer("values", BufferUse::Storage, &start).unwrap();
    let pipeline = fill(&gpu, 3);
    let group = gpu.bind(&pipeline, &[(0, Bound::Buffer(&buffer))]).unwrap();
    let pushes: Vec<Vec<u8>> = (0..20).map(|base| bytes_of(&[base, count])).collect();
    let dispatches: Vec<(&[u8], [u32; 3])> =
        pushes.iter().map(|push| (&push[..], [count.div_ceil(64), 1, 1])).collect();
    let time = gpu.run_all(&pipeline, &group, &dispatches).unwrap();
    assert!(time.device_seconds > 0.0 && time.device_seconds < time.wall_seconds + 1e-3, "{time:?}");
    let expected: Vec<u32> = (0..count).map(|i| (0..20).map(|base| 3 * base + i).sum()).collect();
    assert_eq!(read_u32(&gpu, &buffer), expected);
    let error = error_of(gpu.run_all(&pipeline, &group, &[dispatches[0], (&[0; 4], [1, 1, 1])]));
    assert!(error.contains("push constants"), "{error}");
}

#[test]
fn parts_of_buffers_are_copied() {
    let gpu = Checked::open();
    let from = gpu.upload_buffer("from", BufferUse::Storage, &[1, 2, 3, 4, 5, 6, 7, 8]).unwrap();
    let to = gpu.upload_buffer("to", BufferUse::TexelUint, &[9; 12]).unwrap();
    gpu.copy_buffer(&from, 4, &to, 8, 4).unwrap();
    let mut back = [0; 12];
    gpu.read_buffer(&to, 0, &mut back).unwrap();
    assert_eq!(back, [9, 9, 9, 9, 9, 9, 9, 9, 5, 6, 7, 8]);
    for (start, at, bytes, word) in [(5, 0, 4, "`from`"), (0, 9, 4, "`to`"), (0, 0, 0, "no bytes")] {
        let error = error_of(gpu.copy_buffer(&from, start, &to, at, bytes));
        assert!(error.contains(word), "{error}");
    }
    assert!(error_of(gpu.copy_buffer(&from, 0, &from, 4, 4)).contains("onto itself"));
    let other = Checked::open();
    assert!(error_of(other.copy_buffer(&from, 0, &to, 0, 4)).contains("another open device"));
}

#[test]
fn levels_of_an_image_come_from_a_buffer() {
    let gpu = Checked::open();
    let values: Vec<f32> = (0..16).map(|i| i as f32).collect();
    let buffer = gpu.upload_buffer("levels", BufferUse::Storage, &floats(&values)).unwrap();
    let desc = ImageDesc {
        name: "ramp",
        shape: ImageShape::Flat,
        depth: 1,
        width: 4,
        height: 2,
        format: ImageFormat::R32f,
        swizzle: Swizzle::Grey,
        levels: &[],
    };
    // Level 0 from value 2 on, level 1 from 12, level 2 from 15.
    let image = gpu.image_from(&desc, &buffer, &[8, 48, 60]).unwrap();
    let spec = SamplerSpec {
        mag: Filter::Nearest,
        min: Filter::Nearest,
        mip: MipMode::Nearest,
        ..Default::default()
    };
    let look = Look::of(&gpu, &image, &image, &spec);
    for (uv, level, value) in
        [([0.125, 0.25], 0, 2.0), ([0.875, 0.75], 0, 9.0), ([0.75, 0.5], 1, 13.0), ([0.5, 0.5], 2, 15.0)]
    {
        let [sampled, fetched, _] = look.at(&gpu, uv, level as f32, level);
        assert_eq!((sampled[0], fetched[0]), (value, value), "{uv:?} at level {level}");
    }
    let refused = |starts: &[u64]| error_of(gpu.image_from(&desc, &buffer, starts));
    assert!(refused(&[36]).contains("`levels`"), "beyond the end");
    assert!(refused(&[2]).contains("inside a texel"), "not at a whole texel");
    assert!(refused(&[]).contains("0 levels") && refused(&[0; 4]).contains("4 levels"));
}
