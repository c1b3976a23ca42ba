// Mesa's CPU driver ends all loops of a thread, and of those that run beside it, once these have turned 65 535 times in sum
// (LP_MAX_TGSI_LOOP_ITERATIONS): each goes through its body once more, and what follows computes with half a result. So a
// loop of two turns at the end of a shader tells whether that has happened. Such work is left unfinished, to be done in
// parts: a list of the indices of entries, on which the host acts.
#ifndef LOOPS_GLSL
#define LOOPS_GLSL

#include "features.glsl"
#include "layout.glsl"

layout(std430, set = 0, binding = BINDING_UNFINISHED) buffer Unfinished {
    uint unfinished_count;
    uint unfinished_entries[];
};

bool loops_were_ended() {
    uint turns = 0u;
    if (LOOPS_END) {
        while (turns < OPAQUE(2u)) turns++;
    }
    return LOOPS_END && turns < 2u;
}

void leave_unfinished(uint entry) {
    uint at = atomicAdd(unfinished_count, 1u);
    if (at < uint(unfinished_entries.length())) unfinished_entries[at] = entry;
}

#endif
