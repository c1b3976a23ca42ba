//! The hit of a ray, the surface interaction that shading and mapping use, and shapes that move. Twin of
//! `glsl/shared/geometry/hit.glsl`.

use glam::{DMat3, DVec2, DVec3, DVec4};

use crate::oracle::camera::Ray;
use crate::pack::PackedScene;

/// Farther than any hit that counts.
pub const FAR: f64 = 1e30;

#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// In units of the direction's length; `FAR` on a miss.
    pub t: f64,
    /// Planes first, then spheres, then triangles; `NO_SHAPE` on a miss.
    pub shape: u32,
    /// The shape's own coordinates, where it has any.
    pub local: DVec2,
}

/// Returns the displacement of a shape at the ray's time. Shapes are intersected, and textured, where they are at time 0,
/// by rays that start as far back.
pub fn moved_by(scene: &PackedScene, ray: &Ray, shape: u32) -> DVec3 {
    scene.records.motions.get(shape as usize).map_or(DVec3::ZERO, |motion| ray.time * motion.shift)
}

pub fn at_rest(scene: &PackedScene, ray: &Ray, shape: u32) -> Ray {
    Ray { origin: ray.origin - moved_by(scene, ray, shape), ..*ray }
}

/// What the vertices of a mesh have beside normals and texture coordinates, interpolated.
#[derive(Clone, Copy, Debug)]
pub struct VertexAttributes {
    /// Linear RGB and alpha.
    pub color: DVec4,
    pub second_uv: DVec2,
    /// Along the surface.
    pub second_gradients: [DVec3; 2],
    /// With the sign of the bitangent, 0 for none.
    pub tangent: DVec4,
    /// Of the second texture coordinates, for maps with coordinates of their own; 0 for none.
    pub uv_texel: u32,
    /// Of the corners, and the gradients of each.
    pub weights: DVec3,
    pub weight_gradients: [DVec3; 3],
}

impl Default for VertexAttributes {
    fn default() -> VertexAttributes {
        VertexAttributes {
            color: DVec4::ONE,
            second_uv: DVec2::ZERO,
            second_gradients: [DVec3::ZERO; 2],
            tangent: DVec4::ZERO,
            uv_texel: 0,
            weights: DVec3::ZERO,
            weight_gradients: [DVec3::ZERO; 3],
        }
    }
}

/// Where a ray met a shape, and what it needs to know of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surface {
    pub point: DVec3,
    /// Unit, towards the incoming ray.
    pub geometric_normal: DVec3,
    /// Unit, for shading.
    pub normal: DVec3,
    /// The plane's coordinates or the vertices' interpolated uv, and their gradients along the surface.
    pub own_uv: DVec2,
    pub own_gradients: [DVec3; 2],
    /// Change of the normal a unit of way along the surface, and its mean; positive where the shape
    /// bulges towards the ray.
    pub shape_operator: DMat3,
    pub curvature: f64,
    /// The ray comes from behind the shape's own normal.
    pub inside: bool,
    pub material: u32,
    pub map: u32,
    /// The point where the shape does not move.
    pub at_rest: DVec3,
    /// Largest coordinate from which the point was computed.
    pub size: f64,
    pub attributes: VertexAttributes,
}

pub(super) fn surface(point: DVec3, geometric: DVec3, normal: DVec3, [material, map]: [u32; 2]) -> Surface {
    Surface {
        point,
        geometric_normal: geometric,
        normal,
        own_uv: DVec2::ZERO,
        own_gradients: [DVec3::ZERO; 2],
        shape_operator: DMat3::ZERO,
        curvature: 0.0,
        inside: false,
        material,
        map,
        at_rest: point,
        size: point.abs().max_element(),
        attributes: VertexAttributes::default(),
    }
}
