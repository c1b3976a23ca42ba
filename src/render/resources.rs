//! Packed scene → buffers and images on the device: only those that the features need, and of the textures only the
//! source in use.

use std::sync::{Arc, OnceLock};

use super::diagnostics::DiagnosticCounters;
use super::images::Uploads;
use super::mesh_upload;
use super::mip_chain::MipGenerator;
use super::texel_buffer::{self, TexelBuffer};
use super::tuning::Tuning;
use super::unfinished_list::UnfinishedList;
use crate::core::error::Result;
use crate::gpu::shaders::{self, ReflectedBinding, Shader};
use crate::gpu::{BindGroup, BindingKind, Bound, Buffer, BufferUse, Gpu, Image, Pipeline, Sampler};
use crate::pack::features::{Features, TexelSource};
use crate::pack::{PackedScene, Sections, SlotCounts, TextureKind};
use crate::scene::model::Algorithm;
use crate::schema::bindings;
use crate::schema::enums::Reals;
use crate::schema::layout::{HEAD_BYTES, Header};
use crate::schema::specialization::Constant;

/// Returns the shader of an algorithm for the source of its texels and the precision of its geometry.
pub fn shader_for(algorithm: Algorithm, features: &Features) -> Result<&'static Shader> {
    let reals = if features.double { Reals::F64Math } else { Reals::F32 };
    match algorithm {
        Algorithm::Cone => shaders::CONE_FAMILY.shader(features.source, Reals::F32),
        _ => shaders::RENDER_FAMILY.shader(features.source, reals),
    }
}

pub struct Resources {
    pub sections: Sections,
    pub slots: SlotCounts,
    /// Device time of generating levels, if any were generated.
    pub mips_seconds: Option<f64>,
    scene: Buffer,
    /// Linear values of sRGB codes.
    srgb: Buffer,
    texels: Option<TexelBuffer>,
    /// Where there are some.
    meshes: Option<Buffer>,
    /// Set once beams are used.
    prefix_sums: OnceLock<Buffer>,
    /// Set once there are lists of triangles.
    pub tile_lists: OnceLock<Buffer>,
    /// The counters, if the pipelines count.
    pub diagnostics: Option<DiagnosticCounters>,
    /// What submissions leave unfinished, where the device ends loops.
    pub unfinished: Option<Arc<UnfinishedList>>,
    images: Vec<(Image, Sampler)>,
    volumes: Vec<(Image, Sampler)>,
    cubes: Vec<(Image, Sampler)>,
}

impl Resources {
    /// Uploads a scene; a texel buffer has at most `most_words`. `meshes`: its texels of meshes, which are freed
    /// on the host as the device gets them, unless others hold them too.
    pub fn upload(
        gpu: &Gpu,
        packed: &PackedScene,
        meshes: Arc<Vec<[u32; 4]>>,
        features: &Features,
        most_words: u64,
    ) -> Result<Resources> {
        let (bytes, sections) = packed.scene_bytes();
        let scene = gpu.upload_buffer("scene", BufferUse::Storage, &bytes)?;
        let srgb = packed.srgb_light();
        // A binding must not be empty.
        let srgb = if srgb.is_empty() { &[0.0] } else { srgb.as_slice() };
        let srgb =
            gpu.upload_buffer("light of sRGB codes", BufferUse::TexelUint, bytemuck::cast_slice(srgb))?;
        let mut generator = MipGenerator::new(gpu);
        let pooled = match features.source {
            TexelSource::Buffer => Some(packed.texels.len()),
            TexelSource::Solids => Some(packed.solid_bytes),
            TexelSource::None | TexelSource::Image => None,
        };
        let mut slots = packed.slot_counts();
        slots.texel_quads = !features.everything
            && packed.allows_texel_quads()
            && match features.source {
                TexelSource::Buffer => packed.texel_quad_words().is_some_and(|n| n as u64 <= most_words),
                TexelSource::Image => true,
                TexelSource::None | TexelSource::Solids => false,
            };
        let upload = |bytes| {
            if slots.texel_quads {
                TexelBuffer::upload_quads(gpu, packed)
            } else {
                TexelBuffer::upload(gpu, packed, bytes, most_words, &mut generator)
            }
        };
        let texels = pooled.map(upload).transpose()?;
        if let Some(texel_buffer) = &texels {
            (slots.texel_blocks, slots.block_log2) =
                (texel_buffer.blocks.len() as u32, texel_buffer.block_log2);
        }
        let meshes = mesh_upload::upload(gpu, meshes)?;
        slots.meshes = meshes.is_some() || features.everything;
        let prefix_sums = OnceLock::new();
        if packed.beams {
            // Never set twice: it is empty.
            let _ = prefix_sums.set(texel_buffer::upload_row_sums(gpu, packed, &packed.prefix_sums)?);
        }
        let mut uploads = Uploads::new(gpu, packed, generator);
        let [mut images, mut volumes, mut cubes] = [const { Vec::new() }; 3];
        if matches!(features.source, TexelSource::Image | TexelSource::Solids) {
            images = uploads.slots(&packed.slots, TextureKind::Flat)?;
        }
        if features.source == TexelSource::Solids {
            volumes = uploads.slots(&packed.volume_slots, TextureKind::Volume)?;
            cubes = uploads.slots(&packed.cube_slots, TextureKind::Cube)?;
        }
        Ok(Resources {
            sections,
            slots,
            mips_seconds: uploads.mips_seconds(),
            scene,
            srgb,
            texels,
            meshes,
            prefix_sums,
            tile_lists: OnceLock::new(),
            diagnostics: features
                .has(Constant::Diagnosed)
                .then(|| DiagnosticCounters::new(gpu))
                .transpose()?,
            unfinished: Tuning::loops_end(gpu.info())
                .then(|| UnfinishedList::new(gpu, packed.header.film_size.to_array()).map(Arc::new))
                .transpose()?,
            images,
            volumes,
            cubes,
        })
    }

    /// Adds the prefix sums of rows to a scene that was not packed for beams, unless they exist.
    pub fn add_row_sums(
        &self,
        gpu: &Gpu,
        packed: &PackedScene,
        make: impl FnOnce() -> Vec<u32>,
    ) -> Result<()> {
        if self.prefix_sums.get().is_none() {
            // Never set twice: it was empty just now.
            let _ = self.prefix_sums.set(texel_buffer::upload_row_sums(gpu, packed, &make())?);
        }
        Ok(())
    }

    /// Replaces the header of the scene buffer.
    pub fn write_header(&self, gpu: &Gpu, packed: &PackedScene, header: &Header) -> Result<()> {
        gpu.write_buffer(&self.scene, 0, &packed.header_bytes(header))
    }

    /// Binds all of the shader's bindings: its output, a list of queries or batches (any buffer if none is read), and
    /// the scene.
    pub fn bind(
        &self,
        gpu: &Gpu,
        pipeline: &Pipeline,
        shader: &Shader,
        output: &Buffer,
        queries: Option<&Buffer>,
    ) -> Result<BindGroup> {
        let [images, volumes, cubes] = [&self.images, &self.volumes, &self.cubes].map(|slots| pairs(slots));
        let resource = |b: &ReflectedBinding| {
            let resource = match (b.kind, b.binding) {
                (BindingKind::StorageBuffer, bindings::OUTPUT) => Bound::Buffer(output),
                (BindingKind::StorageBuffer, bindings::LIST) => Bound::Buffer(queries.unwrap_or(&self.scene)),
                (BindingKind::StorageBuffer, bindings::TILE_LISTS) => {
                    Bound::Buffer(self.tile_lists.get().unwrap_or(&self.scene))
                }
                (BindingKind::StorageBuffer, bindings::DIAGNOSTICS) => Bound::Buffer(
                    self.diagnostics.as_ref().map_or(&self.scene, |diagnostics| &diagnostics.buffer),
                ),
                (BindingKind::StorageBuffer, bindings::UNFINISHED) => {
                    Bound::Buffer(self.unfinished.as_ref().map_or(&self.scene, |list| &list.buffer))
                }
                (BindingKind::StorageBuffer, _) => Bound::Buffer(&self.scene),
                (BindingKind::UniformBuffer, _) => Bound::Head(&self.scene, HEAD_BYTES as u64),
                (BindingKind::TexelBuffer, bindings::SRGB_LIGHT) => {
                    Bound::Texels(std::slice::from_ref(&self.srgb))
                }
                (BindingKind::TexelBuffer, bindings::MESHES) if !self.slots.meshes => return None,
                (BindingKind::TexelBuffer, bindings::MESHES) => {
                    // Without meshes nothing is read from it.
                    Bound::Texels(std::slice::from_ref(self.meshes.as_ref().unwrap_or(&self.srgb)))
                }
                (BindingKind::TexelBuffer, bindings::PREFIX_SUMS) => {
                    Bound::Texels(std::slice::from_ref(self.prefix_sums.get()?))
                }
                (BindingKind::TexelBuffer, _) => Bound::Texels(&self.texels.as_ref()?.blocks),
                (BindingKind::SampledImage, bindings::VOLUMES) => Bound::Images(&volumes),
                (BindingKind::SampledImage, bindings::CUBES) => Bound::Images(&cubes),
                (BindingKind::SampledImage, _) => Bound::Images(&images),
            };
            Some((b.binding, resource))
        };
        let bound: Vec<(u32, Bound<'_>)> = shader.bindings.iter().filter_map(resource).collect();
        gpu.bind(pipeline, &bound)
    }
}

fn pairs(slots: &[(Image, Sampler)]) -> Vec<(&Image, &Sampler)> {
    slots.iter().map(|(image, sampler)| (image, sampler)).collect()
}
