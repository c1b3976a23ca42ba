//! The enums that the shader knows. Each has a prefix: `LightKind::Sun` is `LIGHT_SUN` of the shader, and
//! `LIGHT_COUNT` says how many there are.

enums! {
    /// How the camera's rays run.
    #[derive(Default)]
    PROJECTION: ProjectionKind {
        #[default]
        Perspective = "perspective",
        Orthographic = "orthographic",
    }

    /// Where in the pixel the samples lie (`[sampling] pattern`).
    #[derive(Default)]
    PATTERN: Pattern {
        #[default]
        Center = "center",
        Grid = "grid",
        Random = "random",
        Stratified = "stratified",
        /// Kensler 2013, correlated.
        MultiJittered = "multi-jittered",
        /// Bases 2 and 3, nested scrambling.
        Halton = "halton",
        /// A (0,2)-sequence, nested scrambling (Burley 2020).
        SobolOwen = "sobol-owen",
        /// Blocks of one sequence along a shuffled Morton curve of pixels (Ahmed & Wonka 2020).
        BlueNoise = "blue-noise",
        /// Shirley 1991, also known as latin hypercube.
        NRooks = "n-rooks",
    }

    /// How samples are handed out to threads.
    #[derive(Default)]
    SCHEDULE: Schedule {
        /// Equally many to each pixel, tile by tile.
        #[default]
        Tiles = "tiles",
        /// By a list of jobs.
        Jobs = "jobs",
    }

    /// The shape of a pixel filter; the same along both axes, whose product it is.
    #[derive(Default)]
    PIXEL_FILTER: PixelFilterKind {
        #[default]
        Box = "box",
        Tent = "tent",
        /// exp(-x²/2σ²) less its value at the radius, which is 3σ.
        Gaussian = "gaussian",
        /// The cubic of Mitchell & Netravali 1988 with B = C = 1/3; negative beyond 4/7 of the radius.
        Mitchell = "mitchell",
        /// The four terms of Harris 1978 with the least side lobes.
        BlackmanHarris = "blackman-harris",
    }

    /// What a sample chooses beside its place in the pixel; from `Light` on anew at every hit.
    #[derive(Default)]
    DIMENSION: SampleDimension {
        /// A point of the lens.
        #[default]
        Lens = "lens",
        Time = "time",
        /// A place of lights with an extent.
        Light = "light",
        /// A direction of a glossy surface.
        Lobe = "lobe",
        /// Whether glass mirrors or refracts; by the pair of `Light`: where there is glass no light is chosen.
        Fresnel = "fresnel",
    }

    /// Over what a texture look-up is averaged (`[sampling] footprint`).
    #[derive(Default)]
    FOOTPRINT: Footprint {
        #[default]
        None = "none",
        /// A width and a spread (Amanatides 1984; Akenine-Möller et al. 2021).
        Cone = "cone",
        /// Two vectors each of origin and direction (Igehy 1999).
        Differentials = "differentials",
    }

    /// What a material's bump texture holds.
    #[derive(Default)]
    BUMP: BumpKind {
        /// Unit normals as 2 rgb - 1: along growing u, along growing v, outward.
        #[default]
        Normal = "normal",
        /// Heights.
        Bump = "bump",
        /// Unit normals whose green runs against v.
        NormalDown = "normal-down",
    }

    /// What shines; from `Sphere` on the lights have an extent.
    #[derive(Default)]
    LIGHT: LightKind {
        #[default]
        Point = "point",
        Directional = "directional",
        Sphere = "sphere",
        Rectangle = "rectangle",
        /// Directional, from a disc of the sky.
        Sun = "sun",
    }

    /// How a device forms a texture coordinate.
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
        /// The place on the cube's face, for a flat texture.
        Box = "box",
    }

    /// The vector that a map looks at.
    #[derive(Default)]
    ENTITY: EntityKind {
        #[default]
        Position = "position",
        Normal = "normal",
        Reflection = "reflection",
        /// Of the ray: an environment's.
        Direction = "direction",
    }

    /// Where the shader finds its texels.
    #[derive(Default)]
    SOURCE: TexelSource {
        /// No texture in the scene.
        #[default]
        None = "none",
        /// A texel buffer with all textures one after the other.
        Buffer = "buffer",
        /// One image a texture; the only source of the device's own samplers.
        Image = "image",
        /// Images, those of volumes and cubes among them, beside a texel buffer.
        Solids = "solids",
    }

    /// In which numbers geometry is read and computed.
    #[derive(Default)]
    REALS: Reals {
        #[default]
        F32 = "f32",
        /// Records hold f64, rays are of f64.
        F64Math = "f64-math",
        /// Records hold f64, which are rounded to f32 where they are read.
        F64Records = "f64-records",
    }

    /// How a texture is read.
    #[derive(Default)]
    TEXTURE_KIND: TextureKind {
        /// One or two dimensions.
        #[default]
        Flat = "flat",
        Volume = "volume",
        Cube = "cube",
        /// Computed at every look-up.
        Procedural = "procedural",
    }

    /// Powers of two wrap by a mask.
    #[derive(Default)]
    TEXTURE_SIZE: TextureSize {
        #[default]
        PowerOfTwo = "power-of-two",
        Any = "any",
    }

    /// Channels × number type. One channel reads as (g, g, g, 1), two as (g, g, g, a).
    #[derive(Default)]
    TEXEL_FORMAT: TexelFormat {
        #[default]
        Grey8 = "grey8",
        GreyAlpha8 = "grey-alpha8",
        Rgba8 = "rgba8",
        Grey16 = "grey16",
        GreyAlpha16 = "grey-alpha16",
        Rgba16 = "rgba16",
        GreyFloat = "grey-float",
        GreyAlphaFloat = "grey-alpha-float",
        RgbaFloat = "rgba-float",
    }

    /// How stored values become linear light; sRGB is decoded before filtering.
    #[derive(Default)]
    COLOR_SPACE: ColorSpace {
        #[default]
        Linear = "linear",
        Srgb = "srgb",
    }

    /// Pattern of a procedural texture. Hard-edged ones first, then those made of noise.
    #[derive(Default)]
    PROCEDURAL: ProceduralKind {
        /// Unit cubes; the figure where floor(x) + floor(y) + floor(z) is odd.
        #[default]
        Checker = "checker",
        /// The figure where the fraction of x is below `width`.
        Stripes = "stripes",
        /// Lines of `width`, centred on whole x and y, in three dimensions whole z too.
        Grid = "grid",
        /// Bricks of `aspect` × 1 with joints of `width`, every other row shifted by `offset` bricks.
        Brick = "brick",
        /// Gradient noise (Perlin 2002).
        Noise = "noise",
        /// A sum of octaves of noise.
        Fbm = "fbm",
        /// A sum of octaves of |noise|.
        Turbulence = "turbulence",
        /// A sine of x, displaced by turbulence.
        Marble = "marble",
        /// Rings about the z axis, displaced by a sum of octaves.
        Wood = "wood",
        /// Distance to the nearest of the points, one a cell (Worley 1996, F1).
        Cellular = "cellular",
    }

    /// Who filters: our shader in f32, or the device's texture unit.
    #[derive(Default)]
    METHOD: Method {
        #[default]
        Shader = "shader",
        Hardware = "hardware",
    }

    /// What a coordinate outside [0, 1) reads (Vulkan 1.3, "Wrapping Operation").
    #[derive(Default)]
    ADDRESS: Address {
        #[default]
        Repeat = "repeat",
        MirroredRepeat = "mirrored-repeat",
        ClampToEdge = "clamp-to-edge",
        ClampToBorder = "clamp-to-border",
        MirrorClampToEdge = "mirror-clamp-to-edge",
    }

    /// How the texels around a place, or under a footprint, become one value.
    #[derive(Default)]
    FILTER: Filter {
        #[default]
        Nearest = "nearest",
        Linear = "linear",
        /// Four by four texels, by B and C of Mitchell & Netravali 1988.
        Cubic = "cubic",
        /// One texel, by chance, with the weights of `linear` (Fajardo et al. 2023).
        Stochastic = "stochastic",
        /// Look-ups along the footprint's major axis (McCormack et al. 1999); as texture units do it.
        Anisotropic = "anisotropic",
        /// All texels under the footprint's ellipse (Heckbert 1989).
        Ewa = "ewa",
        /// The mean over the footprint's bounding box (Crow 1984).
        SummedArea = "summed-area",
        /// Four by four texels, by a windowed sinc (Duchon 1979).
        Lanczos2 = "lanczos-2",
        /// Six by six.
        Lanczos3 = "lanczos-3",
    }

    /// How levels of a mip chain become one value.
    #[derive(Default)]
    MIP: MipMode {
        #[default]
        None = "none",
        Nearest = "nearest",
        Linear = "linear",
    }

    /// Half: texel i is centred at i + ½ (Vulkan). Integer: at i (the lecture's formulas).
    #[derive(Default)]
    TEXEL_CENTER: TexelCenter {
        #[default]
        Half = "half",
        Integer = "integer",
    }

    /// What is counted where it goes beyond a limit.
    #[derive(Default)]
    DIAGNOSTIC: Diagnostic {
        /// Look-ups at coordinates that are no numbers.
        #[default]
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
