// Raises variances around pixels that have made a discovery, and to what an audit found. Variances are not negative, so that
// their bits are in their order. Twins: src/integrators/adaptive/explore.rs and audit.rs.
#ifndef GOAL_RAISE_GLSL
#define GOAL_RAISE_GLSL

#include "state.glsl"

// Assumes that the pixels around one vary like it, by a share, and visits them.
void raise(uint pixel, float spread, uint radius) {
    uint x = pixel % goal.width;
    uint y = pixel / goal.width;
    for (uint row = y - min(y, radius); row <= min(y + radius, goal.height - 1u); row++) {
        for (uint column = x - min(x, radius); column <= min(x + radius, goal.width - 1u); column++) {
            uint other = row * goal.width + column;
            float like = (other == pixel ? spread : GOAL_SHARE_AROUND * spread) / (2.0 * float(word_of(GOAL_COUNTS, other)));
            uint bits = floatBitsToUint(like);
            if (atomicMax(pixel_words[at(GOAL_VARIANCES, other)], bits) < bits) {
                keep_real(visits(true), other, real_of(GOAL_SPREADS, other));
            }
        }
    }
}

// Nothing was visited before the first pass.
void spread_discoveries() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count() || OPAQUE(goal.pass) == 0u) return;
    float before = real_of(visits(false), pixel);
    float now = real_of(GOAL_SPREADS, pixel);
    if (before != NOT_VISITED && now > GOAL_DISCOVERY * before) raise(pixel, now, GOAL_RADIUS);
}

// The host lists pixels, each with the variance of one of its samples.
void raise_listed() {
    uint entry = number_of_thread();
    if (entry >= OPAQUE(goal.count)) return;
    uint place = GOAL_RAISES + 2u * entry;
    raise(totals[place], uintBitsToFloat(totals[place + 1u]), GOAL_AUDIT_RADIUS);
}

// And the least variance of one sample for each octave of counts.
void raise_to_floors() {
    uint pixel = number_of_thread();
    if (pixel >= pixel_count()) return;
    uint count = word_of(GOAL_COUNTS, pixel);
    float least = uintBitsToFloat(totals[GOAL_FLOORS + octave(count)]) / (2.0 * float(count));
    keep_real(GOAL_VARIANCES, pixel, max(real_of(GOAL_VARIANCES, pixel), least));
}

#endif
