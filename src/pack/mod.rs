//! Scene and textures → exactly the bytes that device and oracle read. Computed in f64, stored in
//! f32: positions relative to the eye, texture coordinates with whole tiles taken out, so that what
//! the device sees is small and near wherever the scene lies in the world.

mod bright;
mod environment_light;
mod facet_table;
pub mod features;
mod geometry;
mod header;
mod lights;
mod mapping;
mod materials;
mod mip_chain;
mod nonfinite;
mod pixel_filter;
mod precision;
mod procedural;
mod resample;
mod sample_dimensions;
mod sections;
mod stored_levels;
mod texel_format;
mod texel_quads;
mod texture_lines;
mod texture_readers;
mod textures;
mod tile_culling;

use std::sync::Arc;

use crate::core::error::Result;
use crate::core::range::Rect;
use crate::scene::cone;
use crate::scene::model::{
    Algorithm, Environment, EnvironmentLayout, Footprint, Material, Model, PixelFilter, Precision, Scene,
};
use crate::schema::layout::{self, Header, MAX_SAMPLES_AT_ONCE, Records};
use crate::texture::data::TextureData;
use crate::texture::sampler_spec::{Address, Method, SamplerSpec};
use environment_light::Distribution;
use materials::material;
use pixel_filter::Warp;

pub use crate::schema::enums::{
    Diagnostic, EntityKind, LightKind, MapKind, ProjectionKind, SampleDimension, Schedule, TextureKind,
};
pub use header::camera_basis;
use header::header;
use mip_chain::Anew;
pub use mip_chain::{LevelMaker, MipPlacement, reads_levels};
pub use pixel_filter::{filtered_mean, kernel};
pub use procedural::procedural;
pub use sections::Sections;
pub use textures::{MAX_SLOTS, Slot, prefix_sum_words, prefix_sums};

/// All that is rendered from: header and lists of records of the scene buffer, and the texels.
#[derive(Clone, Debug, Default)]
pub struct PackedScene {
    pub header: Header,
    pub records: Records,
    /// Names of the textures, for messages.
    pub texture_names: Vec<String>,
    /// Channels that each texture's file has, for messages.
    pub file_channels: Vec<usize>,
    /// Texels of each texture that are NaN or infinite.
    pub nonfinite_texels: Vec<u64>,
    /// The samplers as data, for the device's own sampler objects.
    pub sampler_specs: Vec<SamplerSpec>,
    /// Meshes: for each the children of its tree's nodes, then the corners of its triangles in the order of the leaves,
    /// then their attributes.
    pub mesh_texels: Arc<Vec<[u32; 4]>>,
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
    /// Texture coordinates are moderate numbers wherever a ray meets something.
    pub bounded_uv: bool,
    /// Samples per pixel.
    pub samples: u32,
    /// Reals are f64 on the device too; else they are rounded to f32 here.
    pub double: bool,
    /// Samples of a pixel that one thread takes at once, at most `MAX_SAMPLES_AT_ONCE`.
    pub samples_at_once: u32,
    pub schedule: Schedule,
    pub algorithm: Algorithm,
    /// One beam a pixel, and samples where that cannot tell.
    pub beams: bool,
    /// For beams: where each texture's sums along rows begin, 0 for none; then those.
    pub prefix_sums: Vec<u32>,
    /// The textures from which those sums are made, where beams may still be wanted.
    pub beam_textures: Option<Arc<Vec<TextureData>>>,
    /// The device counts values beyond a limit.
    pub diagnosed: bool,
    /// For adaptive sampling: the share of a texture that is far brighter than the rest and yet has much of its light;
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
    /// A bilinear look-up reads its four texels at once.
    pub texel_quads: bool,
    /// The buffer of meshes is bound.
    pub meshes: bool,
}

/// Packs what the scene shows; textures and samplers that no shape reaches are not in `scene`.
pub fn pack(scene: &Scene, textures: Vec<TextureData>, crop: Option<Rect>) -> Result<PackedScene> {
    pack_with(scene, textures, crop, MipPlacement::Host)
}

/// Packs a scene, with some levels of textures left to the device.
pub fn pack_with(
    scene: &Scene,
    textures: Vec<TextureData>,
    crop: Option<Rect>,
    mip_chains: MipPlacement,
) -> Result<PackedScene> {
    pack_by(scene, textures, crop, mip_chains, &mut Anew)
}

/// Packs a scene like [`pack_with`]; `levels` makes those that the host has to make.
pub fn pack_by(
    scene: &Scene,
    textures: Vec<TextureData>,
    crop: Option<Rect>,
    mip_chains: MipPlacement,
    levels: &mut dyn LevelMaker,
) -> Result<PackedScene> {
    let settled = (scene.sampling.algorithm == Algorithm::Cone).then(|| cone::freeze_time(scene));
    let scene = settled.as_ref().unwrap_or(scene);
    let crop = crop.unwrap_or(Rect::whole([scene.width, scene.height]));
    let samples = scene.sampling.samples();
    let schedule = schedule(scene);
    let algorithm = scene.sampling.algorithm;
    let mut packed = PackedScene {
        samples,
        samples_at_once: MAX_SAMPLES_AT_ONCE,
        schedule,
        algorithm,
        ..Default::default()
    };
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
    if schedule == Schedule::Batches {
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
    packed.records.samplers = scene.samplers.iter().map(|spec| textures::sampler(spec, filtered)).collect();
    let environment_light = scene.is_lit_by_environment().then(|| {
        let environment = scene.background.environment.as_ref();
        let picture = environment.and_then(|e| Some((e, textures.get(e.texture)?)));
        environment_light::distribution(picture.filter(|(e, _)| has_texels(scene, e)))
    });
    textures::pack_textures(&mut packed, scene, textures, mip_chains, levels)?;
    for source in &scene.materials {
        let material = material(&mut packed, source);
        packed.records.materials.push(material);
    }
    geometry::pack_shapes(&mut packed, scene)?;
    packed.bounded_uv = geometry::bounds_uv(scene);
    if let Some(environment) = &scene.background.environment {
        pack_environment(&mut packed, scene, environment);
    }
    pack_environment_light(&mut packed, scene, environment_light);
    if scene.materials.iter().any(|m| m.model.is_glossy()) {
        packed.records.facet_parts = facet_table::facet_table();
    }
    packed.records.lights = scene.lights.iter().map(|l| lights::light(l, scene.camera.eye)).collect();
    packed.header.sample_dimensions = sample_dimensions::sample_dimensions(scene);
    packed.header.camera_moves = scene.camera.moves();
    packed.header.cell_side = tile_culling::cell_side(scene, [crop.width, crop.height], packed.double);
    if !packed.double {
        packed.round_reals();
    }
    Ok(packed)
}

fn schedule(scene: &Scene) -> Schedule {
    match scene.sampling.algorithm {
        Algorithm::Samples | Algorithm::Beam | Algorithm::Cone => Schedule::Tiles,
        Algorithm::Adaptive | Algorithm::Auto => Schedule::Batches,
    }
}

/// Returns true if an environment is a picture, not a pattern.
fn has_texels(scene: &Scene, environment: &Environment) -> bool {
    let source = scene.textures.get(environment.texture);
    source.is_some_and(|source| source.content.procedural().is_none())
}

/// The environment is the last material, unlit, with the last map.
fn pack_environment(packed: &mut PackedScene, scene: &Scene, environment: &Environment) {
    let mut sampler = environment.sampler;
    if environment.layout == EnvironmentLayout::Equirectangular {
        // The same sampler on a shape does not go on over poles.
        let mut record = packed.records.samplers[sampler];
        record.crosses_poles = true;
        // From pole to pole: with `repeat` the lower half would be read as what lies above the upper one.
        record.address_v = Address::ClampToEdge;
        let spec = packed.sampler_specs[sampler];
        packed.records.samplers.push(record);
        packed.sampler_specs.push(SamplerSpec { address: [spec.address[0], Address::ClampToEdge], ..spec });
        sampler = packed.records.samplers.len() - 1;
    }
    let slot = textures::slot(packed, environment.texture, sampler);
    packed.header.environment_material = packed.records.materials.len() as u32;
    packed.header.environment_projection = packed.records.uv_projections.len() as u32;
    packed.records.uv_projections.push(mapping::environment_map(environment));
    let plain = material(packed, &Material::default());
    packed.records.materials.push(layout::Material {
        color: scene.background.color.as_vec3(),
        model: Model::PLAIN,
        texture_index: environment.texture as u32,
        sampler_index: sampler as u32,
        image_slot: slot,
        ..plain
    });
}

/// Packs the distribution of the environment's light, if it is one.
fn pack_environment_light(packed: &mut PackedScene, scene: &Scene, found: Option<Distribution>) {
    let Some(found) = found.filter(|_| scene.is_lit_by_environment()) else { return };
    (packed.header.environment_columns, packed.header.environment_rows) = (found.columns, found.rows);
    packed.records.environment_parts = found.parts;
}

impl PackedScene {
    /// Returns true if samples are averages over footprints.
    pub fn prefilters(&self) -> bool {
        self.header.footprint != Footprint::None
    }

    /// Returns true if camera rays find their triangles in lists.
    pub fn culls_tiles(&self) -> bool {
        self.header.cell_side != 0 && self.algorithm != Algorithm::Cone && !self.beams
    }

    /// Returns true if a look-up uses the device's own samplers.
    pub fn uses_hardware_samplers(&self) -> bool {
        let mut slots = self.slots.iter().chain(&self.volume_slots).chain(&self.cube_slots);
        slots.any(|s| self.sampler_specs[s.sampler].method == Method::Hardware)
    }

    /// Returns true if some texture is in no image of flat textures.
    pub fn has_solids(&self) -> bool {
        let solids = [TextureKind::Volume, TextureKind::Cube];
        self.summed_tables || self.records.textures.iter().any(|t| solids.contains(&t.kind))
    }

    /// Returns the number of image descriptors.
    pub fn slot_counts(&self) -> SlotCounts {
        SlotCounts {
            flat: self.slots.len() as u32,
            volumes: self.volume_slots.len() as u32,
            cubes: self.cube_slots.len() as u32,
            ..SlotCounts::default()
        }
    }
}
