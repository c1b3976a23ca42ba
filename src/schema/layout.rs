//! `repr(C)` mirrors of `glsl/shared/layout.glsl`, field by field, in the same order. Every member
//! is a four-vector of f32 or u32, so std430 and Rust agree; the sizes are asserted here and a test
//! compares them with the shader's. What each member holds is said there.

mod record;

pub use super::blocks::{CellRange, Halving, Job, Slice};
pub use super::constants::*;
use record::Member;
pub use record::{Record, bytes_of};

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

/// Bytes at the front of the scene buffer that are also bound as uniforms.
pub const HEAD_BYTES: usize = HEAD_UNITS as usize * 16;

/// Samples that are summed in f32 before the sum goes to the film, at most. More samples arrive in chunks
/// and are added with compensation (Kahan 1965).
pub const CHUNK: u32 = 256;
