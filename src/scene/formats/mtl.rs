//! Materials of MTL libraries as materials of a scene. Input: the statements of a library. Output: lambert, or phong where
//! it has a highlight; textures are colours (sRGB) that repeat and are read trilinearly.

use std::path::Path;

use glam::{DVec2, DVec3};

use crate::mesh::mtl::{MtlMap, MtlMaterial};
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{BumpKind, BumpMap, Mapping, Material, Model};
use crate::texture::data::{ColorSpace, Dimension, MipKernel};
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec};
use crate::texture::source::{ReadOptions, TextureContent, TextureSource};

/// `illum` from this number on has a highlight.
const HIGHLIGHT: u32 = 2;

/// A library whose materials are added to a scene.
pub(super) struct Library<'a> {
    folder: &'a Path,
    builder: &'a mut SceneBuilder,
    /// Textures that were added: file, whether it holds colours, index.
    textures: Vec<(String, bool, usize)>,
    /// Samplers that were added, which repeat and which clamp.
    samplers: [Option<usize>; 2],
}

impl<'a> Library<'a> {
    pub fn new(path: &'a Path, builder: &'a mut SceneBuilder) -> Library<'a> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Library { folder, builder, textures: Vec::new(), samplers: [None; 2] }
    }

    /// Adds a material; returns its index.
    pub fn add(&mut self, found: &MtlMaterial) -> usize {
        let mut material = Material { name: found.name.clone(), ..Material::default() };
        let color = |rgb: Option<[f64; 3]>| rgb.map(|rgb| DVec3::from_array(rgb).max(DVec3::ZERO));
        material.color = color(found.diffuse).unwrap_or(material.color);
        let specular = color(found.specular).filter(|specular| *specular != DVec3::ZERO);
        if let Some(specular) = specular.filter(|_| found.illumination.is_some_and(|i| i >= HIGHLIGHT)) {
            material.model = Model::HIGHLIGHTED;
            material.specular = specular;
            material.exponent = found.exponent.unwrap_or(material.exponent).clamp(1.0, 1e6);
        }
        let bump = match (&found.normal_map, &found.bump_map) {
            (Some(map), _) => Some((map, BumpKind::Normal)),
            (None, Some(map)) => Some((map, BumpKind::Bump)),
            (None, None) => None,
        };
        if let Some((map, kind)) = bump {
            let texture = self.texture(map, false);
            material.bump = Some(BumpMap {
                kind,
                texture,
                strength: map.strength.unwrap_or(1.0),
                sampler: None,
                second_uv: false,
            });
        }
        if let Some(map) = &found.diffuse_map {
            // Many exporters write black beside a texture, and mean the texture.
            if material.color == DVec3::ZERO {
                material.color = DVec3::ONE;
            }
            material.texture = Some(self.texture(map, true));
        }
        if let Some(map) = found.diffuse_map.as_ref().or(bump.map(|(map, _)| map)) {
            material.sampler = self.sampler(map.clamp);
            material.mapping = mapping(map);
        }
        self.builder.material(material)
    }

    fn texture(&mut self, map: &MtlMap, is_color: bool) -> usize {
        let known = self.textures.iter().find(|(file, color, _)| *file == map.file && *color == is_color);
        if let Some(&(.., index)) = known {
            return index;
        }
        let index = self.builder.texture(TextureSource {
            name: map.file.clone(),
            content: TextureContent::flat_file(self.folder.join(&map.file)),
            dimension: Dimension::Two,
            color_space: if is_color { ColorSpace::Srgb } else { ColorSpace::Linear },
            color_space_stated: true,
            reading: ReadOptions::default(),
            flip_v: false,
            mip_kernel: MipKernel::Box,
        });
        self.textures.push((map.file.clone(), is_color, index));
        index
    }

    fn sampler(&mut self, clamp: bool) -> usize {
        let address = [if clamp { Address::ClampToEdge } else { Address::Repeat }; 2];
        let spec = SamplerSpec { address, mip: MipMode::Linear, ..SamplerSpec::default() };
        let builder = &mut *self.builder;
        *self.samplers[usize::from(clamp)].get_or_insert_with(|| builder.sampler(spec))
    }
}

/// Returns scale and offset of coordinates whose v grows upwards, for one that grows downwards:
/// 1 - (s v + o) = s (1 - v) + 1 - s - o.
fn mapping(map: &MtlMap) -> Mapping {
    let ([scale_u, scale_v], [offset_u, offset_v]) = (map.scale, map.offset);
    Mapping {
        scale: DVec2::new(scale_u, scale_v),
        offset: DVec2::new(offset_u, 1.0 - scale_v - offset_v),
        ..Mapping::default()
    }
}
