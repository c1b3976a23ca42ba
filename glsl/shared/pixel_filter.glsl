// Importance sampling of the pixel filter: maps a sample in the unit square to its position around the pixel,
// by the inverse of the distribution of the filter's absolute value along each axis (Ernst, Stamminger &
// Greiner 2006), and to the filter's sign there. From the centre outwards, with a fraction t of the samples
// nearer, the distance is D(√(1 - t)) radii: D(v) = 1 - v for a tent, a table for others. A box of one pixel
// leaves every position unchanged.
#ifndef PIXEL_FILTER_GLSL
#define PIXEL_FILTER_GLSL

const bool SIGNED = HAS(PIXEL_FILTERS, PIXEL_FILTER_MITCHELL);

struct Place {
    vec2 inside; // from the pixel's corner, in units of 2^-24 of a pixel
    float sign;
};

// Each thread reads at an index of its own: CPU devices are fastest with a uniform buffer, GPUs with others,
// as their constant caches serve one address at a time.
float tabled_distance(uint i) {
    uint at = PIXEL_FILTER_AT + (i >> 2u);
    uvec4 four;
    if (TABLES_IN_HEAD) four = head[at];
    else four = scene[at];
    return uintBitsToFloat(four[i & 3u]);
}

// Returns the distance from the centre beyond which `rest` of 2^24 samples lie, in radii.
float distance_in_radii(const Header header, uint rest) {
    float v = sqrt(float(rest) * (1.0 / 16777216.0));
    if (MODE_IS(PIXEL_FILTERS, PIXEL_FILTER_TENT, header.pixel_filter)) return 1.0 - v;
    float at = v * float(PIXEL_FILTER_CELLS);
    uint cell = min(uint(at), PIXEL_FILTER_CELLS - 1u);
    float near = tabled_distance(cell);
    float further = tabled_distance(cell + 1u) - near;
    return near + (at - float(cell)) * further;
}

// Returns the distance of the centre of a position's step from the centre of all, of 2^24.
uint from_middle(uint position) {
    uint doubled = 2u * position + 1u;
    return position < 0x800000u ? 0x1000000u - doubled : doubled - 0x1000000u;
}

float filtered_position(const Header header, uint position) {
    float radius = header.filter_radius;
    if (MODE_IS(PIXEL_FILTERS, PIXEL_FILTER_BOX, header.pixel_filter)) {
        return 8388608.0 + (float(position) - 8388608.0) * (2.0 * radius);
    }
    float offset = distance_in_radii(header, 0x1000000u - from_middle(position)) * (radius * 16777216.0);
    return position < 0x800000u ? 8388608.0 - offset : 8388608.0 + offset;
}

float filter_sign(const Header header, uvec2 position) {
    bool x = from_middle(position.x) >= header.first_negative_step;
    bool y = from_middle(position.y) >= header.first_negative_step;
    return x == y ? 1.0 : -1.0;
}

Place filtered_place(const Header header, uvec2 position) {
    if (!WARPED) return Place(vec2(position), 1.0);
    vec2 inside = vec2(filtered_position(header, position.x), filtered_position(header, position.y));
    return Place(inside, SIGNED ? filter_sign(header, position) : 1.0);
}

// Returns the width in pixels of the box that has the filter's variance.
float filter_width(const Header header) { return WARPED ? header.filter_width : 1.0; }

#endif
