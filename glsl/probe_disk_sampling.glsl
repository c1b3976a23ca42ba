// Sampling mappings from a list: one thread per query, the image of a point of the unit square.
#include "schema/blocks.glsl"
#include "shared/features.glsl"
#include "shared/layout.glsl"
#include "shared/bsdf/facets.glsl"
#include "shared/rectangle.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    vec4 square;    // z: height of the cap; w: alpha
    vec4 direction; // of the ray that meets a facet
    vec4 normal;    // w: height of the point above the rectangle's plane
    vec4 rectangle; // its centre as seen from the point, half of its edges
};

// Results on the disc; on the cap; the facet's normal, with the reflected share in w; on the rectangle, with
// its solid angle in w.
struct Answer {
    vec4 disc;
    vec4 cap;
    vec4 facet;
    vec4 rectangle;
};

layout(std430, set = 0, binding = BINDING_OUTPUT) writeonly buffer Answers { Answer answers[]; };
layout(std430, set = 0, binding = BINDING_LIST) readonly buffer Queries { Query queries[]; };
layout(push_constant) uniform Push { QueryRange range; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    vec4 square = queries[i].square;
    vec2 disc = concentric_disc(square.xy);
    vec3 direction = queries[i].direction.xyz;
    vec3 n = queries[i].normal.xyz;
    vec4 sides = queries[i].rectangle;
    vec4 rectangle = on_rectangle(sides.xy, sides.zw, queries[i].normal.w, square.xy);
    vec3 facet = visible_normal(direction, n, square.w, square.xy);
    float share = smith_g2_over_g1(-dot3(direction, n), dot3(mirrored(direction, facet), n), square.w);
    answers[i] = Answer(vec4(disc, 0.0, 0.0), vec4(on_cap(disc, square.z), 0.0), vec4(facet, share), rectangle);
}
