//! Runs single parts of the renderer on a device: texture lookups, procedural textures, rays and
//! sample positions for lists of queries; mip chains. Tests and conformance reports compare the
//! results with the oracle; the shaders call the same functions as rendering.

mod records;

use std::sync::Arc;

use bytemuck::Pod;

use crate::core::error::{Error, Result};
use crate::gpu::shaders::{self, Shader};
use crate::gpu::{BufferUse, Gpu, Pipeline};
use crate::pack::PackedScene;
use crate::pack::features::{Features, TexelSource};
use crate::render::{MipGenerator, MipSource, Resources, Tuning, build_pipeline, specialization};
use crate::texture::data::TextureData;
use crate::texture::mips;

pub use crate::render::can_sample;
pub use records::{
    DoubleAnswer, DoubleRay, GlassQuery, LookupQuery, ProceduralQuery, RayAnswer, RayQuery, WarpAnswer,
    WarpQuery,
};

const GROUP: u32 = 64;

/// Returns RGBA of each lookup, computed by the pipeline that rendering this scene would build.
pub fn lookups(
    gpu: &Gpu,
    scene: &PackedScene,
    image_source: bool,
    keep_everything: bool,
    queries: &[LookupQuery],
) -> Result<Vec<[f32; 4]>> {
    let features = Features::new(scene, image_source, keep_everything);
    let shader = look_up_shader(&features);
    run(gpu, scene, &features, shader, Some(bytemuck::cast_slice(queries)), queries.len(), &[])
}

fn look_up_shader(features: &Features) -> &'static Shader {
    match features.source {
        TexelSource::Image => &shaders::PROBE_IMAGE,
        TexelSource::Solids => &shaders::PROBE_SOLIDS,
        TexelSource::None | TexelSource::Buffer => &shaders::PROBE_BUFFER,
    }
}

/// Box mip chains of a sequence of textures. Textures of one format share pipelines.
pub struct MipProbe<'a>(&'a Gpu, MipGenerator<'a>);

impl<'a> MipProbe<'a> {
    pub fn new(gpu: &'a Gpu) -> MipProbe<'a> {
        MipProbe(gpu, MipGenerator::new(gpu))
    }

    /// Returns levels 1 to the last, like `texture::mips`, and the device time in seconds.
    pub fn make(&mut self, texture: &TextureData) -> Result<(Vec<TextureData>, f64)> {
        let MipProbe(gpu, generator) = self;
        let mut levels = mips::zeroed_levels(texture);
        if levels.is_empty() {
            return Ok((levels, 0.0));
        }
        if !mips::halves_throughout(texture) {
            return Err(Error::new(format!(
                "texture \"{}\": devices make mip_chains of lengths that are powers of two",
                texture.name
            )));
        }
        let sizes: Vec<[u32; 3]> =
            (0..mips::level_count(texture)).map(|level| mips::level_size(texture, level)).collect();
        generator.seconds = None;
        let mip_chain = generator.make(&MipSource {
            name: &texture.name,
            format: texture.format,
            space: texture.color_space,
            sizes: &sizes,
            texels: &texture.texels,
        })?;
        for (level, start) in levels.iter_mut().zip(&mip_chain.starts[1..]) {
            gpu.read_buffer(&mip_chain.buffer, *start, &mut level.texels)?;
        }
        Ok((levels, generator.seconds.unwrap_or(0.0)))
    }
}

/// Returns the hit of each ray. Shapes need a texture for their coordinates to be defined.
pub fn rays(
    gpu: &Gpu,
    scene: &PackedScene,
    keep_everything: bool,
    queries: &[RayQuery],
) -> Result<Vec<RayAnswer>> {
    let features = Features::new(scene, false, keep_everything);
    run(gpu, scene, &features, &shaders::PROBE_RAYS, Some(bytemuck::cast_slice(queries)), queries.len(), &[])
}

/// Returns the hits for a scene with geometry in f64.
pub fn double_rays(gpu: &Gpu, scene: &PackedScene, queries: &[DoubleRay]) -> Result<Vec<DoubleAnswer>> {
    if !scene.double || !gpu.info().limits.float64 {
        return Err(Error::new(
            "rays in f64 need a scene that is packed for them, and a device that has f64",
        ));
    }
    let features = Features::new(scene, false, false);
    let list = Some(bytemuck::cast_slice(queries));
    run(gpu, scene, &features, &shaders::PROBE_RAYS_F64_MATH, list, queries.len(), &[])
}

/// Returns linear RGB and an alpha of 1 for each lookup of a procedural texture.
pub fn procedurals(
    gpu: &Gpu,
    scene: &PackedScene,
    keep_everything: bool,
    queries: &[ProceduralQuery],
) -> Result<Vec<[f32; 4]>> {
    let features = Features::new(scene, false, keep_everything);
    let list = Some(bytemuck::cast_slice(queries));
    run(gpu, scene, &features, &shaders::PROBE_PROCEDURAL, list, queries.len(), &[])
}

/// Returns the points on disc and cap to which points of the unit square are mapped.
pub fn warps(gpu: &Gpu, scene: &PackedScene, queries: &[WarpQuery]) -> Result<Vec<WarpAnswer>> {
    let features = Features::new(scene, false, false);
    let list = Some(bytemuck::cast_slice(queries));
    run(gpu, scene, &features, &shaders::PROBE_DISK_SAMPLING, list, queries.len(), &[])
}

/// Returns the refracted direction and the Fresnel reflectance.
pub fn glass(gpu: &Gpu, scene: &PackedScene, queries: &[GlassQuery]) -> Result<Vec<[f32; 4]>> {
    let features = Features::new(scene, false, false);
    let list = Some(bytemuck::cast_slice(queries));
    run(gpu, scene, &features, &shaders::PROBE_GLASS, list, queries.len(), &[])
}

/// The range of positions: `samples` samples from `first` on of the first `pixels` pixels of a
/// picture `width` wide.
#[derive(Clone, Copy, Debug)]
pub struct Positions {
    pub pair: u32,
    pub width: u32,
    pub pixels: u32,
    pub first: u32,
    pub samples: u32,
}

/// Returns positions, sample by sample within a pixel, as integers of 24 bits.
pub fn positions(
    gpu: &Gpu,
    scene: &PackedScene,
    keep_everything: bool,
    which: &Positions,
) -> Result<Vec<[u32; 2]>> {
    let features = Features::new(scene, false, keep_everything);
    let count = which.pixels as usize * which.samples as usize;
    let push = [which.samples, which.width, which.pair, which.first];
    run(gpu, scene, &features, &shaders::STRATA, None, count, &push)
}

/// Runs one dispatch with a thread per answer. The push constants are the count followed by `push`.
fn run<T: Pod>(
    gpu: &Gpu,
    scene: &PackedScene,
    features: &Features,
    shader: &'static Shader,
    queries: Option<&[u8]>,
    count: usize,
    push: &[u32],
) -> Result<Vec<T>> {
    let (meshes, most_words) = (Arc::clone(&scene.mesh_texels), Tuning::default().texel_words(gpu));
    let resources = Resources::upload(gpu, scene, meshes, features, most_words)?;
    let slots = resources.slots;
    let constants = specialization::constants(shader, features, &resources.sections, [GROUP, 1], slots);
    let pipeline = build_pipeline(gpu, shader, &constants, slots, (1 + push.len()) * size_of::<u32>())?;
    dispatch(gpu, &pipeline, &resources, shader, queries, count, push)
}

fn dispatch<T: Pod>(
    gpu: &Gpu,
    pipeline: &Pipeline,
    resources: &Resources,
    shader: &'static Shader,
    queries: Option<&[u8]>,
    count: usize,
    push: &[u32],
) -> Result<Vec<T>> {
    let mut answers = vec![T::zeroed(); count];
    let output = gpu.buffer("answers", size_of_val(answers.as_slice()) as u64, BufferUse::Storage)?;
    let queries = queries.map(|q| gpu.upload_buffer("queries", BufferUse::Storage, q)).transpose()?;
    let push: Vec<u32> = std::iter::once(count as u32).chain(push.iter().copied()).collect();
    let group = resources.bind(gpu, pipeline, shader, &output, queries.as_ref())?;
    gpu.run(pipeline, &group, bytemuck::cast_slice(&push), [(count as u32).div_ceil(GROUP), 1, 1])?;
    gpu.read_buffer(&output, 0, bytemuck::cast_slice_mut(&mut answers))?;
    Ok(answers)
}
