// Corrects variances where half of the samples have not seen what the other half has, one part of the picture in a
// workgroup; and sums what the host is told of the whole picture. Twin: src/integrators/adaptive/unseen.rs, which says why.
#ifndef GOAL_UNSEEN_GLSL
#define GOAL_UNSEEN_GLSL

#include "statistics.glsl"
#include "draws.glsl"

const uint PIXELS_A_THREAD = GOAL_PART_SIDE * GOAL_PART_SIDE / GOAL_THREADS;

// Returns pixel `k` of the thread in the workgroup's part of the picture, or the number of pixels if there is none.
uint part_pixel(uint k) {
    uint across = (goal.width + GOAL_PART_SIDE - 1u) / GOAL_PART_SIDE;
    uint part = number_of_group();
    uint inside = k * GOAL_THREADS + gl_LocalInvocationIndex;
    uint x = part % across * GOAL_PART_SIDE + inside % GOAL_PART_SIDE;
    uint y = part / across * GOAL_PART_SIDE + inside / GOAL_PART_SIDE;
    return x < goal.width && y < goal.height ? y * goal.width + x : pixel_count();
}

// Pixels of a thread are rows apart, so that the first one outside of the picture ends them.
#define EACH_PIXEL(pixel) \
    for (uint k = 0u, pixel = part_pixel(0u); k < PIXELS_A_THREAD && pixel < pixel_count(); k++, pixel = part_pixel(k))

// The correction of the variances of one octave's pixels.
void correct(uint o) {
    vec4 sums = vec4(0.0); // of the spreads of halves, their squares, the products of both, the variances
    vec4 number = vec4(0.0);
    EACH_PIXEL(pixel) {
        if (octave(word_of(GOAL_COUNTS, pixel)) != o) continue;
        vec2 h = seen(pixel).halves;
        sums += vec4(h.x + h.y, dot(h, h), h.x * h.y, real_of(GOAL_VARIANCES, pixel));
        number.x += 1.0;
    }
    sum_lanes(sums, number);
    if (number.x == 0.0) return;
    float halves = 2.0 * number.x;
    float mean = sums.x / halves;
    float variance = sums.y / halves - mean * mean;
    float covariance = 2.0 * sums.z / halves - mean * mean;
    float correlation = clamp(covariance / max(variance, 1e-37) - inversesqrt(number.x), 0.0, 1.0);
    bool sure = OPAQUE(goal.bright) != 0u || (1u << o) >= GOAL_MANY_SAMPLES;
    if (correlation >= (sure ? GOAL_MAX_SURE_CORRELATION : GOAL_MAX_CORRELATION)) return;
    float nothing = mean / GOAL_NOTHING_RATIO;
    vec4 found = vec4(0.0); // halves beside halves that saw nothing, their variances, those of means, contradictions
    EACH_PIXEL(pixel) {
        uint count = word_of(GOAL_COUNTS, pixel);
        if (octave(count) != o) continue;
        vec2 h = seen(pixel).halves;
        for (uint side = 0u; side < 2u; side++) {
            if (h[side] > nothing) continue;
            float partner = h[1u - side];
            found += vec4(1.0, partner, 0.5 / (2.0 * float(count)), partner > GOAL_NOTHING_RATIO * nothing ? 1.0 : 0.0);
        }
    }
    vec4 unused = vec4(0.0);
    sum_lanes(found, unused);
    float least = found.y / max(found.x, 1.0);
    if (found.w < float(GOAL_MIN_CONTRADICTIONS) || found.z * least <= GOAL_MIN_UNSEEN_SHARE * sums.w) return;
    float reliability = 2.0 * correlation / (1.0 + correlation);
    EACH_PIXEL(pixel) {
        uint count = word_of(GOAL_COUNTS, pixel);
        if (octave(count) != o) continue;
        vec2 h = seen(pixel).halves;
        float own = 0.5 * (h.x + h.y);
        float drawn = mean + reliability * (own - mean);
        float factor = own > 0.0 ? drawn / own : 0.0;
        keep_real(GOAL_VARIANCES, pixel, max(real_of(GOAL_VARIANCES, pixel) * factor, least / (2.0 * float(count))));
    }
}

void keep_partial(uint column, uint bits) {
    uint across = (goal.width + GOAL_PART_SIDE - 1u) / GOAL_PART_SIDE;
    uint down = (goal.height + GOAL_PART_SIDE - 1u) / GOAL_PART_SIDE;
    totals[GOAL_PARTIALS + column * (across * down) + number_of_group()] = bits;
}

void find_unseen() {
    uint parts = ((goal.width + GOAL_PART_SIDE - 1u) / GOAL_PART_SIDE) * ((goal.height + GOAL_PART_SIDE - 1u) / GOAL_PART_SIDE);
    if (number_of_group() >= parts) return;
    uint lane = gl_LocalInvocationIndex;
    if (lane < 5u) counters[lane] = 0u;
    barrier();
    EACH_PIXEL(pixel) {
        uint count = word_of(GOAL_COUNTS, pixel);
        atomicOr(counters[0], 1u << octave(count));
        atomicMax(counters[1], count);
        atomicMax(counters[2], ~count);
        atomicAdd(counters[3], count & 0xFFFFu);
        atomicAdd(counters[4], count >> 16u);
    }
    barrier();
    uint octaves = counters[0];
    for (uint o = 0u; o < COUNT_OCTAVES; o++) {
        if ((octaves & 1u << o) != 0u) correct(o);
    }
    vec4 sums = vec4(0.0); // of the differences, their squares, the variances, resolved pixels
    vec4 draws = vec4(0.0);
    EACH_PIXEL(pixel) {
        float variance = real_of(GOAL_VARIANCES, pixel);
        float by_beams = 0.0;
        if (OPAQUE(goal.resolves) != 0u) {
            by_beams = 1.0 - resolved[pixel].w;
            variance *= resolved[pixel].w;
            keep_real(GOAL_VARIANCES, pixel, variance);
        }
        float difference = real_of(GOAL_PAIRS, pixel);
        float cost = samples_of(word_of(GOAL_COUNTS, pixel));
        sums += vec4(difference, difference * difference, variance, by_beams);
        draws.xy += vec2(1.0 / cost, cost * variance);
    }
    sum_lanes(sums, draws);
    if (lane > 0u) return;
    for (uint k = 0u; k < 4u; k++) keep_partial(GOAL_DIFFERENCE + k, floatBitsToUint(sums[k]));
    for (uint k = 0u; k < 2u; k++) keep_partial(GOAL_INVERSE_COST + k, floatBitsToUint(draws[k]));
    for (uint k = 0u; k < 4u; k++) keep_partial(GOAL_MOST + k, counters[1u + k]);
}

#endif
