//! The mapping from surface points to texture coordinates as data: its kind, the entity that it projects, and
//! its frame. Part of the model.

use glam::{DVec2, DVec3};

use crate::core::named::named_enum;

named_enum! {
    /// The kind of a mapping from surface points to texture coordinates.
    pub enum MappingKind {
        Surface = "surface",
        Planar = "planar",
        Cylindrical = "cylindrical",
        Spherical = "spherical",
        /// The position on the six faces of a cube.
        Cube = "cube",
        /// The three coordinates themselves, for 3D and procedural textures.
        Solid = "solid",
    }
}

named_enum! {
    /// The entity that a mapping projects.
    pub enum Entity {
        Position = "position",
        /// The shading normal.
        Normal = "normal",
        /// The vector from the shape's centroid to the point.
        Centroid = "centroid",
        /// The direction into which the surface reflects the incoming ray.
        Reflection = "reflection",
    }
}

impl Entity {
    /// Returns true for directions, to which no origin or bounding box applies.
    pub const fn is_direction(self) -> bool {
        matches!(self, Entity::Normal | Entity::Reflection)
    }
}

named_enum! {
    /// The space of a projecting mapping's frame.
    pub enum Space {
        World = "world",
        Bounds = "bounds",
    }
}

/// `uv' = R(rotate) · (uv ∘ scale) + offset`, in the order of KHR_texture_transform; for `solid` and `cube`
/// the rotation is about the frame's axis.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    /// The kind.
    pub kind: MappingKind,
    /// The entity that is projected.
    pub entity: Entity,
    /// The space of the frame.
    pub space: Space,
    /// Origin of a projecting mapping's frame.
    pub origin: DVec3,
    /// Axis of the frame, of any length: angles are measured around it, heights along it.
    pub axis: DVec3,
    /// Factors of u and v.
    pub scale: DVec2,
    /// Added last.
    pub offset: DVec2,
    /// Scale of w: `solid` only.
    pub scale_w: f64,
    /// Added to w last.
    pub offset_w: f64,
    /// Degrees, counter-clockwise in (u, v).
    pub rotate: f64,
}

impl Mapping {
    /// Returns true if the box or the centre of a shape decides where its points are mapped.
    pub fn depends_on_shape(&self) -> bool {
        self.kind != MappingKind::Surface && (self.space == Space::Bounds || self.entity == Entity::Centroid)
    }
}

impl Default for Mapping {
    fn default() -> Self {
        Mapping {
            kind: MappingKind::Surface,
            entity: Entity::Position,
            space: Space::World,
            origin: DVec3::ZERO,
            axis: DVec3::Y,
            scale: DVec2::ONE,
            offset: DVec2::ZERO,
            scale_w: 1.0,
            offset_w: 0.0,
            rotate: 0.0,
        }
    }
}
