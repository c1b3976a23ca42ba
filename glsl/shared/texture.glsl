// Texel fetches with addressing, converted to linear RGBA, from one texel buffer, or for 2D textures by
// texelFetch from images. Follows Vulkan 1.3, "Image Sample Operations". Twin: src/oracle/texture.rs.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#include "address.glsl"
#include "filter/kinds.glsl"
#include "mapping.glsl"

#define HAS_IMAGES (SOURCE == SOURCE_IMAGE || SOURCE == SOURCE_SOLIDS)
#define HAS_TEXELS (SOURCE == SOURCE_BUFFER || SOURCE == SOURCE_SOLIDS)

#if HAS_IMAGES
layout(set = 0, binding = BINDING_IMAGES) uniform sampler2D images[SLOTS];
#endif
#if SOURCE == SOURCE_SOLIDS
layout(set = 0, binding = BINDING_VOLUMES) uniform sampler3D volumes[VOLUME_SLOTS];
layout(set = 0, binding = BINDING_CUBES) uniform samplerCube cubes[CUBE_SLOTS];
#endif

#if HAS_TEXELS
#include "texel_buffer.glsl"
#endif

#if SOURCE != SOURCE_NONE
Coordinate near_coordinate(const Texture image, const Sampler how, const TexCoord c) {
#ifdef F64_MATH
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind)) return Coordinate(vec3(c.at), c.dx, c.dy);
    vec3 at = vec3(near_tile(ADDRESSES_U, how.address_u, c.at.x), near_tile(ADDRESSES_V, how.address_v, c.at.y),
                   near_tile(ADDRESSES_W, how.address_w, c.at.z));
    return Coordinate(at, c.dx, c.dy);
#else
    return Coordinate(c.at, c.dx, c.dy);
#endif
}

// Linear values of all codes of 8-bit sRGB, then of 16-bit sRGB, if the scene has any. CPU drivers read
// scattered texels faster than scattered positions of a storage buffer.
layout(set = 0, binding = BINDING_SRGB_LIGHT) uniform usamplerBuffer srgb_light;

float decode_srgb8(uint code) { return uintBitsToFloat(texelFetch(srgb_light, int(code)).x); }

float decode_srgb16(uint code) { return uintBitsToFloat(texelFetch(srgb_light, int(256u + code)).x); }

vec3 decode_srgb16(uvec3 codes) {
    return vec3(decode_srgb16(codes.x), decode_srgb16(codes.y), decode_srgb16(codes.z));
}

// One level of a mip chain.
struct Level {
    ivec3 size; // width, height and depth; 6 faces for a cube
    int index;
    uint word;  // first word in the texel buffer
};

// Returns a level; sizes are halved and rounded down (Vulkan 1.3, "Image Miplevel Sizing"). The words before
// level 0 hold the offsets of the others.
Level level_at(const Texture image, int index) {
    ivec3 size = ivec3(image.size);
    if (!MIPMAPPED || index == 0) return Level(size, 0, image.first_word);
    ivec3 halved = max(size >> index, ivec3(1));
    if (!MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.kind)) halved.z = size.z;
#if HAS_TEXELS
    return Level(halved, index, texel_word(image.first_word - uint(index)));
#else
    return Level(halved, index, 0u);
#endif
}
#endif

#if HAS_TEXELS
uvec4 codes_of(uint word) { return uvec4(word & 255u, (word >> 8u) & 255u, (word >> 16u) & 255u, word >> 24u); }

// k / 255 and k / 65535 to within an ulp; 1 for the largest code.
float unorm8(float k) { return k * (1.0 / 255.0); }

vec4 unorm8(vec4 k) { return k * (1.0 / 255.0); }

float unorm16(float k) { return k * (1.0 / 65535.0); }

vec4 unorm16(vec4 k) { return k * (1.0 / 65535.0); }

vec4 rgba8(uint word, bool srgb) {
    uvec4 codes = codes_of(word);
    if (srgb) return vec4(decode_srgb8(codes.x), decode_srgb8(codes.y), decode_srgb8(codes.z), unorm8(float(codes.w)));
    return unorm8(vec4(codes));
}

// Returns one texel by column, row and slice; grey is replicated, missing alpha is 1, sRGB is decoded.
vec4 fetch_pooled(const Texture image, const Level level, ivec3 at) {
    uint format = image.format;
    uint texel = uint((at.z * level.size.y + at.y) * level.size.x + at.x);
    uint word = level.word;
    bool srgb = MODE_IS(COLOR_SPACES, COLOR_SPACE_SRGB, image.color_space);
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA8, format)) {
        return rgba8(texel_word(word + texel), srgb);
    }
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY8, format)) {
        uint four = TEXEL_QUADS ? texel_word(4u * word + texel) : texel_word(word + (texel >> 2u)) >> ((texel & 3u) * 8u);
        uint code = four & 255u;
        return vec4(vec3(srgb ? decode_srgb8(code) : unorm8(float(code))), 1.0);
    }
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA8, format)) {
        uint pair = texel_word(word + (texel >> 1u)) >> ((texel & 1u) * 16u);
        uint code = pair & 255u;
        return vec4(vec3(srgb ? decode_srgb8(code) : unorm8(float(code))), unorm8(float((pair >> 8u) & 255u)));
    }
    vec4 value = vec4(0.0);
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY16, format)) {
        uint code = (texel_word(word + (texel >> 1u)) >> ((texel & 1u) * 16u)) & 65535u;
        if (DEEP_SRGB && srgb) return vec4(vec3(decode_srgb16(code)), 1.0);
        value = vec4(vec3(unorm16(float(code))), 1.0);
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA16, format)) {
        uint pair = texel_word(word + texel);
        if (DEEP_SRGB && srgb) {
            return vec4(vec3(decode_srgb16(pair & 65535u)), unorm16(float(pair >> 16u)));
        }
        value = vec4(vec3(unorm16(float(pair & 65535u))), unorm16(float(pair >> 16u)));
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA16, format)) {
        uint first = word + texel * 2u;
        uvec2 pairs = uvec2(texel_word(first), texel_word(first + 1u));
        uvec4 codes = uvec4(pairs.x & 65535u, pairs.x >> 16u, pairs.y & 65535u, pairs.y >> 16u);
        if (DEEP_SRGB && srgb) return vec4(decode_srgb16(codes.xyz), unorm16(float(codes.w)));
        value = unorm16(vec4(codes));
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_FLOAT, format)) {
        return vec4(vec3(uintBitsToFloat(texel_word(word + texel))), 1.0);
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA_FLOAT, format)) {
        uint first = word + texel * 2u;
        vec2 pair = uintBitsToFloat(uvec2(texel_word(first), texel_word(first + 1u)));
        return pair.xxxy;
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA_FLOAT, format)) {
        uint first = word + texel * 4u;
        return uintBitsToFloat(uvec4(texel_word(first), texel_word(first + 1u),
                                     texel_word(first + 2u), texel_word(first + 3u)));
    }
    return value;
}
#endif

#if HAS_IMAGES
// Not every device can index descriptors by a variable, so the index is compared with constants.
#define SLOT_SWITCH(count, read) \
    if (count == 1u || slot == 0u) return read(0u); \
    if (count > 1u && slot == 1u) return read(1u); \
    if (count > 2u && slot == 2u) return read(2u); \
    if (count > 3u && slot == 3u) return read(3u); \
    if (count > 4u && slot == 4u) return read(4u); \
    if (count > 5u && slot == 5u) return read(5u); \
    if (count > 6u && slot == 6u) return read(6u); \
    if (count > 7u && slot == 7u) return read(7u); \
    if (count > 8u && slot == 8u) return read(8u); \
    if (count > 9u && slot == 9u) return read(9u); \
    if (count > 10u && slot == 10u) return read(10u); \
    if (count > 11u && slot == 11u) return read(11u); \
    if (count > 12u && slot == 12u) return read(12u); \
    if (count > 13u && slot == 13u) return read(13u); \
    if (count > 14u && slot == 14u) return read(14u); \
    return read(15u);

// Slots beyond the count are never selected, but their constants must stay within the array.
#define SLOT(i) images[(i) < SLOTS ? (i) : 0u]
#define VOLUME_SLOT(i) volumes[(i) < VOLUME_SLOTS ? (i) : 0u]
#define CUBE_SLOT(i) cubes[(i) < CUBE_SLOTS ? (i) : 0u]

vec4 read_image(uint slot, ivec2 at, int level) {
#define READ(i) texelFetch(SLOT(i), at, level)
    SLOT_SWITCH(SLOTS, READ)
#undef READ
}

// Returns the device sampler's value at a level; if it filters anisotropically, over the footprint.
vec4 read_flat(const Sampler how, uint slot, vec2 uv, const Coordinate c, float level) {
    if (FILTERED && is_anisotropic(how)) {
#define READ(i) textureGrad(SLOT(i), uv, c.dx.xy, c.dy.xy)
        SLOT_SWITCH(SLOTS, READ)
#undef READ
    }
#define READ(i) textureLod(SLOT(i), uv, level)
    SLOT_SWITCH(SLOTS, READ)
#undef READ
}

#if SOURCE == SOURCE_SOLIDS
vec4 read_volume(uint slot, vec3 at, float level) {
#define READ(i) textureLod(VOLUME_SLOT(i), at, level)
    SLOT_SWITCH(VOLUME_SLOTS, READ)
#undef READ
}

vec4 read_cube(uint slot, vec3 at, float level) {
#define READ(i) textureLod(CUBE_SLOT(i), at, level)
    SLOT_SWITCH(CUBE_SLOTS, READ)
#undef READ
}
#endif

vec4 read_sampled(const Texture image, const Sampler how, uint slot, const Coordinate c, float level) {
    vec3 shift = vec3(0.0);
    if (MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.texel_center)) {
        shift = 0.5 / vec3(max(ivec3(image.size) >> int(level), ivec3(1)));
    }
#if SOURCE == SOURCE_SOLIDS
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.kind)) return read_volume(slot, c.at + shift, level);
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind)) return read_cube(slot, c.at, level);
#endif
    return read_flat(how, slot, c.at.xy + shift.xy, c, level);
}

// Returns linear RGBA of what an image holds.
vec4 decoded(const Texture image, vec4 value) {
    // The view replicates grey; if all textures are grey, two channels need no arithmetic.
    if (TEXEL_FORMATS == (1u << TEXEL_FORMAT_GREY8)) value = vec4(value.xxx, 1.0);
    if (MODE_IS(COLOR_SPACES, COLOR_SPACE_SRGB, image.color_space)) {
        if (DEEP_SRGB && image.format >= TEXEL_FORMAT_GREY16) {
            value.xyz = decode_srgb16(uvec3(value.xyz * 65535.0 + 0.5));
            return value;
        }
        uvec3 code = uvec3(value.xyz * 255.0 + 0.5);
        value.xyz = vec3(decode_srgb8(code.x), decode_srgb8(code.y), decode_srgb8(code.z));
    }
    return value;
}

vec4 fetch_texel(const Texture image, uint slot, const Level level, ivec3 at) {
#if HAS_TEXELS
    if (!MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_FLAT, image.kind)) return fetch_pooled(image, level, at);
#endif
    return decoded(image, read_image(slot, at.xy, level.index));
}
#elif SOURCE == SOURCE_BUFFER
vec4 fetch_texel(const Texture image, uint slot, const Level level, ivec3 at) { return fetch_pooled(image, level, at); }
#endif

#if SOURCE != SOURCE_NONE
// Adding 1.5 · 2^23 leaves the nearest integer (ties to even) in the low bits of an f32 below 2^22: rounding
// and conversion in two additions, identical on every device.
const float ROUND = 12582912.0;

const uint ADDRESSES = ADDRESSES_U | ADDRESSES_V | ADDRESSES_W;
const bool BORDERS = HAS(ADDRESSES, ADDRESS_CLAMP_TO_BORDER);

// Returns the texel at an addressed position, or the border colour if a component of it is -1.
vec4 fetch_or_border(const Texture image, const Sampler how, uint slot, const Level level, ivec3 at) {
    if (!BORDERS) return fetch_texel(image, slot, level, at);
    vec4 value = fetch_texel(image, slot, level, max(at, ivec3(0)));
    return at.x < 0 || at.y < 0 || at.z < 0 ? how.border : value;
}

// weight * value, and sum + weight * value. A weight of 0 gives 0 even if the value is NaN or infinite. fma
// by name: fused or not, but alike in every pipeline of a device.
vec4 weighted(float weight, vec4 value) {
    if (NONFINITE) {
        if (weight == 0.0) return vec4(0.0);
    }
    return weight * value;
}

vec4 add_weighted(float weight, vec4 value, vec4 sum) {
    if (NONFINITE) {
        if (weight == 0.0) return sum;
    }
    return fma(vec4(weight), value, sum);
}

// Returns a 2D texture's texel at (column, row), addressed. Across a pole of an environment the same row
// continues, half a turn away.
vec4 flat_texel(const Texture image, const Sampler how, uint slot, const Level level, ivec2 at) {
    if (POLES && how.crosses_poles) {
        bool over = at.y < 0 || at.y >= level.size.y;
        at.x += over ? level.size.x / 2 : 0;
        at.y = at.y < 0 ? -1 - at.y : (over ? 2 * level.size.y - 1 - at.y : at.y);
        at.x = wrapped_texel(ADDRESSES_U, how.address_u, at.x, level.size.x);
        return fetch_texel(image, slot, level, ivec3(at.x, clamp(at.y, 0, level.size.y - 1), 0));
    }
    return fetch_or_border(image, how, slot, level,
                           ivec3(addressed_texel(ADDRESSES_U, how.address_u, at.x, level.size.x),
                                 addressed_texel(ADDRESSES_V, how.address_v, at.y, level.size.y), 0));
}
#endif

#endif
