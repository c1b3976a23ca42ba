// The features of this scene, as specialization constants (src/schema/specialization.rs). The defaults keep
// everything; src/pack/features.rs narrows them.
#ifndef FEATURES_GLSL
#define FEATURES_GLSL

#include "schema/numbers.glsl"
#include "schema/features.glsl"

// Returns true if the run-time mode is `value`, decided when the pipeline is built if the mask allows.
#define MODE_IS(mask, value, runtime) \
    ((mask) == (1u << (value)) || ((((mask) >> (value)) & 1u) != 0u && (runtime) == (value)))
#define HAS(mask, value) ((((mask) >> (value)) & 1u) != 0u)
#define COUNT(constant, runtime) ((constant) == DYNAMIC ? (runtime) : (constant))

#endif
