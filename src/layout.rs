//! `repr(C)` mirrors of `glsl/shared/layout.glsl`, field by field, in the same order. Every member
//! is a four-vector of f32 or u32, so std430 and Rust agree; the sizes are asserted here and a test
//! compares them with the shader's. What each member holds is said there.

use bytemuck::{Pod, Zeroable};

/// In place of an index: the material has no texture.
pub const NO_TEXTURE: u32 = u32::MAX;
/// In place of an index: no shape is hit, or none is left out.
pub const NO_SHAPE: u32 = u32::MAX;
/// In place of an index: there is no environment.
pub const NO_MATERIAL: u32 = u32::MAX;

/// Declares a mirror and asserts its size in units of 16 bytes.
macro_rules! mirror {
    ($name:ident, $units:literal, { $($(#[$meta:meta])* $field:ident: $type:ty,)+ }) => {
        #[doc = concat!("Mirror of `struct ", stringify!($name), "` in `layout.glsl`.")]
        #[repr(C)]
        #[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
        pub struct $name { $($(#[$meta])* pub $field: $type,)+ }
        const _: () = assert!(size_of::<$name>() == $units * 16);
        impl $name {
            /// Size in the units in which the shader counts.
            pub const UNITS: u32 = $units;
        }
    };
}

mirror!(Header, 16, {
    forward: [f32; 4],
    step_x: [f32; 4],
    step_y: [f32; 4],
    background: [f32; 4],
    /// Width, height, crop x, crop y.
    image: [u32; 4],
    /// Film width, film height, projection, max depth.
    size: [u32; 4],
    /// Pattern, strata a side, samples, seed.
    sampling: [u32; 4],
    /// 1 when all pixels share their displacements; lights.
    /// Footprint, the environment's map.
    key: [u32; 4],
    /// Planes, spheres, triangles, the environment's material or `NO_MATERIAL`.
    counts: [u32; 4],
    /// One bit for each choice that samples make; motions; 1 when the camera moves; pixels along
    /// a side of the survey's cells, 0 without one.
    chances: [u32; 4],
    lens: [f32; 4],
    view: [f32; 4],
    up: [f32; 4],
    eye_motion: [f32; 4],
    view_motion: [f32; 4],
    /// Kind, radius (f32 bits), width (f32 bits), first step from the middle where the filter is negative.
    pixel_filter: [u32; 4],
});

mirror!(Plane, 4, {
    normal: [f32; 4],
    axis_u: [f32; 4],
    axis_v: [f32; 4],
    /// Material, map, half extent (f32 bits), 1 when bounded.
    link: [u32; 4],
});

mirror!(Sphere, 2, {
    ball: [f32; 4],
    /// Material, map.
    link: [u32; 4],
});

mirror!(Triangle, 9, {
    a: [f32; 4],
    b: [f32; 4],
    c: [f32; 4],
    v: [f32; 4],
    normal: [f32; 4],
    normal_a: [f32; 4],
    normal_b: [f32; 4],
    normal_c: [f32; 4],
    /// Material, map.
    link: [u32; 4],
});

mirror!(Light, 5, {
    place: [f32; 4],
    power: [f32; 4],
    /// Kind.
    link: [u32; 4],
    edge_u: [f32; 4],
    edge_v: [f32; 4],
});

mirror!(Material, 4, {
    color: [f32; 4],
    /// Model, texture or `NO_TEXTURE`, sampler, image slot.
    link: [u32; 4],
    /// Of the relief: texture or `NO_TEXTURE`, sampler, image slot, kind.
    detail: [u32; 4],
    specular: [f32; 4],
});

mirror!(Map, 6, {
    x: [f32; 4],
    y: [f32; 4],
    z: [f32; 4],
    matrix: [f32; 4],
    offset: [f32; 4],
    /// Kind, entity.
    link: [u32; 4],
});

mirror!(Texture, 2, {
    /// First word of level 0 in the texel buffer, width, height, format.
    place: [u32; 4],
    /// Colour space, levels, depth, kind.
    link: [u32; 4],
});

mirror!(Sampler, 4, {
    border: [f32; 4],
    /// Address u, address v, magnification filter, texel centre.
    modes: [u32; 4],
    /// Method, minification filter, mip mode, maximum anisotropy.
    link: [u32; 4],
    /// Address w, 1 where rows go on over the poles, B and C of the cubic filter (f32 bits).
    more: [u32; 4],
});

mirror!(Procedural, 5, {
    background: [f32; 4],
    figure: [f32; 4],
    /// Width, aspect, offset, jitter.
    shape: [f32; 4],
    /// Lacunarity, gain, 1 / sum of the gains, distortion.
    octaves: [f32; 4],
    /// Kind, seed, number of octaves, dimensions.
    link: [u32; 4],
});

mirror!(Motion, 1, {
    shift: [f32; 4],
});

/// Mirror of the push constants of `slice.glsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Slice {
    pub tiles_x: u32,
    pub tiles: u32,
    pub tile_stride: u32,
    pub first_tile: u32,
    pub band_y: u32,
    pub band_height: u32,
    pub first_sample: u32,
    pub sample_count: u32,
    /// Tiles of the film, or a list of jobs: `tiles` is their number then.
    pub schedule: u32,
}
const _: () = assert!(size_of::<Slice>() == 36);

/// Mirror of the push constants of `survey_main.glsl`: cells `first` .. `end`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Part {
    pub first: u32,
    pub end: u32,
}
const _: () = assert!(size_of::<Part>() == 8);

/// In a job's part: without a footprint.
pub const JOB_BARE: u32 = 2;

/// Mirror of the jobs of `slice.glsl`: samples `first` .. `first + count` of a pixel's half.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Job {
    /// Column in the low half, row in the high one; rows count from the band's first.
    pub place: u32,
    /// 0 or 1, and `JOB_BARE`.
    pub part: u32,
    pub first: u32,
    pub count: u32,
}
const _: () = assert!(size_of::<Job>() == 16);

impl Job {
    /// The `place` of a film's pixel by its index.
    pub fn place_of(index: u32, width: u32) -> u32 {
        (index / width) << 16 | (index % width)
    }

    /// Column and row.
    pub fn column_and_row(&self) -> [u32; 2] {
        [self.place & 0xFFFF, self.place >> 16]
    }
}

/// Mirror of the push constants of `pyramid.glsl`: one level from the one above.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Halving {
    /// 1: the level above is level 0, words of codes; 0: numbers.
    pub from_codes: u32,
    /// First word or number of the level above.
    pub above: u32,
    /// Where the new level begins as words, and as numbers.
    pub word: u32,
    pub number: u32,
    /// Of the new level.
    pub texels: u32,
    pub columns_log2: u32,
    pub rows_log2: u32,
    /// One bit an axis: the length above is twice as long.
    pub halved: u32,
}
const _: () = assert!(size_of::<Halving>() == 32);

/// The part of the scene buffer that is also bound as uniforms: `maxUniformBufferRange` is at least
/// this on every device.
pub const HEAD_BYTES: usize = 16 << 10;

/// Samples that are summed in f32 before the sum goes to the film, at most. More samples arrive in chunks
/// and are added with compensation (Kahan 1965).
pub const CHUNK: u32 = 256;

/// Cells of the table by which samples are placed about a pixel.
pub const PIXEL_FILTER_CELLS: u32 = 512;

/// Words of a cell of the survey (`survey_main.glsl`): number of triangles, calmness, up to `MOST_LISTED` triangles.
pub const CELL_WORDS: u32 = 64;
pub const MOST_LISTED: u32 = 62;
/// In place of where a cell begins: all triangles are tested.
pub const NO_LIST: u32 = u32::MAX;
/// Calmness of a cell.
pub const CELL_EMPTY: u32 = 0;
pub const CELL_CALM: u32 = 1;
pub const CELL_BUSY: u32 = 2;

/// Pixels along the side of the square tiles in which work is handed out.
pub const TILE: u32 = 64;
