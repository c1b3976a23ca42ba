// Filters by a kernel wider than that of `linear`, the same along both axes of a flat texture: `cubic`, 4 by 4 texels
// (Mitchell & Netravali 1988). Twin: src/oracle/filter/kernels.rs.
#ifndef KERNELS_GLSL
#define KERNELS_GLSL

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

// Whether a filter has such a kernel.
bool has_kernel(uint mode) { return MODE_IS(FILTERS, FILTER_CUBIC, mode); }

// Texels along an axis.
int kernel_taps(uint mode) { return 4; }

vec4 kernel_weights(uint mode, Sampler how, float t) { return cubic_weights(t, vec2(how.cubic_b, how.cubic_c)); }

vec4 kernel_flat(Texture image, Sampler how, uint slot, uint mode, Level level, vec2 texel) {
    vec2 low = floor(texel);
    vec2 t = texel - low;
    vec4 wx = kernel_weights(mode, how, t.x);
    vec4 wy = kernel_weights(mode, how, t.y);
    int taps = kernel_taps(mode);
    ivec2 first = ivec2(low) - (taps / 2 - 1);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < taps; j++) {
        for (int i = 0; i < taps; i++) {
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
#endif

#endif
