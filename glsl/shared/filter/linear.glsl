// Filter `linear`: the 2 texels around a position along each axis, for 2D textures, volumes and cubes,
// seamless across edges and corners. Twin: src/oracle/filter/linear.rs.
#ifndef LINEAR_GLSL
#define LINEAR_GLSL

#include "cube.glsl"
#include "../texel_quad.glsl"

#if SOURCE != SOURCE_NONE

vec4 linear_flat(const Texture image, const Sampler how, uint slot, const Level level, vec2 texel) {
    // floor(texel); if texel is an integer, possibly the one before, with weight 1 on its neighbour.
    vec2 shifted = (texel - 0.5) + ROUND;
    vec2 low = shifted - ROUND;
    vec2 b = texel - low;
    vec2 a = 1.0 - b;
    ivec2 first = floatBitsToInt(shifted) - floatBitsToInt(ROUND);
    if (POLES) {
        vec4 sum = weighted(a.x * a.y, flat_texel(image, how, slot, level, first));
        sum = add_weighted(b.x * a.y, flat_texel(image, how, slot, level, first + ivec2(1, 0)), sum);
        sum = add_weighted(a.x * b.y, flat_texel(image, how, slot, level, first + ivec2(0, 1)), sum);
        return add_weighted(b.x * b.y, flat_texel(image, how, slot, level, first + ivec2(1, 1)), sum);
    }
    if (TEXEL_QUADS) {
        ivec2 last = level.size.xy - 1;
        Quad quad = texel_quad(image, how, slot, low, first);
        // Beyond an edge that is clamped the texel is its own neighbour.
        if (MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, how.address_u)) {
            if (first.x < 0 || first.x >= last.x) quad = Quad(quad.at, quad.at, quad.below, quad.below);
        }
        if (MODE_IS(ADDRESSES_V, ADDRESS_CLAMP_TO_EDGE, how.address_v)) {
            if (first.y < 0 || first.y >= last.y) quad = Quad(quad.at, quad.right, quad.at, quad.right);
        }
        vec4 sum = weighted(a.x * a.y, quad.at);
        sum = add_weighted(b.x * a.y, quad.right, sum);
        sum = add_weighted(a.x * b.y, quad.below, sum);
        return add_weighted(b.x * b.y, quad.across, sum);
    }
    ivec2 u = ivec2(addressed_texel(ADDRESSES_U, how.address_u, first.x, level.size.x),
                    addressed_texel(ADDRESSES_U, how.address_u, first.x + 1, level.size.x));
    ivec2 v = ivec2(addressed_texel(ADDRESSES_V, how.address_v, first.y, level.size.y),
                    addressed_texel(ADDRESSES_V, how.address_v, first.y + 1, level.size.y));
    vec4 sum = weighted(a.x * a.y, fetch_or_border(image, how, slot, level, ivec3(u.x, v.x, 0)));
    sum = add_weighted(b.x * a.y, fetch_or_border(image, how, slot, level, ivec3(u.y, v.x, 0)), sum);
    sum = add_weighted(a.x * b.y, fetch_or_border(image, how, slot, level, ivec3(u.x, v.y, 0)), sum);
    return add_weighted(b.x * b.y, fetch_or_border(image, how, slot, level, ivec3(u.y, v.y, 0)), sum);
}

vec4 linear_volume(const Texture image, const Sampler how, uint slot, const Level level, vec3 texel) {
    vec3 low = floor(texel);
    vec3 t = texel - low;
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 8; k++) {
        ivec3 corner = ivec3(k & 1, (k >> 1) & 1, k >> 2);
        ivec3 at = ivec3(low) + corner;
        at = ivec3(addressed_texel(ADDRESSES_U, how.address_u, at.x, level.size.x),
                   addressed_texel(ADDRESSES_V, how.address_v, at.y, level.size.y),
                   addressed_texel(ADDRESSES_W, how.address_w, at.z, level.size.z));
        vec3 w = mix(1.0 - t, t, vec3(corner));
        sum = add_weighted(w.x * w.y * w.z, fetch_or_border(image, how, slot, level, at), sum);
    }
    return sum;
}

// Beyond a corner there is no texel: its weight is divided among the three that meet there.
vec4 linear_cube(const Texture image, uint slot, const Level level, uint face, vec2 texel) {
    int size = level.size.x;
    vec2 low = floor(texel);
    vec2 t = texel - low;
    ivec2 first = ivec2(low);
    float missing = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 at = first + ivec2(k & 1, k >> 1);
        bool corner = (at.x < 0 || at.x >= size) && (at.y < 0 || at.y >= size);
        vec2 w = mix(1.0 - t, t, vec2(k & 1, k >> 1));
        missing += corner ? w.x * w.y : 0.0;
    }
    vec4 sum = vec4(0.0);
    for (int k = 0; k < 4; k++) {
        ivec2 at = first + ivec2(k & 1, k >> 1);
        bool corner = (at.x < 0 || at.x >= size) && (at.y < 0 || at.y >= size);
        vec2 w = mix(1.0 - t, t, vec2(k & 1, k >> 1));
        float weight = corner ? 0.0 : w.x * w.y + missing * (1.0 / 3.0);
        sum = add_weighted(weight, fetch_texel(image, slot, level, cube_texel(face, at, size)), sum);
    }
    return sum;
}
#endif

#endif
