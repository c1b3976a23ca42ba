//! Camera, image, sampling, background and everything that colours a surface. In: the tables of
//! those sections. Out: the types of the model, with the defaults of keys that are not given.

use glam::{DVec2, DVec3};
use toml::de::DeValue;

use super::model::*;
use super::names::Names;
use super::reader::{COLOR, COORDINATE, FOV, Field, LENGTH, SCALE};
use super::table::Table;
use super::validate::{MAX_DEPTH, MAX_SIZE, MAX_SPP, check_shared, check_spp, parallel};
use crate::error::Result;
use crate::texture::sampler_spec::{Address, Filter, Method, MipMode, SamplerSpec, TexelCenter};

pub(super) const CAMERA: &[&str] =
    &["eye", "look_at", "up", "vertical_fov", "camera_constant", "orthographic_height"];
pub(super) const IMAGE: &[&str] = &["width", "height"];
pub(super) const SAMPLING: &[&str] =
    &["algorithm", "pattern", "spp", "shared", "seed", "max_depth", "footprint"];
pub(super) const BACKGROUND: &[&str] = &["color"];
pub(super) const SAMPLER: &[&str] =
    &["name", "address", "filter", "border_color", "mip", "method", "texel_center"];
pub(super) const MATERIAL: &[&str] = &["name", "model", "color", "texture", "sampler", "mapping"];
const FILTER: &[&str] = &["mag", "min"];
const MAPPING: &[&str] = &["kind", "entity", "space", "origin", "axis", "scale", "offset", "rotate"];
/// Keys of the frame that only projecting maps have.
const FRAME: [&str; 4] = ["origin", "axis", "space", "entity"];

pub(super) fn camera(table: &Table<'_>) -> Result<Camera> {
    let eye = table.required("eye")?.vec3(&COORDINATE)?;
    let look_at_field = table.required("look_at")?;
    let look_at = look_at_field.vec3(&COORDINATE)?;
    let view = look_at - eye;
    if view.abs().max_element() < 1e-30 {
        let what = "look_at is where the eye is, so there is no view direction; move one of them";
        return Err(look_at_field.error(what, "same point as eye"));
    }
    let up_field = table.get("up");
    let up = up_field.map_or(Ok(DVec3::Y), Field::direction)?;
    if parallel(view, up) {
        let what = "up is parallel to the view direction look_at - eye";
        return Err(match up_field {
            Some(field) => field.error(&format!("{what}; choose another up"), "parallel to the view"),
            None => {
                let what = format!("key \"camera.up\": the default [0, 1, 0] for {what}; set up");
                table.error(&what, "up is parallel to the view")
            }
        });
    }
    Ok(Camera { eye, look_at, up, projection: projection(table)? })
}

fn projection(table: &Table<'_>) -> Result<Projection> {
    const KEYS: [&str; 3] = ["vertical_fov", "camera_constant", "orthographic_height"];
    let given: Vec<Field<'_>> = KEYS.iter().filter_map(|key| table.get(key)).collect();
    match given.as_slice() {
        [] => {
            let what = format!("key \"camera.vertical_fov\" is missing: give one of {}", KEYS.join(", "));
            Err(table.error(&what, "needs a field of view"))
        }
        [field] => match field.key {
            "vertical_fov" => field.number(&FOV).map(Projection::VerticalFov),
            "camera_constant" => field.number(&LENGTH).map(Projection::CameraConstant),
            _ => field.number(&LENGTH).map(Projection::Orthographic),
        },
        [first, second, ..] => {
            let what = format!("{} is given too; keep exactly one of {}", first.key, KEYS.join(", "));
            Err(second.error(&what, format!("excludes {}", first.key)))
        }
    }
}

pub(super) fn image(table: &Table<'_>) -> Result<(u32, u32)> {
    let width = table.required("width")?.integer(1..=MAX_SIZE)?;
    let height = table.required("height")?.integer(1..=MAX_SIZE)?;
    Ok((width, height))
}

pub(super) fn sampling(table: Option<&Table<'_>>) -> Result<Sampling> {
    let mut sampling = Sampling {
        algorithm: Algorithm::Samples,
        pattern: Pattern::Stratified,
        spp: 16,
        shared: false,
        seed: 1,
        max_depth: 5,
        footprint: Footprint::None,
    };
    let Some(table) = table else { return Ok(sampling) };
    if let Some(field) = table.get("algorithm") {
        sampling.algorithm = field.choice(Algorithm::NAMES, Algorithm::ALL)?;
    }
    if let Some(field) = table.get("pattern") {
        sampling.pattern = field.choice(Pattern::NAMES, Pattern::ALL)?;
    }
    if let Some(field) = table.get("spp") {
        sampling.spp = field.integer(1..=MAX_SPP)?;
        check_spp(sampling.pattern, sampling.spp).map_err(|what| field.error(&what, "no square number"))?;
    }
    if let Some(field) = table.get("shared") {
        sampling.shared = field.boolean()?;
        check_shared(sampling.pattern, sampling.shared)
            .map_err(|what| field.error(&what, "needs pattern \"stratified\""))?;
    }
    if let Some(field) = table.get("seed") {
        sampling.seed = field.integer(0..=u32::MAX)?;
    }
    if let Some(field) = table.get("max_depth") {
        sampling.max_depth = field.integer(0..=MAX_DEPTH)?;
    }
    if let Some(field) = table.get("footprint") {
        sampling.footprint = field.choice(Footprint::NAMES, Footprint::ALL)?;
    }
    Ok(sampling)
}

pub(super) fn background(table: Option<&Table<'_>>) -> Result<DVec3> {
    table.and_then(|table| table.get("color")).map_or(Ok(DVec3::ZERO), |field| field.vec3(&COLOR))
}

pub(super) fn sampler(table: &Table<'_>) -> Result<SamplerSpec> {
    let mut spec = SamplerSpec::default();
    if let Some(field) = table.get("address") {
        let one = |field: Field<'_>| field.choice(Address::NAMES, Address::ALL);
        spec.address = match field.value() {
            DeValue::Array(_) => field.array("one string, or 2 for u and v", spec.address, one)?,
            _ => [one(field)?; 2],
        };
    }
    if let Some(field) = table.get("filter") {
        let one = |field: Field<'_>| field.choice(Filter::NAMES, Filter::ALL);
        if let DeValue::Table(_) = field.value() {
            let both = Table::inline(field, "sampler.filter", FILTER)?;
            spec.mag = both.get("mag").map_or(Ok(spec.mag), one)?;
            spec.min = both.get("min").map_or(Ok(spec.min), one)?;
        } else {
            let filter = one(field)?;
            (spec.mag, spec.min) = (filter, filter);
        }
    }
    if let Some(field) = table.get("border_color") {
        spec.border_color = field.numbers::<4>(&COLOR)?.map(|x| x as f32);
    }
    if let Some(field) = table.get("mip") {
        spec.mip = field.choice(MipMode::NAMES, MipMode::ALL)?;
    }
    if let Some(field) = table.get("method") {
        spec.method = field.choice(Method::NAMES, Method::ALL)?;
    }
    if let Some(field) = table.get("texel_center") {
        spec.texel_center = field.choice(TexelCenter::NAMES, TexelCenter::ALL)?;
    }
    Ok(spec)
}

pub(super) fn default_material() -> Material {
    Material {
        name: "default".to_owned(),
        model: Model::Lambert,
        color: DVec3::ONE,
        texture: None,
        sampler: 0,
        mapping: Mapping::default(),
    }
}

/// `default_sampler` is where the sampler of a texture without one stands or will stand.
pub(super) fn material(
    table: &Table<'_>,
    textures: &Names<'_>,
    samplers: &Names<'_>,
    default_sampler: usize,
) -> Result<Material> {
    let mut material = default_material();
    material.name = table.required("name")?.string()?.to_owned();
    if let Some(field) = table.get("model") {
        material.model = field.choice(Model::NAMES, Model::ALL)?;
    }
    if let Some(field) = table.get("color") {
        material.color = field.vec3(&COLOR)?;
    }
    material.texture = table.get("texture").map(|field| textures.resolve(field)).transpose()?;
    material.sampler = match (table.get("sampler"), material.texture) {
        (Some(field), _) => samplers.resolve(field)?,
        (None, Some(_)) => default_sampler,
        (None, None) => 0,
    };
    if let Some(field) = table.get("mapping") {
        material.mapping = mapping(&Table::inline(field, "material.mapping", MAPPING)?)?;
    }
    Ok(material)
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
                    remove the key or choose kind planar, cylindrical or spherical";
        return Err(field.error(what, "not with kind \"surface\""));
    }
    if let Some(field) = table.get("entity") {
        mapping.entity = field.choice(Entity::NAMES, Entity::ALL)?;
    }
    if let Some(field) = table.get("space") {
        mapping.space = field.choice(Space::NAMES, Space::ALL)?;
    }
    if let Some(field) = table.get("origin") {
        mapping.origin = field.vec3(&COORDINATE)?;
    }
    if let Some(field) = table.get("axis") {
        mapping.axis = field.direction()?;
    }
    if let Some(field) = table.get("scale") {
        mapping.scale = match field.value() {
            DeValue::Array(_) => field.vec2(&SCALE)?,
            _ => DVec2::splat(field.number(&SCALE)?),
        };
    }
    if let Some(field) = table.get("offset") {
        mapping.offset = field.vec2(&COORDINATE)?;
    }
    if let Some(field) = table.get("rotate") {
        mapping.rotate = field.number(&COORDINATE)?;
    }
    Ok(mapping)
}
