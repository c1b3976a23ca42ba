//! Materials of MTL libraries as materials of a scene. Input: the statements of a library. Output: lambert, or phong where
//! it has a highlight, with what it emits and its opacity; textures are colours (sRGB) that repeat and are read
//! trilinearly. Pictures lie in the folder of the model.

use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3};

use crate::core::error::{Error, ErrorKind, Result};
use crate::mesh::mtl::{MtlMap, MtlMaterial};
use crate::mesh::relative::inside;
use crate::scene::builder::SceneBuilder;
use crate::scene::model::{AlphaMode, BumpKind, BumpMap, Mapping, Material, Model, TextureUse};
use crate::texture::data::{ColorSpace, Dimension, MipKernel};
use crate::texture::open_file::check_file;
use crate::texture::sampler_spec::{Address, MipMode, SamplerSpec};
use crate::texture::source::{ReadOptions, TextureContent, TextureSource};

/// `illum` from this number on has a highlight.
const HIGHLIGHT: u32 = 2;

/// A library whose materials are added to a scene.
pub(super) struct Library<'a> {
    path: &'a Path,
    /// Its folder, from that of the model.
    within: &'a Path,
    /// The folder of the model.
    folder: &'a Path,
    builder: &'a mut SceneBuilder,
    /// Textures that were added: file, whether it holds colours, index.
    textures: Vec<(String, bool, usize)>,
    /// Samplers that were added, which repeat and which clamp.
    samplers: [Option<usize>; 2],
}

impl<'a> Library<'a> {
    /// Opens the library of a model; `name`: its path from the folder of the model.
    pub fn new(
        folder: &'a Path,
        name: &'a str,
        path: &'a Path,
        builder: &'a mut SceneBuilder,
    ) -> Library<'a> {
        let within = Path::new(name).parent().unwrap_or(Path::new(""));
        Library { path, within, folder, builder, textures: Vec::new(), samplers: [None; 2] }
    }

    /// Adds a material; returns its index.
    pub fn add(&mut self, found: &MtlMaterial) -> Result<usize> {
        let mut material = Material { name: found.name.clone(), ..Material::default() };
        let color = |rgb: Option<[f64; 3]>| rgb.map(|rgb| DVec3::from_array(rgb).max(DVec3::ZERO));
        material.color = color(found.diffuse).unwrap_or(material.color);
        let specular = color(found.specular).filter(|specular| *specular != DVec3::ZERO);
        if let Some(specular) = specular.filter(|_| found.illumination.is_some_and(|i| i >= HIGHLIGHT)) {
            material.model = Model::HIGHLIGHTED;
            material.specular = specular;
            material.exponent = found.exponent.unwrap_or(material.exponent).clamp(1.0, 1e6);
        }
        material.emission = color(found.emission).unwrap_or(material.emission);
        material.opacity = found.opacity.unwrap_or(1.0);
        let bump = match (&found.normal_map, &found.bump_map) {
            (Some(map), _) => Some((map, BumpKind::Normal)),
            (None, Some(map)) => Some((map, BumpKind::Bump)),
            (None, None) => None,
        };
        if let Some((map, kind)) = bump {
            let texture = self.texture(map, false)?;
            material.bump = Some(BumpMap {
                kind,
                texture,
                strength: map.strength.unwrap_or(1.0),
                sampler: None,
                second_uv: false,
                own_uv: None,
            });
        }
        if found.diffuse_map.is_some() {
            // Many exporters write black beside a texture, and mean the texture.
            if material.color == DVec3::ZERO {
                material.color = DVec3::ONE;
            }
        }
        material.texture = match (&found.diffuse_map, &found.opacity_map) {
            (color, Some(opacity)) => Some(self.with_opacity(color.as_ref(), opacity)?),
            (Some(color), None) => Some(self.texture(color, true)?),
            (None, None) => None,
        };
        if material.opacity < 1.0 || found.opacity_map.is_some() {
            material.alpha = AlphaMode::Blend;
        }
        let maps = [&found.diffuse_map, &found.opacity_map, &found.emission_map].into_iter().flatten();
        if let Some(map) = maps.chain(bump.map(|(map, _)| map)).next() {
            material.sampler = self.sampler(map.clamp);
            material.mapping = mapping(map);
        }
        if let Some(map) = &found.emission_map {
            if material.emission == DVec3::ZERO {
                material.emission = DVec3::ONE;
            }
            let texture = self.texture(map, true)?;
            material.emission_map = Some(TextureUse {
                texture,
                sampler: self.sampler(map.clamp),
                second_uv: false,
                own_uv: None,
            });
        }
        for note in &found.notes {
            self.builder.note(format!("{}: {note}", self.path.display()));
        }
        Ok(self.builder.material(material))
    }

    /// Adds a picture, which has to be in the folder of the model, or below it.
    fn texture(&mut self, map: &MtlMap, is_color: bool) -> Result<usize> {
        let known = self.textures.iter().find(|(file, color, _)| *file == map.file && *color == is_color);
        if let Some(&(.., index)) = known {
            return Ok(index);
        }
        let content = TextureContent::flat_file(self.file(map)?);
        let index = self.source(map, content, is_color);
        self.textures.push((map.file.clone(), is_color, index));
        Ok(index)
    }

    fn source(&mut self, map: &MtlMap, content: TextureContent, is_color: bool) -> usize {
        self.builder.texture(TextureSource {
            name: map.file.clone(),
            content,
            dimension: Dimension::Two,
            color_space: if is_color { ColorSpace::Srgb } else { ColorSpace::Linear },
            color_space_stated: true,
            reading: ReadOptions::default(),
            flip_v: false,
            mip_kernel: MipKernel::Auto,
        })
    }

    /// Adds the picture of the colours, white without one, with the opacity of another one. A picture that is both has
    /// its own.
    fn with_opacity(&mut self, color: Option<&MtlMap>, opacity: &MtlMap) -> Result<usize> {
        if let Some(color) = color.filter(|color| color.file == opacity.file) {
            return self.texture(color, true);
        }
        let content = TextureContent::Cutout {
            color: color.map(|map| self.file(map)).transpose()?,
            opacity: self.file(opacity)?,
        };
        Ok(self.source(color.unwrap_or(opacity), content, true))
    }

    /// Returns the path of a picture that exists, or of one in tiles.
    fn file(&self, map: &MtlMap) -> Result<PathBuf> {
        let written = self.within.join(&map.file).to_string_lossy().into_owned();
        let inside = inside(&written).map_err(|why| self.fault(map, &format!("{:?} {why}", map.file)))?;
        let file = self.folder.join(inside);
        if let TextureContent::File(file) = TextureContent::flat_file(file.clone()) {
            check_file(&file).map_err(|error| {
                let help = error.help().map(str::to_owned);
                self.fault(map, &error.to_string()).and_help(help)
            })?;
        }
        Ok(file)
    }

    fn fault(&self, map: &MtlMap, what: &str) -> Error {
        let place = if map.line > 0 { format!("line {}", map.line) } else { "its texture".into() };
        let what = format!("{}: {place}: {what}", self.path.display());
        Error::new(what).of_kind(ErrorKind::File)
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
