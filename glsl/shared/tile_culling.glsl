// The result of tile culling: for each square cell of pixels the shapes that its camera rays may meet, as CELL_WORDS
// describes it. Single shapes are in the order of their numbers.
#ifndef TILE_CULLING_GLSL
#define TILE_CULLING_GLSL

#include "geometry/kinds.glsl"
#include "layout.glsl"

layout(std430, set = 0, binding = BINDING_TILE_LISTS) readonly buffer TileLists { uint tile_lists[]; };

// What a camera ray may meet.
struct Candidates {
    uint list;    // first word of the cell in which it lies; NO_LIST if all is tested
    uvec4 meshes; // a bit for each listed triangle of a mesh that rays of its pixel may meet
    uvec4 more;
};

const Candidates ANYTHING = Candidates(NO_LIST, uvec4(0u), uvec4(0u));

// Returns the first word of the cell of a film pixel; NO_LIST for a scene without tile culling, or a cell
// with more shapes than it can list.
uint cell_list(const Header header, uvec2 place) {
    uint side = header.cell_side;
    if (side == 0u) return NO_LIST;
    uint across = (header.film_size.x + side - 1u) / side;
    uint at = ((place.y / side) * across + place.x / side) * CELL_WORDS;
    if (CONCAVE_SHAPES && HOLDS_TRIANGLES) {
        uvec2 quarter = (place % side) / (side / 2u);
        bool is_divided = tile_lists[at + 1u] == CELL_DIVIDED;
        at = is_divided ? tile_lists[at + CELL_MORE] + (2u * quarter.y + quarter.x) * CELL_WORDS : at;
    }
    return tile_lists[at] <= LIST_ROOM ? at : NO_LIST;
}

#endif
