// Which texel of an axis a place means, in each address mode (Vulkan 1.3, "Wrapping Operation"). `mask` is the
// constant of the modes that occur on that axis. Twin: src/oracle/address.rs.
#ifndef ADDRESS_GLSL
#define ADDRESS_GLSL

#include "layout.glsl"

// The coordinate in texels, brought near the texture without changing what it reads. Whole periods
// leave exactly, to [-1/2, 1/2] or, mirrored, [-1, 1]; what is not finite reads as 0. Clamped modes
// lose what lies far outside.
float reduced_coordinate(uint mask, uint mode, float u, float size) {
    float s;
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        s = u - roundEven(u);
        s = abs(s) <= 0.5 ? s : 0.0;
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        s = u - 2.0 * roundEven(0.5 * u);
        s = abs(s) <= 1.0 ? s : 0.0;
    } else {
        s = u >= -2.0 ? (u <= 3.0 ? u : 3.0) : -2.0;
    }
    float texel = s * size;
    return texel;
}

#ifdef F64_MATH
// The same for a coordinate in tiles, which then fits an f32.
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

// The same for every i: wide filters reach beyond one period. Of a negative number Vulkan leaves the
// remainder undefined, so i is mirrored at -1/2 first.
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
