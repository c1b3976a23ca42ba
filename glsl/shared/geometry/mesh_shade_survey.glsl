// The shades of a cell of pixels: the triangles of meshes that may shade what its camera rays see from a directional light,
// which its pixels choose from. They stand behind the cells, after the region for which they are all.
#ifndef MESH_SHADE_SURVEY_GLSL
#define MESH_SHADE_SURVEY_GLSL

#include "mesh_survey.glsl"
#include "mesh_shade_region.glsl"

// What the cell sees, in parts: surfaces that lie apart would have much between them in one.
const uint REGION_PARTS = 4u;
ShadeRegion region_parts[REGION_PARTS];

float size_of(const ShadeRegion region) { return is_empty(region) ? 0.0 : sum_of_parts(region.greatest - region.least); }

// Adds a region to the part that grows least by it.
void add_to_parts(const ShadeRegion region) {
    if (is_empty(region)) return;
    float least = FAR;
    uint best = 0u;
    for (uint k = 0u; k < REGION_PARTS; k++) {
        // A new part for what is not near another one.
        float growth = is_empty(region_parts[k]) ? 8.0 * size_of(region) : size_of(joined(region_parts[k], region)) - size_of(region_parts[k]);
        best = growth < least ? k : best;
        least = min(growth, least);
    }
    for (uint k = 0u; k < REGION_PARTS; k++) {
        if (k == best) region_parts[k] = joined(region_parts[k], region);
    }
}

// True if a box of the tree is above none of the parts.
bool is_box_beside(vec3 low, vec3 high) {
    vec3 middle = in_frame(0.5 * (low + high));
    vec3 half_size = 0.5 * (high - low);
    vec3 extent = vec3(dot3(abs(shade_frame[0]), half_size), dot3(abs(shade_frame[1]), half_size), dot3(abs(shade_frame[2]), half_size));
    bool is_out = true;
    for (uint k = 0u; k < REGION_PARTS; k++) is_out = is_out && (is_empty(region_parts[k]) || is_beside(region_parts[k], middle - extent, middle + extent));
    return is_out;
}

bool is_above_parts(vec3 a, vec3 b, vec3 c) {
    vec3 pa = in_frame(a);
    vec3 pb = in_frame(b);
    vec3 pc = in_frame(c);
    bool is_over = false;
    for (uint k = 0u; k < REGION_PARTS; k++) is_over = is_over || is_above(region_parts[k], pa, pb, pc);
    return is_over;
}

// The triangles above the parts: the texels of the first ones. Where threads are many, their memory is dear.
const uint SHADE_ROOM = HOLDS_TRIANGLES ? 768u : 96u;
uint above[SHADE_ROOM];

// Nodes that wait, from the beginning on, and leaves above the parts, from the end on.
const uint NODE_ROOM = HOLDS_TRIANGLES ? 768u : 256u;
uint room[NODE_ROOM];

// Finds the leaves above the parts. Returns their number, NODE_ROOM if there are too many.
uint leaves_above() {
    uint height = 0u;
    uint leaves = 0u;
    uint reference = 0u;
    for (uint opened = 0u; opened < MAX_CELL_NODES / 2u; opened++) {
        for (uint k = 0u; k < TREE_WIDTH; k++) {
            uvec4 least = mesh_texel(reference + 2u * k);
            uvec4 greatest = mesh_texel(reference + 2u * k + 1u);
            bool is_met = least.w != NO_SHAPE && !is_box_beside(point_in(least), point_in(greatest));
            bool is_leaf = greatest.w != 0u;
            if (is_met) room[is_leaf ? NODE_ROOM - 1u - leaves : height] = least.w | (greatest.w << TREE_COUNT_SHIFT);
            leaves += is_met && is_leaf ? 1u : 0u;
            height += is_met && !is_leaf ? 1u : 0u;
        }
        if (height == 0u) return leaves;
        if (height + leaves + TREE_WIDTH > NODE_ROOM) return NODE_ROOM;
        height--;
        reference = room[height];
    }
    return NODE_ROOM;
}

// Finds the triangles above the parts. Returns their number, more than SHADE_ROOM if not all are known.
uint triangles_above() {
    uint leaves = leaves_above();
    if (leaves == NODE_ROOM) return NODE_ROOM;
    uint count = 0u;
    uint left = 0u;
    uint at = 0u;
    while ((left | leaves) != 0u) {
        if (left == 0u) {
            uint leaf = room[NODE_ROOM - leaves];
            leaves--;
            at = leaf & ((1u << TREE_COUNT_SHIFT) - 1u);
            left = leaf >> TREE_COUNT_SHIFT;
        }
        if (is_above_parts(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)))) {
            if (count < SHADE_ROOM) above[count] = at;
            count++;
        }
        at += 3u;
        left--;
    }
    return count;
}

// Returns the first of as many words of shades, which are free now; NO_LIST if there are not as many.
uint shade_words(const Header header, uint count) {
    if (words_behind(header) == 0u) return NO_LIST;
    uint words = first_shade_word(header);
    uint end = uint(found.length());
    uint taken = atomicAdd(found[behind_cells(header) + CELL_COUNTER_SHADES], count);
    uint most = end > words ? end - words : 0u;
    return taken <= most && count <= most - taken ? words + taken : NO_LIST;
}

// Words of bits for the triangles of a cell's list; none if there are too many pairs to test, or where pixels test them.
uint bit_words(const Survey survey, uint count) {
    return HOLDS_TRIANGLES && count * survey.count <= MAX_SHADE_PAIRS ? (survey.count + 31u) / 32u : 0u;
}

// Chooses of the triangles above the parts those that may shade one of the cell's list, each followed by the bits of those
// that it may shade: they fill the room of nodes from its beginning on. Returns the number of words, NODE_ROOM if they are
// too many.
uint choose_shades(const Survey survey, uint count, float reach) {
    uint words = bit_words(survey, count);
    uint end = 0u;
    for (uint k = 0u; k < count; k++) {
        if (end + words >= NODE_ROOM) return NODE_ROOM;
        uint texel = above[k];
        vec3 a = point_in(mesh_texel(texel));
        vec3 b = point_in(mesh_texel(texel + 1u));
        vec3 c = point_in(mesh_texel(texel + 2u));
        room[end] = texel;
        bool is_kept = words == 0u;
        for (uint word = 0u; word < words; word++) {
            uint bits = 0u;
            uint last = min(survey.count, 32u * word + 32u);
            for (uint r = 32u * word; r < last; r++) {
                Receiver receiver = receiver_at(found[listed_at(survey, r)]);
                bits |= leaves_lit(a, b, c, receiver, reach) ? 0u : 1u << (r & 31u);
            }
            room[end + 1u + word] = bits;
            is_kept = is_kept || bits != 0u;
        }
        end += is_kept ? 1u + words : 0u;
    }
    return end;
}

// Finds the shades of what a cell's list holds; writes where they are.
void survey_shades(const Header header, const PixelFrustum frame, const Survey survey) {
    set_shade_frame(vec3(light_at(0u).direction));
    vec3 x = 0.5 * frame.rays[0];
    vec3 y = 0.5 * frame.rays[1];
    vec3 way = frame.rays[2] + (x + y);
    for (uint k = 0u; k < REGION_PARTS; k++) region_parts[k] = EMPTY_REGION;
    for (uint k = 0u; k < survey.count; k++) add_to_parts(region_of(receiver_at(found[listed_at(survey, k)]), way, x, y));
    ShadeRegion region = EMPTY_REGION;
    for (uint k = 0u; k < REGION_PARTS; k++) {
        region_parts[k] = widened(region_parts[k]);
        region = joined(region, region_parts[k]);
    }
    uint words = 0u;
    uint count = 0u;
    uint first = NO_SHADES;
    if (!is_empty(region)) {
        first = NO_LIST;
        count = triangles_above();
        words = count <= SHADE_ROOM ? choose_shades(survey, count, region.reach) : NODE_ROOM;
        if (words < NODE_ROOM) first = shade_words(header, SHADES_HEAD + words);
    }
    found[survey.cell + CELL_SHADES] = first;
    if (first == NO_LIST || first == NO_SHADES) return;
    for (uint k = 0u; k < 3u; k++) {
        found[first + SHADES_LEAST + k] = floatBitsToUint(region.least[k]);
        found[first + SHADES_GREATEST + k] = floatBitsToUint(region.greatest[k]);
    }
    uint bits = bit_words(survey, count);
    found[first + SHADES_COUNT] = words / (1u + bits);
    found[first + SHADES_BITS] = bits;
    found[first + SHADES_REACH] = floatBitsToUint(region.reach);
    for (uint k = 0u; k < words; k++) found[first + SHADES_HEAD + k] = room[k];
}

#endif
