// One place of one level by one filter: nearest, linear (of flat textures, volumes and cubes, seamless
// across edges and corners), cubic (Mitchell & Netravali 1988), stochastic (Fajardo et al. 2023). Twin:
// src/oracle/levels.rs.
#ifndef LEVELS_GLSL
#define LEVELS_GLSL

#include "texture.glsl"

#if SOURCE != SOURCE_NONE

vec4 linear_flat(Texture image, Sampler how, uint slot, Level level, vec2 texel) {
    // floor(texel); where texel is whole, perhaps the one before, with weight 1 on its neighbour.
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
    ivec2 u = ivec2(addressed_texel(ADDRESSES_U, how.address_u, first.x, level.size.x),
                    addressed_texel(ADDRESSES_U, how.address_u, first.x + 1, level.size.x));
    ivec2 v = ivec2(addressed_texel(ADDRESSES_V, how.address_v, first.y, level.size.y),
                    addressed_texel(ADDRESSES_V, how.address_v, first.y + 1, level.size.y));
    vec4 sum = weighted(a.x * a.y, fetch_or_border(image, how, slot, level, ivec3(u.x, v.x, 0)));
    sum = add_weighted(b.x * a.y, fetch_or_border(image, how, slot, level, ivec3(u.y, v.x, 0)), sum);
    sum = add_weighted(a.x * b.y, fetch_or_border(image, how, slot, level, ivec3(u.x, v.y, 0)), sum);
    return add_weighted(b.x * b.y, fetch_or_border(image, how, slot, level, ivec3(u.y, v.y, 0)), sum);
}

// Weights of the four texels around a place t in [0, 1] between the middle two (Mitchell & Netravali
// 1988): B = 0, C = 1/2 is Catmull-Rom, B = 1, C = 0 the B-spline.
vec4 cubic_weights(float t, vec2 bc) {
    float b = bc.x;
    float c = bc.y;
    float r = 1.0 - t;
    float tt = t * t;
    float rr = r * r;
    vec4 outer = vec4(b * (1.0 / 6.0), -c, 0.0, 0.0);
    float w0 = rr * (outer.x * r + outer.y * t);
    float w3 = tt * (outer.x * t + outer.y * r);
    float w1 = 1.0 - b * (1.0 / 3.0) + tt * ((-3.0 + 2.0 * b + c) + (2.0 - 1.5 * b - c) * t);
    return vec4(w0, w1, ((1.0 - w0) - w1) - w3, w3);
}

vec4 cubic_flat(Texture image, Sampler how, uint slot, Level level, vec2 texel) {
    vec2 low = floor(texel);
    vec2 t = texel - low;
    vec2 bc = vec2(how.cubic_b, how.cubic_c);
    vec4 wx = cubic_weights(t.x, bc);
    vec4 wy = cubic_weights(t.y, bc);
    ivec2 first = ivec2(low) - 1;
    vec4 sum = vec4(0.0);
    for (int j = 0; j < 4; j++) {
        for (int i = 0; i < 4; i++) {
            ivec2 at = first + ivec2(i, j);
            if (!POLES || !how.crosses_poles) {
                at.x = wrapped_texel(ADDRESSES_U, how.address_u, at.x, level.size.x);
                at.y = wrapped_texel(ADDRESSES_V, how.address_v, at.y, level.size.y);
            }
            vec4 value = POLES ? flat_texel(image, how, slot, level, at)
                               : fetch_or_border(image, how, slot, level, ivec3(at, 0));
            sum = add_weighted(wx[i] * wy[j], value, sum);
        }
    }
    return sum;
}

vec4 linear_volume(Texture image, Sampler how, uint slot, Level level, vec3 texel) {
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

// The direction from a cube's centre to a place of a face's plane, (s, t) in [-1, 1] on the face.
vec3 face_direction(uint face, vec2 st) {
    float side = (face & 1u) != 0u ? -1.0 : 1.0;
    return face < 2u ? vec3(side, -st.y, -side * st.x)
                     : (face < 4u ? vec3(st.x, side, side * st.y) : vec3(side * st.x, -st.y, side));
}

// A place of a face's plane, on the face that lies behind it.
vec3 refaced(vec3 at, inout uint face) {
    uint other;
    vec3 stm = on_cube_face(face_direction(face, 2.0 * at.xy - 1.0), other);
    face = other;
    return vec3(within_face(stm), 0.0);
}

// The texel of a cube at a place of a face, or beyond its edge: of the neighbour that the extended
// plane of the face reaches there.
ivec3 cube_texel(uint face, ivec2 at, int size) {
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(size)))) return ivec3(at, face);
    vec2 st = (2.0 * vec2(at) + 1.0) / float(size) - 1.0;
    uint other;
    vec2 uv = face_uv(on_cube_face(face_direction(face, st), other));
    return ivec3(clamp(ivec2(floor(uv * float(size))), ivec2(0), ivec2(size - 1)), other);
}

// Beyond a corner there is no texel: its weight goes to the three that meet there.
vec4 linear_cube(Texture image, uint slot, Level level, uint face, vec2 texel) {
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

// A place of one level by one filter; `dice` in [0, 1) are of the stochastic one.
vec4 filtered_level(Texture image, Sampler how, uint slot, uint mode, Level level, vec3 at, uint face, vec3 dice) {
    bool cube = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind);
    bool volume = MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.kind);
    vec3 texel;
    if (cube) {
        texel = at * float(level.size.x);
    } else {
        texel = vec3(reduced_coordinate(ADDRESSES_U, how.address_u, at.x, float(level.size.x)),
                     reduced_coordinate(ADDRESSES_V, how.address_v, at.y, float(level.size.y)),
                     volume ? reduced_coordinate(ADDRESSES_W, how.address_w, at.z, float(level.size.z)) : 0.0);
        // Integer centres move texel i from i + 1/2 to i: half a texel is added before addressing.
        if (MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.texel_center)) texel += 0.5;
    }
    // Linear weights as chances: the nearest texel of a place moved by up to half a texel.
    if (MODE_IS(FILTERS, FILTER_STOCHASTIC, mode)) texel += dice - 0.5;
    if (MODE_IS(FILTERS, FILTER_NEAREST, mode) || MODE_IS(FILTERS, FILTER_STOCHASTIC, mode)) {
        ivec3 nearest = ivec3(floor(texel));
        if (cube) {
            // A place on the far edge belongs to the face that the direction meets.
            if (MODE_IS(FILTERS, FILTER_NEAREST, mode)) nearest = min(nearest, ivec3(level.size.x - 1));
            // Beyond a corner: one of the three texels there, by the clamped place.
            bool corner = (nearest.x < 0 || nearest.x >= level.size.x) && (nearest.y < 0 || nearest.y >= level.size.x);
            if (corner && dice.z < 2.0 / 3.0) {
                nearest.x = dice.z < 1.0 / 3.0 ? clamp(nearest.x, 0, level.size.x - 1) : nearest.x;
                nearest.y = dice.z < 1.0 / 3.0 ? nearest.y : clamp(nearest.y, 0, level.size.x - 1);
            } else if (corner) {
                nearest.xy = clamp(nearest.xy, ivec2(0), ivec2(level.size.x - 1));
            }
            return fetch_texel(image, slot, level, cube_texel(face, nearest.xy, level.size.x));
        }
        if (!volume) return flat_texel(image, how, slot, level, nearest.xy);
        return fetch_or_border(image, how, slot, level,
                               ivec3(addressed_texel(ADDRESSES_U, how.address_u, nearest.x, level.size.x),
                                     addressed_texel(ADDRESSES_V, how.address_v, nearest.y, level.size.y),
                                     addressed_texel(ADDRESSES_W, how.address_w, nearest.z, level.size.z)));
    }
    texel -= 0.5;
    if (cube) return linear_cube(image, slot, level, face, texel.xy);
    if (volume) return linear_volume(image, how, slot, level, texel);
    if (MODE_IS(FILTERS, FILTER_CUBIC, mode)) return cubic_flat(image, how, slot, level, texel.xy);
    return linear_flat(image, how, slot, level, texel.xy);
}
#endif

#endif
