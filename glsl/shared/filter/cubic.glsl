// Filter `cubic`: 4 by 4 texels (Mitchell & Netravali 1988). Twin: src/oracle/filter/cubic.rs.
#ifndef CUBIC_GLSL
#define CUBIC_GLSL

#include "../texture.glsl"

#if SOURCE != SOURCE_NONE

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
    vec2 bc = uintBitsToFloat(how.more.zw);
    vec4 wx = cubic_weights(t.x, bc);
    vec4 wy = cubic_weights(t.y, bc);
    ivec2 first = ivec2(low) - 1;
    vec4 sum = vec4(0.0);
    for (int j = 0; j < 4; j++) {
        for (int i = 0; i < 4; i++) {
            ivec2 at = first + ivec2(i, j);
            if (!POLES || how.more.y == 0u) {
                at.x = wrapped_texel(ADDRESSES_U, how.modes.x, at.x, level.size.x);
                at.y = wrapped_texel(ADDRESSES_V, how.modes.y, at.y, level.size.y);
            }
            vec4 value = POLES ? flat_texel(image, how, slot, level, at)
                               : fetch_or_border(image, how, slot, level, ivec3(at, 0));
            sum = add_weighted(wx[i] * wy[j], value, sum);
        }
    }
    return sum;
}
#endif

#endif
