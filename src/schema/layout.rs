//! `repr(C)` mirrors of `glsl/shared/layout.glsl`, field by field, in the same order. Every member
//! is a four-vector of f32 or u32, so std430 and Rust agree; the sizes are asserted here and a test
//! compares them with the shader's. What each member holds is said there.

mod record;

use bytemuck::{Pod, Zeroable};

use record::Member;
pub use record::{Record, bytes_of};

/// In place of an index: the material has no texture.
pub const NO_TEXTURE: u32 = u32::MAX;
/// In place of an index: no shape is hit, or none is left out.
pub const NO_SHAPE: u32 = u32::MAX;
/// In place of an index: there is no environment.
pub const NO_MATERIAL: u32 = u32::MAX;

/// Declares a mirror. Its members lie one behind the other.
macro_rules! mirror {
    ($name:ident, { $($(#[$meta:meta])* $field:ident: $type:ty,)+ }) => {
        #[doc = concat!("Mirror of `struct ", stringify!($name), "` in `layout.glsl`.")]
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $name { $($(#[$meta])* pub $field: $type,)+ }
        impl Record for $name {
            const REALS: u32 = 0 $(+ <$type as Member>::REALS)+;
            const OTHERS: u32 = 0 $(+ 1 - <$type as Member>::REALS)+;

            fn write(&self, double: bool, bytes: &mut Vec<u8>) {
                $(self.$field.write(double, bytes);)+
            }

            fn quantize_f32(&self) -> Self {
                $name { $($field: self.$field.quantize_f32(),)+ }
            }
        }
    };
}

mirror!(Header, {
    forward: [f64; 4],
    step_x: [f64; 4],
    step_y: [f64; 4],
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
    view: [f64; 4],
    up: [f64; 4],
    eye_motion: [f64; 4],
    view_motion: [f64; 4],
    /// Kind, radius (f32 bits), width (f32 bits), first step from the middle where the filter is negative.
    pixel_filter: [u32; 4],
});

mirror!(Plane, {
    normal: [f64; 4],
    axis_u: [f64; 4],
    axis_v: [f64; 4],
    /// Material, map, and of bounded planes the half extent: f32 bits and 1, or the bits of an f64, whose high
    /// half is greater.
    link: [u32; 4],
});

impl Plane {
    /// How many tangents a bounded plane reaches.
    pub fn half_extent(&self) -> Option<f64> {
        match self.link[2..] {
            [_, 0] => None,
            [bits, 1] => Some(f32::from_bits(bits).into()),
            [low, high] => Some(f64::from_bits(u64::from(high) << 32 | u64::from(low))),
            _ => None,
        }
    }

    /// The last two numbers of `link`.
    pub fn extent_words(half_extent: Option<f64>, double: bool) -> [u32; 2] {
        match half_extent {
            None => [0, 0],
            Some(extent) if double => {
                let bits = extent.to_bits();
                [bits as u32, (bits >> 32) as u32]
            }
            Some(extent) => [(extent as f32).to_bits(), 1],
        }
    }
}

mirror!(Sphere, {
    ball: [f64; 4],
    /// Material, map.
    link: [u32; 4],
});

mirror!(Triangle, {
    a: [f64; 4],
    b: [f64; 4],
    c: [f64; 4],
    v: [f64; 4],
    normal: [f64; 4],
    normal_a: [f64; 4],
    normal_b: [f64; 4],
    normal_c: [f64; 4],
    /// Material, map.
    link: [u32; 4],
});

mirror!(Light, {
    place: [f64; 4],
    power: [f32; 4],
    /// Kind.
    link: [u32; 4],
    edge_u: [f64; 4],
    edge_v: [f64; 4],
});

mirror!(Material, {
    color: [f32; 4],
    /// Model, texture or `NO_TEXTURE`, sampler, image slot.
    link: [u32; 4],
    /// Of the bump map: texture or `NO_TEXTURE`, sampler, image slot, kind.
    detail: [u32; 4],
    specular: [f32; 4],
});

mirror!(UvProjection, {
    x: [f64; 4],
    y: [f64; 4],
    z: [f64; 4],
    matrix: [f64; 4],
    offset: [f64; 4],
    /// Kind, entity.
    link: [u32; 4],
});

mirror!(Texture, {
    /// First word of level 0 in the texel buffer, width, height, format.
    place: [u32; 4],
    /// Colour space, levels, depth, kind.
    link: [u32; 4],
});

mirror!(Sampler, {
    border: [f32; 4],
    /// Address u, address v, magnification filter, texel centre.
    modes: [u32; 4],
    /// Method, minification filter, mip mode, maximum anisotropy.
    link: [u32; 4],
    /// Address w, 1 where rows go on over the poles, B and C of the cubic filter (f32 bits).
    more: [u32; 4],
});

mirror!(Procedural, {
    background: [f32; 4],
    figure: [f32; 4],
    /// Width, aspect, offset, jitter.
    shape: [f64; 4],
    /// Lacunarity, gain, 1 / sum of the gains, distortion.
    octaves: [f32; 4],
    /// Kind, seed, number of octaves, dimensions.
    link: [u32; 4],
});

mirror!(Motion, {
    shift: [f64; 4],
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

/// Mirror of the push constants of `tile_culling_main.glsl`: cells `first` .. `end`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Part {
    pub first: u32,
    pub end: u32,
}
const _: () = assert!(size_of::<Part>() == 8);

/// In a job's part: without a footprint.
pub const JOB_BARE: u32 = 2;
/// In a job's part: its sums go to its own place in the list, not to the pixel's half.
pub const JOB_APART: u32 = 4;
/// Above it in a job's part: the stream of samples, each as good as another seed.
pub const JOB_STREAM_SHIFT: u32 = 8;

/// Mirror of the jobs of `slice.glsl`: samples `first` .. `first + count` of a pixel's half.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Job {
    /// Column in the low half, row in the high one; rows count from the band's first.
    pub place: u32,
    /// The half (0 or 1), `JOB_BARE`, `JOB_APART`, and the stream of samples.
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

    /// The `part` of a half of the film: its samples are the stream of the same number.
    pub fn part_of(half: u32) -> u32 {
        half | half << JOB_STREAM_SHIFT
    }

    /// The stream of samples.
    pub fn stream(&self) -> u32 {
        self.part >> JOB_STREAM_SHIFT
    }

    /// Column and row.
    pub fn column_and_row(&self) -> [u32; 2] {
        [self.place & 0xFFFF, self.place >> 16]
    }
}

/// Mirror of the push constants of `mip_chain.glsl`: one level from the one above.
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

/// Words of a cell of the survey (`tile_culling_main.glsl`): number of triangles, calmness, up to `MAX_LISTED` triangles.
pub const CELL_WORDS: u32 = 64;
pub const MAX_LISTED: u32 = 62;
/// In place of where a cell begins: all triangles are tested.
pub const NO_LIST: u32 = u32::MAX;
/// Calmness of a cell.
pub const CELL_EMPTY: u32 = 0;
pub const CELL_UNIFORM: u32 = 1;
pub const CELL_BUSY: u32 = 2;

/// Pixels along the side of the square tiles in which work is handed out.
pub const TILE: u32 = 64;
