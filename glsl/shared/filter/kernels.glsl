// Filters by a kernel wider than that of `linear`, the same along both axes of a 2D texture: `cubic`, 4 by 4
// texels (Mitchell & Netravali 1988), and `lanczos-2` and `lanczos-3`, twice the radius (Duchon 1979). Twin:
// src/oracle/filter/kernels.rs.
#ifndef KERNELS_GLSL
#define KERNELS_GLSL

#include "../math.glsl"
#include "../texture.glsl"

#if SOURCE != SOURCE_NONE

// Returns the weights of the four texels around a position t in [0, 1] between the middle two (Mitchell &
// Netravali 1988): B = 0, C = 1/2 is Catmull-Rom, B = 1, C = 0 the B-spline.
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

// Weights of the taps along an axis: four, and for wide kernels two more.
struct KernelWeights {
    vec4 first;
    vec2 rest;
};

// Returns sinc(x) sinc(x / radius) up to a factor, `x` relative to the position: sin(pi x) is that of t up to
// sign.
float lanczos_weight(float sine, float x, float radius) {
    return x == 0.0 ? PI * PI / radius : sine * sine_turns(0.5 * x / radius) / (x * x);
}

// Normalises the weights to a sum of 1, which a windowed sinc does not have by itself.
KernelWeights lanczos_weights(float t, float radius) {
    float sine = sine_turns(0.5 * t);
    float before = t + (radius - 1.0);
    float side = radius == 2.0 ? -sine : sine; // at the first tap
    vec4 first = vec4(lanczos_weight(side, before, radius), lanczos_weight(-side, before - 1.0, radius),
                      lanczos_weight(side, before - 2.0, radius), lanczos_weight(-side, before - 3.0, radius));
    vec2 rest = vec2(0.0);
    if (radius > 2.0) rest = vec2(lanczos_weight(side, before - 4.0, radius), lanczos_weight(-side, before - 5.0, radius));
    float scale = 1.0 / (((first.x + first.y) + (first.z + first.w)) + (rest.x + rest.y));
    return KernelWeights(first * scale, rest * scale);
}

// True if some sampler has such a filter. Tested separately before `has_kernel`: code behind a call stays in
// the pipeline.
const bool HAS_KERNELS = (FILTERS & ((1u << FILTER_CUBIC) | (1u << FILTER_LANCZOS_2) | (1u << FILTER_LANCZOS_3))) != 0u;

// Returns true if a filter has such a kernel.
bool has_kernel(uint mode) {
    return MODE_IS(FILTERS, FILTER_CUBIC, mode) || MODE_IS(FILTERS, FILTER_LANCZOS_2, mode) ||
           MODE_IS(FILTERS, FILTER_LANCZOS_3, mode);
}

// Returns the number of texels along an axis.
int kernel_taps(uint mode) { return MODE_IS(FILTERS, FILTER_LANCZOS_3, mode) ? 6 : 4; }

KernelWeights kernel_weights(uint mode, const Sampler how, float t) {
    if (MODE_IS(FILTERS, FILTER_LANCZOS_2, mode)) return lanczos_weights(t, 2.0);
    if (MODE_IS(FILTERS, FILTER_LANCZOS_3, mode)) return lanczos_weights(t, 3.0);
    return KernelWeights(cubic_weights(t, vec2(how.cubic_b, how.cubic_c)), vec2(0.0));
}

float tap_weight(KernelWeights weights, int tap) {
    if (HAS(FILTERS, FILTER_LANCZOS_3)) {
        if (tap >= 4) return weights.rest[tap - 4];
    }
    return weights.first[tap];
}

vec4 kernel_flat(const Texture image, const Sampler how, uint slot, uint mode, const Level level, vec2 texel) {
    vec2 low = floor(texel);
    vec2 t = texel - low;
    KernelWeights wx = kernel_weights(mode, how, t.x);
    KernelWeights wy = kernel_weights(mode, how, t.y);
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
            sum = add_weighted(tap_weight(wx, i) * tap_weight(wy, j), value, sum);
        }
    }
    return sum;
}
#endif

#endif
