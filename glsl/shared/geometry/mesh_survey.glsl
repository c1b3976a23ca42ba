// Meshes and a cell of pixels: the triangles that the cell's camera rays may meet, found by the tree from near to far, and
// the depth up to which these are all. It ends where five rays of the cell have met something, as little is seen beyond.
#ifndef MESH_SURVEY_GLSL
#define MESH_SURVEY_GLSL

#include "beams.glsl"
#include "mesh_edges.glsl"

// Rays that tell how deep a cell is: those at its corners and at its middle.
const uint PROBES = 5u;
// Planes of boxes and depths in f32 are off by less than this part of them.
const float BOX_ROUNDING = 4e-6;

// The rays of a cell: its sides, within which dot(normal, p) is not less than the height; and the probes.
struct CellRays {
    vec3 normals[4];
    float heights[4];
    vec3 ways[PROBES];
    vec3 origins[PROBES];
};

// What is known of the cell so far.
struct Survey {
    uint cell;          // its first word
    uint first;         // place of the first triangle in its list
    uint more;          // first word of its room for more, if it has any
    uint count;         // of triangles in its list
    float depth;        // no triangle that is not in the list is met up to here
    bool is_full;       // triangles are left out
    float met[PROBES];  // where the probes meet the first triangle
};

CellRays cell_rays(const Header header, const PixelFrustum frame) {
    CellRays cell;
    for (uint k = 0u; k < PROBES; k++) {
        vec2 place = k < 4u ? vec2(k == 1u || k == 2u ? 1.0 : 0.0, k >= 2u ? 1.0 : 0.0) : vec2(0.5);
        ray_at(header, frame, place, cell.ways[k], cell.origins[k]);
    }
    vec3 inside = cell.origins[4] + cell.ways[4];
    for (uint k = 0u; k < 4u; k++) {
        uint next = (k + 1u) % 4u;
        vec3 n = cross3(cell.ways[k], cell.origins[next] + cell.ways[next] - cell.origins[k]);
        float height = dot3(n, cell.origins[k]);
        bool turned = dot3(n, inside) < height;
        cell.normals[k] = turned ? -n : n;
        cell.heights[k] = turned ? -height : height;
    }
    return cell;
}

// Returns the least depth of a box before the eye, -1 if no ray of the cell meets it.
float depth_in(const Header header, const CellRays cell, vec3 low, vec3 high) {
    vec3 middle = 0.5 * (low + high);
    vec3 extent = 0.5 * (high - low);
    vec3 reach = abs(middle) + extent;
    bool outside = false;
    for (uint k = 0u; k < 4u; k++) {
        vec3 n = cell.normals[k];
        float most = dot3(n, middle) + dot3(abs(n), extent) + BOX_ROUNDING * dot3(abs(n), reach);
        outside = outside || most < cell.heights[k] - BOX_ROUNDING * abs(cell.heights[k]);
    }
    vec3 forward = vec3(header.forward);
    float along = dot3(forward, middle);
    float half_depth = dot3(abs(forward), extent) + BOX_ROUNDING * dot3(abs(forward), reach);
    return outside || along + half_depth < 0.0 ? -1.0 : max(along - half_depth, 0.0);
}

// Where a ray meets the triangle, FAR if it does not; as `distance_in` of mesh_tests.glsl.
float meets_at(vec3 a, vec3 b, vec3 c, vec3 d, bool one_sided) {
    vec3 edges = vec3(dot3(d, cross3(b + c, c - b)), dot3(d, cross3(c + a, a - c)), dot3(d, cross3(a + b, b - a)));
    bool back = edges.x >= 0.0 && edges.y >= 0.0 && edges.z >= 0.0;
    bool front = edges.x <= 0.0 && edges.y <= 0.0 && edges.z <= 0.0;
    if (CULLED_BACKS) back = back && !one_sided;
    float whole = (edges.x + edges.y) + edges.z;
    float t = dot3(edges, vec3(dot3(a, d), dot3(b, d), dot3(c, d))) / (whole * dot3(d, d));
    return (front || back) && whole != 0.0 && t > 0.0 ? t : FAR;
}

uint cell_count(const Header header) {
    uint side = header.cell_side;
    return ((header.film_size.x + side - 1u) / side) * ((header.film_size.y + side - 1u) / side);
}

// What stands behind the cells, as far as the buffer has it.
uint behind_cells(const Header header) { return cell_count(header) * CELL_WORDS; }

uint words_behind(const Header header) {
    uint words = uint(found.length()) - behind_cells(header);
    return words < CELL_COUNTERS ? 0u : words - CELL_COUNTERS;
}

// Of each its number, and four cells.
const uint DIVISION_WORDS = 1u + 4u * CELL_WORDS;

uint count_of_divisions(const Header header) {
    uint most = HOLDS_TRIANGLES ? (cell_count(header) + CELLS_A_DIVISION - 1u) / CELLS_A_DIVISION : 0u;
    return min(most, words_behind(header) / DIVISION_WORDS);
}

uint count_of_rooms(const Header header) {
    uint left = words_behind(header) - count_of_divisions(header) * DIVISION_WORDS;
    return min((cell_count(header) + CELLS_A_ROOM - 1u) / CELLS_A_ROOM, left / MORE_WORDS);
}

uint first_division(const Header header) { return behind_cells(header) + CELL_COUNTERS; }
uint first_quarter(const Header header, uint division) {
    return first_division(header) + count_of_divisions(header) + 4u * CELL_WORDS * division;
}
uint first_room(const Header header) { return first_division(header) + count_of_divisions(header) * DIVISION_WORDS; }
uint first_shade_word(const Header header) { return first_room(header) + count_of_rooms(header) * MORE_WORDS; }

// Returns the first word of a room for more that is free now; NO_LIST if there is none.
uint more_room(const Header header) {
    uint rooms = count_of_rooms(header);
    if (rooms == 0u) return NO_LIST;
    uint taken = atomicAdd(found[behind_cells(header) + CELL_COUNTER_ROOMS], 1u);
    return taken < rooms ? first_room(header) + taken * MORE_WORDS : NO_LIST;
}

// Returns the first word of the quarters of a cell, which are surveyed later; NO_LIST if there is no room for them.
uint divided(const Header header, uint cell) {
    uint divisions = count_of_divisions(header);
    if (divisions == 0u) return NO_LIST;
    uint taken = atomicAdd(found[behind_cells(header) + CELL_COUNTER_DIVISIONS], 1u);
    if (taken >= divisions) return NO_LIST;
    found[first_division(header) + taken] = cell;
    return first_quarter(header, taken);
}

// The word of a triangle in the list.
uint listed_at(const Survey survey, uint index) {
    uint place = survey.first + index;
    return place < LIST_ROOM ? survey.cell + CELL_HEAD + place : survey.more + place - LIST_ROOM;
}

// Adds a triangle to the list.
void add_to_list(const Header header, const CellRays cell, uint at, vec3 a, vec3 b, vec3 c, bool one_sided, inout Survey survey) {
    uint place = survey.first + survey.count;
    if (place == LIST_ROOM && survey.more == NO_LIST) survey.more = more_room(header);
    uint room = survey.more == NO_LIST ? LIST_ROOM : LIST_ROOM + MAX_MORE_LISTED;
    if (place < room) {
        found[listed_at(survey, survey.count)] = at;
        survey.count++;
    } else {
        // What is left out may be met from here on.
        survey.is_full = true;
        survey.depth = min(survey.depth, depth_in(header, cell, min(min(a, b), c), max(max(a, b), c)));
    }
    float farthest = 0.0;
    for (uint k = 0u; k < PROBES; k++) {
        vec3 o = cell.origins[k];
        survey.met[k] = min(survey.met[k], meets_at(a - o, b - o, c - o, cell.ways[k], one_sided));
        farthest = max(farthest, survey.met[k]);
    }
    survey.depth = min(survey.depth, farthest);
}

// True if rays of the cell may meet the triangle; those of a perspective camera are within a pyramid.
bool meets_cell(const Header header, const PixelFrustum frame, uint square, vec3 a, vec3 b, vec3 c) {
    if (is_parallel(header)) {
        Triangle triangle;
        triangle.a = a;
        triangle.b = b;
        triangle.c = c;
        return may_meet(header, frame, square, triangle);
    }
    vec3 x = 0.5 * frame.rays[0];
    vec3 y = 0.5 * frame.rays[1];
    vec3 way = frame.rays[2] + (x + y);
    EdgeForms edges = edge_forms_of(a, b, c, way, x, y, abs(way) + (abs(x) + abs(y)));
    vec3 aside = (abs(edges.along_x) + abs(edges.along_y)) + edges.slack;
    return all(greaterThanEqual(edges.here, -aside)) || all(lessThanEqual(edges.here, aside));
}

// Adds the triangles of all meshes but those that are leaves of the tree over all, which end the depth.
void survey_meshes(const Header header, const PixelFrustum frame, uint square, const CellRays cell, inout Survey survey) {
    uint waiting[TREE_STACK];
    float depths[TREE_STACK];
    uint height = 0u;
    uint reference = 0u;
    uint count = 0u;
    float near = 0.0;
    for (uint opened = 0u; opened < MAX_CELL_NODES; opened++) {
        if (count == 0u) {
            uint children[TREE_WIDTH];
            float nears[TREE_WIDTH];
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                uvec4 least = mesh_texel(reference + 2u * k);
                uvec4 greatest = mesh_texel(reference + 2u * k + 1u);
                children[k] = least.w | (greatest.w << TREE_COUNT_SHIFT);
                bool is_used = least.w != NO_SHAPE;
                nears[k] = is_used ? depth_in(header, cell, point_in(least), point_in(greatest)) : -1.0;
            }
            SORT_CHILDREN(float, nears, children)
            for (uint k = 0u; k < TREE_WIDTH; k++) {
                if (nears[k] >= 0.0 && nears[k] <= survey.depth) {
                    waiting[height] = children[k];
                    depths[height] = nears[k];
                    height++;
                }
            }
        } else if (count == TREE_MESH) {
            survey.depth = min(survey.depth, near);
        } else {
            for (uint k = 0u; k < count; k++) {
                uint at = reference + 3u * k;
                uvec4 first = mesh_texel(at);
                vec3 a = point_in(first);
                vec3 b = point_in(mesh_texel(at + 1u));
                vec3 c = point_in(mesh_texel(at + 2u));
                if (meets_cell(header, frame, square, a, b, c)) add_to_list(header, cell, at, a, b, c, first.w != 0u, survey);
            }
        }
        while (height > 0u && depths[height - 1u] > survey.depth) height--;
        if (height == 0u) return;
        height--;
        reference = waiting[height] & ((1u << TREE_COUNT_SHIFT) - 1u);
        count = waiting[height] >> TREE_COUNT_SHIFT;
        near = depths[height];
        // The node that would be opened next is left out if it is one too many, with all that wait.
        if (opened + 1u == MAX_CELL_NODES) survey.depth = min(survey.depth, depths[height]);
    }
    for (uint k = 0u; k < height; k++) survey.depth = min(survey.depth, depths[k]);
}

// Marks for each part of the cell the triangles of its list that the part's rays may meet; all for parallel rays. In a
// part, rays are those through its middle and as much to either side as `radius` steps, in which edge functions are affine.
void mark_parts(const Header header, uvec2 pixel, const Survey survey) {
    uint masks = survey.cell + CELL_MASKS;
    float side = float(header.cell_side / CELL_PARTS);
    float radius = header.filter_radius + 0.5 * (side - 1.0);
    vec2 place = (vec2(pixel) - 0.5 * vec2(header.image_size)) + 0.5 * side;
    vec3 way = (place.x * header.step_x + place.y * header.step_y) + header.forward;
    vec3 x = side * header.step_x;
    vec3 y = side * header.step_y;
    vec3 size = abs(way) + (4.0 + radius) * (abs(x) + abs(y));
    uint words = survey.more == NO_LIST ? CELL_MASK_WORDS : CELL_MASK_WORDS + MORE_MASK_WORDS;
    for (uint word = 0u; word < words; word++) {
        uint marks[CELL_PARTS * CELL_PARTS];
        for (uint part = 0u; part < CELL_PARTS * CELL_PARTS; part++) marks[part] = 0u;
        uint end = min(survey.count, 32u * word + 32u);
        for (uint k = 32u * word; k < end; k++) {
            uint at = found[listed_at(survey, k)];
            vec3 a = point_in(mesh_texel(at));
            vec3 b = point_in(mesh_texel(at + 1u));
            vec3 c = point_in(mesh_texel(at + 2u));
            EdgeForms edges = edge_forms_of(a, b, c, way, x, y, size);
            vec3 aside = (radius / side) * (abs(edges.along_x) + abs(edges.along_y)) + edges.slack;
            vec3 least = edges.here - aside;
            uint bit = 1u << (k & 31u);
            for (uint part = 0u; part < CELL_PARTS * CELL_PARTS; part++) {
                vec3 low = (least + float(part % CELL_PARTS) * edges.along_x) + float(part / CELL_PARTS) * edges.along_y;
                vec3 high = low + 2.0 * aside;
                bool is_met = min(min(high.x, high.y), high.z) >= 0.0 || max(max(low.x, low.y), low.z) <= 0.0;
                marks[part] |= is_met || is_parallel(header) ? bit : 0u;
            }
        }
        bool in_cell = word < CELL_MASK_WORDS;
        uint first = in_cell ? masks + word : survey.more + MAX_MORE_LISTED + word - CELL_MASK_WORDS;
        uint stride = in_cell ? CELL_MASK_WORDS : MORE_MASK_WORDS;
        for (uint part = 0u; part < CELL_PARTS * CELL_PARTS; part++) found[first + part * stride] = marks[part];
    }
}

#endif
