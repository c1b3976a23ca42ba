// Filter `anisotropic`: look-ups along the major axis of the footprint, as wide as the minor one (McCormack
// et al. 1999, as texture units do). Twin: src/oracle/filter/anisotropic.rs.
#ifndef ANISOTROPIC_GLSL
#define ANISOTROPIC_GLSL

#include "cube.glsl"
#include "../diagnostics.glsl"
#include "../footprint_axes.glsl"

#if SOURCE != SOURCE_NONE

uint anisotropic_probes(const Sampler how, const FootprintEllipse spread) {
    float most = float(how.max_anisotropy);
    float ratio = spread.major / max(spread.minor, 1e-30);
    count_diagnostic(DIAGNOSTIC_ANISOTROPY, ratio > most * most);
    uint probes = uint(ceil(sqrt(min(ratio, most * most)) - 1e-3));
    return max(probes, 1u);
}

// Returns the position of a probe; probes are ordered from both ends inwards.
vec3 anisotropic_place(const Texture image, const Coordinate c, const FootprintEllipse spread, uint probe, uint probes, float each,
                       inout uint face) {
    uint order = (probe & 1u) != 0u ? probes - 1u - probe / 2u : probe / 2u;
    float way = (float(order) + 0.5) * each - 0.5;
    vec3 at = c.at + way * (spread.along.x * c.dx + spread.along.y * c.dy);
    if (MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind)) at = refaced(at, face);
    return at;
}
#endif

#endif
