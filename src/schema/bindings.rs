//! The descriptors of set 0. A number that occurs twice belongs to shaders that have only one of the two.

bindings! {
    /// The output of a shader: the film, or a probe's results.
    OUTPUT = 0;
    /// The whole scene buffer.
    SCENE = 1;
    /// Images of 2D textures.
    IMAGES = 2;
    /// Linear values of sRGB codes.
    SRGB_LIGHT = 3;
    /// The input list: batches, or a probe's queries.
    LIST = 4;
    /// The front of the scene buffer, as a uniform buffer.
    HEAD = 5;
    /// Texels of all textures, in words.
    TEXELS = 6;
    VOLUMES = 7;
    CUBES = 8;
    /// Prefix sums of the rows of textures, for beams.
    PREFIX_SUMS = 9;
    /// Lists of triangles for the cells of the picture.
    TILE_LISTS = 10;
    /// Counters of exceeded limits.
    DIAGNOSTICS = 11;
    /// Nodes, corners and attributes of meshes.
    MESHES = 12;
    /// Entries that a submission leaves unfinished.
    UNFINISHED = 13;
    /// For sampling to a goal: what is kept of each pixel, of the whole picture, and the pixels that beams resolved.
    GOAL_PIXELS = 1;
    GOAL_TOTALS = 2;
    GOAL_RESOLVED = 3;
    /// Parts of long batches, and their sums.
    GOAL_PARTS = 5;
    GOAL_PART_SUMS = 6;
    /// For generating mip chains: the texture as in the texel buffer.
    MIP_WORDS = 0;
    /// Values of two levels, between which the passes alternate.
    MIP_NUMBERS = 1;
    /// Linear values of all sRGB codes, and the values from which on the next code is nearer.
    MIP_TABLES = 2;
}
