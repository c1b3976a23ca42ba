//! The lookups of a verification, equal in every run: random texels, random coordinates, and
//! coordinates where addressing and filtering are error-prone (texel edges and centres, integers
//! and their neighbours, both sides of 0, far from the texture); ramps between two texels.

use glam::{DVec2, DVec3};

use crate::core::error::Result;
use crate::core::named::named_enum;
use crate::lab::probe::LookupQuery;
use crate::oracle::mapping::Coordinate;
use crate::pack::{self, PackedScene};
use crate::scene::model::{
    Algorithm, Background, Camera, Footprint, Material, Model, Pattern, PixelFilter, Precision, Projection,
    Sampling, Scene, Shapes,
};
use crate::texture::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use crate::texture::sampler_spec::SamplerSpec;

/// Xorshift (Marsaglia 2003), independent of the renderer's own hash, which is under test.
pub struct Rng(u64);

impl Rng {
    pub fn new(seed: u64) -> Rng {
        Rng(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Returns a number in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Returns random texels of a 2D texture; floats are in [-2, 6].
pub fn texture(
    width: u32,
    height: u32,
    format: TexelFormat,
    color_space: ColorSpace,
    seed: u64,
) -> TextureData {
    noise(Dimension::Two, [width, height, 1], format, color_space, seed)
}

/// Returns random texels; a cube's third size is 6.
pub fn noise(
    dimension: Dimension,
    size: [u32; 3],
    format: TexelFormat,
    color_space: ColorSpace,
    seed: u64,
) -> TextureData {
    let mut rng = Rng::new(seed);
    let [width, height, depth] = size;
    let count = size.iter().product::<u32>() as usize * format.channels();
    let texels = match format.component() {
        Component::Unorm8 => (0..count).map(|_| (rng.bits() >> 40) as u8).collect(),
        Component::Unorm16 => (0..count).flat_map(|_| ((rng.bits() >> 40) as u16).to_ne_bytes()).collect(),
        Component::Float32 => {
            (0..count).flat_map(|_| (rng.between(-2.0, 6.0) as f32).to_ne_bytes()).collect()
        }
    };
    let name = format!("{format} {color_space} {width}x{height}");
    let name = if depth == 1 { name } else { format!("{name}x{depth}") };
    TextureData {
        name,
        dimension,
        width,
        height,
        depth,
        format,
        color_space,
        file_channels: format.channels(),
        texels,
        stored_levels: Vec::new(),
    }
}

named_enum! {
    /// The axis along which a ramp runs.
    pub enum Axis {
        U = "u",
        V = "v",
    }
}

/// Returns 2 × 2 texels: 0 in every channel on the left, 1 on the right; or, along v, above and
/// below.
pub fn ramp_texture(axis: Axis, format: TexelFormat, color_space: ColorSpace) -> TextureData {
    let component = format.component();
    let texel = |value: [u8; 4]| value[..component.bytes()].repeat(format.channels());
    let [zero, one] = [texel([0; 4]), texel(component.one())];
    let texels = match axis {
        Axis::U => [&zero, &one, &zero, &one].map(Vec::as_slice).concat(),
        Axis::V => [&zero, &zero, &one, &one].map(Vec::as_slice).concat(),
    };
    let name = format!("ramp {format} {color_space}");
    TextureData { name, texels, ..texture(2, 2, format, color_space, 0) }
}

/// Returns coordinates from the centre of the first texel of `ramp_texture` to that of the next
/// one: weights k / `steps`, exact in f32 up to 2²² steps. On the other coordinate both rows have
/// equal weight.
pub fn ramp(axis: Axis, steps: u32) -> impl Iterator<Item = [f32; 2]> {
    (0..=steps).map(move |k| {
        let along = (0.25 + 0.5 * f64::from(k) / f64::from(steps)) as f32;
        match axis {
            Axis::U => [along, 0.5],
            Axis::V => [0.5, along],
        }
    })
}

/// Returns a scene without shapes whose materials are these (texture, sampler) pairs.
pub fn pairs(
    textures: Vec<TextureData>,
    samplers: &[SamplerSpec],
    list: &[(usize, usize)],
) -> Result<PackedScene> {
    pairs_over(Footprint::None, textures, samplers, list)
}

/// Returns such a scene with lookups over footprints.
pub fn pairs_over(
    footprint: Footprint,
    textures: Vec<TextureData>,
    samplers: &[SamplerSpec],
    list: &[(usize, usize)],
) -> Result<PackedScene> {
    let material = |&(texture, sampler): &(usize, usize)| Material {
        name: "pair".into(),
        model: Model::PLAIN,
        texture: Some(texture),
        sampler,
        ..Default::default()
    };
    let scene = Scene {
        path: "pairs.toml".into(),
        camera: Camera {
            eye: DVec3::ZERO,
            look_at: DVec3::NEG_Z,
            up: DVec3::Y,
            projection: Projection::VerticalFov(90.0),
            lens: None,
            shutter: [0.0, 1.0],
            motion: [DVec3::ZERO; 2],
        },
        width: 1,
        height: 1,
        pixel_filter: PixelFilter::default(),
        sampling: Sampling {
            algorithm: Algorithm::Samples,
            pattern: Pattern::Center,
            spp: 1,
            shared: false,
            seed: 1,
            max_depth: 0,
            footprint,
            precision: Precision::Single,
            quantity: Default::default(),
        },
        background: Background::default(),
        textures: Vec::new(),
        samplers: samplers.to_vec(),
        materials: list.iter().map(material).collect(),
        shapes: Shapes::default(),
        settings: Vec::new(),
        dropped_triangles: 0,
        sources: Vec::new(),
        notes: Vec::new(),
        first_dropped: String::new(),
        lights: Vec::new(),
    };
    pack::pack(&scene, textures, None)
}

/// Returns the lookup of a pair's material at (u, v).
pub fn query(scene: &PackedScene, pair: usize, uv: [f32; 2]) -> LookupQuery {
    let material = &scene.records.materials[pair];
    let (texture, sampler, slot) = (material.texture_index, material.sampler_index, material.image_slot);
    LookupQuery { texture, sampler, slot, uv: [uv[0], uv[1], 0.0, 0.0], ..Default::default() }
}

/// Returns coordinate and footprint of a lookup.
pub fn place_of(query: &LookupQuery) -> Coordinate {
    let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
    Coordinate { at: vector(query.uv), change: [vector(query.dx), vector(query.dy)] }
}

pub fn uv_of(query: &LookupQuery) -> DVec2 {
    DVec2::new(f64::from(query.uv[0]), f64::from(query.uv[1]))
}

/// Returns coordinates along one axis: texel edges and centres in and around the texture, integers
/// and their neighbours, numbers close to 0 on both sides.
pub fn edge_coordinates(size: u32) -> Vec<f32> {
    let mut all = vec![1e-9, -1e-9, 1e-20, -1e-20, 0.0, -0.0, 0.25, 0.5, 0.75];
    for whole in [-3.0f32, -2.0, -1.0, 1.0, 2.0, 3.0] {
        all.extend([whole, whole.next_down(), whole.next_up()]);
    }
    let w = f64::from(size);
    let step = (size / 4).max(1);
    for k in (-i64::from(size)..=2 * i64::from(size)).step_by(step as usize) {
        all.extend([(k as f64 / w) as f32, ((k as f64 + 0.5) / w) as f32]);
    }
    all
}

/// Distant coordinates whose whole periods can be subtracted exactly: up to the last f32 with a
/// fraction (2²³) and, with odd integers, which mirroring distinguishes from even ones, to the last
/// odd f32 integer (2²⁴).
pub const FAR_COORDINATES: [f32; 12] = [
    1000.25,
    -1000.75,
    65_536.5,
    -65_535.375,
    1_048_576.5,
    -1_048_575.75,
    4_194_304.5,
    -4_194_304.5,
    8_388_607.0,
    -8_388_609.0,
    16_777_215.0,
    -16_777_215.0,
];

/// Returns random pairs of coordinates, half of them in [-3, 4] and half in and just around the
/// texture, where clamped modes read more than their edge; and pairs of error-prone ones.
pub fn coordinates(rng: &mut Rng, size: [u32; 2], random: usize, far: bool) -> Vec<[f32; 2]> {
    let ends = |i: usize| if i.is_multiple_of(2) { (-3.0, 4.0) } else { (-0.25, 1.25) };
    let mut all: Vec<[f32; 2]> =
        (0..random).map(ends).map(|(low, high)| [0; 2].map(|_| rng.between(low, high) as f32)).collect();
    let [mut us, mut vs] = size.map(edge_coordinates);
    if far {
        us.extend(FAR_COORDINATES);
        vs.extend(FAR_COORDINATES);
    }
    let any = |rng: &mut Rng, list: &[f32]| list[rng.bits() as usize % list.len()];
    for &u in &us {
        all.push([u, any(rng, &vs)]);
    }
    for &v in &vs {
        all.push([any(rng, &us), v]);
    }
    all
}
