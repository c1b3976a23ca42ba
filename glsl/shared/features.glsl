// What this scene uses, as specialization constants. The defaults keep everything; src/pack/features.rs
// narrows them. A constant that names modes is a bit mask: one bit set means the mode is known when
// the pipeline is built and no test is left; several mean a test at run time.
#ifndef FEATURES_GLSL
#define FEATURES_GLSL

const uint DYNAMIC = 0xFFFFFFFFu; // "read the number from the scene"

layout(constant_id = 2) const uint PROJECTIONS = 0x3u;
layout(constant_id = 3) const uint PATTERNS = 0x1FFu;
layout(constant_id = 4) const uint STRATA_SIDE = DYNAMIC;
layout(constant_id = 64) const uint SAMPLES = DYNAMIC;
layout(constant_id = 5) const uint PLANES = DYNAMIC;
layout(constant_id = 6) const uint SPHERES = DYNAMIC;
layout(constant_id = 7) const uint TRIANGLES = DYNAMIC;
layout(constant_id = 8) const uint LIGHTS = DYNAMIC;
layout(constant_id = 9) const uint MATERIALS = DYNAMIC;
layout(constant_id = 10) const uint MAPS = DYNAMIC;
layout(constant_id = 11) const uint TEXTURES = DYNAMIC;
layout(constant_id = 12) const uint SAMPLERS = DYNAMIC;
layout(constant_id = 13) const bool BOUNDED_PLANES = true;
layout(constant_id = 14) const bool SMOOTH_NORMALS = true;
layout(constant_id = 15) const uint MODELS = 0x1Fu;
layout(constant_id = 16) const uint LIGHT_KINDS = 0x1Fu;
layout(constant_id = 17) const bool SHADOWS = true;
layout(constant_id = 18) const bool BOUNCES = true;
layout(constant_id = 19) const uint MAPPINGS = 0xFFu;
layout(constant_id = 31) const bool ROTATED_UV = true;
layout(constant_id = 20) const bool TEXTURED = true;   // some material reads a texture
layout(constant_id = 21) const bool UNTEXTURED = true; // some material reads none
layout(constant_id = 22) const uint METHODS = 0x3u;
layout(constant_id = 23) const uint ADDRESSES_U = 0x1Fu;
layout(constant_id = 24) const uint ADDRESSES_V = 0x1Fu;
layout(constant_id = 25) const uint FILTERS = 0x7Fu;
layout(constant_id = 33) const uint MIPS = 0x7u;
layout(constant_id = 34) const uint FOOTPRINTS = 0x7u;
layout(constant_id = 35) const uint ENTITIES = 0xFu;
layout(constant_id = 36) const uint TEXTURE_KINDS = 0xFu;
layout(constant_id = 37) const uint ADDRESSES_W = 0x1Fu;
layout(constant_id = 38) const bool MIPMAPPED = true;   // some texture has more than one level
layout(constant_id = 39) const bool ENVIRONMENT = true;
layout(constant_id = 49) const bool POLES = true;       // environments whose rows go on over the poles
layout(constant_id = 50) const bool BUMPED = true;
layout(constant_id = 51) const uint BUMP_KINDS = 0x7u;
layout(constant_id = 52) const bool RANDOM = true;      // look-ups take texels at random
layout(constant_id = 26) const uint TEXEL_CENTERS = 0x3u;
layout(constant_id = 32) const uint TEXTURE_SIZES = 0x3u;
layout(constant_id = 57) const bool NONFINITE = true;   // some texels are no numbers
layout(constant_id = 27) const uint TEXEL_FORMATS = 0x1FFu;
layout(constant_id = 28) const uint COLOR_SPACES = 0x3u;
layout(constant_id = 55) const bool DEEP_SRGB = true;   // some texture has sRGB of 16 bits
layout(constant_id = 29) const bool COMPENSATED = true; // more samples than one chunk holds
layout(constant_id = 82) const bool BLOCKS = true;      // a thread may sum more than MAX_PLAIN samples
layout(constant_id = 30) const uint SLOTS = 1u;         // image descriptors: flat, volumes, cubes
layout(constant_id = 53) const uint VOLUME_SLOTS = 1u;
layout(constant_id = 54) const uint CUBE_SLOTS = 1u;
layout(constant_id = 58) const uint TEXEL_BLOCKS = 16u; // buffers that the texels lie in, of as many words
layout(constant_id = 59) const uint BLOCK_LOG2 = 16u;

layout(constant_id = 60) const uint PROCEDURALS = DYNAMIC;
layout(constant_id = 61) const uint PROCEDURAL_KINDS = 0x3FFu;
layout(constant_id = 62) const bool PROCEDURAL_FILTERED = true; // averaged over footprints
layout(constant_id = 65) const uint SCHEDULES = 0x3u;
layout(constant_id = 66) const uint PIXEL_FILTERS = 0x1Fu;
layout(constant_id = 77) const bool TILE_CULLED = true;    // triangles are listed by cells of the picture
layout(constant_id = 67) const bool WARPED = true;      // a pixel filter that is not the pixel's own square
layout(constant_id = 80) const uint CONE_SHAPES = DYNAMIC; // of the scene, where a cone can hold all

layout(constant_id = 81) const bool DIAGNOSED = true;     // counts what goes beyond a limit
layout(constant_id = 70) const uint SAMPLE_DIMENSIONS = 0x1Fu; // what samples choose beside their place in the pixel
layout(constant_id = 71) const uint MOTIONS = DYNAMIC;     // as many as shapes where some move, else none
layout(constant_id = 72) const bool MOVING_CAMERA = true;

// Where each list begins in the scene buffer, in units of 16 bytes.
layout(constant_id = 40) const uint PLANES_AT = 0u;
layout(constant_id = 41) const uint SPHERES_AT = 0u;
layout(constant_id = 42) const uint TRIANGLES_AT = 0u;
layout(constant_id = 43) const uint LIGHTS_AT = 0u;
layout(constant_id = 44) const uint MATERIALS_AT = 0u;
layout(constant_id = 45) const uint MAPS_AT = 0u;
layout(constant_id = 46) const uint TEXTURES_AT = 0u;
layout(constant_id = 47) const uint SAMPLERS_AT = 0u;
layout(constant_id = 63) const uint PROCEDURALS_AT = 0u;
layout(constant_id = 68) const uint PIXEL_FILTER_AT = 0u;
layout(constant_id = 78) const bool TABLES_IN_HEAD = true; // what reads a table at scattered places differs by device
layout(constant_id = 73) const uint MOTIONS_AT = 0u;

// Whether the run-time mode is `value`, decided at build time where the mask allows.
#define MODE_IS(mask, value, runtime) \
    ((mask) == (1u << (value)) || ((((mask) >> (value)) & 1u) != 0u && (runtime) == (value)))
#define HAS(mask, value) ((((mask) >> (value)) & 1u) != 0u)
#define COUNT(constant, runtime) ((constant) == DYNAMIC ? (runtime) : (constant))

#endif
