//! The enums of surfaces, what lights them and how they are mapped, that host and device share: as those of `enums.rs`,
//! which hands them on.

enums! {
    /// The content of a material's bump texture.
    #[derive(Default)]
    BUMP: BumpKind {
        /// Unit normals as 2 rgb - 1: along increasing u, along increasing v, outward.
        #[default]
        Normal = "normal",
        /// Heights.
        Bump = "bump",
        /// Unit normals whose green channel points against v.
        NormalDown = "normal-down",
    }

    /// The kind of a light; those from `Sphere` on are area lights.
    #[derive(Default)]
    LIGHT: LightKind {
        #[default]
        Point = "point",
        Directional = "directional",
        /// A point that shines within a cone.
        Spot = "spot",
        Sphere = "sphere",
        Rectangle = "rectangle",
        /// Directional, from a disc of the sky.
        Sun = "sun",
        /// What rays see that hit nothing.
        Environment = "environment",
    }

    /// The meaning of a material's alpha (glTF 2.0, 3.9.4).
    #[derive(Default)]
    ALPHA: AlphaMode {
        /// None.
        #[default]
        Opaque = "opaque",
        /// There is a surface where alpha is not below the cutoff.
        Mask = "mask",
        /// The share of a ray's light that the surface has; the rest passes.
        Blend = "blend",
    }

    /// The maps of a material beside those of its colour and its relief.
    #[derive(Default)]
    MATERIAL_MAP: MaterialMap {
        /// Roughness in green, metallic in blue.
        #[default]
        Roughness = "roughness",
        Emission = "emission",
        /// In red: the share of the environment's light that arrives.
        Occlusion = "occlusion",
        /// Alpha of the colour's texture, without a footprint, for a mask.
        Mask = "mask",
        /// In alpha: multiplies what the surface of a dielectric reflects.
        SpecularWeight = "specular-weight",
        /// Multiplies the reflectance of a dielectric head-on.
        SpecularTint = "specular-tint",
        /// In red: multiplies the share of light in a body that passes it.
        Transmission = "transmission",
    }

    /// The texture coordinate computation on the device.
    #[derive(Default)]
    MAP: MapKind {
        /// The plane's own coordinates.
        #[default]
        Plane = "plane",
        /// Affine in the position: planar.
        Affine = "affine",
        /// Interpolated over a triangle.
        VertexUv = "vertex-uv",
        Cylindrical = "cylindrical",
        Spherical = "spherical",
        /// Affine in the entity, three coordinates.
        Solid = "solid",
        /// A direction for a cube texture.
        Cube = "cube",
        /// The position on the cube's face, for a 2D texture.
        Box = "box",
    }

    /// The vector that a mapping looks at.
    #[derive(Default)]
    ENTITY: EntityKind {
        #[default]
        Position = "position",
        Normal = "normal",
        Reflection = "reflection",
        /// The direction of the ray, for an environment.
        Direction = "direction",
    }
}
