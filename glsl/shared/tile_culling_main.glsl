// One thread a cell of pixels: the triangles that its camera rays may meet, and how calm it is: EMPTY with
// nothing but the background, CALM where one shape alone fills it and its colour changes little from texel to
// pixel, BUSY else. found[cell] = number, calmness, triangles. Twin: src/oracle/tile_culling.rs.
#ifndef TILE_CULLING_MAIN_GLSL
#define TILE_CULLING_MAIN_GLSL

#include "features.glsl"
#include "bsdf/models.glsl"
#include "projective.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = 0) writeonly buffer Found { uint found[]; };

layout(push_constant) uniform Part {
    uint first; // cell
    uint end;
} part;

// Pixels around a cell, against rounding.
const float MARGIN = 0.0625;
// Of edge functions in f32, relative to the lengths of their vectors: 32 ulps.
const float ROUNDING = 4e-6;
const uint SQUARE = 0u; // the polygon of the cell

// A ray meets a triangle where all three edge functions have one sign (intersect.glsl). These are affine in the
// ray's place, so that their corners' extremes bound them.
bool may_meet_triangle(Header header, PixelFrustum frame, Triangle triangle) {
    vec3 ahead = vec3(dot3(triangle.a.xyz, header.forward.xyz), dot3(triangle.b.xyz, header.forward.xyz),
                      dot3(triangle.c.xyz, header.forward.xyz));
    if (max(max(ahead.x, ahead.y), ahead.z) <= 0.0) return false;
    vec3 least = vec3(3e38);
    vec3 most = vec3(-3e38);
    for (uint k = 0u; k < 4u; k++) {
        vec3 way;
        vec3 origin;
        ray_at(header, frame, corner(SQUARE, k), way, origin);
        vec3 a = triangle.a.xyz - origin;
        vec3 b = triangle.b.xyz - origin;
        vec3 c = triangle.c.xyz - origin;
        vec3 edges = vec3(dot3(way, cross3(b, c)), dot3(way, cross3(c, a)), dot3(way, cross3(a, b)));
        vec3 squares = vec3(dot3(a, a), dot3(b, b), dot3(c, c));
        vec3 slack = ROUNDING * sqrt(dot3(way, way)) * sqrt(squares.yzx) * sqrt(squares.zxy);
        least = min(least, edges - slack);
        most = max(most, edges + slack);
    }
    bool front = most.x >= 0.0 && most.y >= 0.0 && most.z >= 0.0;
    bool back = least.x <= 0.0 && least.y <= 0.0 && least.z <= 0.0;
    return front || back;
}

// Texels that a pixel spans at most, at the cell's corners.
float texels_across(Header header, PixelFrustum frame, uint shape, UvProjection map, Texture image) {
    RationalMap q = coordinates(header, frame, shape, map, nearness_of(header, frame, shape));
    float most = 0.0;
    for (uint k = 0u; k < 4u; k++) {
        vec2 place = corner(SQUARE, k);
        float under = at(q.below, place);
        vec2 du = (q.u.xy * under - at(q.u, place) * q.below.xy) / (under * under);
        vec2 dv = (q.v.xy * under - at(q.v, place) * q.below.xy) / (under * under);
        vec2 size = vec2(image.place.yz);
        float span = max(max(abs(du.x), abs(du.y)) * size.x, max(abs(dv.x), abs(dv.y)) * size.y);
        most = max(most, span);
    }
    return most / float(header.chances.w);
}

// Whether one shape, with all lines of its region around the cell, shows a colour that changes little.
bool is_calm(Header header, PixelFrustum frame, uint shape, ConvexRegion region) {
    for (uint k = 0u; k < region.count; k++) {
        if (range(SQUARE, region.lines[k]).x <= 0.0) return false;
    }
    uvec2 link = shape_links(header, shape);
    Material record = material_at(link.x);
    bool unlit = !is_lit(record) && !is_specular(record);
    bool plain = is_diffuse(record) && !SHADOWS;
    if (!unlit && !plain) return false;
    if (BUMPED && record.detail.x != NO_TEXTURE) return false;
    if (!TEXTURED || record.link.y == NO_TEXTURE) return true;
    UvProjection map = map_at(link.y);
    bool affine = MODE_IS(MAPPINGS, MAP_PLANE, map.link.x) || MODE_IS(MAPPINGS, MAP_AFFINE, map.link.x) ||
                  MODE_IS(MAPPINGS, MAP_VERTEX_UV, map.link.x);
    Texture image = texture_at(record.link.y);
    if (!affine || !MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_FLAT, image.link.w)) return false;
    return texels_across(header, frame, shape, map, image) <= 1.0;
}

void main() {
    Header header = load_header();
    preload_records();
    uint cell = part.first + gl_WorkGroupID.x * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
    if (cell >= part.end) return;
    uint side = header.chances.w;
    uint across = (header.size.x + side - 1u) / side;
    uvec2 pixel = uvec2(cell % across, cell / across) * side + header.image.zw;
    PixelFrustum frame = frame_over(header, pixel, float(side - 1u), MARGIN);
    unit_square(SQUARE);
    uint planes = COUNT(PLANES, header.counts.x);
    uint before_triangles = planes + COUNT(SPHERES, header.counts.y);
    uint triangles = COUNT(TRIANGLES, header.counts.z);
    uint seen = 0u;
    uint alone = 0u;
    for (uint i = 0u; i < planes; i++) {
        ConvexRegion region = shape_region(header, frame, i);
        bool met = true;
        for (uint k = 0u; k < region.count; k++) met = met && range(SQUARE, region.lines[k]).y > 0.0;
        alone = met ? i : alone;
        seen += met ? 1u : 0u;
    }
    bool round = false;
    for (uint i = planes; i < before_triangles; i++) {
        round = round || may_meet_sphere(header, frame, SQUARE, sphere_at(i - planes));
    }
    uint begin = cell * CELL_WORDS;
    uint listed = 0u;
    for (uint i = 0u; i < triangles; i++) {
        if (may_meet_triangle(header, frame, triangle_at(i))) {
            if (listed < MAX_LISTED) found[begin + 2u + listed] = i;
            alone = before_triangles + i;
            listed++;
        }
    }
    seen += listed;
    bool empty = seen == 0u && !round && !(ENVIRONMENT && header.counts.w != NO_MATERIAL);
    uint calmness = empty ? CELL_EMPTY : CELL_BUSY;
    if (seen == 1u && !round) {
        if (is_calm(header, frame, alone, shape_region(header, frame, alone))) calmness = CELL_UNIFORM;
    }
    found[begin] = listed;
    found[begin + 1u] = calmness;
}

#endif
