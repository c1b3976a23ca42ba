//! Materials of a glTF file as materials of a scene. Input: the model and its folder. Output: the index of a material,
//! with its textures and samplers as the file has them; what is not drawn is told by its name, once for a material.

use std::path::Path;

use glam::DVec3;
use glam::swizzles::Vec4Swizzles as _;

use super::coordinates::CoordinateSets;
use super::images::{self, Chosen};
use super::notes::MaterialNotes;
use crate::mesh::gltf::{self, Content, Material, Model, Texture, TextureRef, Wrap};
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{self, AlphaMode, BumpKind, BumpMap, Sides, TextureUse};
use crate::texture::data::{ColorSpace, Dimension, MipKernel};
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec, basic_filter};
use crate::texture::source::{OrientationUse, ProfileUse, ReadOptions, TextureSource};

/// Adds a material; returns its index, or which of its images cannot be read.
pub(in crate::scene::formats) fn add(
    path: &Path,
    found_in: &Model,
    material: &Material,
    builder: &mut SceneBuilder,
    notes: &mut MaterialNotes,
) -> Result<usize, String> {
    let sets = CoordinateSets::of(material);
    let mut reader = Reader { path, model: found_in, builder, material, notes, sets };
    let mut added = model::Material {
        name: material.name.clone(),
        color: material.base_color.xyz().max(DVec3::ZERO),
        model: model_of(material),
        metallic: material.metallic,
        roughness: material.roughness,
        ior: if material.ior == 0.0 { TOTAL_IOR } else { material.ior.clamp(1.0, TOTAL_IOR) },
        specular_tint: material.specular_color,
        specular_weight: material.specular,
        opacity: material.base_color.w.clamp(0.0, 1.0),
        sides: if material.double_sided { Sides::Both } else { Sides::Front },
        ..model::Material::default()
    };
    (added.alpha, added.alpha_cutoff) = match material.alpha {
        gltf::AlphaMode::Opaque => (AlphaMode::Opaque, added.alpha_cutoff),
        gltf::AlphaMode::Mask(cutoff) => (AlphaMode::Mask, cutoff),
        gltf::AlphaMode::Blend => (AlphaMode::Blend, added.alpha_cutoff),
    };
    let base = reader.used(material.base_color_texture, ColorSpace::Srgb)?;
    if let Some(base) = base {
        (added.texture, added.sampler, added.second_uv) = (Some(base.texture), base.sampler, base.second_uv);
    }
    if !material.unlit {
        let normal = reader.used(material.normal_texture, ColorSpace::Linear)?;
        // Green of glTF points along the bitangent, which is against v.
        added.bump = normal.map(|normal| BumpMap {
            kind: BumpKind::NormalDown,
            texture: normal.texture,
            strength: material.normal_scale,
            sampler: Some(normal.sampler),
            second_uv: normal.second_uv,
            own_uv: normal.own_uv,
        });
        if added.model.is_glossy() {
            added.metallic_roughness_map =
                reader.used(material.metallic_roughness_texture, ColorSpace::Linear)?;
            added.specular_weight_map = reader.used(material.specular_texture, ColorSpace::Linear)?;
            added.specular_tint_map = reader.used(material.specular_color_texture, ColorSpace::Srgb)?;
            added.transmission = material.transmission;
            if material.transmission > 0.0 {
                added.transmission_texture =
                    reader.used(material.transmission_texture, ColorSpace::Linear)?;
            }
        }
        added.emission = material.emissive * material.emissive_strength;
        added.emission_map = reader.used(material.emissive_texture, ColorSpace::Srgb)?;
        added.occlusion_map = reader.used(material.occlusion_texture, ColorSpace::Linear)?;
        added.occlusion_strength = material.occlusion_strength;
    }
    if base.is_none()
        && let Some(other) = added.textures().next()
    {
        added.sampler = other.sampler;
    }
    reader.tell_missing_coordinates();
    Ok(builder.material(added))
}

/// The greatest refractive index of scenes: it reflects nearly all light.
const TOTAL_IOR: f64 = 100.0;

/// Returns the reflection model. A body that lets all light pass and says nothing of what it reflects is clear glass, of
/// which Fresnel's share is known exactly; a colour would tint what that reflects, too.
fn model_of(material: &Material) -> model::Model {
    let is_clear =
        material.transmission >= 1.0 && material.metallic <= 0.0 && material.base_color.xyz() == DVec3::ONE;
    let reflects_by_itself = material.specular == 1.0 && material.specular_color == DVec3::ONE;
    let textures = [
        material.base_color_texture,
        material.metallic_roughness_texture,
        material.transmission_texture,
        material.specular_texture,
        material.specular_color_texture,
    ];
    if material.unlit {
        model::Model::PLAIN
    } else if is_clear && reflects_by_itself && textures.iter().all(Option::is_none) {
        model::Model::GLASS
    } else {
        model::Model::PHYSICAL
    }
}

/// Returns a texture's sampler as the specification of glTF has it: what is left open repeats and is trilinear.
fn spec(model: &Model, texture: &Texture) -> SamplerSpec {
    let found = texture.sampler.map(|index| model.samplers[index]).unwrap_or_default();
    let filter = |filter| basic_filter(filter == gltf::Weighting::Linear);
    let (min, between) = found.min.unwrap_or((gltf::Weighting::Linear, Some(gltf::Weighting::Linear)));
    SamplerSpec {
        address: found.wrap.map(|wrap| match wrap {
            Wrap::Repeat => Address::Repeat,
            Wrap::Mirror => Address::MirroredRepeat,
            Wrap::Clamp => Address::ClampToEdge,
        }),
        mag: filter(found.mag.unwrap_or(gltf::Weighting::Linear)),
        min: filter(min),
        mip: match between {
            None => MipMode::None,
            Some(gltf::Weighting::Nearest) => MipMode::Nearest,
            Some(gltf::Weighting::Linear) => MipMode::Linear,
        },
        ..SamplerSpec::default()
    }
}

struct Reader<'a> {
    path: &'a Path,
    model: &'a Model,
    builder: &'a mut SceneBuilder,
    material: &'a Material,
    notes: &'a mut MaterialNotes,
    sets: CoordinateSets<'a>,
}

impl Reader<'_> {
    fn note(&mut self, what: &str) {
        self.notes.add(what, self.model, self.material);
    }

    fn sampler(&mut self, texture: &Texture) -> usize {
        let spec = spec(self.model, texture);
        self.builder.sampler_like(spec)
    }

    /// Adds a texture, if there is one, as the material reads it.
    fn used(
        &mut self,
        reference: Option<TextureRef>,
        color_space: ColorSpace,
    ) -> Result<Option<TextureUse>, String> {
        let Some(reference) = reference else { return Ok(None) };
        let Some(texture) = self.texture(&reference, color_space)? else { return Ok(None) };
        let sampler = self.sampler(&self.model.textures[reference.texture]);
        Ok(Some(TextureUse {
            texture,
            sampler,
            second_uv: self.sets.is_second(&reference),
            own_uv: self.sets.own(&reference),
        }))
    }

    /// Adds a texture in the first of its formats that can be read.
    fn texture(&mut self, reference: &TextureRef, color_space: ColorSpace) -> Result<Option<usize>, String> {
        let texture = &self.model.textures[reference.texture];
        let Some(Chosen { index, content, note }) = images::chosen(self.path, self.model, texture)? else {
            let what = "a texture is left out: it has no image in a format that is read";
            self.note(&format!("{what} (/textures/{})", reference.texture));
            return Ok(None);
        };
        if let Some(note) = note {
            self.note(&note);
        }
        let image = &self.model.images[index];
        let file = match &image.content {
            Content::Path(file) => file,
            Content::Bytes(_) => "",
        };
        let names = [file, &image.name, &texture.name];
        let name = names.into_iter().find(|name| !name.is_empty());
        Ok(Some(self.builder.texture(TextureSource {
            name: name.map_or_else(|| format!("image {index}"), str::to_owned),
            content,
            dimension: Dimension::Two,
            color_space,
            color_space_stated: true,
            reading: ReadOptions {
                orientation: OrientationUse::Ignore,
                // glTF 2.0, 3.8.2: colour space information of PNG and JPEG files is ignored.
                color_profile: ProfileUse::Ignore,
                layer: None,
            },
            flip_v: false,
            mip_kernel: MipKernel::Auto,
        })))
    }

    /// Tells of meshes in this material without the coordinates at which it reads a texture.
    fn tell_missing_coordinates(&mut self) {
        let (model, material) = (self.model, self.material);
        let others = [
            material.normal_texture,
            material.metallic_roughness_texture,
            material.emissive_texture,
            material.occlusion_texture,
            material.specular_texture,
            material.specular_color_texture,
            material.transmission_texture,
        ];
        let others = others.into_iter().filter(|_| !material.unlit);
        let read: Vec<usize> =
            others.chain([material.base_color_texture]).flatten().map(|reference| reference.uv_set).collect();
        let worn = |index: usize| std::ptr::eq(&model.materials[index], material);
        let most = read.iter().copied().max().map_or(0, |most| most + 1);
        for set in (0..most).filter(|set| read.contains(set)) {
            let instances = model.instances.iter().filter(|instance| instance.material.is_some_and(worn));
            let mut meshes = instances.map(|instance| &model.primitives[instance.primitive]);
            if let Some(mesh) = meshes.find(|mesh| mesh.uvs.get(set).is_none_or(Vec::is_empty)) {
                let name =
                    if mesh.name.is_empty() { mesh.place.clone() } else { format!("mesh {:?}", mesh.name) };
                self.note(&format!("{name} has no TEXCOORD_{set}, so its texture is read at (0, 0)"));
            }
        }
    }
}
