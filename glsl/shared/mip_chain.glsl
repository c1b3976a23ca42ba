// The texels of a level from those of the previous level, whose lengths are halved: converts codes to linear
// values, averages them, and converts back to codes; alpha is a channel like the others. Host side:
// src/texture/mips; sums are in the order of halve.rs, codes are those of codec.rs.
#ifndef MIP_CHAIN_GLSL
#define MIP_CHAIN_GLSL

#include "schema/blocks.glsl"
#include "opaque.glsl"

layout(constant_id = ID_CHANNELS) const uint CHANNELS = 4u;
layout(constant_id = ID_COMPONENT_BYTES) const uint COMPONENT_BYTES = 1u;
layout(constant_id = ID_SRGB) const bool SRGB = false; // colours, of 8 or 16 bits

const uint CODES = COMPONENT_BYTES == 1u ? 256u : 65536u;

// The texture as in the texel buffer; values of two levels, between which the passes alternate; linear values
// of all sRGB codes, and then for each the value from which on the next code is nearer.
layout(std430, set = 0, binding = BINDING_MIP_WORDS) buffer Words { uint words[]; };
layout(std430, set = 0, binding = BINDING_MIP_NUMBERS) buffer Numbers { float numbers[]; };
layout(std430, set = 0, binding = BINDING_MIP_TABLES) readonly buffer Tables { float tables[]; };

layout(push_constant) uniform Push { Halving halving; };

// Returns the bit of an axis, 1, 2 or 4, if it has half as many texels as the previous level.
bool halves(uint axis) { return (OPAQUE(halving.halved) & axis) != 0u; }

const float SHARES[4] = float[](1.0, 0.5, 0.25, 0.125);

float light(uint code) { return tables[code]; }

float middle(uint code) { return tables[CODES + code]; }

uvec4 codes_at(uint element) {
    if (COMPONENT_BYTES == 1u) {
        uint bits = words[halving.above + (element >> 2u)] >> ((element & 3u) * 8u);
        return uvec4(bits & 255u, (bits >> 8u) & 255u, (bits >> 16u) & 255u, bits >> 24u);
    }
    uint at = halving.above + (element >> 1u);
    uint bits = words[at] >> ((element & 1u) * 16u);
    uvec4 codes = uvec4(bits & 65535u, bits >> 16u, 0u, 0u);
    if (CHANNELS == 4u) {
        bits = words[at + 1u];
        codes.zw = uvec2(bits & 65535u, bits >> 16u);
    }
    return codes;
}

// Colours, and alpha last.
vec4 decoded(uint texel) {
    uint element = texel * CHANNELS;
    if (COMPONENT_BYTES == 4u) {
        uint at = halving.above + element;
        uvec4 bits = uvec4(words[at], 0u, 0u, 0u);
        if (CHANNELS > 1u) bits.y = words[at + 1u];
        if (CHANNELS > 2u) bits.zw = uvec2(words[at + 2u], words[at + 3u]);
        return uintBitsToFloat(bits);
    }
    uvec4 codes = codes_at(element);
    vec4 value = vec4(codes);
    if (SRGB) {
        value.x = light(codes.x);
        if (CHANNELS == 4u) value.yz = vec2(light(codes.y), light(codes.z));
    }
    return value;
}

vec4 numbers_of(uint texel) {
    if (OPAQUE(halving.from_codes) != 0u) return decoded(texel);
    uint at = halving.above + texel * CHANNELS;
    vec4 value = vec4(numbers[at], 0.0, 0.0, 0.0);
    if (CHANNELS > 1u) value.y = numbers[at + 1u];
    if (CHANNELS > 2u) value.zw = vec2(numbers[at + 2u], numbers[at + 3u]);
    return value;
}

// Returns one column of the texels that a new one covers.
vec4 column(uvec3 first, uint x, float share) {
    uint columns_log2 = halving.columns_log2 + (halving.halved & 1u);
    uint rows_log2 = halving.rows_log2 + ((halving.halved >> 1u) & 1u);
    uint texel = (((first.z << rows_log2) + first.y) << columns_log2) + first.x + x;
    uint below = 1u << columns_log2;
    uint behind = below << rows_log2;
    vec4 sum = numbers_of(texel) * share;
    if (halves(2u)) sum += numbers_of(texel + below) * share;
    if (halves(4u)) {
        sum += numbers_of(texel + behind) * share;
        if (halves(2u)) sum += numbers_of(texel + behind + below) * share;
    }
    return sum;
}

vec4 mean(uint texel) {
    uint row = texel >> halving.columns_log2;
    uvec3 place = uvec3(texel & ((1u << halving.columns_log2) - 1u),
                        row & ((1u << halving.rows_log2) - 1u), row >> halving.rows_log2);
    uvec3 first = place << (uvec3(halving.halved, halving.halved >> 1u, halving.halved >> 2u) & 1u);
    float share = SHARES[bitCount(halving.halved)];
    vec4 sum = column(first, 0u, share);
    if (halves(1u)) sum += column(first, 1u, share);
    return sum;
}

void keep(uint texel, vec4 value) {
    uint at = halving.number + texel * CHANNELS;
    numbers[at] = value.x;
    if (CHANNELS > 1u) numbers[at + 1u] = value.y;
    if (CHANNELS > 2u) {
        numbers[at + 2u] = value.z;
        numbers[at + 3u] = value.w;
    }
}

// Returns the number of midpoints at or below the value.
uint srgb_code(float linear) {
    uint code = 0u;
    for (uint step = CODES / 2u; step > 0u; step >>= 1u) {
        if (linear >= middle(code + step - 1u)) code += step;
    }
    return code;
}

// Halves round up.
uvec4 encoded(vec4 value) {
    if (COMPONENT_BYTES == 4u) return floatBitsToUint(value);
    uvec4 codes = uvec4(value + 0.5);
    if (SRGB) {
        codes.x = srgb_code(value.x);
        if (CHANNELS == 4u) codes.yz = uvec2(srgb_code(value.y), srgb_code(value.z));
    }
    return min(codes, uvec4(CODES - 1u));
}

// Writes the texels in word `index` of the level, or the words of texel `index` if a texel fills one or more
// words.
void make_texels(uint index) {
    uint texel_bytes = CHANNELS * COMPONENT_BYTES;
    uint sharing = texel_bytes < 4u ? 4u / texel_bytes : 1u;
    uint word = 0u;
    for (uint i = 0u; i < sharing; ++i) {
        uint texel = index * sharing + i;
        if (texel >= halving.texels) break;
        vec4 value = mean(texel);
        keep(texel, value);
        uvec4 codes = encoded(value);
        if (texel_bytes > 4u || COMPONENT_BYTES == 4u) {
            uint at = halving.word + texel * (texel_bytes / 4u);
            if (COMPONENT_BYTES == 2u) codes.xy = uvec2(codes.x | codes.y << 16u, codes.z | codes.w << 16u);
            words[at] = codes.x;
            if (texel_bytes > 4u) words[at + 1u] = codes.y;
            if (texel_bytes > 8u) {
                words[at + 2u] = codes.z;
                words[at + 3u] = codes.w;
            }
            return;
        }
        uint bits = codes.x;
        if (CHANNELS > 1u) bits |= codes.y << (8u * COMPONENT_BYTES);
        if (CHANNELS > 2u) bits |= codes.z << 16u | codes.w << 24u;
        word |= bits << (8u * texel_bytes * i);
    }
    if (index * sharing < halving.texels) words[halving.word + index] = word;
}

#endif
