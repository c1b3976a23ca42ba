//! `[[material]]` and its mapping. In: the table, and the textures and samplers it may name. Out: a
//! material whose mapping fits its texture.

use glam::DVec2;
use toml::de::DeValue;

use super::bsdf::read_model_keys;
use super::model::*;
use super::reader::{COLOR, COORDINATE, Field, SCALE};
use super::samplers::Known;
use super::table::Table;
use crate::core::error::Result;
use crate::texture::data::Dimension;

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
];
pub(super) const MAPPING: &[&str] =
    &["kind", "entity", "space", "origin", "axis", "scale", "offset", "rotate"];
/// Keys of the frame that only projecting maps have.
const FRAME: [&str; 4] = ["origin", "axis", "space", "entity"];

pub(super) fn material(table: &Table<'_>, known: &Known<'_, '_>) -> Result<Material> {
    let name = table.required("name")?.string()?.to_owned();
    let mut material = Material { name, ..Material::default() };
    if let Some(field) = table.get("model") {
        material.model = field.choice(Model::NAMES, Model::ALL)?;
    }
    if let Some(field) = table.get("color") {
        material.color = field.vec3(&COLOR)?;
    }
    read_model_keys(table, &mut material)?;
    let texture_field = table.get("texture");
    material.texture = texture_field.map(|field| known.textures.resolve(field)).transpose()?;
    let bump_field = bump(table, &mut material, known)?;
    material.sampler = match (table.get("sampler"), material.is_mapped()) {
        (Some(field), _) => known.samplers.resolve(field)?,
        (None, true) => known.default_sampler,
        (None, false) => 0,
    };
    if let Some(field) = table.get("mapping") {
        material.mapping = mapping(&Table::inline(field, "material.mapping", MAPPING)?)?;
    }
    if let (Some(field), Some(texture)) = (texture_field, material.texture) {
        let source = &known.sources[texture];
        if source.content.procedural().is_none() {
            fits(field, &material.mapping, source.dimension)?;
        }
    }
    if let (Some(field), Some(bump)) = (bump_field, material.bump) {
        let source = &known.sources[bump.texture];
        let dimension = source.dimension;
        if source.content.procedural().is_some() {
            let what = "a bump or normal map is read from texels; bake the pattern into a picture";
            return Err(field.error(what, "procedural"));
        }
        if !matches!(dimension, Dimension::One | Dimension::Two) {
            let what = format!("a bump or normal map is a 2d texture; this one is {dimension}");
            return Err(field.error(&what, "not 2d"));
        }
        fits(field, &material.mapping, dimension)?;
    }
    Ok(material)
}

/// The field that names the bump map's texture.
fn bump<'a>(table: &Table<'a>, material: &mut Material, known: &Known<'_, '_>) -> Result<Option<Field<'a>>> {
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
    let strength = table.get("strength").map_or(Ok(1.0), |field| field.number(&COORDINATE))?;
    material.bump = Some(BumpMap { kind, texture: known.textures.resolve(field)?, strength });
    Ok(Some(field))
}

/// A texture has to have the coordinates that the mapping makes.
fn fits(field: Field<'_>, mapping: &Mapping, dimension: Dimension) -> Result<()> {
    let what = match (dimension, mapping.kind) {
        (Dimension::Three, MappingKind::Solid) | (Dimension::Cube, MappingKind::Cube) => return Ok(()),
        (Dimension::Three, kind) => {
            format!(
                "a 3d texture needs a mapping of kind \"solid\", which has three coordinates; this one is \"{kind}\""
            )
        }
        (Dimension::Cube, kind) => {
            format!(
                "a cube texture needs a mapping of kind \"cube\", which gives a direction; this one is \"{kind}\""
            )
        }
        (Dimension::One | Dimension::Two, MappingKind::Solid) => {
            format!("a {dimension} texture has no third coordinate for kind \"solid\"; use kind \"planar\"")
        }
        (Dimension::One | Dimension::Two, _) => return Ok(()),
    };
    Err(field.error(&what, "does not fit the mapping"))
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
        if mapping.space == Space::Bounds && mapping.entity.is_direction() {
            return Err(field.error(&no_place(mapping.entity), "a direction has no box"));
        }
    }
    if let Some(field) = table.get("origin") {
        mapping.origin = field.vec3(&COORDINATE)?;
        if mapping.entity.is_direction() {
            return Err(field.error(&no_place(mapping.entity), "a direction has no origin"));
        }
    }
    if let Some(field) = table.get("axis") {
        mapping.axis = field.direction()?;
    }
    let solid = mapping.kind == MappingKind::Solid;
    if let Some(field) = table.get("scale") {
        match field.value() {
            DeValue::Array(_) if solid => {
                let [x, y, z] = field.numbers::<3>(&SCALE)?;
                (mapping.scale, mapping.scale_w) = (DVec2::new(x, y), z);
            }
            DeValue::Array(_) => mapping.scale = field.vec2(&SCALE)?,
            _ => {
                mapping.scale_w = field.number(&SCALE)?;
                mapping.scale = DVec2::splat(mapping.scale_w);
            }
        }
    }
    if let Some(field) = table.get("offset") {
        if solid {
            let [x, y, z] = field.numbers::<3>(&COORDINATE)?;
            (mapping.offset, mapping.offset_w) = (DVec2::new(x, y), z);
        } else {
            mapping.offset = field.vec2(&COORDINATE)?;
        }
    }
    if let Some(field) = table.get("rotate") {
        mapping.rotate = field.number(&COORDINATE)?;
    }
    Ok(mapping)
}

fn no_place(entity: Entity) -> String {
    format!("entity \"{entity}\" is a direction, which is nowhere; remove the key or use entity \"position\"")
}
