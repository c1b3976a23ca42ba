// Counters of exceeded limits: look-ups at coordinates that are NaN or infinite, levels beyond a texture's
// last, footprints beyond a sampler's anisotropy, rays at grazing angles, paths that end by depth, cones
// without room. Each thread counts by itself and adds to the device's 64-bit counters at its end. Without
// DIAGNOSED there is no code.
#ifndef DIAGNOSTICS_GLSL
#define DIAGNOSTICS_GLSL

#include "features.glsl"
#include "layout.glsl"

layout(std430, set = 0, binding = BINDING_DIAGNOSTICS) buffer Counters { uint counters[]; }; // low and high half of each

uint noticed[DIAGNOSTIC_COUNT];

void clear_notices() {
    if (DIAGNOSED) {
        for (uint k = 0u; k < DIAGNOSTIC_COUNT; k++) noticed[k] = 0u;
    }
}

void count_diagnostic(uint what, bool happened) {
    if (DIAGNOSED) noticed[what] += happened ? 1u : 0u;
}

void report_notices() {
    if (DIAGNOSED) {
        for (uint k = 0u; k < DIAGNOSTIC_COUNT; k++) {
            if (noticed[k] > 0u) {
                uint before = atomicAdd(counters[2u * k], noticed[k]);
                if (before + noticed[k] < before) atomicAdd(counters[2u * k + 1u], 1u);
            }
        }
    }
}

// Tested by the bits: compilers optimise comparisons for finite values.
bool no_number(vec3 v) { return any(equal(floatBitsToUint(v) & 0x7F800000u, uvec3(0x7F800000u))); }

#ifdef F64_MATH
bool no_number(dvec3 v) {
    uvec3 high = uvec3(unpackDouble2x32(v.x).y, unpackDouble2x32(v.y).y, unpackDouble2x32(v.z).y);
    return any(equal(high & 0x7FF00000u, uvec3(0x7FF00000u)));
}
#endif

#endif
