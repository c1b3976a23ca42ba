// What sampling to a goal keeps of each pixel between passes, and of the whole picture. Filled by the host: the number of the
// first samples, what beams resolved, what an audit found. Read by the host: a few words of `totals` after each goal.
// Twin: src/integrators/adaptive/host_pixels.rs.
#ifndef GOAL_STATE_GLSL
#define GOAL_STATE_GLSL

#include "schema/numbers.glsl"
#include "schema/blocks.glsl"
#include "../shared/opaque.glsl"

layout(local_size_x = GOAL_THREADS, local_size_y = 1, local_size_z = 1) in;

// Sums of the first halves of all pixels, then of the second ones: red, green, blue, and the mean of their squares.
layout(std430, set = 0, binding = BINDING_OUTPUT) buffer Film { vec4 film[]; };
layout(std430, set = 0, binding = BINDING_LIST) writeonly buffer Batches { PixelBatch batches[]; };
// One array of all pixels after the other: GOAL_COUNTS and so on.
layout(std430, set = 0, binding = BINDING_GOAL_PIXELS) buffer Pixels { uint pixel_words[]; };
layout(std430, set = 0, binding = BINDING_GOAL_TOTALS) buffer Totals { uint totals[]; };
// Red, green, blue, and 1 where samples are needed.
layout(std430, set = 0, binding = BINDING_GOAL_RESOLVED) readonly buffer Resolved { vec4 resolved[]; };

layout(std430, set = 0, binding = BINDING_GOAL_PARTS) writeonly buffer Parts { PixelBatch parts[]; };
layout(std430, set = 0, binding = BINDING_GOAL_PART_SUMS) readonly buffer PartSums { vec4 part_sums[]; };

layout(push_constant) uniform Push { GoalStep goal; };

const float NOT_VISITED = -1.0;

// For sums over a workgroup, and lists of its own.
shared vec4 lanes[2u * GOAL_THREADS];
shared uint counters[3u * GOAL_BINS];

uint number_of_group() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

uint number_of_thread() { return number_of_group() * GOAL_THREADS + gl_LocalInvocationIndex; }

uint pixel_count() { return OPAQUE(goal.width) * goal.height; }

uint at(uint array, uint pixel) { return array * pixel_count() + pixel; }

uint word_of(uint array, uint pixel) { return pixel_words[at(array, pixel)]; }

float real_of(uint array, uint pixel) { return uintBitsToFloat(word_of(array, pixel)); }

void keep_real(uint array, uint pixel, float value) { pixel_words[at(array, pixel)] = floatBitsToUint(value); }

uint octave(uint count) { return min(uint(findMSB(max(count, 1u))), COUNT_OCTAVES - 1u); }

// The mean over the channels.
float square(vec3 v) { return dot(v, v) * (1.0 / 3.0); }

// Where visits of the pass before are kept, and those of the next one.
uint visits(bool next) { return GOAL_VISITED + (((OPAQUE(goal.pass) & 1u) != 0u) == next ? 0u : 1u); }

// Sums of two vectors over all threads of the workgroup.
void sum_lanes(inout vec4 a, inout vec4 b) {
    uint lane = gl_LocalInvocationIndex;
    barrier();
    lanes[lane] = a;
    lanes[GOAL_THREADS + lane] = b;
    barrier();
    for (uint side = GOAL_THREADS / 2u; side > 0u; side /= 2u) {
        if (lane < side) {
            lanes[lane] += lanes[lane + side];
            lanes[GOAL_THREADS + lane] += lanes[GOAL_THREADS + lane + side];
        }
        barrier();
    }
    a = lanes[0];
    b = lanes[GOAL_THREADS];
}

#endif
