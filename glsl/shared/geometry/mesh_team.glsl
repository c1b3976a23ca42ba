// The listed triangles that a workgroup holds in its shared memory: bits for those of each of its pixels, found by a thread a
// pixel, and a few of the pixels that it samples at once with their edge functions, each set up by one thread.
#ifndef MESH_TEAM_GLSL
#define MESH_TEAM_GLSL

#include "mesh_lists.glsl"

// Threads of the workgroup, as many as pixels.
const uint TEAM = TEAM_WIDTH * TEAM_HEIGHT;
// Samples of a pixel that are taken at once, each by a thread; and triangles of a pixel that are held at once.
const uint TEAM_SAMPLES = TEAM_SQUARES;
// Triangles that may shade a pixel. Pixels with more are left unfinished.
const uint TEAM_SHADES = 12u;

// The listed triangles of each pixel.
shared uvec4 team_marks[TEAM];
shared uvec4 team_more[TEAM];
shared uint team_counts[TEAM];
shared uint team_lists[TEAM];
shared uint team_shades[TEAM_SHADES * TEAM];
shared uint team_shade_counts[TEAM];
shared uint team_left_out[TEAM]; // 1 for a pixel that the pass does not sample
uint team_member = 0u;           // the number of the pixel that the thread samples

// What is held of a triangle, by the thread that set it up.
shared real4 held_a[TEAM]; // corner and a component of the first edge function
shared real4 held_b[TEAM];
shared real4 held_c[TEAM];
shared real4 held_across[TEAM];
shared real2 held_last[TEAM];
shared uint held_texels[TEAM];

const uint HELD_ONE_SIDED = 0x80000000u;

// Pixels of a square along a side.
const uint TEAM_SIDE = 2u;

// The first pixel of a square.
uvec2 place_of_square(uint square) {
    uint across = TEAM_WIDTH / TEAM_SIDE;
    return TEAM_SIDE * uvec2(square % across, square / across);
}

// Finds the listed triangles that rays of a pixel may meet; `member` is the number of the thread.
void gather_for_team(const Header header, uvec2 pixel, uint member, inout Candidates candidates) {
    bool is_listed = candidates.list != NO_LIST;
    if (is_listed) test_in_pixel(header, pixel, candidates);
    team_lists[member] = candidates.list;
    team_marks[member] = candidates.meshes;
    team_more[member] = candidates.more;
    ivec4 counts = bitCount(candidates.meshes) + bitCount(candidates.more);
    team_counts[member] = uint((counts.x + counts.y) + (counts.z + counts.w));
    team_left_out[member] = is_listed ? 0u : 1u;
}

// Returns the place of bit `index` among those that are set, of 32 times as many as words.
uint marked_at(uvec4 marks, uvec4 more, uint index) {
    uint word = 0u;
    uint first = 0u;
    uint before = 0u;
    uint skipped = 0u; // bits of the word before it
    for (uint k = 0u; k < 8u; k++) {
        uint bits = k < 4u ? marks[k] : more[k - 4u];
        uint count = uint(bitCount(bits));
        bool is_here = index >= before && index < before + count;
        word = is_here ? bits : word;
        first = is_here ? 32u * k : first;
        skipped = is_here ? index - before : skipped;
        before += count;
    }
    for (uint k = 0u; k < skipped; k++) word &= word - 1u;
    return first + uint(findLSB(word));
}

// Holds triangle `index` of a pixel, whose list this is, for its threads.
void hold_for_team(uint list, uint member, uint index, uint thread) {
    if (index >= team_counts[member]) return;
    Candidates candidates = ANYTHING;
    candidates.list = list;
    Held triangle = held_triangle(listed_texel(candidates, marked_at(team_marks[member], team_more[member], index)));
    held_a[thread] = real4(triangle.a, triangle.across_a.x);
    held_b[thread] = real4(triangle.b, triangle.across_a.y);
    held_c[thread] = real4(triangle.c, triangle.across_a.z);
    held_across[thread] = real4(triangle.across_b, triangle.across_c.x);
    held_last[thread] = triangle.across_c.yz;
    held_texels[thread] = triangle.at | (triangle.one_sided ? HELD_ONE_SIDED : 0u);
}

Held held_of_team(uint thread) {
    real4 a = held_a[thread];
    real4 b = held_b[thread];
    real4 c = held_c[thread];
    real4 across = held_across[thread];
    uint at = held_texels[thread];
    return Held(at & ~HELD_ONE_SIDED, a.xyz, b.xyz, c.xyz, real3(a.w, b.w, c.w), across.xyz, real3(across.w, held_last[thread]),
                (at & HELD_ONE_SIDED) != 0u);
}

// Finds what a ray of a pixel meets of the triangles that its threads hold: `count` from thread `first` on.
void find_for_team(real3 way, uint first, uint count) {
    for (uint k = 0u; k < count; k++) {
        Held triangle = held_of_team(first + k);
        NEARER(team_nearest, team_found, distance_to_held(triangle, way), triangle.at)
    }
}

#endif
