// What may shade the pixels of a workgroup that samples them together, from a directional light: its threads search the tree
// for the triangles above all pixels, find those above each pixel, and keep what may shade it.
#ifndef MESH_TEAM_SHADES_GLSL
#define MESH_TEAM_SHADES_GLSL

#include "mesh_shades.glsl"

// Room for nodes that wait, from the first word on, with leaves, from the last word on; then for pairs of a pixel and a
// triangle. And for triangles above all pixels.
const uint TEAM_ROOM = 512u;
const uint TEAM_ABOVE = 384u;
const uint TEAM_NODES_AT_ONCE = TEAM / TREE_WIDTH;

shared uint team_room[TEAM_ROOM];
shared uint team_waiting;
shared uint team_leaves;
shared uint team_pairs;
shared uint team_above[TEAM_ABOVE];
shared uint team_above_count;
// The region of each pixel.
shared vec3 team_least[TEAM];
shared vec3 team_greatest[TEAM];
shared float team_reach[TEAM];

void load_region(uint member) {
    shade_least = team_least[member];
    shade_greatest = team_greatest[member];
    shade_reach = team_reach[member];
}

// Finds the leaves above the region of all pixels, a child of a node by each thread. Returns false if there are too many.
bool find_leaves(uint thread) {
    if (thread == 0u) {
        team_room[0] = 0u;
        team_waiting = 1u;
        team_leaves = 0u;
        team_above_count = 0u;
        team_pairs = 0u;
    }
    barrier();
    uint waiting = 1u;
    while (waiting > 0u && waiting + team_leaves + TEAM <= TEAM_ROOM) {
        uint taken = min(waiting, TEAM_NODES_AT_ONCE);
        uint turn = thread / TREE_WIDTH;
        uint at = turn < taken ? team_room[waiting - 1u - turn] + 2u * (thread % TREE_WIDTH) : NO_SHAPE;
        barrier();
        if (thread == 0u) team_waiting = waiting - taken;
        barrier();
        if (at != NO_SHAPE) {
            uvec4 least = mesh_texel(at);
            uvec4 greatest = mesh_texel(at + 1u);
            if (least.w != NO_SHAPE && !is_box_beside(point_in(least), point_in(greatest))) {
                if (greatest.w == 0u) team_room[atomicAdd(team_waiting, 1u)] = least.w;
                else team_room[TEAM_ROOM - 1u - atomicAdd(team_leaves, 1u)] = least.w | (greatest.w << TREE_COUNT_SHIFT);
            }
        }
        barrier();
        waiting = team_waiting;
    }
    return waiting == 0u;
}

// Finds the triangles of leaves that are above the region of all pixels. Returns false if there are too many.
bool find_above(uint thread) {
    uint leaves = team_leaves;
    for (uint first = 0u; first < leaves; first += TEAM_NODES_AT_ONCE) {
        uint index = first + thread / TREE_WIDTH;
        uint leaf = index < leaves ? team_room[TEAM_ROOM - 1u - index] : 0u;
        for (uint k = thread % TREE_WIDTH; k < leaf >> TREE_COUNT_SHIFT; k += TREE_WIDTH) {
            uint at = (leaf & ((1u << TREE_COUNT_SHIFT) - 1u)) + 3u * k;
            if (is_above(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)))) {
                uint place = atomicAdd(team_above_count, 1u);
                if (place < TEAM_ABOVE) team_above[place] = at;
            }
        }
    }
    barrier();
    return team_above_count <= TEAM_ABOVE;
}

// Finds the pairs of a pixel and a triangle above its region, with a triangle of those above all by each thread.
void find_pairs(uint thread) {
    uint count = min(team_above_count, TEAM_ABOVE);
    for (uint first = 0u; first < count; first += TEAM) {
        uint place = first + thread;
        uint at = team_above[min(place, count - 1u)];
        vec3 a = in_frame(point_in(mesh_texel(at)));
        vec3 b = in_frame(point_in(mesh_texel(at + 1u)));
        vec3 c = in_frame(point_in(mesh_texel(at + 2u)));
        for (uint member = 0u; member < TEAM; member++) {
            load_region(member);
            if (place < count && !is_region_empty() && is_above_in_frame(a, b, c)) {
                uint index = atomicAdd(team_pairs, 1u);
                if (index < TEAM_ROOM) team_room[index] = place | (member << 16u);
                else team_left_out[member] = 1u;
            }
        }
    }
    barrier();
}

// Keeps the triangles of pairs that may shade what the pixel sees.
void keep_shades(uint thread) {
    uint count = min(team_pairs, TEAM_ROOM);
    for (uint index = thread; index < count; index += TEAM) {
        uint member = team_room[index] >> 16u;
        uint at = team_above[team_room[index] & 0xFFFFu];
        load_region(member);
        Candidates marked = Candidates(team_lists[member], team_marks[member], team_more[member]);
        if (!leaves_all_lit(point_in(mesh_texel(at)), point_in(mesh_texel(at + 1u)), point_in(mesh_texel(at + 2u)), marked)) {
            uint place = atomicAdd(team_shade_counts[member], 1u);
            if (place < TEAM_SHADES) team_shades[place * TEAM + member] = at;
            else team_left_out[member] = 1u;
        }
    }
}

// Finds what may shade each pixel, of which the thread's own has these listed triangles.
void gather_shades_for_team(const Header header, uvec2 pixel, uint member, const Candidates marked) {
    bool is_sure = receive_all(header, pixel, marked);
    team_least[member] = shade_least;
    team_greatest[member] = shade_greatest;
    team_reach[member] = shade_reach;
    team_shade_counts[member] = 0u;
    barrier();
    for (uint k = 0u; k < TEAM; k++) {
        shade_least = min(shade_least, team_least[k]);
        shade_greatest = max(shade_greatest, team_greatest[k]);
        shade_reach = max(shade_reach, team_reach[k]);
    }
    if (!is_region_empty()) {
        bool is_complete = find_leaves(member);
        if (is_complete) is_complete = find_above(member);
        if (is_complete) {
            find_pairs(member);
            keep_shades(member);
        }
        is_sure = is_sure && is_complete;
    }
    if (!is_sure) team_left_out[member] = 1u;
}

#endif
