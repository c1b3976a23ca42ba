//! Scene and textures → exactly the bytes that device and oracle read. Computed in f64, stored in
//! f32: positions relative to the eye, texture coordinates with whole tiles taken out, so that what
//! the device sees is small and near wherever the scene lies in the world.

mod bright;
pub mod features;
mod geometry;
mod header;
mod kinds;
mod lights;
mod mapping;
mod mip_chain;
mod nonfinite;
mod pixel_filter;
mod precision;
mod procedural;
mod resample;
mod sample_dimensions;
mod sections;
mod textures;
mod tile_culling;

use std::sync::Arc;

use glam::{DVec3, DVec4};

use crate::core::error::Result;
use crate::scene::cone;
use crate::scene::model::{
    Algorithm, Environment, EnvironmentLayout, Footprint, Material, Model, PixelFilter, Precision, Scene,
};
use crate::schema::layout::{self, CHUNK, Header};
use crate::texture::data::TextureData;
use crate::texture::sampler_spec::{Address, Method, SamplerSpec};
use pixel_filter::Warp;

pub use header::camera_basis;
use header::header;
pub use kinds::{
    Diagnostic, EntityKind, LightKind, MapKind, ProjectionKind, SampleDimension, Schedule, TextureKind,
};
pub use mip_chain::{MipPlacement, reads_levels};
pub use pixel_filter::{filtered_mean, kernel};
pub use procedural::procedural;
pub use sections::Sections;
pub use textures::{MAX_SLOTS, Slot, prefix_sum_words, prefix_sums};

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
    pub maps: Vec<layout::UvProjection>,
    pub textures: Vec<layout::Texture>,
    pub samplers: Vec<layout::Sampler>,
    pub procedurals: Vec<layout::Procedural>,
    /// Of all shapes, where some move; else none.
    pub motions: Vec<layout::Motion>,
    /// Names of the textures, for messages.
    pub texture_names: Vec<String>,
    /// Channels that each texture's file has, for messages.
    pub file_channels: Vec<usize>,
    /// Texels of each texture that are NaN or infinite.
    pub nonfinite_texels: Vec<u64>,
    /// The samplers as data, for the device's own sampler objects.
    pub sampler_specs: Vec<SamplerSpec>,
    /// Texels of all textures one after the other, each beginning at a whole 32-bit word.
    pub texels: Vec<u8>,
    /// Textures whose levels a device makes from level 0, in the order of their texels; these have zeros
    /// there.
    pub device_levels: Vec<usize>,
    /// Which texture is read through which image descriptor: flat ones, volumes, cubes. The last two are
    /// read through images by method hardware only.
    pub slots: Vec<Slot>,
    pub volume_slots: Vec<Slot>,
    pub cube_slots: Vec<Slot>,
    /// Bytes at the front of `texels` that a pipeline with images needs too: no image holds them.
    pub solid_bytes: usize,
    /// Some texture has a table of sums, which no image holds.
    pub summed_tables: bool,
    /// Samples per pixel.
    pub samples: u32,
    /// Reals are f64 on the device too; else they are rounded to f32 here.
    pub double: bool,
    /// Samples of a pixel that one thread takes at once, at most `CHUNK`.
    pub chunk: u32,
    pub schedule: Schedule,
    pub algorithm: Algorithm,
    /// One beam a pixel, and samples where that cannot tell.
    pub beams: bool,
    /// For beams: where each texture's sums along rows begin, 0 for none; then those.
    pub prefix_sums: Vec<u32>,
    /// What those sums are made from, where beams may still be wanted.
    pub beam_textures: Option<Arc<Vec<TextureData>>>,
    /// Whether a device counts what goes beyond a limit.
    pub guarded: bool,
    /// Of adaptive sampling: the share of a texture that is far brighter than the rest and yet has much of its light;
    /// else none.
    pub bright_share: Option<f64>,
    /// The table by which samples are placed about their pixel; empty where there is a closed form.
    pub pixel_filter: Vec<f32>,
    /// Mean of the samples' signs, where the pixel filter has negative lobes.
    pub mean_sign: Option<f64>,
}

/// Image descriptors of each kind, and texel buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SlotCounts {
    pub flat: u32,
    pub volumes: u32,
    pub cubes: u32,
    /// Buffers that the texels lie in.
    pub texel_blocks: u32,
    /// Words of each but the last, where there are several.
    pub block_log2: u32,
}

/// Packs what the scene shows; textures and samplers that no shape reaches are not in `scene`.
pub fn pack(scene: &Scene, textures: Vec<TextureData>, crop: Option<Crop>) -> Result<PackedScene> {
    pack_with(scene, textures, crop, MipPlacement::Host)
}

/// The same, with some levels of textures left to the device.
pub fn pack_with(
    scene: &Scene,
    textures: Vec<TextureData>,
    crop: Option<Crop>,
    mip_chains: MipPlacement,
) -> Result<PackedScene> {
    let settled = (scene.sampling.algorithm == Algorithm::Cone).then(|| cone::freeze_time(scene));
    let scene = settled.as_ref().unwrap_or(scene);
    let crop = crop.unwrap_or(Crop { x: 0, y: 0, width: scene.width, height: scene.height });
    let samples = scene.sampling.samples();
    let schedule = schedule(scene);
    let algorithm = scene.sampling.algorithm;
    let mut packed = PackedScene { samples, chunk: CHUNK, schedule, algorithm, ..Default::default() };
    let sizes: Vec<[u32; 3]> = textures.iter().map(|t| [t.width, t.height, t.depth]).collect();
    let need = precision::need(scene, &sizes);
    packed.double = match (algorithm, scene.sampling.precision) {
        (Algorithm::Cone, _) | (_, Precision::Single) => false,
        (_, Precision::Double) => true,
        (_, Precision::Auto) => need.outlines || need.texels,
    };
    // Beams are of f32 always.
    let supports_beams = scene.supports_beams() && !(need.outlines && packed.double);
    // A cone stands for its pixel's own square.
    let filter = if algorithm == Algorithm::Cone { PixelFilter::default() } else { scene.pixel_filter };
    let warp = Warp::new(filter);
    packed.header = header(scene, crop, &warp);
    (packed.pixel_filter, packed.mean_sign) = (warp.table, warp.mean_sign);
    let filtered = packed.prefilters();
    packed.sampler_specs = scene.samplers.clone();
    packed.beams = scene.sampling.algorithm == Algorithm::Beam && supports_beams;
    nonfinite::admit(&mut packed, scene, &textures)?;
    if schedule == Schedule::Jobs {
        packed.bright_share = bright::share(scene, &textures);
    }
    if packed.beams {
        packed.prefix_sums = textures::prefix_sums(&textures);
    } else if algorithm == Algorithm::Auto
        && supports_beams
        && !packed.has_nonfinite()
        // No buffer is longer.
        && prefix_sum_words(&textures) <= i32::MAX as u64
    {
        packed.beam_textures = Some(Arc::new(textures.clone()));
    }
    packed.samplers = scene.samplers.iter().map(|spec| textures::sampler(spec, filtered)).collect();
    textures::pack_textures(&mut packed, scene, textures, mip_chains)?;
    for source in &scene.materials {
        let material = material(&mut packed, source);
        packed.materials.push(material);
    }
    geometry::pack_shapes(&mut packed, scene)?;
    if let Some(environment) = &scene.background.environment {
        pack_environment(&mut packed, scene, environment);
    }
    packed.lights = scene.lights.iter().map(|l| lights::light(l, scene.camera.eye)).collect();
    packed.header.key[1] = packed.lights.len() as u32;
    let moves = u32::from(scene.camera.moves());
    let side = tile_culling::cell_side(scene, [crop.width, crop.height]);
    packed.header.chances =
        [sample_dimensions::sample_dimensions(scene), packed.motions.len() as u32, moves, side];
    if !packed.double {
        packed.round_reals();
    }
    Ok(packed)
}

fn schedule(scene: &Scene) -> Schedule {
    match scene.sampling.algorithm {
        Algorithm::Samples | Algorithm::Beam | Algorithm::Cone => Schedule::Tiles,
        Algorithm::Adaptive | Algorithm::Auto => Schedule::Jobs,
    }
}

fn material(packed: &mut PackedScene, source: &Material) -> layout::Material {
    let mut slot = |texture: Option<usize>| match texture {
        Some(texture) => textures::slot(packed, texture, source.sampler),
        None => 0,
    };
    let index = |texture: Option<usize>| texture.map_or(layout::NO_TEXTURE, |t| t as u32);
    let bump = source.bump;
    let bump_texture = bump.map(|r| r.texture);
    let facets = DVec3::new(source.roughness.powi(2), 0.0, 0.0);
    let specular = if source.model.is_specular() { facets } else { source.specular };
    let fourth = source.model.number_of(source);
    layout::Material {
        color: vec4(source.color.extend(bump.map_or(0.0, |r| r.strength))),
        link: [source.model as u32, index(source.texture), source.sampler as u32, slot(source.texture)],
        detail: [
            index(bump_texture),
            source.sampler as u32,
            slot(bump_texture),
            bump.map_or(0, |r| r.kind as u32),
        ],
        specular: vec4(specular.extend(fourth)),
    }
}

/// The environment is the last material, unlit, with the last map.
fn pack_environment(packed: &mut PackedScene, scene: &Scene, environment: &Environment) {
    let mut sampler = environment.sampler;
    if environment.layout == EnvironmentLayout::Equirectangular {
        // The same sampler on a shape does not go on over poles.
        let mut record = packed.samplers[sampler];
        record.more[1] = 1;
        // From pole to pole: with `repeat` the lower half would be read as what lies above the upper one.
        record.modes[1] = Address::ClampToEdge as u32;
        let spec = packed.sampler_specs[sampler];
        packed.samplers.push(record);
        packed.sampler_specs.push(SamplerSpec { address: [spec.address[0], Address::ClampToEdge], ..spec });
        sampler = packed.samplers.len() - 1;
    }
    let slot = textures::slot(packed, environment.texture, sampler);
    packed.header.counts[3] = packed.materials.len() as u32;
    packed.header.key[3] = packed.maps.len() as u32;
    packed.maps.push(mapping::environment_map(environment));
    packed.materials.push(layout::Material {
        color: vec4(scene.background.color.extend(0.0)),
        link: [Model::PLAIN as u32, environment.texture as u32, sampler as u32, slot],
        detail: [layout::NO_TEXTURE, 0, 0, 0],
        specular: [0.0; 4],
    });
}

impl PackedScene {
    /// Whether samples are averages over footprints.
    pub fn prefilters(&self) -> bool {
        self.header.key[2] != Footprint::None as u32
    }

    /// Whether camera rays find their triangles in lists.
    pub fn culls_tiles(&self) -> bool {
        self.header.chances[3] != 0 && self.algorithm != Algorithm::Cone && !self.beams
    }

    /// Does any look-up go through the device's own samplers?
    pub fn uses_hardware_samplers(&self) -> bool {
        let mut slots = self.slots.iter().chain(&self.volume_slots).chain(&self.cube_slots);
        slots.any(|s| self.sampler_specs[s.sampler].method == Method::Hardware)
    }

    /// Is there anything to look up that images of flat textures do not hold?
    pub fn has_solids(&self) -> bool {
        let solids = [TextureKind::Volume as u32, TextureKind::Cube as u32];
        self.summed_tables || self.textures.iter().any(|t| solids.contains(&t.link[3]))
    }

    /// Of images alone.
    pub fn slot_counts(&self) -> SlotCounts {
        SlotCounts {
            flat: self.slots.len() as u32,
            volumes: self.volume_slots.len() as u32,
            cubes: self.cube_slots.len() as u32,
            ..SlotCounts::default()
        }
    }
}

fn real4(v: DVec4) -> [f64; 4] {
    v.to_array()
}

fn vec4(v: DVec4) -> [f32; 4] {
    v.as_vec4().to_array()
}
