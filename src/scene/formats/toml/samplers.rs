//! Reads `[[sampler]]` and `[background]`. Input: their tables. Output: types of the model, with the defaults
//! of keys that are not given.

use glam::DVec3;
use toml::de::DeValue;

use super::names::Names;
use super::reader::Field;
use super::table::Table;
use crate::core::error::Result;
use crate::scene::limits::ANISOTROPY;
use crate::scene::model::DEFAULT;
use crate::scene::model::{Background, Environment, EnvironmentLayout, TextureSource};
use crate::texture::data::Dimension;
use crate::texture::sampler_spec::{Address, CUBICS, Filter, LevelUse, Method, SamplerSpec, TexelCenter};

pub(super) const SAMPLER: &[&str] = &[
    "name",
    "address",
    "filter",
    "border_color",
    "mip",
    "method",
    "texel_center",
    "max_anisotropy",
    "cubic",
];
pub(super) const BACKGROUND: &[&str] = &["color", "environment", "sampler", "layout", "rotate", "mirror"];
const FILTER: &[&str] = &["mag", "min"];

pub(super) fn sampler(table: &Table<'_>) -> Result<SamplerSpec> {
    let mut spec = SamplerSpec::default();
    if let Some(field) = table.get("address") {
        let one = |field: Field<'_>| field.choice(Address::NAMES, Address::ALL);
        spec.address = match field.value() {
            DeValue::Array(array) if array.len() == 3 => {
                let [u, v, w] = field.array("one string, or one an axis", [spec.address_w; 3], one)?;
                spec.address_w = w;
                [u, v]
            }
            DeValue::Array(_) => {
                field.array("one string, or 2 for u and v, or 3 for u, v and w", spec.address, one)?
            }
            _ => {
                spec.address_w = one(field)?;
                [spec.address_w; 2]
            }
        };
    }
    if let Some(field) = table.get("filter") {
        let one = |field: Field<'_>| field.choice(Filter::NAMES, Filter::ALL);
        if let DeValue::Table(_) = field.value() {
            let both = Table::inline(field, "sampler.filter", FILTER)?;
            if let Some(field) = both.get("mag") {
                spec.mag = one(field)?;
            }
            spec.min = both.get("min").map_or(Ok(spec.min), one)?;
        } else {
            (spec.mag, spec.min) = one(field)?.both();
        }
    }
    if let Some(field) = table.get("max_anisotropy") {
        spec.max_anisotropy = field.integer(&ANISOTROPY)?;
    }
    if let Some(field) = table.get("cubic") {
        spec.cubic = cubic(field)?;
    }
    if let Some(field) = table.get("border_color") {
        spec.border_color = field.numbers::<4>()?.map(|x| x as f32);
    }
    if let Some(field) = table.get("mip") {
        (spec.mip, spec.stored_levels) = field.choice(LevelUse::NAMES, LevelUse::ALL)?.parts();
    }
    if let Some(field) = table.get("method") {
        spec.method = field.choice(Method::NAMES, Method::ALL)?;
    }
    if let Some(field) = table.get("texel_center") {
        spec.texel_center = field.choice(TexelCenter::NAMES, TexelCenter::ALL)?;
    }
    Ok(spec)
}

/// Reads a name, or [B, C].
fn cubic(field: Field<'_>) -> Result<[f32; 2]> {
    if let DeValue::Array(_) = field.value() {
        return Ok(field.numbers::<2>()?.map(|x| x as f32));
    }
    field.choice(&CUBICS.map(|c| c.0), &CUBICS.map(|c| c.1))
}

/// The names that references to textures and samplers resolve to.
pub(super) struct Known<'n, 'a> {
    pub textures: &'n Names<'a>,
    pub sources: &'n [TextureSource],
    pub samplers: &'n Names<'a>,
}

pub(super) fn background(table: Option<&Table<'_>>, known: &Known<'_, '_>) -> Result<Background> {
    let mut background = Background { color: DVec3::ZERO, environment: None };
    let Some(table) = table else { return Ok(background) };
    let color = table.get("color").map(Field::vec3).transpose()?;
    let Some(field) = table.get("environment") else {
        if let Some(field) = ["sampler", "layout", "rotate", "mirror"].iter().find_map(|key| table.get(key)) {
            return Err(field.error("this needs an environment = \"TEXTURE\" beside it", "no environment"));
        }
        background.color = color.unwrap_or(DVec3::ZERO);
        return Ok(background);
    };
    let texture = known.textures.resolve(field)?;
    // Defaults to the texture's own layout.
    let mut layout = match known.sources[texture].dimension {
        Dimension::Cube => EnvironmentLayout::Cube,
        _ => EnvironmentLayout::Equirectangular,
    };
    if let Some(field) = table.get("layout") {
        layout = field.choice(EnvironmentLayout::NAMES, EnvironmentLayout::ALL)?;
    }
    let sampler = table.get("sampler").map(|field| known.samplers.resolve(field)).transpose()?;
    let rotate = table.get("rotate").map_or(Ok(0.0), Field::number)?;
    let mirror = table.get("mirror").map_or(Ok(false), Field::boolean)?;
    background.color = color.unwrap_or(DVec3::ONE);
    background.environment = Some(Environment {
        texture,
        sampler: sampler.unwrap_or(DEFAULT),
        layout,
        rotate,
        idle_address: None,
        mirror,
    });
    Ok(background)
}
