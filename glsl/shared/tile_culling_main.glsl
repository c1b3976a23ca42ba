// One thread per cell of pixels: the shapes that its camera rays may meet, and its content: EMPTY for the
// background alone, UNIFORM for one shape that fills it and whose colour changes little from texel to pixel,
// BUSY otherwise, or DIVIDED if its quarters are to be surveyed. found[cell] = number, content, shapes. Twin: src/oracle/tile_culling.rs.
#ifndef TILE_CULLING_MAIN_GLSL
#define TILE_CULLING_MAIN_GLSL

#define SHAPES_IN_BEAMS
#define MESHES_IN_CELLS
#include "schema/blocks.glsl"
#include "features.glsl"
#include "bsdf/models.glsl"
#include "geometry/beams.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = BINDING_OUTPUT) buffer Found { uint found[]; };

#include "geometry/mesh_shade_survey.glsl"

layout(push_constant) uniform Push { CellRange part; };

// Margin in pixels around a cell, against rounding errors.
const float MARGIN = 0.0625;
const uint SQUARE = 0u; // the polygon of the cell

// Returns the most texels that a pixel spans, at the cell's corners.
float texels_across(const Header header, const PixelFrustum frame, uint shape, const UvProjection map, const Texture image) {
    RationalMap q = coordinates(header, frame, shape, map, nearness_of(header, frame, shape));
    float most = 0.0;
    for (uint k = 0u; k < 4u; k++) {
        vec2 place = corner(SQUARE, k);
        float under = at(q.below, place);
        vec2 du = (q.u.xy * under - at(q.u, place) * q.below.xy) / (under * under);
        vec2 dv = (q.v.xy * under - at(q.v, place) * q.below.xy) / (under * under);
        vec2 size = vec2(image.size.xy);
        float span = max(max(abs(du.x), abs(du.y)) * size.x, max(abs(dv.x), abs(dv.y)) * size.y);
        most = max(most, span);
    }
    return most / float(header.cell_side);
}

// Returns true if one shape, whose region contains the cell, has a colour that changes little.
bool is_uniform(const Header header, const PixelFrustum frame, uint shape, const ConvexRegion region) {
    for (uint k = 0u; k < region.count; k++) {
        if (range(SQUARE, region.lines[k]).x <= 0.0) return false;
    }
    uvec2 link = shape_links(shape);
    Material record = material_at(link.x);
    bool unlit = !is_lit(record.model) && !is_specular(record.model);
    bool plain = is_diffuse(record.model) && !SHADOWS;
    if (!unlit && !plain) return false;
    if (BUMPED && record.bump_texture_index != NO_TEXTURE) return false;
    if (!is_plain(record)) return false;
    if (!TEXTURED || record.texture_index == NO_TEXTURE) return true;
    UvProjection map = uv_projection_at(link.y);
    bool affine = MODE_IS(MAPPINGS, MAP_PLANE, map.kind) || MODE_IS(MAPPINGS, MAP_AFFINE, map.kind) ||
                  MODE_IS(MAPPINGS, MAP_VERTEX_UV, map.kind);
    Texture image = texture_at(record.texture_index);
    if (!affine || !MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_FLAT, image.kind)) return false;
    return texels_across(header, frame, shape, map, image) <= 1.0;
}

void main() {
    Header header = load_header();
    preload_records();
    uint thread = part.first + gl_WorkGroupID.x * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
    if (thread >= part.end) return;
    uint side = header.cell_side;
    uvec2 cells = (header.film_size + side - 1u) / side;
    bool is_quarter = CONCAVE_SHAPES && HOLDS_TRIANGLES && OPAQUE(part.quarters) != 0u;
    uint blocks = (cells.x + CELL_BLOCK_WIDTH - 1u) / CELL_BLOCK_WIDTH;
    uint across = blocks * CELL_BLOCK_WIDTH;
    uvec2 place = uvec2(thread % across, thread / across);
    if (HOLDS_TRIANGLES) {
        // Neighbours take about as long, which short subgroups gain by. Wide ones of nothing but long lists end late.
        uint block = thread / (CELL_BLOCK_WIDTH * CELL_BLOCK_HEIGHT);
        uvec2 in_block = uvec2(thread % CELL_BLOCK_WIDTH, thread / CELL_BLOCK_WIDTH % CELL_BLOCK_HEIGHT);
        place = uvec2(block % blocks * CELL_BLOCK_WIDTH, block / blocks * CELL_BLOCK_HEIGHT) + in_block;
    }
    uint quarter = thread % 4u;
    if (is_quarter) {
        if (thread / 4u >= count_of_divisions(header)) return;
        uint whole = found[first_division(header) + thread / 4u];
        place = uvec2(whole % cells.x, whole / cells.x);
    }
    if (place.x >= cells.x || place.y >= cells.y) return;
    uint cell = place.y * cells.x + place.x;
    uvec2 pixel = place * side + header.crop;
    uvec2 corner = pixel + (is_quarter ? uvec2(quarter % 2u, quarter / 2u) * (side / 2u) : uvec2(0u));
    PixelFrustum frame = frame_over(header, corner, float((is_quarter ? side / 2u : side) - 1u), MARGIN);
    unit_square(SQUARE);
    COUNT_SHAPES
    uint begin = is_quarter ? first_quarter(header, thread / 4u) + quarter * CELL_WORDS : cell * CELL_WORDS;
    uint seen = 0u;
    uint listed = 0u;
    uint alone = 0u;
    bool round = false;
#define SURVEY(Type, at, LIST, first, count, is_planar, is_polygonal, is_listed, is_concave)                            \
    for (uint i = 0u; i < count; i++) {                                               \
        if (!is_concave && may_meet(header, frame, SQUARE, at(i))) {                  \
            if (is_listed && listed < LIST_ROOM) found[begin + CELL_HEAD + listed] = (first) + i; \
            listed += is_listed ? 1u : 0u;                                            \
            seen += is_polygonal ? 1u : 0u;                                                \
            alone = is_polygonal ? (first) + i : alone;                                    \
            round = round || !is_polygonal;                                                \
        }                                                                             \
    }
    SHAPE_KINDS(SURVEY)
#undef SURVEY
    Survey survey = Survey(begin, 0u, NO_LIST, 0u, FAR, false, float[PROBES](FAR, FAR, FAR, FAR, FAR));
    if (CONCAVE_SHAPES) {
        CellRays cell_sides = cell_rays(header, frame);
        survey.first = min(listed, LIST_ROOM);
        survey_meshes(header, frame, SQUARE, cell_sides, survey);
        found[begin + CELL_MORE] = survey.more;
        if (HOLDS_TRIANGLES) mark_parts(header, pixel, survey);
        if (LISTS_SHADES) survey_shades(header, frame, survey);
        round = round || survey.count > 0u || survey.depth < FAR;
    }
    bool empty = seen == 0u && !round && !(ENVIRONMENT && header.environment_material != NO_MATERIAL);
    uint content = empty ? CELL_EMPTY : CELL_BUSY;
    if (seen == 1u && !round) {
        if (is_uniform(header, frame, alone, shape_region(header, frame, alone))) content = CELL_UNIFORM;
    }
    if (CONCAVE_SHAPES && HOLDS_TRIANGLES) {
        bool lacks_shades = false;
        if (LISTS_SHADES) lacks_shades = found[begin + CELL_SHADES] == NO_LIST;
        if (!is_quarter && (survey.is_full || lacks_shades)) {
            uint quarters = divided(header, cell);
            if (quarters != NO_LIST) {
                found[begin + CELL_MORE] = quarters;
                content = CELL_DIVIDED;
            }
        }
    }
    found[begin] = listed;
    found[begin + 1u] = content;
    found[begin + 2u] = survey.count;
    found[begin + 3u] = floatBitsToUint(survey.depth);
}

#endif
