//! What is looked up, the same in every run: random texels, random coordinates, and coordinates where
//! addressing and filtering can fail (texel edges and centres, whole numbers and their neighbours, both
//! sides of 0, far away); ramps between two texels.

use glam::{DVec2, DVec3};

use crate::core::error::Result;
use crate::core::named::named_enum;
use crate::lab::probe::LookUp;
use crate::oracle::mapping::Coordinate;
use crate::pack::{self, PackedScene};
use crate::scene::model::{
    Algorithm, Background, Camera, Footprint, Material, Model, Pattern, PixelFilter, Precision, Projection,
    Sampling, Scene,
};
use crate::texture::data::{ColorSpace, Component, Dimension, TexelFormat, TextureData};
use crate::texture::sampler_spec::SamplerSpec;

/// Xorshift (Marsaglia 2003); apart from the renderer's own hash, so as not to lean on what it tests.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Dice {
        Dice(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    pub fn bits(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Random texels of two dimensions; floats in [-2, 6].
pub fn texture(
    width: u32,
    height: u32,
    format: TexelFormat,
    color_space: ColorSpace,
    seed: u64,
) -> TextureData {
    noise(Dimension::Two, [width, height, 1], format, color_space, seed)
}

/// Random texels; a cube's third number is 6.
pub fn noise(
    dimension: Dimension,
    size: [u32; 3],
    format: TexelFormat,
    color_space: ColorSpace,
    seed: u64,
) -> TextureData {
    let mut dice = Dice::new(seed);
    let [width, height, depth] = size;
    let count = size.iter().product::<u32>() as usize * format.channels();
    let texels = match format.component() {
        Component::Unorm8 => (0..count).map(|_| (dice.bits() >> 40) as u8).collect(),
        Component::Unorm16 => (0..count).flat_map(|_| ((dice.bits() >> 40) as u16).to_ne_bytes()).collect(),
        Component::Float32 => {
            (0..count).flat_map(|_| (dice.between(-2.0, 6.0) as f32).to_ne_bytes()).collect()
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
    }
}

named_enum! {
    /// Along which a ramp runs.
    pub enum Axis {
        U = "u",
        V = "v",
    }
}

/// 2 × 2 texels: 0 in every channel on the left, 1 on the right; or, along v, above and below.
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

/// From the centre of the first texel of `ramp_texture` to that of the next one: weights k / `steps`,
/// exact in f32 up to 2²² steps. The other coordinate is where both rows weigh the same.
pub fn ramp(axis: Axis, steps: u32) -> impl Iterator<Item = [f32; 2]> {
    (0..=steps).map(move |k| {
        let along = (0.25 + 0.5 * f64::from(k) / f64::from(steps)) as f32;
        match axis {
            Axis::U => [along, 0.5],
            Axis::V => [0.5, along],
        }
    })
}

/// A scene without shapes whose materials are these (texture, sampler) pairs.
pub fn pairs(
    textures: Vec<TextureData>,
    samplers: &[SamplerSpec],
    list: &[(usize, usize)],
) -> Result<PackedScene> {
    pairs_over(Footprint::None, textures, samplers, list)
}

/// The same, looked up over footprints.
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
        },
        background: Background::default(),
        textures: Vec::new(),
        samplers: samplers.to_vec(),
        materials: list.iter().map(material).collect(),
        planes: Vec::new(),
        spheres: Vec::new(),
        triangles: Vec::new(),
        dropped_triangles: 0,
        first_dropped: String::new(),
        lights: Vec::new(),
    };
    pack::pack(&scene, textures, None)
}

/// The look-up of a pair's material at (u, v).
pub fn query(scene: &PackedScene, pair: usize, uv: [f32; 2]) -> LookUp {
    let material = &scene.materials[pair];
    let (texture, sampler, slot) = (material.texture_index, material.sampler_index, material.image_slot);
    LookUp { texture, sampler, slot, uv: [uv[0], uv[1], 0.0, 0.0], ..Default::default() }
}

/// Where it is looked up, and over what.
pub fn place_of(query: &LookUp) -> Coordinate {
    let vector = |[x, y, z, _]: [f32; 4]| DVec3::new(x.into(), y.into(), z.into());
    Coordinate { at: vector(query.uv), change: [vector(query.dx), vector(query.dy)] }
}

pub fn uv_of(query: &LookUp) -> DVec2 {
    DVec2::new(f64::from(query.uv[0]), f64::from(query.uv[1]))
}

/// Along one axis: texel edges and centres in and around the texture, whole numbers and what lies
/// just beside them, coordinates close to 0 on both sides.
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

/// Far outside, where whole periods leave exactly: to the last f32 with a fraction (2²³) and, with odd
/// whole numbers, which mirroring tells from even ones, to the last f32 that is one (2²⁴).
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

/// Random pairs of coordinates, half of them in [-3, 4] and half in and just around the texture, where
/// clamped modes read more than their edge; and pairs of awkward ones.
pub fn coordinates(dice: &mut Dice, size: [u32; 2], random: usize, far: bool) -> Vec<[f32; 2]> {
    let ends = |i: usize| if i.is_multiple_of(2) { (-3.0, 4.0) } else { (-0.25, 1.25) };
    let mut all: Vec<[f32; 2]> =
        (0..random).map(ends).map(|(low, high)| [0; 2].map(|_| dice.between(low, high) as f32)).collect();
    let [mut us, mut vs] = size.map(edge_coordinates);
    if far {
        us.extend(FAR_COORDINATES);
        vs.extend(FAR_COORDINATES);
    }
    let any = |dice: &mut Dice, list: &[f32]| list[dice.bits() as usize % list.len()];
    for &u in &us {
        all.push([u, any(dice, &vs)]);
    }
    for &v in &vs {
        all.push([any(dice, &us), v]);
    }
    all
}
