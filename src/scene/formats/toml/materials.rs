//! Reads `[[material]]` and its mapping. Input: the table, and the names of textures and samplers. Output: a
//! material.

use glam::{DVec2, DVec3};
use toml::de::DeValue;

use super::reader::Field;
use super::samplers::Known;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::bsdf::{KEYS, ModelKey, Value};
use crate::scene::model::DEFAULT;
use crate::scene::model::*;

pub(super) const MATERIAL: &[&str] = &[
    "name",
    "model",
    "color",
    "texture",
    "sampler",
    "mapping",
    "normal_map",
    "bump_map",
    "green",
    "strength",
    "specular",
    "exponent",
    "ior",
    "roughness",
    "metallic",
    "metallic_roughness_map",
    "specular_weight",
    "specular_weight_map",
    "specular_tint",
    "specular_tint_map",
    "transmission",
    "transmission_texture",
    "emission",
    "emission_map",
    "occlusion_map",
    "occlusion_strength",
    "alpha",
    "alpha_cutoff",
    "opacity",
    "sides",
];
pub(super) const MAPPING: &[&str] =
    &["kind", "entity", "space", "origin", "axis", "scale", "offset", "rotate"];
/// Keys of the frame, which only projecting mappings have.
const FRAME: [&str; 4] = ["origin", "axis", "space", "entity"];

pub(super) fn material(table: &Table<'_>, known: &Known<'_, '_>) -> Result<Material> {
    let name = table.required("name")?.string()?.to_owned();
    let mut material = Material { name, ..Material::default() };
    if let Some(field) = table.get("model") {
        material.model = field.choice(Model::NAMES, Model::ALL)?;
    }
    if let Some(field) = table.get("color") {
        material.color = field.vec3()?;
    }
    material.sampler = table.get("sampler").map_or(Ok(DEFAULT), |field| known.samplers.resolve(field))?;
    read_model_keys(table, known, &mut material)?;
    material.texture = table.get("texture").map(|field| known.textures.resolve(field)).transpose()?;
    material.bump = bump(table, known)?;
    read_emission(table, known, &mut material)?;
    read_alpha(table, &mut material)?;
    if let Some(field) = table.get("mapping") {
        material.mapping = mapping(&Table::inline(field, "material.mapping", MAPPING)?)?;
    }
    Ok(material)
}

/// Reads a map that has the material's sampler.
fn map(field: Field<'_>, known: &Known<'_, '_>, material: &Material) -> Result<TextureUse> {
    let texture = known.textures.resolve(field)?;
    Ok(TextureUse { texture, sampler: material.sampler, second_uv: false, own_uv: None })
}

/// Reads what a material emits, and what keeps the environment's light from it. A map alone is not multiplied.
fn read_emission(table: &Table<'_>, known: &Known<'_, '_>, material: &mut Material) -> Result<()> {
    if let Some(field) = table.get("emission_map") {
        material.emission_map = Some(map(field, known, material)?);
        material.emission = DVec3::ONE;
    }
    if let Some(field) = table.get("emission") {
        material.emission = field.vec3()?;
    }
    let strength = table.get("occlusion_strength");
    match (table.get("occlusion_map"), strength) {
        (Some(field), _) => material.occlusion_map = Some(map(field, known, material)?),
        (None, Some(field)) => return Err(field.error("this needs an occlusion_map beside it", "no map")),
        (None, None) => {}
    }
    if let Some(field) = strength {
        material.occlusion_strength = field.number()?;
    }
    Ok(())
}

/// Reads the meaning of alpha, and the sides from which the surface is seen.
fn read_alpha(table: &Table<'_>, material: &mut Material) -> Result<()> {
    if let Some(field) = table.get("alpha") {
        material.alpha = field.choice(AlphaMode::NAMES, AlphaMode::ALL)?;
    }
    if let Some(field) = table.get("alpha_cutoff") {
        if material.alpha != AlphaMode::Mask {
            return Err(field.error("this needs alpha = \"mask\" beside it", "no mask"));
        }
        material.alpha_cutoff = field.number()?;
    }
    if let Some(field) = table.get("opacity") {
        if material.alpha == AlphaMode::Opaque {
            return Err(field.error("this needs alpha = \"blend\" or \"mask\" beside it", "opaque"));
        }
        material.opacity = field.number()?;
    }
    if let Some(field) = table.get("sides") {
        material.sides = field.choice(Sides::NAMES, Sides::ALL)?;
    }
    Ok(())
}

/// Reads the keys of the material's model.
fn read_model_keys(table: &Table<'_>, known: &Known<'_, '_>, material: &mut Material) -> Result<()> {
    if material.model.has_key("metallic_roughness_map") && table.get("metallic_roughness_map").is_some() {
        (material.metallic, material.roughness) = (1.0, 1.0);
    }
    if material.model.has_key("transmission_texture") && table.get("transmission_texture").is_some() {
        material.transmission = 1.0;
    }
    for ModelKey { name, value, .. } in KEYS {
        let Some(field) = table.get(name) else { continue };
        if !material.model.has_key(name) {
            let models: Vec<Model> = Model::ALL.iter().copied().filter(|model| model.has_key(name)).collect();
            let quoted =
                |between| models.iter().map(|m| format!("\"{m}\"")).collect::<Vec<_>>().join(between);
            let (noun, verb) = if models.len() > 1 { ("models", "have") } else { ("model", "has") };
            let what =
                format!("only {noun} {} {verb} {name}; this one is \"{}\"", quoted(" and "), material.model);
            return Err(field.error(&what, format!("needs model {}", quoted(" or "))));
        }
        match value {
            Value::Number(of) => *of(material) = field.number()?,
            Value::Color(of) => *of(material) = field.vec3()?,
            Value::Map(of) => *of(material) = Some(map(field, known, material)?),
        }
    }
    Ok(())
}

fn bump(table: &Table<'_>, known: &Known<'_, '_>) -> Result<Option<BumpMap>> {
    let (field, kind) = match (table.get("normal_map"), table.get("bump_map")) {
        (Some(_), Some(bump)) => {
            return Err(bump.error("normal_map is given too; keep one of the two", "excludes normal_map"));
        }
        (Some(field), None) => (field, BumpKind::Normal),
        (None, Some(field)) => (field, BumpKind::Bump),
        (None, None) => {
            return match (table.get("strength"), table.get("green")) {
                (Some(field), _) => {
                    Err(field.error("this needs a normal_map or a bump_map beside it", "no map"))
                }
                (_, Some(field)) => Err(field.error("this needs a normal_map beside it", "no normal map")),
                (None, None) => Ok(None),
            };
        }
    };
    let kind = match table.get("green") {
        Some(green) if kind == BumpKind::Bump => {
            return Err(green.error("a bump_map holds heights, which have no direction", "no normal map"));
        }
        Some(green) => match green.choice(Green::NAMES, Green::ALL)? {
            Green::Up => BumpKind::Normal,
            Green::Down => BumpKind::NormalDown,
        },
        None => kind,
    };
    let strength = table.get("strength").map_or(Ok(1.0), Field::number)?;
    Ok(Some(BumpMap {
        kind,
        texture: known.textures.resolve(field)?,
        strength,
        sampler: None,
        second_uv: false,
        own_uv: None,
    }))
}

fn mapping(table: &Table<'_>) -> Result<Mapping> {
    let mut mapping = Mapping::default();
    if let Some(field) = table.get("kind") {
        mapping.kind = field.choice(MappingKind::NAMES, MappingKind::ALL)?;
    }
    if mapping.kind == MappingKind::Surface
        && let Some(field) = FRAME.iter().find_map(|key| table.get(key))
    {
        let what = "kind \"surface\" uses the shape's own coordinates and has no frame; \
                    remove the key or choose kind planar, cylindrical, spherical, cube or solid";
        return Err(field.error(what, "not with kind \"surface\""));
    }
    if let Some(field) = table.get("entity") {
        mapping.entity = field.choice(Entity::NAMES, Entity::ALL)?;
    }
    if let Some(field) = table.get("space") {
        mapping.space = field.choice(Space::NAMES, Space::ALL)?;
    }
    if let Some(field) = table.get("origin") {
        mapping.origin = field.vec3()?;
        if mapping.entity.is_direction() {
            return Err(field.error(&no_place(mapping.entity), "a direction has no origin"));
        }
    }
    if let Some(field) = table.get("axis") {
        mapping.axis = field.vec3()?;
    }
    let solid = mapping.kind == MappingKind::Solid;
    if let Some(field) = table.get("scale") {
        match field.value() {
            DeValue::Array(_) if solid => {
                let [x, y, z] = field.numbers::<3>()?;
                (mapping.scale, mapping.scale_w) = (DVec2::new(x, y), z);
            }
            DeValue::Array(_) => mapping.scale = field.vec2()?,
            _ => {
                mapping.scale_w = field.number()?;
                mapping.scale = DVec2::splat(mapping.scale_w);
            }
        }
    }
    if let Some(field) = table.get("offset") {
        if solid {
            let [x, y, z] = field.numbers::<3>()?;
            (mapping.offset, mapping.offset_w) = (DVec2::new(x, y), z);
        } else {
            mapping.offset = field.vec2()?;
        }
    }
    if let Some(field) = table.get("rotate") {
        mapping.rotate = field.number()?;
    }
    Ok(mapping)
}

fn no_place(entity: Entity) -> String {
    format!("entity \"{entity}\" is a direction, which is nowhere; remove the key or use entity \"position\"")
}
