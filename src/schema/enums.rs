//! The enums that host and device share. Each has a prefix: `LightKind::Sun` is `LIGHT_SUN` in the shader,
//! and `LIGHT_COUNT` is the number of variants.

// For the library; the build reads both tables.
#[allow(unused_imports)]
pub use super::surface_enums::*;

enums! {
    /// The projection of the camera.
    #[derive(Default)]
    PROJECTION: ProjectionKind {
        #[default]
        Perspective = "perspective",
        Orthographic = "orthographic",
    }

    /// The sample pattern within a pixel (`[sampling] pattern`).
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
        /// Shirley 1991, also known as Latin hypercube.
        NRooks = "n-rooks",
    }

    /// A step of a pass of sampling to a goal.
    STEP: GoalStepKind {
        TakeCounts = "take-counts",
        Replace = "replace",
        See = "see",
        SumRows = "sum-rows",
        FindVariances = "find-variances",
        FindUnseen = "find-unseen",
        SumPartials = "sum-partials",
        SpreadDiscoveries = "spread-discoveries",
        RaiseListed = "raise-listed",
        RaiseToFloors = "raise-to-floors",
        FillBins = "fill-bins",
        Solve = "solve",
        ChooseCounts = "choose-counts",
        ListBatches = "list-batches",
        ListParts = "list-parts",
        EndParts = "end-parts",
        AddParts = "add-parts",
        PlanAll = "plan-all",
        SumCapped = "sum-capped",
        WeighCells = "weigh-cells",
        SumMasses = "sum-masses",
        DrawPixels = "draw-pixels",
        DrawParts = "draw-parts",
        SumDraws = "sum-draws",
        FindMeans = "find-means",
    }

    /// The distribution of samples over invocations.
    #[derive(Default)]
    SCHEDULE: Schedule {
        /// An equal number of samples in each pixel, tile by tile.
        #[default]
        Tiles = "tiles",
        /// By a list of batches.
        Batches = "batches",
    }

    /// The shape of a pixel filter, which is the product of the same function along both axes.
    #[derive(Default)]
    PIXEL_FILTER: PixelFilterKind {
        #[default]
        Box = "box",
        Tent = "tent",
        /// exp(-x²/2σ²) less its value at the radius, which is 3σ.
        Gaussian = "gaussian",
        /// The cubic of Mitchell & Netravali 1988 with B = C = 1/3; negative beyond 4/7 of the radius.
        Mitchell = "mitchell",
        /// The four-term window of Harris 1978 with the smallest side lobes.
        BlackmanHarris = "blackman-harris",
    }

    /// The sample dimensions beside the position in the pixel; those from `Light` on are drawn anew at every
    /// hit.
    #[derive(Default)]
    DIMENSION: SampleDimension {
        /// A point on the lens.
        #[default]
        Lens = "lens",
        Time = "time",
        /// A point on an area light.
        Light = "light",
        /// A direction of a glossy lobe.
        Lobe = "lobe",
        /// The choice of reflection or refraction; from the pair of `Light`, as no light is sampled on glass.
        Fresnel = "fresnel",
    }

    /// What samples measure: the radiance of their paths, or one property of what the camera ray hits first, each of
    /// which is described at the layer of the same name (`src/render/aov.rs`).
    #[derive(Default)]
    QUANTITY: Quantity {
        #[default]
        Radiance = "radiance",
        Texels = "texels",
        Magnification = "magnification",
        Level = "level",
        Anisotropy = "anisotropy",
        Uv = "uv",
        Normal = "normal",
        Depth = "depth",
        Instance = "instance",
        Material = "material",
        Albedo = "albedo",
        /// The place where the shape does not move, from the eye at time 0.
        Place = "place",
        /// The number of the shape, the facet's normal and the shading normal before bump maps, as numbers.
        Facet = "facet",
    }

    /// The footprint over which a texture look-up is averaged (`[sampling] footprint`).
    #[derive(Default)]
    FOOTPRINT: Footprint {
        #[default]
        None = "none",
        /// A width and a spread (Amanatides 1984; Akenine-Möller et al. 2021).
        Cone = "cone",
        /// Two vectors each of origin and direction (Igehy 1999).
        Differentials = "differentials",
    }

    /// The source of texels in a shader.
    #[derive(Default)]
    SOURCE: TexelSource {
        /// No texture in the scene.
        #[default]
        None = "none",
        /// A texel buffer with all textures one after the other.
        Buffer = "buffer",
        /// One image per texture; the only source for the device's own samplers.
        Image = "image",
        /// Images, also of volumes and cubes, beside a texel buffer.
        Solids = "solids",
    }

    /// The precision in which geometry is stored and computed.
    #[derive(Default)]
    REALS: Reals {
        #[default]
        F32 = "f32",
        /// Records and rays are f64.
        F64Math = "f64-math",
        /// Records are f64 and rounded to f32 when they are read.
        F64Records = "f64-records",
    }

    /// The kind of a texture.
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

    /// The class of a texture's size; powers of two wrap by a mask.
    #[derive(Default)]
    TEXTURE_SIZE: TextureSize {
        #[default]
        PowerOfTwo = "power-of-two",
        Any = "any",
    }

    /// Channels × component type. One channel reads as (g, g, g, 1), two as (g, g, g, a).
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

    /// The conversion from stored to linear values; sRGB is decoded before filtering.
    #[derive(Default)]
    COLOR_SPACE: ColorSpace {
        #[default]
        Linear = "linear",
        Srgb = "srgb",
    }

    /// The pattern of a procedural texture: first those with hard edges, then those made of noise.
    #[derive(Default)]
    PROCEDURAL: ProceduralKind {
        /// Unit cubes; the figure where floor(x) + floor(y) + floor(z) is odd.
        #[default]
        Checker = "checker",
        /// The figure where the fraction of x is below `width`.
        Stripes = "stripes",
        /// Lines of `width`, centred on integer x and y, in three dimensions also z.
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
        /// Distance to the nearest feature point, one per cell (Worley 1996, F1).
        Cellular = "cellular",
    }

    /// The implementation of a filter: shader code in f32, or the device's texture unit.
    #[derive(Default)]
    METHOD: Method {
        #[default]
        Shader = "shader",
        Hardware = "hardware",
    }

    /// The result of a coordinate outside [0, 1) (Vulkan 1.3, "Wrapping Operation").
    #[derive(Default)]
    ADDRESS: Address {
        #[default]
        Repeat = "repeat",
        MirroredRepeat = "mirrored-repeat",
        ClampToEdge = "clamp-to-edge",
        ClampToBorder = "clamp-to-border",
        MirrorClampToEdge = "mirror-clamp-to-edge",
    }

    /// The filter that turns the texels around a point, or under a footprint, into one value.
    #[derive(Default)]
    FILTER: Filter {
        #[default]
        Nearest = "nearest",
        Linear = "linear",
        /// Four by four texels, with B and C of Mitchell & Netravali 1988.
        Cubic = "cubic",
        /// One texel, chosen at random with the weights of `linear` (Fajardo et al. 2023).
        Stochastic = "stochastic",
        /// Look-ups along the footprint's major axis (McCormack et al. 1999), as texture units do.
        Anisotropic = "anisotropic",
        /// All texels under the footprint's ellipse (Heckbert 1989).
        Ewa = "ewa",
        /// The mean over the footprint's bounding box (Crow 1984).
        SummedArea = "summed-area",
        /// Four by four texels, with a windowed sinc (Duchon 1979).
        Lanczos2 = "lanczos-2",
        /// Six by six texels.
        Lanczos3 = "lanczos-3",
    }

    /// The filter between levels of a mip chain.
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

    /// The limits whose violations are counted.
    #[derive(Default)]
    DIAGNOSTIC: Diagnostic {
        /// Look-ups at coordinates that are NaN or infinite.
        #[default]
        Coordinates = "coordinates",
        /// Look-ups that need a level beyond the texture's last.
        Levels = "levels",
        /// Look-ups whose footprint is more elongated than the sampler's anisotropy.
        Anisotropy = "anisotropy",
        /// Footprints of rays at grazing angles that were truncated.
        Grazing = "grazing",
        /// Paths that ended in black at the maximum depth.
        Depth = "depth",
        /// Cones for which there was no room.
        Pieces = "pieces",
        /// Samples whose radiance is NaN or infinite.
        Radiance = "radiance",
        /// Paths that ended in black behind `MAX_LAYERS` surfaces that let rays pass.
        Layers = "layers",
    }
}
