//! The specialization constants: name in the shader, meaning of the value, and the user-visible name of the code that
//! it controls. Ids follow the order; those of the lists of records (`NAME` for the length, `NAME_AT` for the offset,
//! or `DYNAMIC`) come last. `modes` is a bit mask: with one bit set the mode is known when the pipeline is built and no
//! test remains; several bits mean a test at run time. `count` is a number or `DYNAMIC`, `switch` is code that may be
//! removed; the defaults keep everything, and `src/pack/features.rs` narrows these three. A `parameter` is set by the
//! code that builds the pipeline; for `id` the shader's file itself declares type and default.

specialization! {
    GroupX = "GROUP_X", id, "width of a workgroup";
    GroupY = "GROUP_Y", id, "height of a workgroup";
    Projections = "PROJECTIONS", modes(ProjectionKind), "projection";
    Patterns = "PATTERNS", modes(Pattern), "pattern";
    StrataSide = "STRATA_SIDE", count, "number of strata read at run time";
    Samples = "SAMPLES", count, "number of samples read at run time";
    BoundedPlanes = "BOUNDED_PLANES", switch, "bounds of planes";
    SmoothNormals = "SMOOTH_NORMALS", switch, "interpolated normals";
    Models = "MODELS", modes(Model), "reflection model";
    LightKinds = "LIGHT_KINDS", modes(LightKind), "light";
    /// Some point shines within a cone, or up to a distance.
    Ranged = "RANGED", switch, "cones and ranges of lights";
    /// Some rough mirror reflects an environment that is a light.
    RoughMirrors = "ROUGH_MIRRORS", switch, "environment in rough mirrors";
    Shadows = "SHADOWS", switch, "shadow rays";
    Bounces = "BOUNCES", switch, "bounces";
    Environment = "ENVIRONMENT", switch, "environment";
    Footprints = "FOOTPRINTS", modes(Footprint), "footprint";
    /// Look-ups choose texels at random.
    Random = "RANDOM", switch, "random texels";
    Mappings = "MAPPINGS", modes(MapKind), "mapping";
    Entities = "ENTITIES", modes(EntityKind), "entity";
    /// Some texture coordinates may be infinite, or no numbers.
    BoundlessUv = "BOUNDLESS_UV", switch, "coordinates beyond all bounds";
    RotatedUv = "ROTATED_UV", switch, "rotation of texture coordinates";
    /// Some material reads a texture.
    Textured = "TEXTURED", switch, "texture look-ups";
    /// Some material reads none.
    Untextured = "UNTEXTURED", switch, "plain materials";
    Bumped = "BUMPED", switch, "bump or normal map";
    MaterialMaps = "MATERIAL_MAPS", modes(MaterialMap), "map of a material";
    AlphaModes = "ALPHA_MODES", modes(AlphaMode), "alpha";
    /// Some material beside the unlit ones emits light.
    Emissive = "EMISSIVE", switch, "emission";
    /// Light passes the body of some material of model `metallic-roughness`.
    Transmissive = "TRANSMISSIVE", switch, "light through bodies";
    /// Some surface other than a mesh is seen from the front only.
    OneSided = "ONE_SIDED", switch, "surfaces without a back";
    /// Triangles of meshes are met from the front only.
    CulledBacks = "CULLED_BACKS", switch, "meshes without backs";
    /// Meshes have colours at their vertices.
    VertexColors = "VERTEX_COLORS", switch, "colours of vertices";
    /// Meshes have a second set of texture coordinates.
    SecondUv = "SECOND_UV", switch, "second texture coordinates";
    /// Meshes have tangents at their vertices.
    Tangents = "TANGENTS", switch, "tangents of vertices";
    BumpKinds = "BUMP_KINDS", modes(BumpKind), "bump or normal map";
    Methods = "METHODS", modes(Method), "look-up method";
    AddressesU = "ADDRESSES_U", modes(Address), "address u";
    AddressesV = "ADDRESSES_V", modes(Address), "address v";
    AddressesW = "ADDRESSES_W", modes(Address), "address w";
    /// Environments whose rows continue across the poles.
    Poles = "POLES", switch, "rows over the poles";
    Filters = "FILTERS", modes(Filter), "filter";
    Mips = "MIPS", modes(MipMode), "mip mode";
    TexelCenters = "TEXEL_CENTERS", modes(TexelCenter), "texel centre";
    TextureSizes = "TEXTURE_SIZES", modes(TextureSize), "texture size";
    TextureKinds = "TEXTURE_KINDS", modes(TextureKind), "texture kind";
    /// Some texture has more than one level.
    Mipmapped = "MIPMAPPED", switch, "levels of textures";
    /// Some texels are NaN or infinite.
    Nonfinite = "NONFINITE", switch, "texels that are no numbers";
    TexelFormats = "TEXEL_FORMATS", modes(TexelFormat), "texel format";
    ColorSpaces = "COLOR_SPACES", modes(ColorSpace), "colour space";
    /// Some texture has 16-bit sRGB.
    DeepSrgb = "DEEP_SRGB", switch, "sRGB of 16 bits";
    ProceduralKinds = "PROCEDURAL_KINDS", modes(ProceduralKind), "procedural";
    /// Averaged over footprints.
    ProceduralFiltered = "PROCEDURAL_FILTERED", switch, "filter of procedural textures";
    /// More samples than one invocation takes at once.
    Compensated = "COMPENSATED", switch, "second film for rounding errors";
    /// An invocation may sum more than `MAX_PLAIN` samples.
    Blocks = "BLOCKS", switch, "sums by blocks";
    /// The number of shapes, if a cone has room for all.
    ConeShapes = "CONE_SHAPES", count, "cones through more shapes";
    /// Sample dimensions beside the position in the pixel.
    SampleDimensions = "SAMPLE_DIMENSIONS", modes(SampleDimension), "choice of a sample";
    MovingCamera = "MOVING_CAMERA", switch, "motion of the camera";
    Schedules = "SCHEDULES", modes(Schedule), "schedule";
    PixelFilters = "PIXEL_FILTERS", modes(PixelFilterKind), "pixel filter";
    /// Counts exceeded limits.
    Diagnosed = "DIAGNOSED", switch, "counters of what goes beyond a limit";
    /// Shapes are listed for the cells of the picture.
    TileCulled = "TILE_CULLED", switch, "shapes by cells of the picture";
    /// A pixel filter other than the box of one pixel.
    Warped = "WARPED", switch, "samples beyond their pixels";
    PixelFilterAt = "PIXEL_FILTER_AT", parameter(0), "where the table of the pixel filter begins";
    /// Image descriptors: of 2D textures, volumes, cubes.
    Slots = "SLOTS", parameter(1), "flat images";
    VolumeSlots = "VOLUME_SLOTS", parameter(1), "images of volumes";
    CubeSlots = "CUBE_SLOTS", parameter(1), "images of cubes";
    /// Buffers of texels, of 2^`BLOCK_LOG2` words except for the last.
    TexelBlocks = "TEXEL_BLOCKS", parameter(16), "texel buffers";
    BlockLog2 = "BLOCK_LOG2", parameter(16), "length of texel buffers";
    /// A bilinear look-up reads its four texels at once.
    TexelQuads = "TEXEL_QUADS", flag, "four texels at once";
    /// 1 if tables are read from the uniform buffer: devices differ in the cost of reads at scattered places.
    TablesInHead = "TABLES_IN_HEAD", flag, "tables in uniforms";
    /// A bit mask of `Quantity`: radiance alone by default.
    Quantities = "QUANTITIES", parameter(1), "quantities in place of radiance";
    MeshSearch = "MESH_SEARCH", parameter(0), "by lists or trees";
    /// A pixel lists the triangles of meshes that may shade what it sees.
    ListsShades = "LISTS_SHADES", flag, "lists of shadows";
    /// Triangles of meshes are kept in registers for all samples of a pixel.
    HoldsTriangles = "HOLDS_TRIANGLES", flag, "triangles in registers";
    /// The device ends the loops of threads that turn often.
    LoopsEnd = "LOOPS_END", flag, "test for loops that the device ended";
    OpaqueUniforms = "OPAQUE_UNIFORMS", id, "numbers whose uniformity is hidden";
    GoalStepKind = "GOAL_STEP", id, "step of a pass of sampling to a goal";
    MipChannels = "CHANNELS", id, "channels of a mip chain";
    MipComponentBytes = "COMPONENT_BYTES", id, "bytes of a mip chain's channels";
    MipSrgb = "SRGB", id, "a mip chain of sRGB codes";
}
