// The integral of a texture over a polygon of texture space, by Green's theorem: the double integral of c is that of
// C dY around the polygon, where C is the integral of c along its row, from a table of sums. Every edge is
// walked cell by cell, and in each cell C is a polynomial; so the integral is exact for the reconstruction
// between texels (Heckbert 1986, "Filtering by repeated integration", has it for boxes). Twin:
// src/oracle/rows.rs.
#ifndef ROWS_GLSL
#define ROWS_GLSL

#include "forms.glsl"

// Where each texture's sums begin, then those: channels, levels, least value, step, first word of each
// level; a level's rows of width + 1 sums.
layout(set = 0, binding = 9) uniform usamplerBuffer row_sums;

const int HEADER_WORDS = 4;

// What is walked: a level of a texture, or a checker of unit squares.
struct Grid {
    bool checker;
    bool even;    // seen from so far that all has the colour of the mean
    bool unknown; // of a texture that does not repeat, coarser levels are no prefilter beyond its edges
    ivec2 size;
    int channels;
    int first_word;
    uvec2 address;
    bool linear;  // between texels colour changes linearly, not in steps
    vec2 scale;   // cells an axis a unit of the coordinate
    float shift;  // where cell 0 begins
    float least;  // value = least + step · code
    float step;
};

int word(int index) { return int(texelFetch(row_sums, index).x); }

Grid texture_grid(uint index, Texture image, Sampler how, int level) {
    int head = word(int(index));
    int coarsest = word(head + 1) - 1;
    int held = min(level, coarsest);
    ivec2 size = max(ivec2(image.place.yz) >> held, ivec2(1));
    bool linear = MODE_IS(FILTERS, FILTER_LINEAR, how.modes.z);
    bool integer = MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.modes.w);
    // Linear cells lie between texel centres, of which the integer rule moves all by half a texel.
    float shift = (linear ? -0.5 : 0.0) + (integer ? 0.5 : 0.0);
    bool clamped = MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, how.modes.x) ||
                   MODE_IS(ADDRESSES_V, ADDRESS_CLAMP_TO_EDGE, how.modes.y);
    return Grid(false, level > coarsest, level > 0 && clamped, size, word(head), word(head + HEADER_WORDS + held),
                how.modes.xy, linear, vec2(size), shift, uintBitsToFloat(texelFetch(row_sums, head + 2).x),
                uintBitsToFloat(texelFetch(row_sums, head + 3).x));
}

Grid checker_grid(int level) {
    return Grid(true, level > 0, false, ivec2(1), 1, 0, uvec2(0u), false, vec2(1.0), 0.0, 0.0, 1.0);
}

// floor(a / b) for b > 0.
int floor_div(int a, int b) { return a < 0 ? -1 - (-1 - a) / b : a / b; }

// Codes of a row summed from column 0 to before column i, modulo 2^32.
uvec3 stored_sum(Grid grid, int row, int i) {
    int first = grid.first_word + (row * (grid.size.x + 1) + i) * grid.channels;
    uint code = texelFetch(row_sums, first).x;
    if (grid.channels == 1) return uvec3(code);
    return uvec3(code, texelFetch(row_sums, first + 1).x, texelFetch(row_sums, first + 2).x);
}

// The texture's row that an addressed one shows.
int addressed_row(Grid grid, int j) {
    int size = grid.size.y;
    if (MODE_IS(ADDRESSES_V, ADDRESS_REPEAT, grid.address.y)) return j - size * floor_div(j, size);
    if (MODE_IS(ADDRESSES_V, ADDRESS_MIRRORED_REPEAT, grid.address.y)) {
        int left = j - 2 * size * floor_div(j, 2 * size);
        return left < size ? left : 2 * size - 1 - left;
    }
    return clamp(j, 0, size - 1);
}

// The same for any column, over repeats and edges: from column 0 to before column i, negative before it.
// `row` is addressed; of a checker it is any.
uvec3 row_sum(Grid grid, int row, int i) {
    // Cells whose numbers sum to an odd one.
    if (grid.checker) return uvec3(floor_div(i + (row & 1), 2));
    int size = grid.size.x;
    // sum = times · (a whole row) + sign · (up to `first`)
    int times = 0;
    int first = i;
    bool back = false;
    if (MODE_IS(ADDRESSES_U, ADDRESS_REPEAT, grid.address.x)) {
        times = floor_div(i, size);
        first = i - size * times;
    } else if (MODE_IS(ADDRESSES_U, ADDRESS_MIRRORED_REPEAT, grid.address.x)) {
        times = 2 * floor_div(i, 2 * size);
        first = i - size * times;
        back = first > size;
        times += back ? 2 : 0;
        first = back ? 2 * size - first : first;
    } else {
        first = clamp(i, 0, size);
    }
    uvec3 sum = stored_sum(grid, row, first);
    sum = back ? uvec3(0u) - sum : sum;
    if (times != 0) sum += uint(times) * stored_sum(grid, row, size);
    if (MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, grid.address.x) && first != i) {
        uvec3 edge = i < 0 ? stored_sum(grid, row, 1) : sum - stored_sum(grid, row, size - 1);
        sum += uint(i - first) * edge;
    }
    return sum;
}

// b - a as a signed number.
vec3 difference(uvec3 a, uvec3 b) { return vec3(ivec3(b - a)); }

// A row's texels i and i + 1, and the integral from the middle of texel `from` to that of texel i, or from edge
// to edge where colour changes in steps.
struct Stretch {
    vec3 own;
    vec3 right;
    vec3 whole;
};

Stretch stretch(Grid grid, int j, int from, int i) {
    int row = grid.checker ? j : addressed_row(grid, j);
    uvec3 start = row_sum(grid, row, from);
    uvec3 here = row_sum(grid, row, i);
    uvec3 next = row_sum(grid, row, i + 1);
    Stretch s = Stretch(difference(here, next), vec3(0.0), difference(start, here));
    if (grid.linear) {
        s.right = difference(next, row_sum(grid, row, i + 2));
        s.whole += 0.5 * (s.own - difference(start, row_sum(grid, row, from + 1)));
    }
    return s;
}

// The integral of a row's colour up to place s in the cell.
vec3 along_row(Grid grid, Stretch row, float s) {
    vec3 sum = row.whole + s * row.own;
    if (grid.linear) sum += (0.5 * s * s) * (row.right - row.own);
    return sum;
}

// C in a cell.
vec3 primitive(Grid grid, Stretch low, Stretch high, vec2 within) {
    vec3 sum = along_row(grid, low, within.x);
    if (grid.linear) sum += within.y * (along_row(grid, high, within.x) - sum);
    return sum;
}

// Lines of the grid that an edge crosses.
uint cells_between(vec2 a, vec2 b) {
    vec2 cells = abs(floor(b) - floor(a));
    return uint(cells.x + cells.y);
}

const float GAUSS = 0.57735026918962576; // 1 / √3

// The integral of C dY from a to b; places count from cell `base`. Told whether it came to its end: some
// devices end loops early.
vec3 edge_integral(Grid grid, ivec2 base, vec2 a, vec2 b, inout bool ended) {
    vec2 way = b - a;
    if (way.y == 0.0) return vec3(0.0);
    ivec2 cell = ivec2(floor(a));
    ivec2 last = ivec2(floor(b));
    ivec2 forward = ivec2(way.x > 0.0 ? 1 : 0, way.y > 0.0 ? 1 : 0);
    vec3 sum = vec3(0.0);
    float done = 0.0;
    uint cells = cells_between(a, b);
    uint k = 0u;
    for (; k <= cells; k++) {
        // Where on the edge the next line of the grid is met.
        vec2 ends = clamp((vec2(cell + forward) - a) / way, 0.0, 1.0);
        bool down = cell.x == last.x || (cell.y != last.y && ends.y < ends.x);
        float end = cell == last ? 1.0 : max(down ? ends.y : ends.x, done);
        float half_way = 0.5 * (end - done);
        ivec2 texel = base + cell;
        Stretch low = stretch(grid, texel.y, base.x, texel.x);
        Stretch high = low;
        if (grid.linear) high = stretch(grid, texel.y + 1, base.x, texel.x);
        // Gauss's two points: exact for what is cubic along the edge.
        vec2 first = clamp(a + way * (done + half_way * (1.0 - GAUSS)) - vec2(cell), 0.0, 1.0);
        vec2 second = clamp(a + way * (done + half_way * (1.0 + GAUSS)) - vec2(cell), 0.0, 1.0);
        sum += half_way * (primitive(grid, low, high, first) + primitive(grid, low, high, second));
        done = end;
        if (down) cell.y += 2 * forward.y - 1;
        else cell.x += 2 * forward.x - 1;
    }
    ended = ended && k > cells;
    return sum * way.y;
}

// The colour at a place of a cell.
vec3 value_in(Grid grid, ivec2 cell, vec2 within) {
    Stretch low = stretch(grid, cell.y, cell.x, cell.x);
    if (!grid.linear) return low.own;
    Stretch high = stretch(grid, cell.y + 1, cell.x, cell.x);
    vec3 a = low.own + within.x * (low.right - low.own);
    vec3 b = high.own + within.x * (high.right - high.own);
    return a + within.y * (b - a);
}

const float FARTHEST = 1e8;       // in cells
const float SMALLEST = 0.00390625; // a polygon so small has the colour of its middle

// How places of the picture lie in the grid, counted from a base before the division, so that near places
// differ exactly.
Quotient in_grid(Grid grid, Quotient quotient, ivec2 base) {
    vec2 start = vec2(grid.shift) - vec2(base);
    return Quotient(grid.scale.x * quotient.u + start.x * quotient.below,
                    grid.scale.y * quotient.v + start.y * quotient.below, quotient.below);
}

// Towards the horizon a place goes to infinity.
vec2 place_in(Quotient quotient, vec2 place) {
    vec2 at_place = vec2(at(quotient.u, place), at(quotient.v, place)) / at(quotient.below, place);
    return clamp(at_place, -FARTHEST, FARTHEST);
}

// The longest edge of a polygon, in cells.
float longest_edge(Polygon polygon, Quotient quotient) {
    vec2 a = place_in(quotient, polygon.corners[0]);
    float reach = 0.0;
    for (uint k = 1u; k <= polygon.count; k++) {
        vec2 b = place_in(quotient, polygon.corners[k == polygon.count ? 0u : k]);
        vec2 way = abs(b - a);
        reach = max(reach, way.x + way.y);
        a = b;
    }
    return reach;
}

// Mean colour, in codes, over the texture space that a polygon shows. Cells that were crossed are counted.
vec3 mean_over(Grid grid, Polygon polygon, Quotient quotient, bool small, inout uint crossed, inout bool ended) {
    if (grid.even) return grid.checker ? vec3(0.5) : difference(row_sum(grid, 0, 0), row_sum(grid, 0, 1));
    vec2 place = place_in(in_grid(grid, quotient, ivec2(0)), middle(polygon));
    vec2 cell = floor(place);
    ivec2 base = ivec2(cell);
    vec3 mean = value_in(grid, base, place - cell);
    if (small) return mean;
    Quotient near = in_grid(grid, quotient, base);
    vec3 integral = vec3(0.0);
    float covered = 0.0;
    vec2 a = place_in(near, polygon.corners[0]);
    uint k = 1u;
    for (; k <= polygon.count; k++) {
        vec2 b = place_in(near, polygon.corners[k == polygon.count ? 0u : k]);
        integral += edge_integral(grid, base, a, b, ended);
        covered += 0.5 * (a.x + b.x) * (b.y - a.y);
        crossed += 1u + cells_between(a, b);
        a = b;
    }
    ended = ended && k > polygon.count;
    // What has no area shows the colour of its middle.
    return covered == 0.0 ? mean : integral / covered;
}

#endif
