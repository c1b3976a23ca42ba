// The way of a mirrored ray: that of model `mirror`, of what other models mirror, and the middle of a highlight.
// Twin: src/oracle/bsdf/mirror.rs.
#ifndef MIRROR_GLSL
#define MIRROR_GLSL

#include "../math.glsl"

// d - 2 (d·n) n, for unit n.
real3 mirrored(real3 direction, real3 normal) {
    real3 result = direction - (2.0 * dot3(direction, normal)) * normal;
    return result;
}

#endif
