// (texture, sampler, u, v) -> linear RGBA. Method shader: addressing and filtering here in f32,
// texels from a texel buffer or by texelFetch from an image. Method hardware: the device's sampler
// at level 0. Follows Vulkan 1.3, "Image Sample Operations". Twin: src/oracle/texture.rs.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#define SOURCE_NONE 0
#define SOURCE_BUFFER 1
#define SOURCE_IMAGES 2

#if SOURCE == SOURCE_BUFFER
layout(set = 0, binding = 2) uniform usamplerBuffer texels;
#elif SOURCE == SOURCE_IMAGES
layout(set = 0, binding = 2) uniform sampler2D images[SLOTS];
#endif

#if SOURCE != SOURCE_NONE
// The scene buffer once more, for the 256 entries that decode 8-bit sRGB. Deeper sRGB textures
// arrive here as linear floats.
layout(std430, set = 0, binding = 3) readonly buffer SrgbTable { float srgb_table[]; };

float decode_srgb8(uint code) { return srgb_table[SRGB_AT * 4u + code]; }
#endif

#if SOURCE == SOURCE_BUFFER
// One texel by column and row; grey is replicated, missing alpha is 1, sRGB decoded.
vec4 fetch_texel(Texture image, uint slot, ivec2 at) {
    uint format = image.place.w;
    uint texel = uint(at.y) * image.place.y + uint(at.x);
    uint word = image.place.x;
    bool srgb = MODE_IS(COLOR_SPACES, COLOR_SPACE_SRGB, image.link.x);
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA8, format)) {
        uint packed = texelFetch(texels, int(word + texel)).x;
        uvec4 code = uvec4(packed & 255u, (packed >> 8u) & 255u, (packed >> 16u) & 255u, packed >> 24u);
        if (srgb) return vec4(decode_srgb8(code.x), decode_srgb8(code.y), decode_srgb8(code.z), float(code.w) / 255.0);
        return vec4(code) / 255.0;
    }
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY8, format)) {
        uint code = (texelFetch(texels, int(word + (texel >> 2u))).x >> ((texel & 3u) * 8u)) & 255u;
        return vec4(vec3(srgb ? decode_srgb8(code) : float(code) / 255.0), 1.0);
    }
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA8, format)) {
        uint pair = texelFetch(texels, int(word + (texel >> 1u))).x >> ((texel & 1u) * 16u);
        uint code = pair & 255u;
        return vec4(vec3(srgb ? decode_srgb8(code) : float(code) / 255.0), float((pair >> 8u) & 255u) / 255.0);
    }
    vec4 value = vec4(0.0);
    if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY16, format)) {
        uint code = (texelFetch(texels, int(word + (texel >> 1u))).x >> ((texel & 1u) * 16u)) & 65535u;
        value = vec4(vec3(float(code) / 65535.0), 1.0);
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA16, format)) {
        uint pair = texelFetch(texels, int(word + texel)).x;
        value = vec4(vec3(float(pair & 65535u) / 65535.0), float(pair >> 16u) / 65535.0);
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA16, format)) {
        int first = int(word + texel * 2u);
        uvec2 pairs = uvec2(texelFetch(texels, first).x, texelFetch(texels, first + 1).x);
        value = vec4(pairs.x & 65535u, pairs.x >> 16u, pairs.y & 65535u, pairs.y >> 16u) / 65535.0;
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_FLOAT, format)) {
        return vec4(vec3(uintBitsToFloat(texelFetch(texels, int(word + texel)).x)), 1.0);
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_GREY_ALPHA_FLOAT, format)) {
        int first = int(word + texel * 2u);
        vec2 pair = uintBitsToFloat(uvec2(texelFetch(texels, first).x, texelFetch(texels, first + 1).x));
        return pair.xxxy;
    } else if (MODE_IS(TEXEL_FORMATS, TEXEL_FORMAT_RGBA_FLOAT, format)) {
        int first = int(word + texel * 4u);
        return uintBitsToFloat(uvec4(texelFetch(texels, first).x, texelFetch(texels, first + 1).x,
                                     texelFetch(texels, first + 2).x, texelFetch(texels, first + 3).x));
    }
    return value;
}
#endif

#if SOURCE == SOURCE_IMAGES
// Not every device can index descriptors by a variable, so the index is compared with constants.
#define SLOT_SWITCH(read) \
    if (SLOTS == 1u || slot == 0u) return read(0u); \
    if (SLOTS > 1u && slot == 1u) return read(1u); \
    if (SLOTS > 2u && slot == 2u) return read(2u); \
    if (SLOTS > 3u && slot == 3u) return read(3u); \
    if (SLOTS > 4u && slot == 4u) return read(4u); \
    if (SLOTS > 5u && slot == 5u) return read(5u); \
    if (SLOTS > 6u && slot == 6u) return read(6u); \
    if (SLOTS > 7u && slot == 7u) return read(7u); \
    if (SLOTS > 8u && slot == 8u) return read(8u); \
    if (SLOTS > 9u && slot == 9u) return read(9u); \
    if (SLOTS > 10u && slot == 10u) return read(10u); \
    if (SLOTS > 11u && slot == 11u) return read(11u); \
    if (SLOTS > 12u && slot == 12u) return read(12u); \
    if (SLOTS > 13u && slot == 13u) return read(13u); \
    if (SLOTS > 14u && slot == 14u) return read(14u); \
    return read(15u);

// Slots beyond SLOTS are never chosen, but their constants must stay inside the array.
#define SLOT(i) images[(i) < SLOTS ? (i) : 0u]

vec4 read_image(uint slot, ivec2 at) {
#define READ(i) texelFetch(SLOT(i), at, 0)
    SLOT_SWITCH(READ)
#undef READ
}

vec4 read_sampled(uint slot, vec2 uv) {
#define READ(i) textureLod(SLOT(i), uv, 0.0)
    SLOT_SWITCH(READ)
#undef READ
}

vec4 fetch_texel(Texture image, uint slot, ivec2 at) {
    vec4 value = read_image(slot, at);
    // The view replicates grey; where all textures are grey, two channels need no arithmetic.
    if (TEXEL_FORMATS == (1u << TEXEL_FORMAT_GREY8)) value = vec4(value.xxx, 1.0);
    if (MODE_IS(COLOR_SPACES, COLOR_SPACE_SRGB, image.link.x)) {
        uvec3 code = uvec3(value.xyz * 255.0 + 0.5);
        value.xyz = vec3(decode_srgb8(code.x), decode_srgb8(code.y), decode_srgb8(code.z));
    }
    return value;
}
#endif

#if SOURCE != SOURCE_NONE
// Adding 1.5 · 2^23 leaves the nearest integer (ties to even) in the low bits of an f32 below 2^22:
// rounding and conversion in two additions, alike on every device.
const float ROUND = 12582912.0;

// The coordinate in texels, brought near the texture without changing what it reads. Whole periods
// leave exactly, to [-1/2, 1/2] or, mirrored, [-1, 1]; what is not finite reads as 0. Clamped modes
// lose what lies far outside.
float reduced_coordinate(uint mask, uint mode, float u, float size) {
    precise float s;
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        s = u - roundEven(u);
        s = abs(s) <= 0.5 ? s : 0.0;
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        s = u - 2.0 * roundEven(0.5 * u);
        s = abs(s) <= 1.0 ? s : 0.0;
    } else {
        s = u >= -2.0 ? (u <= 3.0 ? u : 3.0) : -2.0;
    }
    precise float texel = s * size;
    return texel;
}

// Vulkan 1.3, "Wrapping Operation", for what `reduced_coordinate` leaves; -1 asks for
// the border colour. The bounds hold for every i, so no fetch leaves the texture.
int addressed_texel(uint mask, uint mode, int i, int size) {
    if (MODE_IS(mask, ADDRESS_REPEAT, mode) && TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) return i & (size - 1);
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) return int(min(uint(i < 0 ? i + size : i), uint(size - 1)));
    if (MODE_IS(mask, ADDRESS_CLAMP_TO_BORDER, mode)) return i < 0 || i >= size ? -1 : i;
    // Within one period mirroring is mirror-clamp-to-edge.
    if (!MODE_IS(mask, ADDRESS_CLAMP_TO_EDGE, mode)) i = i < 0 ? -1 - i : i;
    return clamp(i, 0, size - 1);
}

// The texel at addressed (x, y), or the border colour where either is -1.
vec4 fetch_or_border(Texture image, Sampler how, uint slot, ivec2 at) {
    if (!HAS(ADDRESSES_U, ADDRESS_CLAMP_TO_BORDER) && !HAS(ADDRESSES_V, ADDRESS_CLAMP_TO_BORDER)) {
        return fetch_texel(image, slot, at);
    }
    vec4 value = fetch_texel(image, slot, max(at, ivec2(0)));
    return at.x < 0 || at.y < 0 ? how.border : value;
}

vec4 look_up(Texture image, Sampler how, uint slot, vec2 uv) {
    ivec2 size = ivec2(image.place.yz);
    bool integer_centers = MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.modes.w);
#if SOURCE == SOURCE_IMAGES
    if (MODE_IS(METHODS, METHOD_HARDWARE, how.link.x)) {
        return read_sampled(slot, integer_centers ? uv + 0.5 / vec2(size) : uv);
    }
#endif
    precise vec2 texel = vec2(reduced_coordinate(ADDRESSES_U, how.modes.x, uv.x, float(size.x)),
                              reduced_coordinate(ADDRESSES_V, how.modes.y, uv.y, float(size.y)));
    // Integer centres move texel i from i + 1/2 to i: half a texel is added before addressing.
    if (MODE_IS(FILTERS, FILTER_NEAREST, how.modes.z)) {
        if (integer_centers) texel += 0.5;
        ivec2 nearest = ivec2(floor(texel));
        return fetch_or_border(image, how, slot,
                               ivec2(addressed_texel(ADDRESSES_U, how.modes.x, nearest.x, size.x),
                                     addressed_texel(ADDRESSES_V, how.modes.y, nearest.y, size.y)));
    }
    if (!integer_centers) texel -= 0.5;
    // floor(texel); where texel is whole, perhaps the one before, with weight 1 on its neighbour.
    precise vec2 shifted = (texel - 0.5) + ROUND;
    precise vec2 low = shifted - ROUND;
    precise vec2 b = texel - low;
    precise vec2 a = 1.0 - b;
    ivec2 first = floatBitsToInt(shifted) - floatBitsToInt(ROUND);
    ivec2 u = ivec2(addressed_texel(ADDRESSES_U, how.modes.x, first.x, size.x),
                    addressed_texel(ADDRESSES_U, how.modes.x, first.x + 1, size.x));
    ivec2 v = ivec2(addressed_texel(ADDRESSES_V, how.modes.y, first.y, size.y),
                    addressed_texel(ADDRESSES_V, how.modes.y, first.y + 1, size.y));
    // fma by name: fused or not, but alike in every pipeline of a device.
    vec4 sum = (a.x * a.y) * fetch_or_border(image, how, slot, ivec2(u.x, v.x));
    sum = fma(vec4(b.x * a.y), fetch_or_border(image, how, slot, ivec2(u.y, v.x)), sum);
    sum = fma(vec4(a.x * b.y), fetch_or_border(image, how, slot, ivec2(u.x, v.y)), sum);
    return fma(vec4(b.x * b.y), fetch_or_border(image, how, slot, ivec2(u.y, v.y)), sum);
}
#endif

#endif
