//! Numbers by which records say what they are, in the order of the shader's constants.

use crate::core::named::named_enum;

named_enum! {
    /// `PROJECTION_*` of the shader.
    pub enum ProjectionKind {
        Perspective = "perspective",
        Orthographic = "orthographic",
    }
}

named_enum! {
    /// `DIMENSION_*` of the shader: what a sample chooses beside its place in the pixel.
    pub enum SampleDimension {
        /// A point of the lens.
        Lens = "lens",
        Time = "time",
        /// A place of lights with an extent.
        Light = "light",
        /// A direction of a glossy surface.
        Lobe = "lobe",
        /// Whether glass mirrors or refracts.
        Fresnel = "fresnel",
    }
}

named_enum! {
    /// `LIGHT_*` of the shader.
    pub enum LightKind {
        Point = "point",
        Directional = "directional",
        Sphere = "sphere",
        Rectangle = "rectangle",
        /// Directional, from a disc of the sky.
        Sun = "sun",
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

named_enum! {
    /// `DIAGNOSTIC_*` of the shader: what is counted where it goes beyond a limit.
    pub enum Diagnostic {
        /// Look-ups at coordinates that are no numbers.
        Coordinates = "coordinates",
        /// Look-ups that wanted a level beyond the texture's last.
        Levels = "levels",
        /// Look-ups whose footprint is longer, over its width, than the sampler follows.
        Anisotropy = "anisotropy",
        /// Footprints of rays that graze a surface, cut off.
        Grazing = "grazing",
        /// Paths that ended in black at the greatest depth.
        Depth = "depth",
        /// Cones for which there was no room.
        Pieces = "pieces",
        /// Samples whose radiance is no number.
        Radiance = "radiance",
    }
}

named_enum! {
    /// `SCHEDULE_*` of the shader: how samples are handed out to threads.
    #[derive(Default)]
    pub enum Schedule {
        /// Equally many to each pixel, tile by tile.
        #[default]
        Tiles = "tiles",
        /// By a list of jobs.
        Jobs = "jobs",
    }
}
