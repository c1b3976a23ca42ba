//! Checks of samplers, materials with their mappings, and the background, and whether their textures match.

use super::super::bsdf::check_model_keys;
use super::super::limits::{
    ANISOTROPY, COLOR, COORDINATE, NOT_NEGATIVE, SCALE, UNIT, check_mag, check_method,
};
use super::super::model::{
    Background, EnvironmentLayout, Mapping, MappingKind, Material, Space, TextureSource,
};
use super::super::refusal::{Check, Key};
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::SamplerSpec;

pub fn sampler(key: Key, spec: &SamplerSpec) -> Check {
    key.of("filter.mag").rule(check_mag(spec.mag), "not for magnification")?;
    key.of("max_anisotropy").integer(spec.max_anisotropy, &ANISOTROPY)?;
    key.of("cubic").numbers_f32(&spec.cubic, &COORDINATE)?;
    key.of("border_color").numbers_f32(&spec.border_color, &COLOR)?;
    key.of("method").rule(check_method(spec), "not by the device")
}

pub fn material(key: Key, material: &Material, textures: &[TextureSource], samplers: usize) -> Check {
    key.of("color").vector(material.color, &COLOR)?;
    key.of("emission").vector(material.emission, &COLOR)?;
    key.of("alpha_cutoff").number(material.alpha_cutoff, &NOT_NEGATIVE)?;
    key.of("opacity").number(material.opacity, &UNIT)?;
    key.of("occlusion_strength").number(material.occlusion_strength, &UNIT)?;
    check_model_keys(key, material)?;
    if material.is_mapped() {
        key.of("sampler").index(material.sampler, samplers, "sampler")?;
    }
    mapping(key, &material.mapping)?;
    if let Some(index) = material.texture {
        let key = key.of("texture");
        key.index(index, textures.len(), "texture")?;
        let source = &textures[index];
        if source.content.procedural().is_none() {
            fits(key, &material.mapping, source.dimension)?;
        }
    }
    for (name, map) in [
        ("metallic_roughness_map", material.metallic_roughness_map),
        ("emission_map", material.emission_map),
        ("occlusion_map", material.occlusion_map),
        ("specular_weight_map", material.specular_weight_map),
        ("specular_tint_map", material.specular_tint_map),
        ("transmission_texture", material.transmission_texture),
    ] {
        let Some(map) = map else { continue };
        let key = key.of(name);
        key.index(map.texture, textures.len(), "texture")?;
        key.index(map.sampler, samplers, "sampler")?;
        fits_map(key, &material.mapping, &textures[map.texture])?;
    }
    let Some(bump) = material.bump else { return Ok(()) };
    key.of("strength").number(bump.strength, &COORDINATE)?;
    let key = key.of(if bump.kind.is_normal_map() { "normal_map" } else { "bump_map" });
    key.index(bump.texture, textures.len(), "texture")?;
    fits_map(key, &material.mapping, &textures[bump.texture])
}

/// A map beside that of the colour is a picture that the mapping's coordinates reach.
fn fits_map(key: Key, mapping: &Mapping, source: &TextureSource) -> Check {
    if source.content.procedural().is_some() {
        let what = "such a map is read from texels; bake the pattern into a picture";
        return key.refuse(what, "procedural");
    }
    let dimension = source.dimension;
    if !matches!(dimension, Dimension::One | Dimension::Two) {
        return key.refuse(format!("such a map is a 2d texture; this one is {dimension}"), "not 2d");
    }
    fits(key, mapping, dimension)
}

/// The texture must have the dimension of the mapping's coordinates.
fn fits(key: Key, mapping: &Mapping, dimension: Dimension) -> Check {
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
    key.refuse(what, "does not fit the mapping")
}

fn mapping(key: Key, mapping: &Mapping) -> Check {
    let entity = mapping.entity;
    if mapping.space == Space::Bounds && entity.is_direction() {
        let what = format!(
            "entity \"{entity}\" is a direction, which is nowhere; remove the key or use entity \"position\""
        );
        return key.of("mapping.space").refuse(what, "a direction has no box");
    }
    key.of("mapping.origin").vector(mapping.origin, &COORDINATE)?;
    key.of("mapping.axis").direction(mapping.axis)?;
    let solid = mapping.kind == MappingKind::Solid;
    let (scale, offset) = (key.of("mapping.scale"), key.of("mapping.offset"));
    let [x, y, z] = [mapping.scale.x, mapping.scale.y, mapping.scale_w];
    // By bits, so that NaN equals itself.
    let [first, second, third] = [x, y, z].map(f64::to_bits);
    match first == second && second == third {
        true => scale.number(x, &SCALE)?,
        false if solid => scale.numbers([x, y, z], &SCALE)?,
        false => scale.numbers([x, y], &SCALE)?,
    }
    if solid {
        offset.numbers([mapping.offset.x, mapping.offset.y, mapping.offset_w], &COORDINATE)?;
    } else {
        offset.numbers(mapping.offset.to_array(), &COORDINATE)?;
    }
    key.of("mapping.rotate").number(mapping.rotate, &COORDINATE)
}

pub fn background(key: Key, background: &Background, textures: &[TextureSource], samplers: usize) -> Check {
    key.of("color").vector(background.color, &COLOR)?;
    let Some(environment) = background.environment else { return Ok(()) };
    key.of("environment").index(environment.texture, textures.len(), "texture")?;
    let dimension = textures[environment.texture].dimension;
    let natural = match dimension {
        Dimension::Two => EnvironmentLayout::Equirectangular,
        Dimension::Cube => EnvironmentLayout::Cube,
        Dimension::One | Dimension::Three => {
            let what = format!("an environment is a 2d or a cube texture; this one is {dimension}");
            return key.of("environment").refuse(what, "neither 2d nor cube");
        }
    };
    if environment.layout != natural {
        let what = format!("the texture is {dimension}, which needs layout \"{natural}\"");
        return key.of("layout").refuse(what, "does not fit the texture");
    }
    key.of("sampler").index(environment.sampler, samplers, "sampler")?;
    key.of("rotate").number(environment.rotate, &COORDINATE)
}
