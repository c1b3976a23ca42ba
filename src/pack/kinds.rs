//! Numbers by which records say what they are, in the order of the shader's constants.

use crate::named::named_enum;

named_enum! {
    /// `PROJECTION_*` of the shader.
    pub enum ProjectionKind {
        Perspective = "perspective",
        Orthographic = "orthographic",
    }
}

named_enum! {
    /// `LIGHT_*` of the shader.
    pub enum LightKind {
        Point = "point",
        Directional = "directional",
    }
}

named_enum! {
    /// `MAP_*` of the shader: how a device forms a texture coordinate.
    pub enum MapKind {
        Plane = "plane",
        Affine = "affine",
        VertexUv = "vertex-uv",
        Cylindrical = "cylindrical",
        Spherical = "spherical",
        Solid = "solid",
        Cube = "cube",
        Box = "box",
    }
}

named_enum! {
    /// `ENTITY_*` of the shader: the vector that a map looks at.
    pub enum EntityKind {
        Position = "position",
        Normal = "normal",
        Reflection = "reflection",
        /// Of the ray: an environment's.
        Direction = "direction",
    }
}

named_enum! {
    /// `TEXTURE_KIND_*` of the shader.
    pub enum TextureKind {
        /// One or two dimensions.
        Flat = "flat",
        Volume = "volume",
        Cube = "cube",
        /// Computed at every look-up; `place[0]` is an index into the list of procedurals.
        Procedural = "procedural",
    }
}
