// The integral of a texture over a polygon in texture space, by Green's theorem: the double integral of c is
// that of C dY around the polygon, where C is the integral of c along its row, from a table of prefix sums.
// Every edge is traversed cell by cell, and in each cell C is a polynomial, so the integral is exact for the
// reconstruction between texels (Heckbert 1986, "Filtering by repeated integration", for boxes). Twin:
// src/oracle/prefix_sums.rs.
#ifndef PREFIX_SUMS_GLSL
#define PREFIX_SUMS_GLSL

#include "projective.glsl"
#include "grid.glsl"

// The start of the integrals along a row.
struct Row {
    int first;
    Codes start;
};

Row load_row(Grid grid, ivec2 base, int j) {
    int first = addressed_row(grid, base.y + j);
    return Row(first, codes_at(grid, first, base.x));
}

// A cell of a row: its texel and the next one, and the integral from the centre of the base's texel to that
// of its own, or from edge to edge if colours are constant per texel.
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

// Returns the integral of a row's colour up to position s in the cell.
vec3 along_row(Grid grid, Stretch row, float s) {
    vec3 sum = row.whole + s * row.own;
    if (grid.linear) sum += (0.5 * s * s) * (row.right - row.own);
    return sum;
}

// Returns the number of grid lines that an edge crosses.
uint cells_between(vec2 a, vec2 b) {
    vec2 cells = abs(floor(b) - floor(a));
    return uint(cells.x + cells.y);
}

const float GAUSS = 0.57735026918962576; // 1 / √3

// Computes the integral of C dY from a to b; positions count from cell `base`. Returns true if it was
// completed: some devices end loops early.
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
        // The parameter at which the edge meets the next grid line.
        vec2 ends = clamp((vec2(cell + forward) - a) / way, 0.0, 1.0);
        bool down = cell.x == last.x || (cell.y != last.y && ends.y < ends.x);
        float end = cell == last ? 1.0 : max(down ? ends.y : ends.x, done);
        float half_way = 0.5 * (end - done);
        // Gauss-Legendre quadrature with two points: exact for cubics along the edge.
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

// Returns the colour at a position in a cell.
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
const float SMALLEST = 0.00390625; // a smaller polygon has the colour at its centre

// Returns the map from the picture to the grid, relative to a base that is subtracted before the division, so
// that differences of near positions are exact.
RationalMap in_grid(Grid grid, const RationalMap quotient, ivec2 base) {
    vec2 start = vec2(grid.shift) - vec2(base);
    return RationalMap(grid.scale.x * quotient.u + start.x * quotient.below,
                    grid.scale.y * quotient.v + start.y * quotient.below, quotient.below);
}

// Maps a position; towards the horizon it would go to infinity.
vec2 place_in(const RationalMap quotient, vec2 place) {
    vec2 at_place = vec2(at(quotient.u, place), at(quotient.v, place)) / at(quotient.below, place);
    return clamp(at_place, -FARTHEST, FARTHEST);
}

// Returns the length of the longest edge of a polygon, in cells.
float longest_edge(uint polygon, const RationalMap quotient) {
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

// An edge counts as horizontal if it rises by less than this fraction of the polygon's height: its integral
// is smaller than the rounding error.
const float LEVEL = 3e-5;

float rows_covered(uint polygon, const RationalMap quotient) {
    vec2 ends = vec2(FARTHEST, -FARTHEST);
    for (uint k = 0u; k < counts[polygon]; k++) {
        float row = place_in(quotient, corner(polygon, k)).y;
        ends = vec2(min(ends.x, row), max(ends.y, row));
    }
    return ends.y - ends.x;
}

// Returns the mean colour, in codes, over the polygon's image in texture space, and counts the cells crossed.
vec3 mean_over(Grid grid, uint polygon, const RationalMap quotient, bool small, inout uint crossed, inout bool ended) {
    if (grid.even && grid.checker) return vec3(0.5);
    vec2 place = place_in(in_grid(grid, quotient, ivec2(0)), middle(polygon));
    vec2 cell = floor(place);
    ivec2 base = ivec2(cell);
    if (!small && !grid.even) {
        RationalMap near = in_grid(grid, quotient, base);
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
    // A polygon without area has the colour at its centre; the coarsest level is uniform.
    return value_in(grid, base, place - cell);
}

#endif
