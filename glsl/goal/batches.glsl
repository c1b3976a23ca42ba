// Lists of batches: of pixels that gain few samples one for each half, of those that gain many several, whose sums are added
// afterwards. Twin: src/integrators/adaptive/host_pixels.rs.
#ifndef GOAL_BATCHES_GLSL
#define GOAL_BATCHES_GLSL

#include "state.glsl"

// Returns the class of a batch by its length: two for each octave.
uint class_of(uint count) {
    uint octave = uint(findMSB(count));
    return 2u * octave + (octave > 0u ? (count >> (octave - 1u)) & 1u : 0u);
}

bool is_long(uint more) { return more > 0u && class_of(more) >= GOAL_LONG_CLASS; }

uint place_of(uint pixel) { return (pixel / goal.width) << 16u | pixel % goal.width; }

// Lists a batch for each half of the pixels that gain few samples, longest first, so that neighbouring threads have nearly equal
// amounts of work.
void list_batches() {
    uint lane = gl_LocalInvocationIndex;
    uint pixel = number_of_thread();
    if (lane < GOAL_LONG_CLASS) counters[lane] = 0u;
    barrier();
    uint count = 0u;
    uint more = 0u;
    uint kind = 0u;
    uint rank = 0u;
    if (pixel < pixel_count()) {
        count = word_of(GOAL_COUNTS, pixel);
        more = word_of(GOAL_NEXT, pixel) - count;
        if (is_long(more)) more = 0u;
        if (more > 0u) {
            kind = class_of(more);
            rank = atomicAdd(counters[kind], 1u);
        }
    }
    barrier();
    if (lane < GOAL_LONG_CLASS && counters[lane] > 0u) {
        uint first = atomicAdd(totals[GOAL_CLASSES_AT + GOAL_CLASSES + lane], counters[lane]);
        for (uint longer = lane + 1u; longer < GOAL_LONG_CLASS; longer++) first += totals[GOAL_CLASSES_AT + longer];
        counters[GOAL_LONG_CLASS + lane] = first;
    }
    barrier();
    if (more == 0u) return;
    uint entry = 2u * (counters[GOAL_LONG_CLASS + kind] + rank);
    for (uint side = 0u; side < 2u; side++) {
        batches[entry + side] = PixelBatch(place_of(pixel), side | side << BATCH_STREAM_SHIFT, count, more);
    }
}

uint parts_of_half(uint samples) { return (samples + goal.part_samples - 1u) / goal.part_samples; }

// Returns the samples of a long batch that are taken now.
uint samples_now(uint more) { return min(more, OPAQUE(goal.until)) - min(more, goal.from); }

// Lists the parts of long batches, those of a pixel one after the other, and keeps the place of its first one.
void list_parts() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    uint count = word_of(GOAL_COUNTS, pixel);
    uint more = word_of(GOAL_NEXT, pixel) - count;
    if (!is_long(more)) return;
    uint samples = samples_now(more);
    uint number = parts_of_half(samples);
    uint first = atomicAdd(totals[GOAL_PART_COUNT], 2u * number);
    pixel_words[at(GOAL_ROWS, pixel)] = first;
    for (uint k = 0u; k < 2u * number; k++) {
        uint side = k / number;
        uint before = k % number * goal.part_samples;
        uint part = side | side << BATCH_STREAM_SHIFT | BATCH_APART;
        uint length = min(goal.part_samples, samples - before);
        parts[first + k] = PixelBatch(place_of(pixel), part, count + goal.from + before, length);
    }
}

// Entries up to the host's bound of their number have no pixel.
void end_parts() {
    uint entry = number_of_thread();
    if (entry >= totals[GOAL_PART_COUNT] && entry < OPAQUE(goal.count)) {
        parts[entry] = PixelBatch(0xFFFFFFFFu, BATCH_APART, 0u, 0u);
    }
}

// Adds the sums of parts to the film, and makes room for further ones.
void add_parts() {
    uint pixel = number_of_thread();
    if (pixel == 0u) totals[GOAL_PART_COUNT] = 0u;
    if (pixel >= pixel_count()) return;
    uint count = word_of(GOAL_COUNTS, pixel);
    uint more = word_of(GOAL_NEXT, pixel) - count;
    if (!is_long(more)) return;
    uint number = parts_of_half(samples_now(more));
    uint first = word_of(GOAL_ROWS, pixel);
    bool adds = count + goal.from > 0u;
    for (uint side = 0u; side < 2u; side++) {
        uint entry = side * pixel_count() + pixel;
        vec4 sum = adds ? film[entry] : vec4(0.0);
        for (uint k = 0u; k < number; k++) sum += part_sums[first + side * number + k];
        film[entry] = sum;
    }
}

#endif
