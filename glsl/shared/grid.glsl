// Prefix sums along the rows of a texture's levels, or of a checker: maps cells to texel codes and to the
// sums of all codes before them, across repetitions and edges. Twin: src/oracle/grid.rs.
#ifndef GRID_GLSL
#define GRID_GLSL

#include "address.glsl"
#include "filter/kinds.glsl"

// The first word of each texture's sums, then for each texture: channels, levels, least value, step, first
// word of each level; a level's rows of width + 1 sums.
layout(set = 0, binding = BINDING_PREFIX_SUMS) uniform usamplerBuffer prefix_sums;

const int HEADER_WORDS = 4;

// A grid of cells: a level of a texture, or a checker of unit squares.
struct Grid {
    bool checker;
    bool even;    // all cells have the mean colour, seen from far away
    bool unknown; // for coarser levels without repetition, which are no prefilter beyond the edges
    ivec2 size;
    int channels;
    int first_word;
    int head;     // first word of the texture's sums
    uvec2 address;
    bool linear;  // colours are interpolated between texels, not constant per texel
    vec2 scale;   // cells per unit of the coordinate along each axis
    float shift;  // coordinate of cell 0
    float least;  // value = least + step · code
    float step;
};

int word(int index) { return int(texelFetch(prefix_sums, index).x); }

// Returns the grid of level 0.
Grid texture_grid(uint index, const Texture image, const Sampler how) {
    int head = word(int(index));
    bool linear = is_continuous(how);
    bool integer = MODE_IS(TEXEL_CENTERS, TEXEL_CENTER_INTEGER, how.texel_center);
    // Linear cells are bounded by texel centres; the integer rule shifts all of them by half a texel.
    float shift = (linear ? -0.5 : 0.0) + (integer ? 0.5 : 0.0);
    return Grid(false, false, false, ivec2(image.size.xy), word(head), word(head + HEADER_WORDS), head, uvec2(how.address_u, how.address_v),
                linear, vec2(image.size.xy), shift, uintBitsToFloat(texelFetch(prefix_sums, head + 2).x),
                uintBitsToFloat(texelFetch(prefix_sums, head + 3).x));
}

Grid checker_grid() {
    return Grid(true, false, false, ivec2(1), 1, 0, 0, uvec2(0u), false, vec2(1.0), 0.0, 0.0, 1.0);
}

// Returns the grid of a coarser level; all coarser levels of a checker are uniform.
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

// Returns floor(a / b) for b > 0.
int floor_div(int a, int b) { return a < 0 ? -1 - (-1 - a) / b : a / b; }

// Returns the sum of codes from column 0 to before column i, in the row that begins at word `first`, modulo
// 2^32.
uvec3 stored_sum(Grid grid, int first, int i) {
    int at_word = first + i * grid.channels;
    uint code = texelFetch(prefix_sums, at_word).x;
    if (grid.channels == 1) return uvec3(code);
    return uvec3(code, texelFetch(prefix_sums, at_word + 1).x, texelFetch(prefix_sums, at_word + 2).x);
}

// Returns the first word of the texture row that row j addresses; for a checker, the parity of the row.
int addressed_row(Grid grid, int j) {
    if (grid.checker) return j & 1;
    int row = wrapped_texel(ADDRESSES_V, grid.address.y, j, grid.size.y);
    return grid.first_word + row * (grid.size.x + 1) * grid.channels;
}

// Column i: the texel that it addresses, and the number of whole rows before it.
struct Column {
    int texel;
    int rows;
    bool back; // mirrored: it counts from the row's end
};

Column addressed_column(Grid grid, int i) {
    int size = grid.size.x;
    Column column = Column(wrapped_texel(ADDRESSES_U, grid.address.x, i, size), 0, false);
    bool mirrors = MODE_IS(ADDRESSES_U, ADDRESS_MIRRORED_REPEAT, grid.address.x);
    if (mirrors || MODE_IS(ADDRESSES_U, ADDRESS_REPEAT, grid.address.x)) {
        // A shift by powers of two rounds down.
        if (TEXTURE_SIZES == (1u << TEXTURE_SIZE_POWER_OF_TWO)) column.rows = i >> findMSB(size);
        else column.rows = floor_div(i, size);
        column.back = mirrors && (column.rows & 1) != 0;
        column.rows += column.back ? 1 : 0;
    }
    return column;
}

// The codes of a column's texel, and the sums of all columns from column 0 to before it, negative left of
// column 0.
struct Codes {
    uvec3 own;
    uvec3 before;
};

Codes codes_at(Grid grid, int row, int i) {
    // Odd cells are the checker's figure: half of the cells before this one.
    if (grid.checker) return Codes(uvec3((i + row) & 1), uvec3((i + row) >> 1));
    Column column = addressed_column(grid, i);
    uvec3 low = stored_sum(grid, row, column.texel);
    uvec3 high = stored_sum(grid, row, column.texel + 1);
    Codes codes = Codes(high - low, column.back ? uvec3(0u) - high : low);
    if (column.rows != 0) codes.before += uint(column.rows) * stored_sum(grid, row, grid.size.x);
    if (MODE_IS(ADDRESSES_U, ADDRESS_CLAMP_TO_EDGE, grid.address.x)) codes.before += uint(i - column.texel) * codes.own;
    return codes;
}

#endif
