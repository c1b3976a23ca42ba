//! Shapes as beams see them: of flat ones the plane, the region, texture coordinates and shadows; of others, and of all
//! for tile culling, whether they may lie in the way. Twin of `glsl/shared/geometry/beams.glsl`.

use glam::DVec4;

use super::kinds::{Form, Polygonal, shape_of};
use crate::oracle::polygon::{AffineFunction, Polygon};
use crate::oracle::projective::{
    ConvexRegion, MAX_LINES, PixelFrustum, RationalMap, add, along, below, region_of_plane,
};
use crate::pack::{LightKind, MapKind, PackedScene};
use crate::schema::layout::Light;

fn polygonal(scene: &PackedScene, shape: u32) -> Option<&dyn Polygonal> {
    match shape_of(scene, shape).form() {
        Form::Polygonal(shape) => Some(shape),
        Form::Round(_) => None,
    }
}

/// Returns true if a shape has a region; beams do not know the outline of others.
pub fn has_region(scene: &PackedScene, shape: u32) -> bool {
    polygonal(scene, shape).is_some()
}

/// Unit normal, and height of the plane in which a flat shape lies.
pub fn shape_plane(scene: &PackedScene, shape: u32) -> DVec4 {
    shape_of(scene, shape).plane_of().unwrap_or(DVec4::ZERO)
}

/// Material and map.
pub fn shape_links(scene: &PackedScene, shape: u32) -> [u32; 2] {
    shape_of(scene, shape).links()
}

pub fn is_smooth(scene: &PackedScene, shape: u32) -> bool {
    polygonal(scene, shape).is_some_and(Polygonal::has_smooth_normals)
}

pub fn shape_region(scene: &PackedScene, frame: &PixelFrustum, shape: u32) -> ConvexRegion {
    let mut region = region_of_plane(frame, shape_plane(scene, shape));
    if let Some(polygonal) = polygonal(scene, shape) {
        polygonal.add_outline(frame, region.inverse_depth, &mut region);
    }
    region
}

/// Texture coordinates on a flat shape, for maps that are affine there.
pub fn coordinates(
    scene: &PackedScene,
    frame: &PixelFrustum,
    shape: u32,
    map: u32,
    near: AffineFunction,
) -> RationalMap {
    let map = &scene.records.uv_projections[map as usize];
    match polygonal(scene, shape) {
        Some(polygonal) if map.kind != MapKind::Affine => polygonal.own_coordinates(frame, near, map),
        _ => {
            let [u, v] = [map.x, map.y].map(|row| along(frame, near, row));
            RationalMap { u, v, below: below(frame, near) }
        }
    }
}

/// Where, on the plane of this inverse depth, a flat shape keeps a light away.
pub fn shadow_region(
    scene: &PackedScene,
    frame: &PixelFrustum,
    near: AffineFunction,
    shape: u32,
    light: &Light,
) -> ConvexRegion {
    let point = light.kind == LightKind::Point;
    let place = if point { light.position } else { light.direction };
    let plane = shape_plane(scene, shape);
    let n = plane.truncate();
    // Height of the light over the shape's plane, or of a unit step towards it.
    let rise = if point { plane.w - n.dot(place) } else { n.dot(place) };
    let side = if rise == 0.0 { 0.0 } else { rise.signum() };
    let mut region = ConvexRegion { count: 0, lines: [AffineFunction::ZERO; MAX_LINES], inverse_depth: near };
    // Beyond the plane, seen from the light.
    let beyond = if point { side * n.extend(-plane.w) } else { -side * n.extend(-plane.w) };
    add(&mut region, along(frame, near, beyond));
    if let Some(polygonal) = polygonal(scene, shape) {
        polygonal.add_shadow((frame, near), light, rise, &mut region);
    }
    region
}

/// False where no ray of the polygon can meet the shape.
pub fn may_meet(scene: &PackedScene, frame: &PixelFrustum, polygon: &Polygon, shape: u32) -> bool {
    shape_of(scene, shape).may_meet(&scene.header, frame, polygon)
}

/// False where no way from the polygon on a surface of this inverse depth to the light can pass the shape, which has
/// no region.
pub fn may_shade(
    scene: &PackedScene,
    surface: (&PixelFrustum, AffineFunction),
    polygon: &Polygon,
    light: &Light,
    shape: u32,
) -> bool {
    match shape_of(scene, shape).form() {
        Form::Round(round) => round.may_shade(surface, polygon, light),
        Form::Polygonal(_) => false,
    }
}
