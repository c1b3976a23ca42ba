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
    int head;     // of the texture's sums
    uvec2 address;
    bool linear;  // between texels colour changes linearly, not in steps
    vec2 scale;   // cells an axis a unit of the coordinate
    float shift;  // where cell 0 begins
    float least;  // value = least + step · code
    float step;
};

int word(int index) { return int(texelFetch(row_sums, index).x); }

// Level 0.
Grid texture_grid(uint index, Texture image, Sampler how) {
    int head = word(int(index));
    bool linear = MODE_IS(FILTERS, FILTER_LINEAR, how.modes.z);
    bool integer = MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.modes.w);
    // Linear cells lie between texel centres, of which the integer rule moves all by half a texel.
    float shift = (linear ? -0.5 : 0.0) + (integer ? 0.5 : 0.0);
    return Grid(false, false, false, ivec2(image.place.yz), word(head), word(head + HEADER_WORDS), head, how.modes.xy,
                linear, vec2(image.place.yz), shift, uintBitsToFloat(texelFetch(row_sums, head + 2).x),
                uintBitsToFloat(texelFetch(row_sums, head + 3).x));
}

Grid checker_grid() {
    return Grid(true, false, false, ivec2(1), 1, 0, 0, uvec2(0u), false, vec2(1.0), 0.0, 0.0, 1.0);
}

// A coarser level of a grid; of a checker all of them are even.
Grid coarser(Grid grid, int level) {
    if (grid.checker) {
        grid.even = true;
        return grid;
    }
    int coarsest = word(grid.head + 1) - 1;
    int held = min(level, coarsest);
    grid.even = level > coarsest;
    grid.unknown = MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, grid.address.x) ||
                   MODE_IS(ADDRESSES_V, ADDRESS_CLAMP_TO_EDGE, grid.address.y);
    grid.size = max(grid.size >> held, ivec2(1));
    grid.first_word = word(grid.head + HEADER_WORDS + held);
    grid.scale = vec2(grid.size);
    return grid;
}

// floor(a / b) for b > 0.
int floor_div(int a, int b) { return a < 0 ? -1 - (-1 - a) / b : a / b; }

// Codes of a row, which begins at word `first`, summed from column 0 to before column i, modulo 2^32.
uvec3 stored_sum(Grid grid, int first, int i) {
    int at_word = first + i * grid.channels;
    uint code = texelFetch(row_sums, at_word).x;
    if (grid.channels == 1) return uvec3(code);
    return uvec3(code, texelFetch(row_sums, at_word + 1).x, texelFetch(row_sums, at_word + 2).x);
}

// The first word of the texture's row that an addressed one shows; of a checker whether cells are odd.
int addressed_row(Grid grid, int j) {
    if (grid.checker) return j & 1;
    int size = grid.size.y;
    int row = clamp(j, 0, size - 1);
    if (MODE_IS(ADDRESSES_V, ADDRESS_REPEAT, grid.address.y)) {
        if (TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) row = j & (size - 1);
        else row = j - size * floor_div(j, size);
    } else if (MODE_IS(ADDRESSES_V, ADDRESS_MIRRORED_REPEAT, grid.address.y)) {
        int left = j - 2 * size * floor_div(j, 2 * size);
        row = left < size ? left : 2 * size - 1 - left;
    }
    return grid.first_word + row * (grid.size.x + 1) * grid.channels;
}

// Column i: the texel that it shows, and how often whole rows lie before it.
struct Column {
    int texel;
    int rows;
    bool back; // mirrored: it runs from the row's end
};

Column addressed_column(Grid grid, int i) {
    int size = grid.size.x;
    Column column = Column(clamp(i, 0, size - 1), 0, false);
    if (MODE_IS(ADDRESSES_U, ADDRESS_REPEAT, grid.address.x)) {
        // A shift of whole powers of two floors.
        if (TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) column.rows = i >> findMSB(size);
        else column.rows = floor_div(i, size);
        column.texel = i - size * column.rows;
    } else if (MODE_IS(ADDRESSES_U, ADDRESS_MIRRORED_REPEAT, grid.address.x)) {
        int period = floor_div(i, 2 * size);
        int left = i - 2 * size * period;
        column.back = left >= size;
        column.texel = column.back ? 2 * size - 1 - left : left;
        column.rows = 2 * period + (column.back ? 2 : 0);
    }
    return column;
}

// Codes of a column's texel, and summed up to it from column 0, negative before that.
struct Codes {
    uvec3 own;
    uvec3 before;
};

Codes codes_at(Grid grid, int row, int i) {
    // A checker's cells of odd number are its figure: half of those before.
    if (grid.checker) return Codes(uvec3((i + row) & 1), uvec3((i + row) >> 1));
    Column column = addressed_column(grid, i);
    uvec3 low = stored_sum(grid, row, column.texel);
    uvec3 high = stored_sum(grid, row, column.texel + 1);
    Codes codes = Codes(high - low, column.back ? uvec3(0u) - high : low);
    if (column.rows != 0) codes.before += uint(column.rows) * stored_sum(grid, row, grid.size.x);
    if (MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, grid.address.x)) codes.before += uint(i - column.texel) * codes.own;
    return codes;
}

// Where the integrals along a row begin.
struct Row {
    int first;
    Codes start;
};

Row load_row(Grid grid, ivec2 base, int j) {
    int first = addressed_row(grid, base.y + j);
    return Row(first, codes_at(grid, first, base.x));
}

// Of a cell of a row: its texel and the next one, and the integral from the middle of the base's texel to that of its own, or
// from edge to edge where colour changes in steps.
struct Stretch {
    vec3 own;
    vec3 right;
    vec3 whole;
};

Stretch stretch(Grid grid, Row row, int i) {
    Codes here = codes_at(grid, row.first, i);
    Stretch s = Stretch(vec3(ivec3(here.own)), vec3(0.0), vec3(ivec3(here.before - row.start.before)));
    if (grid.linear) {
        s.right = vec3(ivec3(codes_at(grid, row.first, i + 1).own));
        s.whole += 0.5 * (s.own - vec3(ivec3(row.start.own)));
    }
    return s;
}

// The integral of a row's colour up to place s in the cell.
vec3 along_row(Grid grid, Stretch row, float s) {
    vec3 sum = row.whole + s * row.own;
    if (grid.linear) sum += (0.5 * s * s) * (row.right - row.own);
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
    ivec2 cell = ivec2(floor(a));
    ivec2 last = ivec2(floor(b));
    ivec2 forward = ivec2(way.x > 0.0 ? 1 : 0, way.y > 0.0 ? 1 : 0);
    vec3 sum = vec3(0.0);
    float done = 0.0;
    uint cells = cells_between(a, b);
    uint rows = grid.linear ? 2u : 1u;
    Row low;
    Row high;
    bool fresh = true;
    uint k = 0u;
    for (; k <= cells; k++) {
        // Where on the edge the next line of the grid is met.
        vec2 ends = clamp((vec2(cell + forward) - a) / way, 0.0, 1.0);
        bool down = cell.x == last.x || (cell.y != last.y && ends.y < ends.x);
        float end = cell == last ? 1.0 : max(down ? ends.y : ends.x, done);
        float half_way = 0.5 * (end - done);
        // Gauss's two points: exact for what is cubic along the edge.
        vec2 first = clamp(a + way * (done + half_way * (1.0 - GAUSS)) - vec2(cell), 0.0, 1.0);
        vec2 second = clamp(a + way * (done + half_way * (1.0 + GAUSS)) - vec2(cell), 0.0, 1.0);
        for (uint r = 0u; r < rows; r++) {
            Row row = low;
            if (r == 1u) row = high;
            if (fresh) row = load_row(grid, base, cell.y + int(r));
            if (r == 0u) low = row;
            else high = row;
            Stretch s = stretch(grid, row, base.x + cell.x);
            vec2 weights = vec2(1.0);
            if (grid.linear) weights = r == 0u ? 1.0 - vec2(first.y, second.y) : vec2(first.y, second.y);
            weights *= half_way;
            sum += weights.x * along_row(grid, s, first.x) + weights.y * along_row(grid, s, second.x);
        }
        done = end;
        fresh = down;
        if (down) cell.y += 2 * forward.y - 1;
        else cell.x += 2 * forward.x - 1;
    }
    ended = ended && k > cells;
    return sum * way.y;
}

// The colour at a place of a cell.
vec3 value_in(Grid grid, ivec2 cell, vec2 within) {
    vec3 sum = vec3(0.0);
    for (int r = 0; r < (grid.linear ? 2 : 1); r++) {
        Stretch s = stretch(grid, load_row(grid, cell, r), cell.x);
        vec3 value = s.own;
        if (grid.linear) value = (s.own + within.x * (s.right - s.own)) * (r == 0 ? 1.0 - within.y : within.y);
        sum += value;
    }
    return sum;
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
float longest_edge(uint polygon, Quotient quotient) {
    vec2 a = place_in(quotient, corner(polygon, 0u));
    float reach = 0.0;
    for (uint k = 1u; k <= counts[polygon]; k++) {
        vec2 b = place_in(quotient, next_corner(polygon, k));
        vec2 way = abs(b - a);
        reach = max(reach, way.x + way.y);
        a = b;
    }
    return reach;
}

// An edge is level that rises by so little of the polygon's height: its integral is less than what rounding
// makes of it.
const float LEVEL = 3e-5;

float rows_covered(uint polygon, Quotient quotient) {
    vec2 ends = vec2(FARTHEST, -FARTHEST);
    for (uint k = 0u; k < counts[polygon]; k++) {
        float row = place_in(quotient, corner(polygon, k)).y;
        ends = vec2(min(ends.x, row), max(ends.y, row));
    }
    return ends.y - ends.x;
}

// Mean colour, in codes, over the texture space that a polygon shows. Cells that were crossed are counted.
vec3 mean_over(Grid grid, uint polygon, Quotient quotient, bool small, inout uint crossed, inout bool ended) {
    if (grid.even && grid.checker) return vec3(0.5);
    vec2 place = place_in(in_grid(grid, quotient, ivec2(0)), middle(polygon));
    vec2 cell = floor(place);
    ivec2 base = ivec2(cell);
    if (!small && !grid.even) {
        Quotient near = in_grid(grid, quotient, base);
        vec3 integral = vec3(0.0);
        float covered = 0.0;
        float height = rows_covered(polygon, near);
        vec2 a = place_in(near, corner(polygon, 0u));
        uint k = 1u;
        for (; k <= counts[polygon]; k++) {
            vec2 b = place_in(near, next_corner(polygon, k));
            if (abs(b.y - a.y) > LEVEL * height) {
                integral += edge_integral(grid, base, a, b, ended);
                covered += 0.5 * (a.x + b.x) * (b.y - a.y);
                crossed += 1u + cells_between(a, b);
            }
            a = b;
        }
        ended = ended && k > counts[polygon];
        if (covered != 0.0) return integral / covered;
    }
    // What has no area shows the colour of its middle; the coarsest level has one everywhere.
    return value_in(grid, base, place - cell);
}

#endif
