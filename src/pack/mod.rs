//! Scene and textures → exactly the bytes that device and oracle read. Computed in f64, stored in
//! f32: positions relative to the eye, texture coordinates with whole tiles taken out, so that what
//! the device sees is small and near wherever the scene lies in the world.

mod mapping;
mod procedural;
mod shapes;
mod textures;

use glam::{DVec3, DVec4};

use crate::color::srgb8_table;
use crate::error::Result;
use crate::layout::{self, Header};
use crate::named::named_enum;
use crate::scene::model::{Light, Pattern, Projection, Scene};
use crate::texture::data::TextureData;
use crate::texture::sampler_spec::{Method, SamplerSpec};

pub use procedural::procedural;
pub use textures::{MAX_SLOTS, Slot};

named_enum! {
    /// `PROJECTION_*` of the shader.
    pub enum ProjectionKind {
        Perspective = "perspective",
        Orthographic = "orthographic",
    }
}

named_enum! {
    /// `LIGHT_*` of the shader.
    pub enum LightKind {
        Point = "point",
        Directional = "directional",
    }
}

named_enum! {
    /// `MAP_*` of the shader: how a device forms a texture coordinate.
    pub enum MapKind {
        Plane = "plane",
        Affine = "affine",
        VertexUv = "vertex-uv",
        Cylindrical = "cylindrical",
        Spherical = "spherical",
    }
}

/// A part of the picture, in pixels of the full picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// All that is rendered from: the lists behind the scene buffer, and the texels.
#[derive(Clone, Debug, Default)]
pub struct PackedScene {
    pub header: Header,
    pub planes: Vec<layout::Plane>,
    pub spheres: Vec<layout::Sphere>,
    pub triangles: Vec<layout::Triangle>,
    pub lights: Vec<layout::Light>,
    pub materials: Vec<layout::Material>,
    pub maps: Vec<layout::Map>,
    pub textures: Vec<layout::Texture>,
    pub samplers: Vec<layout::Sampler>,
    pub procedurals: Vec<layout::Procedural>,
    /// Are they averaged over footprints? Where not, each look-up must pass a footprint of zero.
    pub procedurals_filtered: bool,
    /// Names of the textures, for messages.
    pub texture_names: Vec<String>,
    /// Channels that each texture's file has, for messages.
    pub file_channels: Vec<usize>,
    /// The samplers as data, for the device's own sampler objects.
    pub sampler_specs: Vec<SamplerSpec>,
    /// Texels of all textures one after the other, each beginning at a whole 32-bit word.
    pub texels: Vec<u8>,
    /// Which texture is read through which sampler object; filled where images are used.
    pub slots: Vec<Slot>,
    /// Samples per pixel.
    pub samples: u32,
}

/// Where each list begins in the scene buffer, in units of 16 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sections {
    pub planes: u32,
    pub spheres: u32,
    pub triangles: u32,
    pub lights: u32,
    pub materials: u32,
    pub maps: u32,
    pub textures: u32,
    pub samplers: u32,
    pub procedurals: u32,
    pub srgb: u32,
}

/// Packs what the scene shows; textures and samplers that no shape reaches are not in `scene`.
pub fn pack(scene: &Scene, textures: Vec<TextureData>, crop: Option<Crop>) -> Result<PackedScene> {
    let crop = crop.unwrap_or(Crop { x: 0, y: 0, width: scene.width, height: scene.height });
    let mut packed = PackedScene { samples: scene.sampling.samples(), ..Default::default() };
    packed.header = header(scene, crop);
    packed.sampler_specs = scene.samplers.clone();
    packed.samplers = scene.samplers.iter().map(textures::sampler).collect();
    textures::pack_textures(&mut packed, textures)?;
    for material in &scene.materials {
        let slot = match material.texture {
            Some(texture) => textures::slot(&mut packed, texture, material.sampler),
            None => 0,
        };
        packed.materials.push(layout::Material {
            color: vec4(material.color.extend(1.0)),
            link: [
                material.model as u32,
                material.texture.map_or(layout::NO_TEXTURE, |t| t as u32),
                material.sampler as u32,
                slot,
            ],
        });
    }
    shapes::pack_shapes(&mut packed, scene)?;
    packed.lights = scene.lights.iter().map(|l| light(l, scene.camera.eye)).collect();
    packed.header.key[1] = packed.lights.len() as u32;
    packed.header.counts =
        [packed.planes.len() as u32, packed.spheres.len() as u32, packed.triangles.len() as u32, 0];
    Ok(packed)
}

impl PackedScene {
    /// Does any look-up go through the device's own samplers?
    pub fn uses_hardware_samplers(&self) -> bool {
        self.slots.iter().any(|s| self.sampler_specs[s.sampler].method == Method::Hardware)
    }

    /// The scene buffer and where its lists begin: the short ones first, so that all of them lie in
    /// the head. The sRGB table is there only when a texture of 8 bits needs it.
    pub fn scene_bytes(&self) -> (Vec<u8>, Sections) {
        let srgb: &[f32] = if textures::needs_srgb_table(&self.textures) { srgb8_table() } else { &[] };
        let mut sections = Sections::default();
        let mut lists: [(&[u8], &mut u32); 10] = [
            (bytemuck::cast_slice(&self.planes), &mut sections.planes),
            (bytemuck::cast_slice(&self.spheres), &mut sections.spheres),
            (bytemuck::cast_slice(&self.triangles), &mut sections.triangles),
            (bytemuck::cast_slice(&self.lights), &mut sections.lights),
            (bytemuck::cast_slice(&self.materials), &mut sections.materials),
            (bytemuck::cast_slice(&self.maps), &mut sections.maps),
            (bytemuck::cast_slice(&self.textures), &mut sections.textures),
            (bytemuck::cast_slice(&self.samplers), &mut sections.samplers),
            (bytemuck::cast_slice(&self.procedurals), &mut sections.procedurals),
            (bytemuck::cast_slice(srgb), &mut sections.srgb),
        ];
        lists.sort_by_key(|(list, _)| list.len());
        let mut bytes = bytemuck::bytes_of(&self.header).to_vec();
        for (list, at) in lists {
            *at = (bytes.len() / 16) as u32;
            bytes.extend_from_slice(list);
        }
        bytes.resize(bytes.len().max(layout::HEAD_BYTES), 0);
        (bytes, sections)
    }
}

/// Right-handed basis of the camera: right, up, forward, all of unit length.
pub fn camera_basis(scene: &Scene) -> [DVec3; 3] {
    let forward = (scene.camera.look_at - scene.camera.eye).normalize();
    let right = forward.cross(scene.camera.up).normalize();
    [right, right.cross(forward), forward]
}

fn header(scene: &Scene, crop: Crop) -> Header {
    let [right, up, forward] = camera_basis(scene);
    // Half the picture's height at distance 1 (perspective) or in scene units (orthographic).
    let (half_height, projection) = match scene.camera.projection {
        Projection::VerticalFov(degrees) => ((0.5 * degrees.to_radians()).tan(), ProjectionKind::Perspective),
        Projection::CameraConstant(distance) => (0.5 / distance, ProjectionKind::Perspective),
        Projection::Orthographic(height) => (0.5 * height, ProjectionKind::Orthographic),
    };
    let pixel = 2.0 * half_height / f64::from(scene.height);
    let side = scene.sampling.strata_side();
    Header {
        forward: vec4(forward.extend(0.0)),
        step_x: vec4((right * pixel).extend(0.0)),
        step_y: vec4((-up * pixel).extend(0.0)),
        background: vec4(scene.background.extend(1.0)),
        image: [scene.width, scene.height, crop.x, crop.y],
        size: [crop.width, crop.height, projection as u32, scene.sampling.max_depth],
        sampling: [
            scene.sampling.pattern as u32,
            side,
            side.next_power_of_two().trailing_zeros(),
            scene.sampling.seed,
        ],
        key: [u32::from(scene.sampling.shared && scene.sampling.pattern == Pattern::Stratified), 0, 0, 0],
        counts: [0; 4],
    }
}

fn light(light: &Light, eye: DVec3) -> layout::Light {
    match *light {
        Light::Point { position, intensity } => layout::Light {
            place: vec4((position - eye).extend(0.0)),
            power: vec4(intensity.extend(0.0)),
            link: [LightKind::Point as u32, 0, 0, 0],
        },
        Light::Directional { direction, irradiance } => layout::Light {
            place: vec4(direction.normalize().extend(0.0)),
            power: vec4(irradiance.extend(0.0)),
            link: [LightKind::Directional as u32, 0, 0, 0],
        },
    }
}

fn vec4(v: DVec4) -> [f32; 4] {
    v.as_vec4().to_array()
}
