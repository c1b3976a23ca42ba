// The value at a position of one level by one filter. Twin: src/oracle/filter/levels.rs.
#ifndef LEVELS_GLSL
#define LEVELS_GLSL

#include "kernels.glsl"
#include "linear.glsl"
#include "nearest.glsl"
#include "stochastic.glsl"

#if SOURCE != SOURCE_NONE

// Returns the value at a position of one level by one filter; `dice` in [0, 1) are for the stochastic one.
vec4 filtered_level(const Texture image, const Sampler how, uint slot, uint mode, const Level level, vec3 at, uint face, vec3 dice) {
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
    bool chosen = MODE_IS(FILTERS, FILTER_STOCHASTIC, mode);
    if (chosen) texel = stochastic_place(texel, dice);
    if (chosen || MODE_IS(FILTERS, FILTER_NEAREST, mode)) {
        return nearest(image, how, slot, level, texel, face, dice.z, !chosen);
    }
    texel -= 0.5;
    if (cube) return linear_cube(image, slot, level, face, texel.xy);
    if (volume) return linear_volume(image, how, slot, level, texel);
    if (HAS_KERNELS) {
        if (has_kernel(mode)) return kernel_flat(image, how, slot, mode, level, texel.xy);
    }
    return linear_flat(image, how, slot, level, texel.xy);
}
#endif

#endif
