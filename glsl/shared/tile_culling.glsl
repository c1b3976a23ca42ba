// The result of tile culling: for each square cell of pixels the triangles that its camera rays may meet, as CELL_WORDS
// describes it. Single triangles are in the order of the scene.
#ifndef TILE_CULLING_GLSL
#define TILE_CULLING_GLSL

#include "layout.glsl"

layout(std430, set = 0, binding = BINDING_TILE_LISTS) readonly buffer TileLists { uint tile_lists[]; };

// What a camera ray may meet.
struct Candidates {
    uint list;    // first word of the cell in which it lies; NO_LIST if all is tested
    uvec4 meshes; // a bit for each listed triangle of a mesh that rays of its pixel may meet
};

const Candidates ANYTHING = Candidates(NO_LIST, uvec4(0u));

// Returns the first word of the cell of a film pixel; NO_LIST for a scene without tile culling, or a cell
// with more triangles than it can list.
uint cell_list(const Header header, uvec2 place) {
    uint side = header.cell_side;
    if (side == 0u) return NO_LIST;
    uint across = (header.film_size.x + side - 1u) / side;
    uint at = ((place.y / side) * across + place.x / side) * CELL_WORDS;
    // The second number counts within the room that the first one leaves.
    uint single = tile_lists[at];
    bool has_room = single <= MAX_LISTED && tile_lists[at + 2u] <= MAX_LISTED - min(single, MAX_LISTED);
    return has_room ? at : NO_LIST;
}

#endif
