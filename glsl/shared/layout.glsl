// The one layout contract: what lies where in the scene buffer, in units of uvec4 (16 bytes).
// src/layout.rs mirrors every struct and asserts its size. Positions are relative to the eye.
// Numbers of modes equal the order of the Rust enums; a test compares both.
#ifndef LAYOUT_GLSL
#define LAYOUT_GLSL

const uint PROJECTION_PERSPECTIVE = 0u;
const uint PROJECTION_ORTHOGRAPHIC = 1u;

const uint PATTERN_CENTER = 0u;
const uint PATTERN_GRID = 1u;
const uint PATTERN_RANDOM = 2u;
const uint PATTERN_STRATIFIED = 3u;

const uint MODEL_UNLIT = 0u;
const uint MODEL_LAMBERT = 1u;
const uint MODEL_MIRROR = 2u;

const uint LIGHT_POINT = 0u;
const uint LIGHT_DIRECTIONAL = 1u;

const uint MAP_AFFINE = 0u;      // uv is affine in the position: planes, planar
const uint MAP_VERTEX_UV = 1u;   // uv is interpolated over a triangle
const uint MAP_CYLINDRICAL = 2u;
const uint MAP_SPHERICAL = 3u;

const uint METHOD_SHADER = 0u;
const uint METHOD_HARDWARE = 1u;

const uint ADDRESS_REPEAT = 0u;
const uint ADDRESS_MIRRORED_REPEAT = 1u;
const uint ADDRESS_CLAMP_TO_EDGE = 2u;
const uint ADDRESS_CLAMP_TO_BORDER = 3u;
const uint ADDRESS_MIRROR_CLAMP_TO_EDGE = 4u;

const uint FILTER_NEAREST = 0u;
const uint FILTER_LINEAR = 1u;

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

const uint COLOR_SPACE_LINEAR = 0u;
const uint COLOR_SPACE_SRGB = 1u;

const uint NO_TEXTURE = 0xFFFFFFFFu;
const uint NO_SHAPE = 0xFFFFFFFFu;
const float FAR = 1e30; // farther than any hit that counts

struct Header {
    vec4 forward;    // unit view direction; w: unused
    vec4 step_x;     // one pixel to the right: added to direction (perspective) or origin (orthographic)
    vec4 step_y;     // one pixel down
    vec4 background; // linear RGB
    uvec4 image;     // width, height, crop x, crop y
    uvec4 size;      // film width, film height, projection, max depth
    uvec4 sampling;  // pattern, strata a side, ceil(log2(side)), seed
    uvec4 key;       // 1 when all pixels share their displacements; lights; unused
    uvec4 counts;    // planes, spheres, triangles, unused
};

struct Plane {
    vec4 normal;   // unit n; w = n·(origin − eye)
    vec4 extent_u; // plane coordinate u of an eye-relative point p: xyz·p + w
    vec4 extent_v;
    uvec4 link;    // material, map, half extent (bits), 1 when bounded
};

struct Sphere {
    vec4 ball;  // centre, radius
    uvec4 link; // material, map
};

struct Triangle {
    vec4 a;        // vertex; w = u
    vec4 b;
    vec4 c;
    vec4 v;        // v of the three vertices; w = 1 with shading normals
    vec4 normal;   // unit geometric normal; w = n·a
    vec4 normal_a; // unit shading normals
    vec4 normal_b;
    vec4 normal_c;
    uvec4 link;    // material, map
};

struct Light {
    vec4 place; // position relative to the eye, or unit direction towards the light; w: unused
    vec4 power; // intensity (W/sr) or irradiance
    uvec4 link; // kind
};

struct Material {
    vec4 color;
    uvec4 link; // model, texture or NO_TEXTURE, sampler, image slot
};

struct Map {
    vec4 x;      // frame coordinates of an eye-relative point p: xyz·p + w
    vec4 y;
    vec4 z;
    vec4 matrix; // uv' = (m00 u + m01 v, m10 u + m11 v) + offset
    vec4 offset;
    uvec4 link;  // kind
};

struct Texture {
    uvec4 place; // first word in the texel buffer, width, height, format
    uvec4 link;  // colour space
};

struct Sampler {
    vec4 border;
    uvec4 modes; // address u, address v, filter, texel centre
    uvec4 link;  // method
};

layout(std430, set = 0, binding = 1) readonly buffer SceneBuffer { uvec4 scene[]; };

vec4 scene_vec4(uint at) { return uintBitsToFloat(scene[at]); }

Header load_header() {
    return Header(scene_vec4(0u), scene_vec4(1u), scene_vec4(2u), scene_vec4(3u), scene[4u], scene[5u],
                  scene[6u], scene[7u], scene[8u]);
}

Plane load_plane(uint i) {
    uint at = PLANES_AT + i * 4u;
    return Plane(scene_vec4(at), scene_vec4(at + 1u), scene_vec4(at + 2u), scene[at + 3u]);
}

Sphere load_sphere(uint i) {
    uint at = SPHERES_AT + i * 2u;
    return Sphere(scene_vec4(at), scene[at + 1u]);
}

Triangle load_triangle(uint i) {
    uint at = TRIANGLES_AT + i * 9u;
    return Triangle(scene_vec4(at), scene_vec4(at + 1u), scene_vec4(at + 2u), scene_vec4(at + 3u),
                    scene_vec4(at + 4u), scene_vec4(at + 5u), scene_vec4(at + 6u), scene_vec4(at + 7u),
                    scene[at + 8u]);
}

Light load_light(uint i) {
    uint at = LIGHTS_AT + i * 3u;
    return Light(scene_vec4(at), scene_vec4(at + 1u), scene[at + 2u]);
}

Material load_material(uint i) {
    uint at = MATERIALS_AT + i * 2u;
    return Material(scene_vec4(at), scene[at + 1u]);
}

Map load_map(uint i) {
    uint at = MAPS_AT + i * 6u;
    return Map(scene_vec4(at), scene_vec4(at + 1u), scene_vec4(at + 2u), scene_vec4(at + 3u),
               scene_vec4(at + 4u), scene[at + 5u]);
}

Texture load_texture(uint i) {
    uint at = TEXTURES_AT + i * 2u;
    return Texture(scene[at], scene[at + 1u]);
}

Sampler load_sampler(uint i) {
    uint at = SAMPLERS_AT + i * 3u;
    return Sampler(scene_vec4(at), scene[at + 1u], scene[at + 2u]);
}

// Lists of known, small length are read once, before any branch: some compilers (lavapipe's) read a
// buffer lane by lane inside control flow. An index that is not known at build time then selects
// among registers.
#define HELD_LIST(Type, held, hold, at, load, COUNT_CONSTANT)                                   \
    Type held[COUNT_CONSTANT == DYNAMIC || COUNT_CONSTANT == 0u ? 1u : COUNT_CONSTANT];         \
    void hold() {                                                                               \
        if (COUNT_CONSTANT == DYNAMIC) return;                                                  \
        for (uint i = 0u; i < COUNT_CONSTANT; i++) held[i] = load(i);                           \
    }                                                                                           \
    Type at(uint index) {                                                                       \
        if (COUNT_CONSTANT == DYNAMIC) return load(index);                                      \
        Type found = held[0];                                                                   \
        for (uint i = 1u; i < COUNT_CONSTANT; i++) {                                            \
            if (i == index) found = held[i];                                                    \
        }                                                                                       \
        return found;                                                                           \
    }

HELD_LIST(Plane, held_planes, hold_planes, plane_at, load_plane, PLANES)
HELD_LIST(Sphere, held_spheres, hold_spheres, sphere_at, load_sphere, SPHERES)
HELD_LIST(Triangle, held_triangles, hold_triangles, triangle_at, load_triangle, TRIANGLES)
HELD_LIST(Light, held_lights, hold_lights, light_at, load_light, LIGHTS)
HELD_LIST(Material, held_materials, hold_materials, material_at, load_material, MATERIALS)
HELD_LIST(Map, held_maps, hold_maps, map_at, load_map, MAPS)
HELD_LIST(Texture, held_textures, hold_textures, texture_at, load_texture, TEXTURES)
HELD_LIST(Sampler, held_samplers, hold_samplers, sampler_at, load_sampler, SAMPLERS)

void hold_scene() {
    hold_planes();
    hold_spheres();
    hold_triangles();
    hold_lights();
    hold_materials();
    hold_maps();
    hold_textures();
    hold_samplers();
}

#endif
