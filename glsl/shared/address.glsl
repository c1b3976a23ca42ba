// Address modes: the texel that a coordinate selects along an axis (Vulkan 1.3, "Wrapping Operation"). `mask`
// is the constant of the modes that occur on that axis. Twin: src/oracle/address.rs.
#ifndef ADDRESS_GLSL
#define ADDRESS_GLSL

#include "layout.glsl"

// Returns the coordinate in texels, moved close to the texture without changing the selected texel. Whole
// periods are subtracted exactly, which leaves [-1/2, 1/2] or, if mirrored, [-1, 1]; values that are not
// finite become 0. Clamped modes lose everything far outside.
float reduced_coordinate(uint mask, uint mode, float u, float size) {
    float s;
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        s = u - roundEven(u);
        if (BOUNDLESS_UV) s = abs(s) <= 0.5 ? s : 0.0;
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        s = u - 2.0 * roundEven(0.5 * u);
        if (BOUNDLESS_UV) s = abs(s) <= 1.0 ? s : 0.0;
    } else {
        s = u >= -2.0 ? (u <= 3.0 ? u : 3.0) : -2.0;
    }
    float texel = s * size;
    return texel;
}

#ifdef F64_MATH
// As above for a coordinate in tiles, which then fits an f32.
float near_tile(uint mask, uint mode, double u) {
    double s = clamp(u, -2.0, 3.0);
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        s = u - roundEven(u);
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        s = u - 2.0 * roundEven(0.5 * u);
    }
    return float(s);
}
#endif

// Implements "Wrapping Operation" of Vulkan 1.3 for the results of `reduced_coordinate`; -1 selects the
// border colour. The bounds hold for every i, so no fetch leaves the texture.
int addressed_texel(uint mask, uint mode, int i, int size) {
    if (MODE_IS(mask, ADDRESS_REPEAT, mode) && TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) return i & (size - 1);
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) return int(min(uint(i < 0 ? i + size : i), uint(size - 1)));
    if (MODE_IS(mask, ADDRESS_CLAMP_TO_BORDER, mode)) return i < 0 || i >= size ? -1 : i;
    // Within one period mirroring is mirror-clamp-to-edge.
    if (!MODE_IS(mask, ADDRESS_CLAMP_TO_EDGE, mode)) i = i < 0 ? -1 - i : i;
    return clamp(i, 0, size - 1);
}

// As above for every i: wide filters reach beyond one period. Vulkan leaves the remainder of negative numbers
// undefined, so i is first mirrored at -1/2.
int wrapped_texel(uint mask, uint mode, int i, int size) {
    int folded = i < 0 ? -1 - i : i;
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        if (TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) return i & (size - 1);
        int left = folded % size;
        return i < 0 ? size - 1 - left : left;
    }
    if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        int left = folded % (2 * size);
        return left < size ? left : 2 * size - 1 - left;
    }
    return addressed_texel(mask, mode, i, size);
}

#endif
