//! Materials of MTL libraries as materials of a scene. Input: the statements of a library. Output: lambert, phong where it
//! has a highlight, glass, or metallic-roughness where a program wrote physically based statements, with what it emits and
//! its opacity; textures are colours (sRGB) that repeat and are read trilinearly. Pictures lie in the folder of the model.

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
/// Numbers of `illum` with refraction, and with glass unless `d` says that nothing passes.
const REFRACTION: [u32; 2] = [6, 7];
const GLASS: [u32; 2] = [4, 9];

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
        if is_physical(found) {
            self.physical(found, &mut material)?;
        }
        if is_glass(found) {
            material.model = Model::GLASS;
            material.color = color(found.filter).unwrap_or(DVec3::ONE);
            material.ior = found.ior.unwrap_or(material.ior).clamp(0.01, 100.0);
            material.roughness = found.roughness.unwrap_or(0.0).clamp(0.0, 1.0);
            material.metallic_roughness_map = None;
        } else {
            self.covered(found, &mut material)?;
        }
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
        if let Some(map) = first_map(found, bump.map(|(map, _)| map)) {
            material.sampler = self.sampler(map.clamp);
            material.mapping = mapping(map);
        }
        if let Some(map) = &found.emission_map {
            if material.emission == DVec3::ZERO {
                material.emission = DVec3::ONE;
            }
            material.emission_map = Some(self.used(map, true)?);
        }
        for note in &found.notes {
            self.builder.note(format!("{}: {note}", self.path.display()));
        }
        Ok(self.builder.material(material))
    }

    /// Applies its texture and its opacity.
    fn covered(&mut self, found: &MtlMaterial, material: &mut Material) -> Result<()> {
        // Many exporters write black beside a texture, and mean the texture.
        if found.diffuse_map.is_some() && material.color == DVec3::ZERO {
            material.color = DVec3::ONE;
        }
        material.texture = match (&found.diffuse_map, &found.opacity_map) {
            (color, Some(opacity)) => Some(self.with_opacity(color.as_ref(), opacity)?),
            (Some(color), None) => Some(self.texture(color, true)?),
            (None, None) => None,
        };
        material.opacity = found.opacity.unwrap_or(1.0);
        if material.opacity < 1.0 || found.opacity_map.is_some() {
            material.alpha = AlphaMode::Blend;
        }
        Ok(())
    }

    /// Applies the statements of physically based materials.
    fn physical(&mut self, found: &MtlMaterial, material: &mut Material) -> Result<()> {
        let factor = |number: Option<f64>, map: &Option<MtlMap>, absent: f64| {
            number.unwrap_or(if map.is_some() { 1.0 } else { absent }).clamp(0.0, 1.0)
        };
        material.model = Model::PHYSICAL;
        material.metallic = factor(found.metallic, &found.metallic_map, 0.0);
        // A highlight of this exponent is as wide as facets of roughness² = √(2 / (n + 2)).
        let by_exponent = found.exponent.map_or(1.0, |n| (2.0 / (n.max(0.0) + 2.0)).powf(0.25));
        material.roughness = factor(found.roughness, &found.roughness_map, by_exponent);
        // Programs write 1 where nothing is known.
        if let Some(ior) = found.ior.filter(|ior| *ior > 1.0) {
            material.ior = ior.min(100.0);
        }
        // The line at which a texture is named does not make it another one.
        let is_same = |a: &MtlMap, b: &MtlMap| *a == MtlMap { line: a.line, ..b.clone() };
        let rough = found.roughness_map.as_ref();
        let metal = found.metallic_map.as_ref();
        // One texture has both, in green and blue; a grey one is as good for what is not 0.
        let map = match (rough, metal) {
            (Some(rough), Some(metal)) if is_same(rough, metal) => Some(rough),
            (Some(rough), None) if material.metallic == 0.0 => Some(rough),
            (None, Some(metal)) if material.roughness == 0.0 => Some(metal),
            (None, None) => None,
            _ => {
                self.builder.note(format!(
                    "material {:?}: map_Pr and map_Pm are left out, as they are not one texture with roughness in green \
                     and metallic in blue",
                    found.name
                ));
                None
            }
        };
        material.metallic_roughness_map = map.map(|map| self.used(map, false)).transpose()?;
        Ok(())
    }

    /// Adds a picture with the sampler by which it is read.
    fn used(&mut self, map: &MtlMap, is_color: bool) -> Result<TextureUse> {
        let texture = self.texture(map, is_color)?;
        Ok(TextureUse { texture, sampler: self.sampler(map.clamp), second_uv: false, own_uv: None })
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

/// Returns the map whose scale, offset and clamping are those of the material: the first that is drawn.
fn first_map<'a>(found: &'a MtlMaterial, bump: Option<&'a MtlMap>) -> Option<&'a MtlMap> {
    let MtlMaterial { diffuse_map, opacity_map, emission_map, roughness_map, metallic_map, .. } = found;
    let covering = |map: &'a Option<MtlMap>| map.as_ref().filter(|_| !is_glass(found));
    let first = [covering(diffuse_map), covering(opacity_map), emission_map.as_ref(), bump];
    first.into_iter().chain([covering(roughness_map), covering(metallic_map)]).flatten().next()
}

/// Returns whether a program wrote statements of physically based materials.
fn is_physical(found: &MtlMaterial) -> bool {
    let numbers = found.roughness.is_some() || found.metallic.is_some();
    numbers || found.roughness_map.is_some() || found.metallic_map.is_some()
}

/// Returns whether light passes the surface and is refracted.
fn is_glass(found: &MtlMaterial) -> bool {
    let passes = found.opacity.is_none_or(|covered| covered < 1.0);
    found.illumination.is_some_and(|i| REFRACTION.contains(&i) || passes && GLASS.contains(&i))
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
