//! Materials. Input: the file's list of them. Output: the factors and textures of the metallic and roughness model and
//! of those extensions that describe what is drawn, with the defaults of the specification where the file is silent.

use glam::{DVec2, DVec3, DVec4};

use super::attribute::MOST_SETS;
use super::document::Document;
use super::json::Json;
use super::notes::Notes;
use crate::mesh::Fault;

/// A material. The texture of a property multiplies its factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Empty if it has none.
    pub name: String,
    /// Linear colour and alpha.
    pub base_color: DVec4,
    /// In sRGB; alpha is linear.
    pub base_color_texture: Option<TextureRef>,
    /// 0 for a dielectric, 1 for a metal.
    pub metallic: f64,
    /// 0 for a mirror, 1 for matt.
    pub roughness: f64,
    /// Roughness in green, metallic in blue.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Normals in tangent space.
    pub normal_texture: Option<TextureRef>,
    /// Multiplies x and y of these normals.
    pub normal_scale: f64,
    /// Share of indirect light that arrives, in red.
    pub occlusion_texture: Option<TextureRef>,
    /// How much of this occlusion is applied.
    pub occlusion_strength: f64,
    /// Linear colour.
    pub emissive: DVec3,
    /// Multiplies the emission (KHR_materials_emissive_strength).
    pub emissive_strength: f64,
    /// In sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Whether back faces are seen.
    pub double_sided: bool,
    /// Whether the base colour is drawn as it is (KHR_materials_unlit).
    pub unlit: bool,
    /// Index of refraction (KHR_materials_ior); 0 stands for reflection of everything at grazing and head-on alike.
    pub ior: f64,
    /// Share of light that passes (KHR_materials_transmission).
    pub transmission: f64,
    /// In red.
    pub transmission_texture: Option<TextureRef>,
    /// Strength of dielectric reflection (KHR_materials_specular).
    pub specular: f64,
    /// In alpha.
    pub specular_texture: Option<TextureRef>,
    /// Linear colour of dielectric reflection head-on; it may exceed 1.
    pub specular_color: DVec3,
    /// In sRGB.
    pub specular_color_texture: Option<TextureRef>,
}

/// What alpha means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Nothing.
    Opaque,
    /// Whether there is a surface: where it is at least this.
    Mask(f64),
    /// How much the surface covers.
    Blend,
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index of the texture.
    pub texture: usize,
    /// Which set of texture coordinates; a primitive may lack it.
    pub uv_set: usize,
    /// What is done to texture coordinates first (KHR_texture_transform).
    pub transform: Option<TextureTransform>,
}

/// Scales texture coordinates, then rotates them, then adds the offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureTransform {
    /// Of the origin.
    pub offset: DVec2,
    /// In radians, as the file has it: u' = cos·u + sin·v, v' = cos·v − sin·u.
    pub rotation: f64,
    /// Along u and v.
    pub scale: DVec2,
}

impl Default for Material {
    fn default() -> Material {
        Material {
            name: String::new(),
            base_color: DVec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            occlusion_texture: None,
            occlusion_strength: 1.0,
            emissive: DVec3::ZERO,
            emissive_strength: 1.0,
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            unlit: false,
            ior: 1.5,
            transmission: 0.0,
            transmission_texture: None,
            specular: 1.0,
            specular_texture: None,
            specular_color: DVec3::ONE,
            specular_color_texture: None,
        }
    }
}

/// Reads all materials.
pub(super) fn materials(
    document: &Document,
    textures: usize,
    notes: &mut Notes,
) -> Result<Vec<Material>, Fault> {
    let mut reader = Reader { textures, notes };
    document.list("materials")?.elements().map(|element| reader.material(element?.json())).collect()
}

/// What reading a material needs.
struct Reader<'a> {
    /// Number of textures of the file.
    textures: usize,
    notes: &'a mut Notes,
}

impl Reader<'_> {
    /// Reads a material.
    fn material(&mut self, json: Json) -> Result<Material, Fault> {
        let mut material = Material {
            name: json.name()?,
            emissive: self.vector(json, "emissiveFactor", [0.0; 3], 1.0)?.into(),
            emissive_texture: self.texture(json, "emissiveTexture")?,
            normal_texture: self.texture(json, "normalTexture")?,
            occlusion_texture: self.texture(json, "occlusionTexture")?,
            alpha: self.alpha(json)?,
            double_sided: json.flag("doubleSided")?,
            unlit: json.extension("KHR_materials_unlit")?.is_some(),
            ..Material::default()
        };
        if let Some(normal) = json.object("normalTexture")? {
            material.normal_scale = normal.number("scale")?.unwrap_or(1.0);
        }
        if let Some(occlusion) = json.object("occlusionTexture")? {
            material.occlusion_strength = self.factor(occlusion, "strength", 1.0, 1.0)?;
        }
        if let Some(base) = json.object("pbrMetallicRoughness")? {
            material.base_color = self.vector(base, "baseColorFactor", [1.0; 4], 1.0)?.into();
            material.base_color_texture = self.texture(base, "baseColorTexture")?;
            material.metallic = self.factor(base, "metallicFactor", 1.0, 1.0)?;
            material.roughness = self.factor(base, "roughnessFactor", 1.0, 1.0)?;
            material.metallic_roughness_texture = self.texture(base, "metallicRoughnessTexture")?;
        }
        if let Some(strength) = json.extension("KHR_materials_emissive_strength")? {
            material.emissive_strength = self.factor(strength, "emissiveStrength", 1.0, f64::MAX)?;
        }
        if let Some(ior) = json.extension("KHR_materials_ior")? {
            let allowed = |ior| ior == 0.0 || ior >= 1.0;
            material.ior = ior.number_if("ior", "0 or at least 1", allowed)?.unwrap_or(1.5);
        }
        if let Some(transmission) = json.extension("KHR_materials_transmission")? {
            material.transmission = self.factor(transmission, "transmissionFactor", 0.0, 1.0)?;
            material.transmission_texture = self.texture(transmission, "transmissionTexture")?;
        }
        if let Some(specular) = json.extension("KHR_materials_specular")? {
            material.specular = self.factor(specular, "specularFactor", 1.0, 1.0)?;
            material.specular_texture = self.texture(specular, "specularTexture")?;
            material.specular_color =
                self.vector(specular, "specularColorFactor", [1.0; 3], f64::MAX)?.into();
            material.specular_color_texture = self.texture(specular, "specularColorTexture")?;
        }
        Ok(material)
    }

    /// Reads what alpha means.
    fn alpha(&mut self, json: Json) -> Result<AlphaMode, Fault> {
        match json.text("alphaMode")?.unwrap_or("OPAQUE") {
            "OPAQUE" => Ok(AlphaMode::Opaque),
            "MASK" => Ok(AlphaMode::Mask(self.factor(json, "alphaCutoff", 0.5, f64::MAX)?)),
            "BLEND" => Ok(AlphaMode::Blend),
            _ => Err(json.other_than("alphaMode", "OPAQUE, MASK and BLEND are allowed")),
        }
    }

    /// Reads a number from 0 to `most`; programs round, so one beyond is taken as the nearest.
    fn factor(&mut self, json: Json, key: &str, default: f64, most: f64) -> Result<f64, Fault> {
        let number = json.number(key)?.unwrap_or(default);
        Ok(self.clamped(json, key, number, most))
    }

    /// Reads numbers from 0 to `most`.
    fn vector<const N: usize>(
        &mut self,
        json: Json,
        key: &str,
        default: [f64; N],
        most: f64,
    ) -> Result<[f64; N], Fault> {
        let numbers = json.numbers(key)?.unwrap_or(default);
        Ok(numbers.map(|number| self.clamped(json, key, number, most)))
    }

    fn clamped(&mut self, json: Json, key: &str, number: f64, most: f64) -> f64 {
        let allowed = number.clamp(0.0, most);
        if allowed != number {
            let place = || json.get(key).unwrap_or(json).pointer();
            self.notes.add("factors of materials out of range are moved into it", place);
        }
        allowed
    }

    /// Reads a texture, if a member names one.
    fn texture(&mut self, json: Json, key: &str) -> Result<Option<TextureRef>, Fault> {
        let Some(json) = json.object(key)? else {
            return Ok(None);
        };
        let texture = json.needed("index", json.index("index", self.textures, "textures")?)?;
        let mut uv_set = json.whole("texCoord")?;
        let mut transform = None;
        if let Some(json) = json.extension("KHR_texture_transform")? {
            uv_set = json.whole("texCoord")?.or(uv_set);
            transform = Some(TextureTransform {
                offset: json.numbers("offset")?.unwrap_or([0.0; 2]).into(),
                rotation: json.number("rotation")?.unwrap_or(0.0),
                scale: json.numbers("scale")?.unwrap_or([1.0; 2]).into(),
            });
        }
        let uv_set = uv_set.unwrap_or(0);
        if uv_set >= MOST_SETS {
            self.notes
                .add("textures use coordinates beyond TEXCOORD_7, which are ignored", || json.pointer());
        }
        Ok(Some(TextureRef { texture, uv_set, transform }))
    }
}
