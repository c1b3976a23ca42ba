// The pixels of an audit: expected draws in parts of DRAW_UNIT, summed over cells of the picture and octaves of counts, and
// pixels at equal steps along the whole. Twin: src/integrators/adaptive/draws.rs, which says why.
#ifndef GOAL_DRAWS_GLSL
#define GOAL_DRAWS_GLSL

#include "batches.glsl"

const uint CELLS = DRAW_CELLS * DRAW_CELLS;

// The samples of each of the two means.
uint wanted_samples(uint count) { return clamp(2u * count, DRAW_MIN_SAMPLES, MAX_HALF_SAMPLES); }

// The samples of a draw.
float samples_of(uint count) { return 2.0 * float(wanted_samples(count)); }

// Sums of the variances times a factor, or 1 where that is less, for several factors.
void sum_capped() {
    uint parts = OPAQUE(goal.parts);
    uint group = number_of_group();
    if (group >= parts) return;
    vec4 low = vec4(0.0);
    vec4 high = vec4(0.0);
    float factor = uintBitsToFloat(goal.of_variance);
    for (uint k = 0u; k < GOAL_PART_SIDE * GOAL_PART_SIDE / GOAL_THREADS; k++) {
        uint pixel = (group + k * parts) * GOAL_THREADS + gl_LocalInvocationIndex;
        if (pixel >= pixel_count()) continue;
        float draws = factor * real_of(GOAL_VARIANCES, pixel);
        low += min(draws * vec4(1.0, 4.0, 16.0, 64.0), 1.0);
        high += min(draws * vec4(256.0, 1024.0, 4096.0, 16384.0), 1.0);
    }
    sum_lanes(low, high);
    if (gl_LocalInvocationIndex > 0u) return;
    for (uint k = 0u; k < 4u; k++) {
        totals[GOAL_PARTIALS + k * parts + group] = floatBitsToUint(low[k]);
        totals[GOAL_PARTIALS + (4u + k) * parts + group] = floatBitsToUint(high[k]);
    }
}

// The expected draws of a pixel: from one part to one draw.
uint parts_of(uint pixel) {
    float even = uintBitsToFloat(OPAQUE(goal.even));
    float draws = even / samples_of(word_of(GOAL_COUNTS, pixel)) + uintBitsToFloat(goal.of_variance) * real_of(GOAL_VARIANCES, pixel);
    return max(uint(min(draws, 1.0) * float(DRAW_UNIT) + 0.5), 1u);
}

// Returns the first pixel's place and the size of a cell. Cells follow a boustrophedon path.
uvec4 cell_rectangle(uint cell) {
    uint row = cell / DRAW_CELLS;
    uint along = cell % DRAW_CELLS;
    uint column = row % 2u == 0u ? along : DRAW_CELLS - 1u - along;
    uvec2 size = uvec2(goal.width, goal.height);
    uvec2 first = uvec2(column, row) * size / DRAW_CELLS;
    return uvec4(first, (uvec2(column, row) + 1u) * size / DRAW_CELLS - first);
}

uint pixel_of_cell(uvec4 cell, uint k) { return (cell.y + k / cell.z) * goal.width + cell.x + k % cell.z; }

// One cell in a workgroup.
void weigh_cells() {
    uint cell = number_of_group();
    uint lane = gl_LocalInvocationIndex;
    if (cell >= CELLS) return;
    if (lane < COUNT_OCTAVES) counters[lane] = 0u;
    barrier();
    uvec4 rectangle = cell_rectangle(cell);
    uint pixels = rectangle.z * rectangle.w;
    for (uint k = lane; k < pixels; k += GOAL_THREADS) {
        uint pixel = pixel_of_cell(rectangle, k);
        atomicAdd(counters[octave(word_of(GOAL_COUNTS, pixel))], parts_of(pixel));
    }
    barrier();
    if (lane < COUNT_OCTAVES) totals[GOAL_MASSES + lane * CELLS + cell] = counters[lane];
}

// Sums up to each octave of each cell, in one workgroup.
void sum_masses() {
    const uint A_THREAD = COUNT_OCTAVES * CELLS / GOAL_THREADS;
    uint lane = gl_LocalInvocationIndex;
    uint own = 0u;
    for (uint k = 0u; k < A_THREAD; k++) own += totals[GOAL_MASSES + lane * A_THREAD + k];
    counters[lane] = own;
    barrier();
    for (uint reach = 1u; reach < GOAL_THREADS; reach *= 2u) {
        uint more = lane >= reach ? counters[lane - reach] : 0u;
        barrier();
        counters[lane] += more;
        barrier();
    }
    if (lane == 0u) {
        totals[GOAL_PART_COUNT] = 0u;
        totals[GOAL_DRAW_COST] = 0u;
    }
    uint sum = counters[lane] - own;
    for (uint k = 0u; k < A_THREAD; k++) {
        sum += totals[GOAL_MASSES + lane * A_THREAD + k];
        totals[GOAL_MASSES + lane * A_THREAD + k] = sum;
    }
}

// One draw in a thread: its cell and octave, and then the pixel in it.
void draw_pixels() {
    uint draw = number_of_thread();
    const uint LAST = COUNT_OCTAVES * CELLS - 1u;
    uint all = totals[GOAL_MASSES + LAST];
    uint start = OPAQUE(goal.start);
    uint count = all > start ? min((all - start - 1u) / DRAW_UNIT + 1u, MAX_GOAL_DRAWS) : 0u;
    if (draw == 0u) totals[GOAL_DRAWN] = count;
    if (draw >= count) return;
    uint wanted = start + draw * DRAW_UNIT;
    uint low = 0u;
    uint high = LAST;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (totals[GOAL_MASSES + middle] > wanted) high = middle;
        else low = middle + 1u;
    }
    uint sum = low > 0u ? totals[GOAL_MASSES + low - 1u] : 0u;
    uvec4 rectangle = cell_rectangle(low % CELLS);
    uint pixel = 0u;
    uint parts = 0u;
    for (uint k = 0u; k < rectangle.z * rectangle.w; k++) {
        pixel = pixel_of_cell(rectangle, k);
        if (octave(word_of(GOAL_COUNTS, pixel)) != low / CELLS) continue;
        parts = parts_of(pixel);
        sum += parts;
        if (sum > wanted) break;
    }
    uint at = GOAL_DRAWS + draw * GOAL_DRAW_WORDS;
    bool by_beams = false;
    if (OPAQUE(goal.resolves) != 0u) by_beams = resolved[pixel].w == 0.0;
    atomicAdd(totals[GOAL_DRAW_COST], 2u * wanted_samples(word_of(GOAL_COUNTS, pixel)));
    totals[at] = pixel;
    totals[at + 1u] = word_of(GOAL_COUNTS, pixel);
    totals[at + 2u] = parts;
    totals[at + 3u] = by_beams ? 1u : 0u;
    for (uint c = 0u; c < 4u; c++) {
        totals[at + 4u + c] = floatBitsToUint(film[pixel][c]);
        totals[at + 8u + c] = floatBitsToUint(film[pixel_count() + pixel][c]);
    }
}

// The parts of both means of each draw.
void draw_parts() {
    uint draw = number_of_thread();
    if (draw >= totals[GOAL_DRAWN]) return;
    uint at = GOAL_DRAWS + draw * GOAL_DRAW_WORDS;
    float share = min(uintBitsToFloat(OPAQUE(goal.budget)) / float(totals[GOAL_DRAW_COST]), 1.0);
    uint samples = clamp(uint(float(wanted_samples(totals[at + 1u])) * share), 16u, MAX_HALF_SAMPLES);
    uint number = parts_of_half(samples);
    uint first = atomicAdd(totals[GOAL_PART_COUNT], 2u * number);
    totals[at + 12u] = samples;
    totals[at + 13u] = first;
    for (uint k = 0u; k < 2u * number; k++) {
        uint before = k % number * goal.part_samples;
        uint part = goal.batch_part + (k / number << BATCH_STREAM_SHIFT);
        parts[first + k] = PixelBatch(place_of(totals[at]), part, before, min(goal.part_samples, samples - before));
    }
}

void sum_draws() {
    uint draw = number_of_thread();
    if (draw >= totals[GOAL_DRAWN]) return;
    uint at = GOAL_DRAWS + draw * GOAL_DRAW_WORDS;
    uint number = parts_of_half(totals[at + 12u]);
    for (uint mean = 0u; mean < 2u; mean++) {
        vec4 sum = vec4(0.0);
        for (uint k = 0u; k < number; k++) sum += part_sums[totals[at + 13u] + mean * number + k];
        for (uint c = 0u; c < 4u; c++) totals[at + 16u + 4u * mean + c] = floatBitsToUint(sum[c]);
    }
}

#endif
