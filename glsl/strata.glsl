// Writes sample positions: one thread per (pixel, sample); 24-bit integers, as the renderer uses them.
#include "schema/blocks.glsl"
#include "shared/features.glsl"
#include "shared/layout.glsl"
#include "shared/patterns.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

layout(std430, set = 0, binding = BINDING_OUTPUT) writeonly buffer Positions { uvec2 positions[]; };
layout(push_constant) uniform Push { PositionRange range; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= range.count) return;
    Header header = load_header();
    uint place = i / range.samples;
    uvec2 pixel = uvec2(place % range.width, place / range.width);
    uvec2 key = pixel_key(pixel, header.seed, header.shares_pattern);
    Points points = pair_points(pixel_points(header, pixel, key), range.pair);
    positions[i] = sample_pair(points, range.first_sample + i % range.samples, false);
}
