// Rays from a list, one thread per query. Output: the hit's distance, shape, point, normal and texture
// coordinate, and whether anything lies between the origin and t_max.
#define ORIGIN_IS_EYE false // these rays start anywhere
#include "schema/blocks.glsl"
#include "features.glsl"
#include "layout.glsl"
#include "shade.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

struct Query {
    real4 origin;    // w: time
    real4 direction; // w: t_max
};

struct Answer {
    real4 point;  // w: t
    real4 normal; // towards the ray
    real4 uv;
    uvec4 link;  // shape, 1 when occluded
};

layout(std430, set = 0, binding = BINDING_OUTPUT) writeonly buffer Answers { Answer answers[]; };
layout(std430, set = 0, binding = BINDING_LIST) readonly buffer Queries { Query queries[]; };
layout(push_constant) uniform Push { QueryRange range; };

void main() {
    preload_records();
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    Header header = load_header();
    Ray ray = Ray(queries[i].origin.xyz, queries[i].direction.xyz, float(queries[i].origin.w));
    Hit hit = nearest_hit(ray, NO_SHAPE, ANYTHING);
    bool blocked = occluded(ray, queries[i].direction.w, NO_SHAPE, real3(0.0));
    Answer answer = Answer(real4(0.0, 0.0, 0.0, FAR), real4(0.0), real4(0.0), uvec4(NO_SHAPE, uint(blocked), 0u, 0u));
    if (hit.shape != NO_SHAPE) {
        Surface surface = hit_surface(ray, hit);
        UvProjection map = uv_projection_at(surface.link.y);
        real2 uv = texture_coordinate(map, map_input(map, ray, surface, NO_FOOTPRINT)).at.xy;
        answer = Answer(real4(surface.point, hit.t), real4(surface.normal, 0.0), real4(uv, 0.0, 0.0),
                        uvec4(hit.shape, uint(blocked), 0u, 0u));
    }
    answers[i] = answer;
}
