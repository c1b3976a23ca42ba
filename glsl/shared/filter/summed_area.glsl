// Filter `summed-area`, by a summed-area table (Crow 1984): the mean over the footprint's bounding box,
// whatever its size, from sums over rectangles that start at the texture's corner. Sums are 64-bit integers
// of the linear values in fixed point, so that differences are exact; texels are squares of one colour, which
// the box cuts at its ends. Twin: src/oracle/filter/summed_area.rs.
#ifndef SUMMED_AREA_GLSL
#define SUMMED_AREA_GLSL

#include "../texture.glsl"

#if HAS_TEXELS

// Splits the box along one axis into up to three intervals of texels, each with the length of the box that it
// represents; the rest of the box is border.
struct Parts {
    vec3 from;
    vec3 to;
    vec3 amount;
};

Parts axis_parts(uint mask, uint mode, float from, float to, float size) {
    Parts parts = Parts(vec3(0.0), vec3(0.0), vec3(0.0));
    if (MODE_IS(mask, ADDRESS_REPEAT, mode)) {
        // Whole periods, whose sum is the same from any start, and the remainder.
        float whole = floor((to - from) / size) * size;
        float start = clamp(from - floor(from / size) * size, 0.0, size);
        float end = start + clamp((to - from) - whole, 0.0, size);
        parts.from = vec3(start, 0.0, 0.0);
        parts.to = vec3(min(end, size), max(end - size, 0.0), size);
        parts.amount = vec3(parts.to.xy - parts.from.xy, whole);
    } else if (MODE_IS(mask, ADDRESS_MIRRORED_REPEAT, mode)) {
        float whole = floor((to - from) / (2.0 * size)) * 2.0 * size;
        float width = clamp((to - from) - whole, 0.0, 2.0 * size);
        float start = clamp(from - floor(from / (2.0 * size)) * 2.0 * size, 0.0, 2.0 * size);
        float first = floor(start / size);
        for (int k = 0; k < 3; k++) {
            float tile = first + float(k);
            float a = clamp(start - tile * size, 0.0, size);
            float b = clamp(start + width - tile * size, 0.0, size);
            bool odd = fract(0.5 * tile) != 0.0;
            parts.from[k] = odd ? size - b : a;
            parts.to[k] = odd ? size - a : b;
            parts.amount[k] = b - a;
        }
        // Of three tiles the middle one is whole; if there are two, the third part is free.
        int free = parts.amount.z > 0.0 ? 1 : 2;
        if (free == 2) parts.from.z = 0.0;
        if (free == 2) parts.to.z = size;
        parts.amount[free] += whole;
    } else {
        parts.from.x = clamp(from, 0.0, size);
        parts.to.x = clamp(to, 0.0, size);
        parts.amount.x = parts.to.x - parts.from.x;
        float below = max(min(to, 0.0) - from, 0.0);
        float above = max(to - max(from, size), 0.0);
        if (MODE_IS(mask, ADDRESS_MIRROR_CLAMP_TO_EDGE, mode)) {
            parts.from.y = clamp(-to, 0.0, size);
            parts.to.y = clamp(-from, 0.0, size);
            parts.amount.y = parts.to.y - parts.from.y;
            parts.from.z = size - 1.0;
            parts.to.z = size;
            parts.amount.z = above + below - parts.amount.y;
        } else if (MODE_IS(mask, ADDRESS_CLAMP_TO_EDGE, mode)) {
            parts.from.yz = vec2(0.0, size - 1.0);
            parts.to.yz = vec2(1.0, size);
            parts.amount.yz = vec2(below, above);
        }
    }
    return parts;
}

uvec2 difference(uvec2 a, uvec2 b) {
    uint borrow;
    uint low = usubBorrow(a.x, b.x, borrow);
    return uvec2(low, a.y - b.y - borrow);
}

// A 64-bit number in two's complement.
float as_float(uvec2 n) {
    bool negative = (n.y >> 31u) != 0u;
    n = negative ? difference(uvec2(0u), n) : n;
    float size = float(n.y) * 4294967296.0 + float(n.x);
    return negative ? -size : size;
}

// Returns the sum of one channel over [from, to], in steps of the fixed point.
float rectangle(uint table, int width, vec2 from, vec2 to, ivec2 last) {
    ivec2 i0 = min(ivec2(floor(from)), last);
    ivec2 i1 = min(ivec2(floor(to)), last);
    // Partial texels at both ends and whole ones between; if both ends are in one texel, the number of whole
    // ones is minus one.
    vec2 first = 1.0 - (from - vec2(i0));
    vec2 end = to - vec2(i1);
    vec3 wx = vec3(first.x, 1.0, end.x);
    vec3 wy = vec3(first.y, 1.0, end.y);
    float sum = 0.0;
    uvec2 before[3];
    for (int r = 0; r < 4; r++) {
        int y = r < 2 ? i0.y + r : i1.y + r - 2;
        uvec2 left = uvec2(0u);
        for (int k = 0; k < 4; k++) {
            int x = k < 2 ? i0.x + k : i1.x + k - 2;
            uint at = table + 2u * uint(y * (width + 1) + x);
            uvec2 here = uvec2(texel_word(at), texel_word(at + 1u));
            if (k > 0) {
                uvec2 row = difference(here, left);
                if (r > 0) sum += wx[k - 1] * wy[r - 1] * as_float(difference(row, before[k - 1]));
                before[k - 1] = row;
            }
            left = here;
        }
    }
    return sum;
}

// Returns the mean; `place` is a coordinate of a 2D texture that has a table, which follows its levels.
vec4 summed_area(const Texture image, const Sampler how, const Coordinate place) {
    uint table = texel_word(image.first_word - image.levels);
    float least = uintBitsToFloat(texel_word(table));
    float step = uintBitsToFloat(texel_word(table + 1u));
    int channels = int(texel_word(table + 2u));
    ivec2 size = ivec2(image.size.xy);
    vec2 wide = vec2(size);
    // No box is narrower than a texel, or wider than a million periods.
    vec2 reach = clamp(0.5 * (abs(place.dx.xy) + abs(place.dy.xy)) * wide, vec2(0.5), wide * 1e6);
    vec2 center = vec2(reduced_coordinate(ADDRESSES_U, how.address_u, place.at.x, wide.x),
                               reduced_coordinate(ADDRESSES_V, how.address_v, place.at.y, wide.y));
    if (MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.texel_center)) center += 0.5;
    Parts u = axis_parts(ADDRESSES_U, how.address_u, center.x - reach.x, center.x + reach.x, wide.x);
    Parts v = axis_parts(ADDRESSES_V, how.address_v, center.y - reach.y, center.y + reach.y, wide.y);
    // The part of the box that is not border, as fractions, since the amounts may be large.
    float inside_u = u.amount.x + u.amount.y + u.amount.z;
    float inside_v = v.amount.x + v.amount.y + v.amount.z;
    vec4 sum = vec4(0.0);
    for (int part = 0; part < 9; part++) {
        int i = part % 3;
        int j = part / 3;
        if (u.amount[i] <= 0.0 || v.amount[j] <= 0.0) continue;
        float share = (u.amount[i] / inside_u) * (v.amount[j] / inside_v);
        vec2 from = vec2(u.from[i], v.from[j]);
        vec2 to = vec2(u.to[i], v.to[j]);
        float area = (to.x - from.x) * (to.y - from.y);
        vec4 mean = vec4(0.0, 0.0, 0.0, 1.0);
        for (int c = 0; c < channels; c++) {
            uint first = table + 3u + uint(c) * 2u * uint(size.x + 1) * uint(size.y + 1);
            float value = least + step * (rectangle(first, size.x, from, to, size - 1) / area);
            if (c == 0) mean.xyz = vec3(value);
            else if (channels == 2) mean.w = value;
            else mean[c] = value;
        }
        sum += share * mean;
    }
    // The part that neither axis covers is border.
    if (BORDERS) {
        bool bordered = how.address_u == ADDRESS_CLAMP_TO_BORDER || how.address_v == ADDRESS_CLAMP_TO_BORDER;
        // Along a periodic axis the parts cover one period, which represents the whole.
        float share_u = how.address_u == ADDRESS_CLAMP_TO_BORDER ? inside_u / (2.0 * reach.x) : 1.0;
        float share_v = how.address_v == ADDRESS_CLAMP_TO_BORDER ? inside_v / (2.0 * reach.y) : 1.0;
        return bordered ? mix(how.border, sum, share_u * share_v) : sum;
    }
    return sum;
}
#endif

#endif
