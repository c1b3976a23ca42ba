//! How a surface point becomes a texture coordinate, as data: the kind of map, the entity that it
//! projects, and its frame. Part of the model.

use glam::{DVec2, DVec3};

use crate::core::named::named_enum;

named_enum! {
    /// How a surface point becomes a texture coordinate.
    pub enum MappingKind {
        Surface = "surface",
        Planar = "planar",
        Cylindrical = "cylindrical",
        Spherical = "spherical",
        /// The place on a cube's six faces.
        Cube = "cube",
        /// The three coordinates themselves, for 3D and procedural textures.
        Solid = "solid",
    }
}

named_enum! {
    /// What a projecting map projects.
    pub enum Entity {
        Position = "position",
        /// The shading normal.
        Normal = "normal",
        /// The vector from the shape's centroid to the point.
        Centroid = "centroid",
        /// The direction into which the surface mirrors the incoming ray.
        Reflection = "reflection",
    }
}

impl Entity {
    /// A direction has no place that an origin or a box could be in.
    pub const fn is_direction(self) -> bool {
        matches!(self, Entity::Normal | Entity::Reflection)
    }
}

named_enum! {
    /// Where a projecting map's frame lives.
    pub enum Space {
        World = "world",
        Bounds = "bounds",
    }
}

/// `uv' = R(rotate) · (uv ∘ scale) + offset`, in the order of KHR_texture_transform; of `solid` and `cube`
/// the rotation is about the frame's axis.
#[derive(Clone, Copy, Debug)]
pub struct Mapping {
    /// How a point becomes a coordinate.
    pub kind: MappingKind,
    /// What is projected.
    pub entity: Entity,
    /// Where the frame lives.
    pub space: Space,
    /// Frame of a projecting map: its origin and its axis (not necessarily of unit length).
    pub origin: DVec3,
    /// Around it angles are measured, along it heights.
    pub axis: DVec3,
    /// Factors of u and v.
    pub scale: DVec2,
    /// Added last.
    pub offset: DVec2,
    /// Scale and offset of w: `solid` only.
    pub scale_w: f64,
    /// Added to w last.
    pub offset_w: f64,
    /// Degrees, counter-clockwise in (u, v).
    pub rotate: f64,
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
