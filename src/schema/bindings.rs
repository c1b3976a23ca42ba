//! The descriptors of set 0. A number that stands twice belongs to shaders that have one of the two.

bindings! {
    /// What a shader writes: the film, or a probe's answers.
    OUTPUT = 0;
    /// The whole scene buffer.
    SCENE = 1;
    /// Images of flat textures.
    IMAGES = 2;
    /// Light of sRGB codes.
    SRGB_LIGHT = 3;
    /// A list that is worked off: jobs, or a probe's queries.
    LIST = 4;
    /// The front of the scene buffer, as uniforms.
    HEAD = 5;
    /// Texels of all textures, in words.
    TEXELS = 6;
    VOLUMES = 7;
    CUBES = 8;
    /// Sums along the rows of textures, for beams.
    PREFIX_SUMS = 9;
    /// Triangles by cells of the picture.
    TILE_LISTS = 10;
    /// Counters of what goes beyond a limit.
    DIAGNOSTICS = 11;
    /// Of the generator of mip chains: the texture as the texel buffer holds it.
    MIP_WORDS = 0;
    /// Numbers of two levels, between which the passes alternate.
    MIP_NUMBERS = 1;
    /// Linear light of all sRGB codes, and where the next code is nearer.
    MIP_TABLES = 2;
}
