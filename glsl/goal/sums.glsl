// One number for all parts of the picture, from one for each: a workgroup for each column of partial results. And the means
// of all pixels.
#ifndef GOAL_SUMS_GLSL
#define GOAL_SUMS_GLSL

#include "statistics.glsl"

void sum_partials() {
    uint column = number_of_group();
    if (column >= GOAL_COLUMNS) return;
    uint parts = OPAQUE(goal.parts);
    uint lane = gl_LocalInvocationIndex;
    bool is_real = column < goal.count;
    bool is_largest = column == GOAL_MOST || column == GOAL_LEAST;
    vec4 sum = vec4(0.0);
    if (lane == 0u) counters[0] = 0u;
    barrier();
    for (uint part = lane; part < parts; part += GOAL_THREADS) {
        uint bits = totals[GOAL_PARTIALS + column * parts + part];
        if (is_real) sum.x += uintBitsToFloat(bits);
        else if (is_largest) atomicMax(counters[0], bits);
        else atomicAdd(counters[0], bits);
    }
    vec4 unused = vec4(0.0);
    sum_lanes(sum, unused);
    if (lane == 0u) totals[column] = is_real ? floatBitsToUint(sum.x) : counters[0];
}

// Returns (a + b) / n, rounded as if it were exact before (Knuth's sum and its remainder).
float mean_of(float a, float b, float n) {
    float sum = a + b;
    float from_b = sum - a;
    float lost = (a - (sum - from_b)) + (b - from_b);
    float mean = sum / n;
    return mean + (fma(-mean, n, sum) + lost) / n;
}

// Red, green and blue of each pixel, in the place of what later steps do not need.
void find_means() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    vec3 a = film[pixel].xyz;
    vec3 b = film[pixel_count() + pixel].xyz;
    float n = float(2u * word_of(GOAL_COUNTS, pixel));
    uint first = GOAL_PAIRS * pixel_count() + 3u * pixel;
    for (uint c = 0u; c < 3u; c++) {
        float mean = mean_of(a[c], b[c], n);
        // What is infinite has no remainder.
        if (no_number(mean)) mean = (a[c] + b[c]) / n;
        pixel_words[first + c] = floatBitsToUint(mean);
    }
}

#endif
