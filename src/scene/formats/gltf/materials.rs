//! Materials of a glTF file as materials of a scene. Input: the model and its folder. Output: the index of a material,
//! with its textures and samplers as the file has them; what is not drawn is told by its name, once for a material.

use std::path::{Path, PathBuf};

use glam::DVec3;
use glam::swizzles::Vec4Swizzles as _;

use crate::mesh::gltf::{self, Content, Material, Model, Texture, TextureRef, Wrap};
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{self, AlphaMode, BumpKind, BumpMap, Sides, TextureUse};
use crate::texture::data::{ColorSpace, Dimension, MipKernel};
use crate::texture::formats::is_picture;
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec, basic_filter};
use crate::texture::source::{OrientationUse, ReadOptions, TextureContent, TextureSource};

/// The coordinates at which a material reads its textures: those of its first texture, and the first others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CoordinateSets<'a> {
    pub first: Option<&'a TextureRef>,
    pub second: Option<&'a TextureRef>,
}

impl CoordinateSets<'_> {
    pub fn of(material: &Material) -> CoordinateSets<'_> {
        let read = [
            &material.base_color_texture,
            &material.normal_texture,
            &material.metallic_roughness_texture,
            &material.emissive_texture,
            &material.occlusion_texture,
            &material.specular_texture,
            &material.specular_color_texture,
        ];
        let read = || read.into_iter().flatten();
        let first = read().next();
        let second = read().find(|other| first.is_some_and(|first| !is_alike(first, other)));
        CoordinateSets { first, second }
    }

    /// Returns whether a texture is read at the second coordinates.
    pub fn is_second(&self, reference: &TextureRef) -> bool {
        self.second.is_some_and(|second| is_alike(second, reference))
    }

    fn has(&self, reference: &TextureRef) -> bool {
        [self.first, self.second].into_iter().flatten().any(|known| is_alike(known, reference))
    }
}

impl PartialEq for CoordinateSets<'_> {
    fn eq(&self, other: &Self) -> bool {
        let read = |set: Option<&TextureRef>| set.map_or((0, None), |set| (set.uv_set, set.transform));
        let are = |sets: &Self| (read(sets.first), sets.second.map(|set| read(Some(set))));
        are(self) == are(other)
    }
}

/// Returns whether two textures are read at the same coordinates.
fn is_alike(a: &TextureRef, b: &TextureRef) -> bool {
    a.uv_set == b.uv_set && a.transform == b.transform
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
    let base = material.base_color_texture.and_then(|found| reader.used(&found, ColorSpace::Srgb));
    if let Some(base) = base {
        (added.texture, added.sampler, added.second_uv) = (Some(base.texture), base.sampler, base.second_uv);
    }
    if !material.unlit {
        let normal = material.normal_texture.and_then(|found| reader.used(&found, ColorSpace::Linear));
        // Green of glTF points along the bitangent, which is against v.
        added.bump = normal.map(|normal| BumpMap {
            kind: BumpKind::NormalDown,
            texture: normal.texture,
            strength: material.normal_scale,
            sampler: Some(normal.sampler),
            second_uv: normal.second_uv,
        });
        if added.model.is_glossy() {
            let map = material.metallic_roughness_texture;
            added.metallic_roughness_map = map.and_then(|found| reader.used(&found, ColorSpace::Linear));
            added.specular_weight_map =
                material.specular_texture.and_then(|found| reader.used(&found, ColorSpace::Linear));
            added.specular_tint_map =
                material.specular_color_texture.and_then(|found| reader.used(&found, ColorSpace::Srgb));
        }
        added.emission = material.emissive * material.emissive_strength;
        added.emission_map =
            material.emissive_texture.and_then(|found| reader.used(&found, ColorSpace::Srgb));
        added.occlusion_map =
            material.occlusion_texture.and_then(|found| reader.used(&found, ColorSpace::Linear));
        added.occlusion_strength = material.occlusion_strength;
    }
    if base.is_none()
        && let Some(other) = added.textures().next()
    {
        added.sampler = other.sampler;
    }
    reader.tell_missing_coordinates();
    reader.tell_what_is_left_out();
    builder.material(added)
}

/// The greatest refractive index of scenes: it reflects nearly all light.
const TOTAL_IOR: f64 = 100.0;

/// Returns the reflection model: most of the light passes glass, and nothing else.
fn model_of(material: &Material) -> model::Model {
    if material.unlit {
        model::Model::PLAIN
    } else if material.transmission > 0.5 {
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
        self.notes.add(what, self.material);
    }

    fn sampler(&mut self, texture: &Texture) -> usize {
        let spec = spec(self.model, texture);
        self.builder.sampler_like(spec)
    }

    /// Adds a texture as the material reads it.
    fn used(&mut self, reference: &TextureRef, color_space: ColorSpace) -> Option<TextureUse> {
        if !self.sets.has(reference) {
            self.note("more than two sets of texture coordinates; the others are read as the first");
        }
        let texture = self.texture(reference, color_space)?;
        let sampler = self.sampler(&self.model.textures[reference.texture]);
        Some(TextureUse { texture, sampler, second_uv: self.sets.is_second(reference) })
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
        let file = match &image.content {
            Content::Path(file) => file,
            Content::Bytes(_) => "",
        };
        let names = [file, &image.name, &texture.name];
        let name = names.into_iter().find(|name| !name.is_empty());
        Some(self.builder.texture(TextureSource {
            name: name.map_or_else(|| format!("image {index}"), str::to_owned),
            content,
            dimension: Dimension::Two,
            color_space,
            color_space_stated: true,
            reading: ReadOptions { orientation: OrientationUse::Ignore, layer: None },
            flip_v: false,
            mip_kernel: MipKernel::Box,
        }))
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
        ];
        let others = others.into_iter().filter(|_| !material.unlit);
        let read: Vec<usize> =
            others.chain([material.base_color_texture]).flatten().map(|reference| reference.uv_set).collect();
        let worn = |index: usize| std::ptr::eq(&model.materials[index], material);
        for set in (0..2).filter(|set| read.contains(set)) {
            let instances = model.instances.iter().filter(|instance| instance.material.is_some_and(worn));
            let mut meshes = instances.map(|instance| &model.primitives[instance.primitive]);
            if let Some(mesh) = meshes.find(|mesh| mesh.uvs[set].is_empty()) {
                let name =
                    if mesh.name.is_empty() { "a mesh".into() } else { format!("mesh {:?}", mesh.name) };
                self.note(&format!("{name} has no TEXCOORD_{set}, so its texture is read at (0, 0)"));
            }
        }
    }

    fn tell_what_is_left_out(&mut self) {
        let material = self.material;
        let mut left: Vec<&str> = Vec::new();
        let mut tell = |is_used: bool, what| {
            if is_used {
                left.push(what);
            }
        };
        let transmits = material.transmission > 0.0;
        tell(transmits && material.transmission <= 0.5, "transmission of half the light or less");
        tell(transmits && material.transmission_texture.is_some(), "the texture of transmission");
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
