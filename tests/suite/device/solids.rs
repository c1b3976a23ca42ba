//! Volumes and cubes of the device layer: every texel of every slice, face and level is at its
//! position, faces are selected by Vulkan's table, and a cube is filtered across its edges.

use moire::internal::gpu::{
    BindGroup, BindingKind, Bound, Buffer, BufferUse, Gpu, ImageDesc, ImageFormat, ImageShape, Pipeline,
    PipelineDesc, Swizzle,
};
use moire::internal::texture::sampler_spec::{Address, Filter, MipMode, SamplerSpec};

use super::{Checked, bytes_of, error_of, one, read_u32};
use crate::device_shaders::SOLIDS;
use crate::dimensions::direction;

struct Look {
    output: Buffer,
    pipeline: Pipeline,
    group: BindGroup,
}

impl Look {
    fn new(gpu: &Gpu, volume: &ImageDesc<'_>, cube: &ImageDesc<'_>, spec: &SamplerSpec) -> Look {
        let output = gpu.buffer("looked up", 48, BufferUse::Storage).unwrap();
        let sampler = gpu.sampler(spec).unwrap();
        let (volume, cube) = (gpu.image(volume).unwrap(), gpu.image(cube).unwrap());
        let bindings = [
            one(0, BindingKind::StorageBuffer),
            one(1, BindingKind::SampledImage),
            one(2, BindingKind::SampledImage),
        ];
        let desc = PipelineDesc {
            name: "solids",
            spirv: SOLIDS,
            bindings: &bindings,
            push_constant_bytes: 16,
            constants: &[],
        };
        let pipeline = gpu.pipeline(&desc).unwrap();
        let bound = [
            (0, Bound::Buffer(&output)),
            (1, Bound::Images(&[(&volume, &sampler)])),
            (2, Bound::Images(&[(&cube, &sampler)])),
        ];
        let group = gpu.bind(&pipeline, &bound).unwrap();
        Look { output, pipeline, group }
    }

    /// Red of the volume and of the cube, and the volume's size with the cube's levels.
    fn at(&self, gpu: &Gpu, place: [f32; 3], level: f32) -> (f32, f32, [f32; 4]) {
        let push = bytes_of(&[place[0], place[1], place[2], level].map(f32::to_bits));
        gpu.run(&self.pipeline, &self.group, &push, [1, 1, 1]).unwrap();
        let values: Vec<f32> = read_u32(gpu, &self.output).into_iter().map(f32::from_bits).collect();
        (values[0], values[4], values[8..].try_into().unwrap())
    }
}

/// Counts up from `first`.
fn count(first: u32, texels: u32) -> Vec<u8> {
    (first..first + texels).flat_map(|n| (n as f32).to_ne_bytes()).collect()
}

fn desc<'a>(shape: ImageShape, size: [u32; 3], levels: &'a [&'a [u8]]) -> ImageDesc<'a> {
    ImageDesc {
        name: "solid",
        shape,
        width: size[0],
        height: size[1],
        depth: size[2],
        format: ImageFormat::R32f,
        swizzle: Swizzle::Grey,
        levels,
    }
}

fn nearest() -> SamplerSpec {
    SamplerSpec { mag: Filter::Nearest, min: Filter::Nearest, mip: MipMode::Nearest, ..Default::default() }
}

#[test]
fn every_texel_of_volume_and_cube_arrives_at_its_place() {
    let gpu = Checked::open();
    let volume = [count(0, 5 * 3 * 4), count(100, 2 * 2), count(200, 1)];
    let volume = [&volume[0][..], &volume[1], &volume[2]];
    let cube = [count(0, 6 * 16), count(100, 6 * 4), count(200, 6)];
    let cube = [&cube[0][..], &cube[1], &cube[2]];
    let look = Look::new(
        &gpu,
        &desc(ImageShape::Volume, [5, 3, 4], &volume),
        &desc(ImageShape::Cube, [4, 4, 6], &cube),
        &nearest(),
    );
    for (level, [w, h, d], first) in [(0, [5, 3, 4], 0), (1, [2, 1, 2], 100), (2, [1, 1, 1], 200)] {
        for n in 0..w * h * d {
            let at = [n % w, n / w % h, n / w / h];
            let place = [0, 1, 2].map(|a| (at[a] as f32 + 0.5) / [w, h, d][a] as f32);
            let (found, _, facts) = look.at(&gpu, place, level as f32);
            assert_eq!((found, facts), ((first + n) as f32, [5.0, 3.0, 4.0, 3.0]), "level {level}, {at:?}");
        }
    }
    for (level, side, first) in [(0, 4, 0), (1, 2, 100), (2, 1, 200)] {
        for n in 0..6 * side * side {
            let (face, x, y) = (n / (side * side), n % side, n / side % side);
            let (_, found, _) = look.at(&gpu, direction(face, x, y, side), level as f32);
            assert_eq!(found, (first + n) as f32, "level {level}, face {face}, ({x}, {y})");
        }
    }
}

#[test]
fn cube_edges_are_filtered_across() {
    let gpu = Checked::open();
    let volume = count(0, 1);
    let faces = count(0, 6);
    let clamp = SamplerSpec { address: [Address::ClampToEdge; 2], ..Default::default() };
    let look = Look::new(
        &gpu,
        &desc(ImageShape::Volume, [1, 1, 1], &[&volume]),
        &desc(ImageShape::Cube, [1, 1, 6], &[&faces]),
        &clamp,
    );
    for (place, mean) in [([1.0, 0.0, 1.0], 2.0), ([-1.0, 1.0, 0.0], 1.5), ([0.0, -1.0, -1.0], 4.0)] {
        let (_, found, _) = look.at(&gpu, place, 0.0);
        // 8 bits of weight (sub-texel precision), between faces that differ by at most 5.
        assert!((found - mean).abs() <= 5.0 / 256.0, "{place:?}: {found}, not {mean}");
    }
}

#[test]
fn a_volume_larger_than_a_transfer_chunk_arrives_whole() {
    let gpu = Checked::open();
    let (w, h, d) = (128, 100, 350);
    let (texels, faces) = (count(0, w * h * d), count(0, 6));
    let look = Look::new(
        &gpu,
        &desc(ImageShape::Volume, [w, h, d], &[&texels]),
        &desc(ImageShape::Cube, [1, 1, 6], &[&faces]),
        &nearest(),
    );
    for n in [0, w * h * 173 + 5 * w + 77, w * h * 327 + 99 * w, w * h * d - 1] {
        let at = [n % w, n / w % h, n / w / h];
        let place = [0, 1, 2].map(|a| (at[a] as f32 + 0.5) / [w, h, d][a] as f32);
        assert_eq!(look.at(&gpu, place, 0.0).0, n as f32, "{at:?}");
    }
}

#[test]
fn solids_that_no_device_holds_are_refused() {
    let gpu = Checked::open();
    let limits = &gpu.info().limits;
    let texels = vec![0; 4 * 1000];
    let (deep, wide) = (limits.max_image_3d + 1, limits.max_image_cube + 1);
    for (shape, size, words) in [
        (ImageShape::Cube, [4, 5, 6], ["`solid` 4×5×6", "six square faces"]),
        (ImageShape::Cube, [4, 4, 5], ["`solid` 4×4×5", "six square faces"]),
        (ImageShape::Flat, [4, 4, 2], ["`solid` 4×4×2", "one slice"]),
        (ImageShape::Volume, [4, 4, 0], ["`solid` 4×4×0", "no texels"]),
        (ImageShape::Volume, [1, 1, deep], ["too large", &limits.max_image_3d.to_string()]),
        (ImageShape::Cube, [wide, wide, 6], ["too large", &limits.max_image_cube.to_string()]),
        (ImageShape::Volume, [4, 4, 4], ["4000 bytes", "4×4×4 take 256"]),
    ] {
        let error = error_of(gpu.image(&desc(shape, size, &[&texels])));
        assert!(words.iter().all(|word| error.contains(word)), "{words:?}: {error}");
    }
}
