//! The colour of a visible fragment: decides which materials have a closed-form integral, and computes it, of texture
//! times irradiance over strips of the fragment. Twin of `glsl/shared/shading_integral.glsl`.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};

use super::bsdf::{is_integrable_over_region, is_specular};
use super::filter::kinds::is_integrable;
use super::geometry::beams::is_smooth;
use super::grid::{Grid, checker_grid, coarser, texture_grid};
use super::polygon::{AffineFunction, MAX_CORNERS, Polygon, area, at, middle, range, split};
use super::prefix_sums::{SMALLEST, in_grid, longest_edge, mean_over};
use super::projective::{PixelFrustum, RationalMap, ray_at};
use crate::pack::{EntityKind, LightKind, MapKind, PackedScene, TextureKind};
use crate::schema::layout::{Light, Material, NO_TEXTURE};
use crate::texture::procedural::ProceduralKind;
use crate::texture::sampler_spec::Address;

/// Most cells of textures that a pixel's edges may cross.
const MAX_CELLS: u32 = 40_000;
/// The pixel is too complex for a beam.
pub struct GaveUp;

pub type Result<T> = std::result::Result<T, GaveUp>;

/// The material and geometry of a fragment.
pub struct ShadingIntegral<'a> {
    pub record: &'a Material,
    /// Its colour times those of the mirrors that show it.
    pub carried: DVec3,
    pub quotient: Option<RationalMap>,
    pub plane: DVec4,
    pub frame: PixelFrustum,
    pub near: AffineFunction,
}

/// Returns true if the integral of a shape's colour is known: its material supports that, with a checker or a 2D texture
/// whose coordinates are affine on the shape.
pub fn is_simple(scene: &PackedScene, shape: u32, record: &Material, map: u32) -> bool {
    let texture = record.texture_index;
    if !is_integrable_over_region(record, is_smooth(scene, shape)) || record.bump_texture_index != NO_TEXTURE
    {
        return false;
    }
    if texture == NO_TEXTURE {
        return true;
    }
    let map = &scene.records.uv_projections[map as usize];
    let flat = matches!(map.kind, MapKind::Plane | MapKind::VertexUv | MapKind::Affine);
    if !flat || map.entity != EntityKind::Position || is_specular(record.model) {
        return false;
    }
    let image = &scene.records.textures[texture as usize];
    if image.kind == TextureKind::Procedural {
        let what = &scene.records.procedurals[image.procedural as usize];
        return what.kind == ProceduralKind::Checker && what.dimensions < 3;
    }
    let sampler = &scene.records.samplers[record.sampler_index as usize];
    let known = |address: Address| {
        matches!(address, Address::Repeat | Address::MirroredRepeat | Address::ClampToEdge)
    };
    let steps = is_integrable(sampler);
    steps && known(sampler.address_u) && known(sampler.address_v) && scene.prefix_sums[texture as usize] > 0
}

fn mean_color(
    scene: &PackedScene,
    record: &Material,
    grid: &Grid,
    strip: &Polygon,
    quotient: &RationalMap,
    most: f64,
    crossed: &mut u32,
) -> Option<DVec3> {
    let reach = longest_edge(strip, &in_grid(grid, quotient, [0, 0]));
    // The level at which the edge is short enough.
    let grid = if reach > most { coarser(*grid, (reach / most).log2().ceil() as i64) } else { *grid };
    if grid.unknown {
        return None;
    }
    let mean = mean_over(&grid, strip, quotient, reach < SMALLEST, crossed);
    let image = &scene.records.textures[record.texture_index as usize];
    if image.kind == TextureKind::Procedural {
        let what = &scene.records.procedurals[image.procedural as usize];
        return Some(what.background.as_dvec3().lerp(what.figure.as_dvec3(), mean.x));
    }
    Some(DVec3::splat(grid.least) + grid.step * mean)
}

/// Returns false for a light behind the surface as seen by the beam, which contributes nothing.
pub fn is_facing(paint: &ShadingIntegral, polygon: &Polygon, light: &Light) -> bool {
    let n = paint.plane.truncate();
    let (way, _) = ray_at(&paint.frame, middle(polygon));
    let above = if light.kind == LightKind::Point {
        n.dot(light.position) - paint.plane.w
    } else {
        n.dot(light.direction)
    };
    above * n.dot(way) < 0.0
}

/// Returns the irradiance over π at the centre of a strip, by an unoccluded light.
fn irradiance(paint: &ShadingIntegral, strip: &Polygon, light: &Light) -> DVec3 {
    let n = paint.plane.truncate();
    let place = light.position;
    let power = light.power.as_dvec3() / PI;
    if light.kind != LightKind::Point {
        return power * n.dot(light.direction).abs();
    }
    // The vector to the light times the inverse depth: towards the horizon both stay finite.
    let (direction, origin) = ray_at(&paint.frame, middle(strip));
    let near = at(paint.near, middle(strip));
    let parallel = paint.frame.parallel;
    let way = if parallel { place - origin + near * direction } else { near * (place - origin) - direction };
    let squared = way.length_squared();
    let scale = if parallel { 1.0 } else { near * near };
    power * scale * n.dot(way).abs() / (squared * squared.sqrt())
}

/// Number of strips of a fragment: √(STRIPS · logarithm of the ratio of depths).
const STRIPS: f64 = 2000.0;
const MAX_STRIPS: f64 = 64.0;
/// Everything e^7 times as deep as the fragment's nearest part is one strip.
const DEEPEST: f64 = 7.0;
/// Cells that an edge of a strip may cross, and a further number that is divided among the strips of a fragment.
const CELLS_OF_AN_EDGE: f64 = 32.0;
const CELLS_OF_ALL: f64 = 512.0;

/// Returns ∬ of texture times irradiance / π over the fragment, in strips of almost constant depth, within which equal
/// areas of the texture are equal areas of the picture.
pub fn integral(
    scene: &PackedScene,
    paint: &ShadingIntegral,
    polygon: &Polygon,
    light: Option<&Light>,
    crossed: &mut u32,
) -> Result<DVec3> {
    let ShadingIntegral { record, quotient, .. } = paint;
    let depth = match quotient {
        Some(quotient) => quotient.below,
        None if paint.frame.parallel => AffineFunction::Z,
        None => paint.near,
    };
    let (low, high) = range(polygon, depth);
    let span = (high / low.max(1e-30 * high)).ln().min(DEEPEST);
    let flat = quotient.is_none() && light.is_none();
    let strips = if flat { 1.0 } else { (STRIPS * span).sqrt().ceil().clamp(1.0, MAX_STRIPS) };
    let most = CELLS_OF_AN_EDGE + CELLS_OF_ALL / strips;
    let grid = quotient.map(|_| {
        let image = &scene.records.textures[record.texture_index as usize];
        if image.kind == TextureKind::Procedural {
            return checker_grid();
        }
        texture_grid(
            &scene.prefix_sums,
            record.texture_index,
            image,
            &scene.records.samplers[record.sampler_index as usize],
        )
    });
    let mut rest = *polygon;
    let mut sum = DVec3::ZERO;
    for k in 1..=strips as u32 {
        let mut strip = rest;
        if f64::from(k) < strips {
            let limit = high * (-span * f64::from(k) / strips).exp();
            [strip, rest] = split(&rest, depth - limit * AffineFunction::Z);
            if strip.count > MAX_CORNERS || rest.count > MAX_CORNERS {
                return Err(GaveUp);
            }
        }
        let share = area(&strip);
        if strip.count < 3 || share <= 0.0 {
            continue;
        }
        let color = match (quotient, &grid) {
            (Some(quotient), Some(grid)) => {
                let mean = mean_color(scene, record, grid, &strip, quotient, most, crossed);
                mean.ok_or(GaveUp)?
            }
            _ => DVec3::ONE,
        };
        if *crossed > MAX_CELLS {
            return Err(GaveUp);
        }
        let irradiance = light.map_or(DVec3::ONE, |light| irradiance(paint, &strip, light));
        sum += share * color * irradiance;
    }
    Ok(sum)
}
