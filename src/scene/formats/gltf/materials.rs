//! Materials of a glTF file as materials of a scene. Input: the model and its folder. Output: the index of a material,
//! with its textures and samplers as the file has them; what is not drawn is told by its name, once for a material.

use std::path::{Path, PathBuf};

use glam::swizzles::Vec4Swizzles as _;
use glam::{DVec3, DVec4};

use crate::mesh::gltf::{self, AlphaMode, Content, Material, Model, Texture, TextureRef, Wrap};
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{self, BumpKind, BumpMap, Mapping};
use crate::texture::data::{ColorSpace, Dimension, MipKernel};
use crate::texture::formats::is_picture;
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec, basic_filter};
use crate::texture::source::{OrientationUse, ReadOptions, TextureContent, TextureSource};

/// Returns the texture whose coordinates are those of the material: the base colour's, else the normal map's.
pub(super) fn coordinates(material: &Material) -> Option<&TextureRef> {
    material.base_color_texture.as_ref().or(material.normal_texture.as_ref())
}

/// What is told about materials: the words, the first material of which they are true, and the number of these.
#[derive(Default)]
pub(in crate::scene::formats) struct MaterialNotes(Vec<(String, String, usize)>);

impl MaterialNotes {
    fn add(&mut self, what: &str, material: &Material) {
        match self.0.iter_mut().find(|(words, ..)| words == what) {
            Some((.., count)) => *count += 1,
            None => self.0.push((what.to_owned(), material.name.clone(), 1)),
        }
    }

    /// Returns one sentence for all materials of which the same is told.
    pub fn sentences(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(what, first, count)| match count {
            1 => format!("material {first:?}: {what}"),
            _ => format!("{count} materials, the first {first:?}: {what}"),
        })
    }
}

/// Adds a material; returns its index.
pub(in crate::scene::formats) fn add(
    path: &Path,
    found_in: &Model,
    material: &Material,
    builder: &mut SceneBuilder,
    notes: &mut MaterialNotes,
) -> usize {
    let mut reader = Reader { path, model: found_in, builder, material, notes };
    let mut added = model::Material {
        name: material.name.clone(),
        color: material.base_color.xyz().max(DVec3::ZERO),
        ..model::Material::default()
    };
    if material.unlit {
        added.model = model::Model::PLAIN;
    }
    added.texture =
        material.base_color_texture.and_then(|reference| reader.texture(&reference, ColorSpace::Srgb));
    if let Some(reference) = material.normal_texture.filter(|_| !material.unlit) {
        // Green of glTF points along the bitangent, which is against v.
        let texture = reader.texture(&reference, ColorSpace::Linear);
        added.bump = texture.map(|texture| BumpMap {
            kind: BumpKind::NormalDown,
            texture,
            strength: material.normal_scale,
        });
        if material.base_color_texture.is_some_and(|base| !same_lookup(found_in, &base, &reference)) {
            reader.note("its normal map is read with the coordinates and the sampler of its base colour");
        }
    }
    if let Some(reference) = coordinates(material) {
        added.sampler = reader.sampler(&found_in.textures[reference.texture]);
        added.mapping = Mapping::default();
    }
    reader.tell_what_is_left_out();
    builder.material(added)
}

/// Returns whether two textures are read alike.
fn same_lookup(model: &Model, a: &TextureRef, b: &TextureRef) -> bool {
    let sampler = |reference: &TextureRef| spec(model, &model.textures[reference.texture]);
    a.uv_set == b.uv_set && a.transform == b.transform && sampler(a) == sampler(b)
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
}

impl Reader<'_> {
    fn note(&mut self, what: &str) {
        self.notes.add(what, self.material);
    }

    fn sampler(&mut self, texture: &Texture) -> usize {
        let spec = spec(self.model, texture);
        self.builder.sampler_like(spec)
    }

    /// Adds a texture in the first of its formats that can be read.
    fn texture(&mut self, reference: &TextureRef, color_space: ColorSpace) -> Option<usize> {
        let texture = &self.model.textures[reference.texture];
        let mut images = texture.sources.iter().map(|&index| (index, &self.model.images[index]));
        let Some((index, image)) = images.find(|(_, image)| is_readable(&image.content)) else {
            let formats: Vec<&str> = texture
                .sources
                .iter()
                .filter_map(|&index| self.model.images[index].mime.as_deref())
                .collect();
            self.note(&format!(
                "a texture is left out: its images are none that can be read ({})",
                if formats.is_empty() {
                    "no PNG, JPEG, WebP, KTX2 or DDS".into()
                } else {
                    formats.join(", ")
                }
            ));
            return None;
        };
        let content = match &image.content {
            Content::Path(file) => {
                TextureContent::File(self.path.parent().unwrap_or(Path::new("")).join(file))
            }
            Content::Bytes(bytes) => {
                let label = PathBuf::from(format!("{} (image {index})", self.path.display()));
                TextureContent::Embedded(label, bytes.clone())
            }
        };
        let name = [&texture.name, &image.name].into_iter().find(|name| !name.is_empty());
        Some(self.builder.texture(TextureSource {
            name: name.cloned().unwrap_or_else(|| format!("image {index}")),
            content,
            dimension: Dimension::Two,
            color_space,
            color_space_stated: true,
            reading: ReadOptions { orientation: OrientationUse::Ignore, layer: None },
            flip_v: false,
            mip_kernel: MipKernel::Box,
        }))
    }

    fn tell_what_is_left_out(&mut self) {
        let material = self.material;
        let mut left: Vec<&str> = Vec::new();
        let mut tell = |is_used: bool, what| {
            if is_used {
                left.push(what);
            }
        };
        tell(!material.unlit && material.metallic > 0.0, "metallic (all of it is diffuse)");
        tell(material.metallic_roughness_texture.is_some(), "the texture of metallic and roughness");
        tell(material.occlusion_texture.is_some(), "occlusion");
        tell(material.emissive != DVec3::ZERO, "emission");
        tell(material.transmission > 0.0, "transmission");
        tell(matches!(material.alpha, AlphaMode::Mask(_)), "the mask of alpha");
        tell(matches!(material.alpha, AlphaMode::Blend), "the blending of alpha");
        let color: DVec4 = material.base_color;
        tell(material.alpha != AlphaMode::Opaque && color.w < 1.0, "the factor of alpha");
        if !left.is_empty() {
            let left = left.join(", ");
            self.note(&format!("not drawn: {left}"));
        }
    }
}

/// Returns whether an image is in a format that textures may have; of a file that is not opened yet its ending tells.
fn is_readable(content: &Content) -> bool {
    match content {
        Content::Bytes(bytes) => is_picture(bytes),
        Content::Path(path) => !path.to_lowercase().ends_with(".basis"),
    }
}
