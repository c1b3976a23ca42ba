// The one layout contract: what lies where in the scene buffer, in units of uvec4 (16 bytes).
// src/schema/layout.rs mirrors every struct and asserts its size. Positions are relative to the eye.
// Numbers of modes equal the order of the Rust enums; a test compares both.
#ifndef LAYOUT_GLSL
#define LAYOUT_GLSL

#include "opaque.glsl"
#include "real.glsl"

const uint PROJECTION_PERSPECTIVE = 0u;
const uint PROJECTION_ORTHOGRAPHIC = 1u;

const uint PATTERN_CENTER = 0u;
const uint PATTERN_GRID = 1u;
const uint PATTERN_RANDOM = 2u;
const uint PATTERN_STRATIFIED = 3u;
const uint PATTERN_MULTI_JITTERED = 4u;
const uint PATTERN_HALTON = 5u;
const uint PATTERN_SOBOL_OWEN = 6u;
const uint PATTERN_BLUE_NOISE = 7u;
const uint PATTERN_N_ROOKS = 8u;

const uint SCHEDULE_TILES = 0u;
const uint SCHEDULE_JOBS = 1u;
const uint JOB_BARE = 2u; // without a footprint
const uint JOB_APART = 4u; // sums go to the place of the job in its list, not to the pixel's half
const uint JOB_STREAM_SHIFT = 8u; // above it: which stream of samples, each as good as another seed

const uint CELL_WORDS = 64u; // of a cell of the survey: number of triangles, calmness, up to MAX_LISTED triangles
const uint MAX_LISTED = 62u;
const uint CELL_EMPTY = 0u;
const uint CELL_UNIFORM = 1u;
const uint CELL_BUSY = 2u;
const uint NO_LIST = 0xFFFFFFFFu;

const uint PIXEL_FILTER_BOX = 0u;
const uint PIXEL_FILTER_TENT = 1u;
const uint PIXEL_FILTER_GAUSSIAN = 2u;
const uint PIXEL_FILTER_MITCHELL = 3u;
const uint PIXEL_FILTER_BLACKMAN_HARRIS = 4u;
const uint PIXEL_FILTER_CELLS = 512u; // of the table by which samples are placed
const uint DIMENSION_LENS = 0u;
const uint DIMENSION_TIME = 1u;
const uint DIMENSION_LIGHT = 2u; // from here on dimensions are made at every hit
const uint DIMENSION_LOBE = 3u;
const uint DIMENSION_FRESNEL = 4u; // by the pair of the light: where there is glass no light is chosen

const uint MODEL_UNLIT = 0u;
const uint MODEL_LAMBERT = 1u;
const uint MODEL_MIRROR = 2u;
const uint MODEL_DIELECTRIC = 3u;
const uint MODEL_PHONG = 4u;

const uint FOOTPRINT_NONE = 0u;
const uint FOOTPRINT_CONE = 1u;
const uint FOOTPRINT_DIFFERENTIALS = 2u;

const uint ENTITY_POSITION = 0u;
const uint ENTITY_NORMAL = 1u;
const uint ENTITY_REFLECTION = 2u;
const uint ENTITY_DIRECTION = 3u; // of the ray: an environment's

const uint BUMP_NORMAL = 0u;
const uint BUMP_BUMP = 1u;
const uint BUMP_NORMAL_DOWN = 2u;

const uint LIGHT_POINT = 0u;
const uint LIGHT_DIRECTIONAL = 1u;
const uint LIGHT_SPHERE = 2u; // from here on the lights have an extent
const uint LIGHT_RECTANGLE = 3u;
const uint LIGHT_SUN = 4u;

const uint MAP_PLANE = 0u;       // the plane's own coordinates
const uint MAP_AFFINE = 1u;      // affine in the position: planar
const uint MAP_VERTEX_UV = 2u;   // interpolated over a triangle
const uint MAP_CYLINDRICAL = 3u;
const uint MAP_SPHERICAL = 4u;
const uint MAP_SOLID = 5u; // affine in the entity, three coordinates
const uint MAP_CUBE = 6u;  // a direction for a cube texture
const uint MAP_BOX = 7u;   // the place on the cube's face, for a flat texture

const uint METHOD_SHADER = 0u;
const uint METHOD_HARDWARE = 1u;

const uint ADDRESS_REPEAT = 0u;
const uint ADDRESS_MIRRORED_REPEAT = 1u;
const uint ADDRESS_CLAMP_TO_EDGE = 2u;
const uint ADDRESS_CLAMP_TO_BORDER = 3u;
const uint ADDRESS_MIRROR_CLAMP_TO_EDGE = 4u;

const uint FILTER_NEAREST = 0u;
const uint FILTER_LINEAR = 1u;
const uint FILTER_CUBIC = 2u;
const uint FILTER_STOCHASTIC = 3u;
const uint FILTER_ANISOTROPIC = 4u;
const uint FILTER_EWA = 5u;
const uint FILTER_SUMMED_AREA = 6u;

const uint MIP_NONE = 0u;
const uint MIP_NEAREST = 1u;
const uint MIP_LINEAR = 2u;

const uint TEXTURE_KIND_FLAT = 0u;
const uint TEXTURE_KIND_VOLUME = 1u;
const uint TEXTURE_KIND_CUBE = 2u;
const uint TEXTURE_KIND_PROCEDURAL = 3u;

const uint TEXEL_CENTER_HALF = 0u;
const uint TEXEL_CENTER_INTEGER = 1u;

const uint TEXEL_FORMAT_GREY8 = 0u;
const uint TEXEL_FORMAT_GREY_ALPHA8 = 1u;
const uint TEXEL_FORMAT_RGBA8 = 2u;
const uint TEXEL_FORMAT_GREY16 = 3u;
const uint TEXEL_FORMAT_GREY_ALPHA16 = 4u;
const uint TEXEL_FORMAT_RGBA16 = 5u;
const uint TEXEL_FORMAT_GREY_FLOAT = 6u;
const uint TEXEL_FORMAT_GREY_ALPHA_FLOAT = 7u;
const uint TEXEL_FORMAT_RGBA_FLOAT = 8u;

const uint TEXTURE_SIZE_POWER_OF_TWO = 0u;
const uint TEXTURE_SIZE_ANY = 1u;

const uint COLOR_SPACE_LINEAR = 0u;
const uint COLOR_SPACE_SRGB = 1u;

const uint PROCEDURAL_CHECKER = 0u;
const uint PROCEDURAL_STRIPES = 1u;
const uint PROCEDURAL_GRID = 2u;
const uint PROCEDURAL_BRICK = 3u;
const uint PROCEDURAL_NOISE = 4u;
const uint PROCEDURAL_FBM = 5u;
const uint PROCEDURAL_TURBULENCE = 6u;
const uint PROCEDURAL_MARBLE = 7u;
const uint PROCEDURAL_WOOD = 8u;
const uint PROCEDURAL_CELLULAR = 9u;

const uint DIAGNOSTIC_COORDINATES = 0u;
const uint DIAGNOSTIC_LEVELS = 1u;
const uint DIAGNOSTIC_ANISOTROPY = 2u;
const uint DIAGNOSTIC_GRAZING = 3u;
const uint DIAGNOSTIC_DEPTH = 4u;
const uint DIAGNOSTIC_PIECES = 5u;
const uint DIAGNOSTIC_RADIANCE = 6u;
const uint DIAGNOSTICS = 7u;

const uint NO_TEXTURE = 0xFFFFFFFFu;
const uint NO_SHAPE = 0xFFFFFFFFu;
const uint NO_MATERIAL = 0xFFFFFFFFu;
const float FAR = 1e30; // farther than any hit that counts

struct Header {
    real4 forward;    // unit view direction; w: unused
    real4 step_x;     // one pixel to the right: added to direction (perspective) or origin (orthographic);
                     // w: side of the part of a pixel that a sample stands for;
                     // 0 without a footprint
    real4 step_y;     // one pixel down; w: a pixel's side
    vec4 background; // linear RGB
    uvec4 image;     // width, height, crop x, crop y
    uvec4 size;      // film width, film height, projection, max depth
    uvec4 sampling;  // pattern, strata a side, samples, seed
    uvec4 key;       // 1 when all pixels share their displacements; lights; footprint; the environment's map
    uvec4 counts;    // planes, spheres, triangles, the environment's material
    uvec4 chances;   // one bit for each choice that samples make; motions; 1 when the camera moves
    vec4 lens;       // its radius over a pixel's side at distance 1, or 0; 1 / focus distance; when the shutter
                     // opens, how long it is open
    real4 view;       // from the eye to what it looks at
    real4 up;
    real4 eye_motion; // between the times 0 and 1
    real4 view_motion;
    uvec4 pixel_filter; // kind, radius and width (bits; pixels), first step from the middle where it is negative
};

struct Plane {
    real4 normal;   // unit n; w = n·(origin − eye)
    real4 axis_u;   // own coordinate u of an eye-relative point p, counted from the eye: xyz·p; plus
    real4 axis_v;   // w it counts from the plane's origin. v likewise
    uvec4 link;    // material, map, and of bounded planes the half extent: f32 bits and 1, or f64 bits
};

struct Sphere {
    real4 ball;  // centre, radius
    uvec4 link; // material, map
};

struct Triangle {
    real4 a;        // vertex; w = u
    real4 b;
    real4 c;
    real4 v;        // v of the three vertices; w = 1 with shading normals
    real4 normal;   // unit geometric normal; w = n·a
    real4 normal_a; // unit shading normals
    real4 normal_b;
    real4 normal_c;
    uvec4 link;    // material, map
};

struct Light {
    real4 place;  // position relative to the eye, or unit direction towards the light; w: a sphere's radius,
                 // or the height of the sun's cap on the unit sphere
    vec4 power;  // intensity (W/sr), irradiance, or of a rectangle radiance
    uvec4 link;  // kind
    real4 edge_u; // of a rectangle: its sides, the longer first; it shines where edge_u × edge_v points
    real4 edge_v; // their lengths are last, 0 where they are not at right angles
};

struct Material {
    vec4 color;    // w: strength of the bump
    uvec4 link;    // model, texture or NO_TEXTURE, sampler, image slot
    uvec4 detail;  // the bump's texture or NO_TEXTURE, sampler, image slot; normal or bump map
    vec4 specular; // colour of the highlight, of mirrors and glass x: alpha of their facets; w: the highlight's
                   // exponent, or the refractive index
};

struct UvProjection {
    real4 x;      // frame coordinates of an eye-relative point p: xyz·p + w
    real4 y;
    real4 z;
    real4 matrix; // uv' = (m00 u + m01 v, m10 u + m11 v) + offset
    real4 offset;
    uvec4 link;  // kind, entity
};

struct Texture {
    uvec4 place; // first word of level 0 in the texel buffer, width, height, format
    uvec4 link;  // colour space, levels, depth, kind
};

struct Sampler {
    vec4 border;
    uvec4 modes; // address u, address v, magnification filter, texel centre
    uvec4 link;  // method, minification filter, mip mode, maximum anisotropy
    uvec4 more;  // address w, 1 where rows go on over the poles, B and C of the cubic filter (bits)
};

struct Procedural {
    vec4 background; // linear RGB
    vec4 figure;
    real4 shape;      // width, aspect, offset, jitter
    vec4 octaves;    // lacunarity, gain, 1 / sum of the gains, distortion
    uvec4 link;      // kind, seed, number of octaves, dimensions
};

// Of a shape, in their order: planes, spheres, triangles.
struct Motion {
    real4 shift; // between the times 0 and 1
};

layout(std430, set = 0, binding = 1) readonly buffer SceneBuffer { uvec4 scene[]; };

// The first 16 KiB of the scene buffer once more, which devices read fastest as uniforms: header, short lists.
const uint HEAD_UNITS = 1024u;
layout(std140, set = 0, binding = 5) uniform SceneHead { uvec4 head[HEAD_UNITS]; };

#define READ_HEAD(at) OPAQUE(head[at])
#define READ_SCENE(at) scene[at]
// A vector of reals behind `reals` of them and `others` that are none.
#define R(read, at, reals, others) READ_REAL(read, (at) + (reals) * REAL_UNITS + (others))
#define F(read, at, reals, others) uintBitsToFloat(read((at) + (reals) * REAL_UNITS + (others)))
#define U(read, at, reals, others) read((at) + (reals) * REAL_UNITS + (others))

Header load_header() {
    return Header(R(READ_HEAD, 0u, 0u, 0u), R(READ_HEAD, 0u, 1u, 0u), R(READ_HEAD, 0u, 2u, 0u), F(READ_HEAD, 0u, 3u, 0u),
                  U(READ_HEAD, 0u, 3u, 1u), U(READ_HEAD, 0u, 3u, 2u), U(READ_HEAD, 0u, 3u, 3u), U(READ_HEAD, 0u, 3u, 4u),
                  U(READ_HEAD, 0u, 3u, 5u), U(READ_HEAD, 0u, 3u, 6u), F(READ_HEAD, 0u, 3u, 7u), R(READ_HEAD, 0u, 3u, 8u),
                  R(READ_HEAD, 0u, 4u, 8u), R(READ_HEAD, 0u, 5u, 8u), R(READ_HEAD, 0u, 6u, 8u), U(READ_HEAD, 0u, 7u, 8u));
}

// How a record is put together from what lies at `at`, read from the head or from the whole.
#define PLANE(read, at) Plane(R(read, at, 0u, 0u), R(read, at, 1u, 0u), R(read, at, 2u, 0u), U(read, at, 3u, 0u))
#define SPHERE(read, at) Sphere(R(read, at, 0u, 0u), U(read, at, 1u, 0u))
#define TRIANGLE(read, at)                                                                      \
    Triangle(R(read, at, 0u, 0u), R(read, at, 1u, 0u), R(read, at, 2u, 0u), R(read, at, 3u, 0u), \
             R(read, at, 4u, 0u), R(read, at, 5u, 0u), R(read, at, 6u, 0u), R(read, at, 7u, 0u), \
             U(read, at, 8u, 0u))
#define LIGHT(read, at)                                                                         \
    Light(R(read, at, 0u, 0u), F(read, at, 1u, 0u), U(read, at, 1u, 1u), R(read, at, 1u, 2u), R(read, at, 2u, 2u))
#define MATERIAL(read, at) \
    Material(F(read, at, 0u, 0u), U(read, at, 0u, 1u), U(read, at, 0u, 2u), F(read, at, 0u, 3u))
#define MAP(read, at)                                                                           \
    UvProjection(R(read, at, 0u, 0u), R(read, at, 1u, 0u), R(read, at, 2u, 0u), R(read, at, 3u, 0u), R(read, at, 4u, 0u), \
        U(read, at, 5u, 0u))
#define TEXTURE(read, at) Texture(U(read, at, 0u, 0u), U(read, at, 0u, 1u))
#define SAMPLER(read, at) \
    Sampler(F(read, at, 0u, 0u), U(read, at, 0u, 1u), U(read, at, 0u, 2u), U(read, at, 0u, 3u))
#define PROCEDURAL(read, at)                                                                    \
    Procedural(F(read, at, 0u, 0u), F(read, at, 0u, 1u), R(read, at, 0u, 2u), F(read, at, 1u, 2u), U(read, at, 1u, 3u))
#define MOTION(read, at) Motion(R(read, at, 0u, 0u))

const uint PLANE_UNITS = 3u * REAL_UNITS + 1u;
const uint SPHERE_UNITS = 1u * REAL_UNITS + 1u;
const uint TRIANGLE_UNITS = 8u * REAL_UNITS + 1u;
const uint LIGHT_UNITS = 3u * REAL_UNITS + 2u;
const uint MATERIAL_UNITS = 4u;
const uint UVPROJECTION_UNITS = 5u * REAL_UNITS + 1u;
const uint TEXTURE_UNITS = 2u;
const uint SAMPLER_UNITS = 4u;
const uint PROCEDURAL_UNITS = 1u * REAL_UNITS + 4u;
const uint MOTION_UNITS = 1u * REAL_UNITS;

#include "record_cache.glsl"

#endif
