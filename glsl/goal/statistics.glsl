// Sums of two halves → the variance of each pixel's mean. Twin: src/integrators/adaptive/estimate.rs, which says why.
#ifndef GOAL_STATISTICS_GLSL
#define GOAL_STATISTICS_GLSL

#include "state.glsl"

struct Seen {
    vec3 mean;
    float difference; // the mean's variance by the difference of the halves
    float spread; // and by the variance of the samples
    vec2 halves; // the variance of one sample, by each half
    bool is_number; // false if the pixel is NaN or infinite
};

bool no_number(float x) { return (floatBitsToUint(x) & 0x7F800000u) == 0x7F800000u; }

Seen seen(uint pixel) {
    float part = 1.0 / float(word_of(GOAL_COUNTS, pixel));
    vec4 a = part * film[pixel];
    vec4 b = part * film[pixel_count() + pixel];
    Seen s;
    s.mean = 0.5 * (a.xyz + b.xyz);
    s.difference = 0.25 * square(a.xyz - b.xyz);
    s.spread = 0.5 * part * max(0.5 * (a.w + b.w) - square(s.mean), 0.0);
    s.halves = vec2(max(a.w - square(a.xyz), 0.0), max(b.w - square(b.xyz), 0.0));
    s.is_number = !(no_number(s.mean.x + s.mean.y + s.mean.z) || no_number(s.difference) || no_number(s.spread));
    if (!s.is_number) {
        s.difference = 0.0;
        s.spread = 0.0;
        s.halves = vec2(0.0);
    }
    return s;
}

// Pixels that beams resolved have their value in place of samples.
void replace() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    vec4 value = resolved[pixel];
    if (value.w != 0.0) return;
    vec4 sums = float(word_of(GOAL_COUNTS, pixel)) * vec4(value.xyz, square(value.xyz));
    film[pixel] = sums;
    film[pixel_count() + pixel] = sums;
}

void take_counts() {
    uint pixel = number_of_thread();
    if (pixel < pixel_count()) pixel_words[at(GOAL_COUNTS, pixel)] = word_of(GOAL_NEXT, pixel);
}

// Keeps both variances of each pixel.
void see() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    Seen s = seen(pixel);
    keep_real(GOAL_PAIRS, pixel, s.difference);
    keep_real(GOAL_PAIRS + 1u, pixel, s.spread);
    keep_real(GOAL_SPREADS, pixel, s.spread * 2.0 * float(word_of(GOAL_COUNTS, pixel)));
    keep_real(visits(true), pixel, NOT_VISITED);
}

vec2 pair(uint array, uint pixel) { return vec2(real_of(array, pixel), real_of(array + 1u, pixel)); }

// The sum of both variances over the part of a window in the pixel's row.
void sum_rows() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    uint x = pixel % goal.width;
    uint last = min(x + GOAL_RADIUS, goal.width - 1u) - x;
    vec2 sum = vec2(0.0);
    for (uint other = pixel - min(x, GOAL_RADIUS); other <= pixel + last; other++) sum += pair(GOAL_PAIRS, other);
    keep_real(GOAL_ROWS, pixel, sum.x);
    keep_real(GOAL_ROWS + 1u, pixel, sum.y);
}

vec2 window_sums(uint pixel) {
    uint y = pixel / goal.width;
    uint first = y - min(y, GOAL_RADIUS);
    uint last = min(y + GOAL_RADIUS, goal.height - 1u);
    vec2 sum = vec2(0.0);
    for (uint row = first; row <= last; row++) sum += pair(GOAL_ROWS, row * goal.width + pixel % goal.width);
    return sum;
}

float contrast_to(Seen s, uint other) {
    Seen o = seen(other);
    return s.is_number && o.is_number ? square(s.mean - o.mean) : 0.0;
}

// The largest squared difference to one of the four nearest pixels.
float contrast(Seen s, uint pixel) {
    uint x = pixel % goal.width;
    uint y = pixel / goal.width;
    float most = 0.0;
    if (x > 0u) most = max(most, contrast_to(s, pixel - 1u));
    if (x + 1u < goal.width) most = max(most, contrast_to(s, pixel + 1u));
    if (y > 0u) most = max(most, contrast_to(s, pixel - goal.width));
    if (y + 1u < goal.height) most = max(most, contrast_to(s, pixel + goal.width));
    return most;
}

void find_variances() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    Seen s = seen(pixel);
    vec2 sums = window_sums(pixel);
    float own = sums.y > 0.0 ? s.spread * (sums.x / sums.y) : s.difference;
    float n = 2.0 * float(word_of(GOAL_COUNTS, pixel));
    keep_real(GOAL_VARIANCES, pixel, max(own, contrast(s, pixel) / (3.0 * n * n)));
}

#endif
