// Properties of a sampler's filters that matter outside the filters. Twin: src/oracle/filter/kinds.rs.
#ifndef FILTER_KINDS_GLSL
#define FILTER_KINDS_GLSL

#include "../features.glsl"
#include "../layout.glsl"

// Returns true if the device's own sampler follows the footprint.
bool is_anisotropic(const Sampler how) { return HAS(FILTERS, FILTER_ANISOTROPIC) && how.min_filter == FILTER_ANISOTROPIC; }

const uint INTEGRABLE = (1u << FILTER_NEAREST) | (1u << FILTER_LINEAR);

// Returns true if beams can integrate the magnifying filter; `is_continuous`, if it has no steps.
bool is_integrable(const Sampler how) { return HAS(INTEGRABLE, how.mag_filter); }

bool is_continuous(const Sampler how) { return MODE_IS(FILTERS, FILTER_LINEAR, how.mag_filter); }

#endif
