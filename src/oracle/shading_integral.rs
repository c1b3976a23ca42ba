//! The colour of a visible fragment: which materials have an integral that is known, and that integral, of texture
//! times irradiance over strips of the fragment. Twin of `glsl/shared/shading_integral.glsl`.

use std::f64::consts::PI;

use glam::{DVec3, DVec4};

use super::bsdf::{is_integrable_over_region, is_specular};
use super::filter::kinds::is_integrable;
use super::geometry::beams::is_smooth;
use super::grid::{Grid, checker_grid, coarser, texture_grid};
use super::math::xyz;
use super::polygon::{AffineFunction, MAX_CORNERS, Polygon, area, at, middle, range, split};
use super::prefix_sums::{SMALLEST, in_grid, longest_edge, mean_over};
use super::projective::{PixelFrustum, RationalMap, ray_at};
use crate::pack::{EntityKind, LightKind, MapKind, PackedScene, TextureKind};
use crate::schema::layout::{Light, Material, NO_TEXTURE};
use crate::texture::procedural::ProceduralKind;
use crate::texture::sampler_spec::Address;

/// Cells of textures that a pixel's edges may cross.
const MAX_CELLS: u32 = 40_000;
/// Too much for a beam.
pub struct GaveUp;

pub type Result<T> = std::result::Result<T, GaveUp>;

/// What a fragment is painted with.
pub struct ShadingIntegral<'a> {
    pub record: &'a Material,
    /// Its colour, and those of the mirrors that show it.
    pub carried: DVec3,
    pub quotient: Option<RationalMap>,
    pub plane: DVec4,
    pub frame: PixelFrustum,
    pub near: AffineFunction,
}

/// Whether the integral of a shape's colour is known: of a material that has one, with a checker or a flat texture
/// that is affine on the shape.
pub fn is_simple(scene: &PackedScene, shape: u32, record: &Material, map: u32) -> bool {
    let [_, texture, sampler, _] = record.link;
    if !is_integrable_over_region(record, is_smooth(scene, shape)) || record.detail[0] != NO_TEXTURE {
        return false;
    }
    if texture == NO_TEXTURE {
        return true;
    }
    let [kind, entity, _, _] = scene.maps[map as usize].link;
    let flat = [MapKind::Plane as u32, MapKind::VertexUv as u32, MapKind::Affine as u32].contains(&kind);
    if !flat || entity != EntityKind::Position as u32 || is_specular(record) {
        return false;
    }
    let image = &scene.textures[texture as usize];
    if image.link[3] == TextureKind::Procedural as u32 {
        let [kind, _, _, dimensions] = scene.procedurals[image.place[0] as usize].link;
        return kind == ProceduralKind::Checker as u32 && dimensions < 3;
    }
    let sampler = &scene.samplers[sampler as usize];
    let known = |address: u32| {
        use Address::{ClampToEdge, MirroredRepeat, Repeat};
        [Repeat as u32, MirroredRepeat as u32, ClampToEdge as u32].contains(&address)
    };
    let steps = is_integrable(sampler);
    steps && known(sampler.modes[0]) && known(sampler.modes[1]) && scene.prefix_sums[texture as usize] > 0
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
    // The level at which it is short enough.
    let grid = if reach > most { coarser(*grid, (reach / most).log2().ceil() as i64) } else { *grid };
    if grid.unknown {
        return None;
    }
    let mean = mean_over(&grid, strip, quotient, reach < SMALLEST, crossed);
    let image = &scene.textures[record.link[1] as usize];
    if image.link[3] == TextureKind::Procedural as u32 {
        let what = &scene.procedurals[image.place[0] as usize];
        return Some(xyz(what.background).lerp(xyz(what.figure), mean.x));
    }
    Some(DVec3::splat(grid.least) + grid.step * mean)
}

/// A light behind the surface, as its beam sees it, gives nothing.
pub fn is_facing(paint: &ShadingIntegral, polygon: &Polygon, light: &Light) -> bool {
    let n = paint.plane.truncate();
    let (way, _) = ray_at(&paint.frame, middle(polygon));
    let place = xyz(light.place);
    let above =
        if light.link[0] == LightKind::Point as u32 { n.dot(place) - paint.plane.w } else { n.dot(place) };
    above * n.dot(way) < 0.0
}

/// Irradiance over π at the middle of a strip, of a light that it sees.
fn irradiance(paint: &ShadingIntegral, strip: &Polygon, light: &Light) -> DVec3 {
    let n = paint.plane.truncate();
    let place = xyz(light.place);
    let power = xyz(light.power) / PI;
    if light.link[0] != LightKind::Point as u32 {
        return power * n.dot(place).abs();
    }
    // The way to the light times the inverse_depth: towards the horizon both stay finite.
    let (direction, origin) = ray_at(&paint.frame, middle(strip));
    let near = at(paint.near, middle(strip));
    let parallel = paint.frame.parallel;
    let way = if parallel { place - origin + near * direction } else { near * (place - origin) - direction };
    let squared = way.length_squared();
    let scale = if parallel { 1.0 } else { near * near };
    power * scale * n.dot(way).abs() / (squared * squared.sqrt())
}

/// Strips that a fragment is cut into: √(STRIPS · logarithm of the ratio of depths).
const STRIPS: f64 = 2000.0;
const MAX_STRIPS: f64 = 64.0;
/// What lies e^7 times as deep as the fragment's nearest part counts as one strip.
const DEEPEST: f64 = 7.0;
/// Cells that an edge of a strip may cross, and what all strips of a fragment share beyond that.
const CELLS_OF_AN_EDGE: f64 = 32.0;
const CELLS_OF_ALL: f64 = 512.0;

/// ∬ of texture times irradiance / π over the fragment, in strips within which the depth hardly changes: there
/// equal areas of the texture are equal areas of the picture.
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
        let image = &scene.textures[record.link[1] as usize];
        if image.link[3] == TextureKind::Procedural as u32 {
            return checker_grid();
        }
        texture_grid(&scene.prefix_sums, record.link[1], image, &scene.samplers[record.link[2] as usize])
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
