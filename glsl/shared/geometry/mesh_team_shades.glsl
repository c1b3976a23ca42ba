// What may shade the pixels of a workgroup that samples them together, from a directional light: its threads find which
// shades of their cells are above each pixel.
#ifndef MESH_TEAM_SHADES_GLSL
#define MESH_TEAM_SHADES_GLSL

#include "mesh_shades.glsl"

// The region of each pixel.
shared vec3 team_least[TEAM];
shared vec3 team_greatest[TEAM];
shared float team_reach[TEAM];

void load_region(uint member) {
    shade_region = ShadeRegion(team_least[member], team_greatest[member], team_reach[member]);
}

// The triangles of a cell's list that a triangle may shade.
Candidates shaded_by(vec3 a, vec3 b, vec3 c, uint list, uint first) {
    Candidates shaded = ANYTHING;
    shaded.list = list;
    uint seen = tile_lists[list + 2u];
    bool is_tested = seen * count_of_shades(first) <= MAX_SHADE_PAIRS;
    float reach = uintBitsToFloat(tile_lists[first + SHADES_REACH]);
    for (uint k = 0u; k < seen; k++) {
        bool is_lit = is_tested && leaves_lit(a, b, c, receiver_at(listed_texel(shaded, k)), reach);
        mark(shaded, k, !is_lit);
    }
    return shaded;
}

// Lists what may shade each pixel, with a shade of the cell by each thread.
void share_shades(const Header header, uint thread) {
    for (uint corner = 0u; corner < TEAM_WIDTH; corner += header.cell_side) {
        uint list = team_lists[corner];
        uint first = list == NO_LIST ? NO_LIST : cell_shades(list);
        uint count = count_of_shades(first);
        for (uint index = thread; index < count; index += TEAM) {
            uint texel = tile_lists[first + SHADES_HEAD + index];
            vec3 a = point_in(mesh_texel(texel));
            vec3 b = point_in(mesh_texel(texel + 1u));
            vec3 c = point_in(mesh_texel(texel + 2u));
            Candidates shaded = shaded_by(a, b, c, list, first);
            a = in_frame(a);
            b = in_frame(b);
            c = in_frame(c);
            for (uint member = 0u; member < TEAM; member++) {
                bool is_met = team_lists[member] == list && ((team_marks[member] & shaded.meshes) | (team_more[member] & shaded.more)) != uvec4(0u);
                load_region(member);
                if (!is_met || !is_above(shade_region, a, b, c)) continue;
                uint place = atomicAdd(team_shade_counts[member], 1u);
                if (place < TEAM_SHADES) team_shades[place * TEAM + member] = texel;
                else team_left_out[member] = 1u;
            }
        }
    }
}

// Finds what may shade each pixel, of which the thread's own has these listed triangles.
void gather_shades_for_team(const Header header, uvec2 pixel, uint member, const Candidates marked) {
    receive_all(header, pixel, marked);
    bool is_known = true;
    if (!is_empty(shade_region)) {
        uint first = cell_shades(marked.list);
        is_known = first != NO_LIST;
        cut_to_cell(first);
    }
    team_least[member] = shade_region.least;
    team_greatest[member] = shade_region.greatest;
    team_reach[member] = shade_region.reach;
    team_shade_counts[member] = 0u;
    barrier();
    share_shades(header, member);
    if (!is_known) team_left_out[member] = 1u;
}

#endif
