// What of the filters matters elsewhere: which of them a sampler has, by what it can do. Twin:
// src/oracle/filter/kinds.rs.
#ifndef FILTER_KINDS_GLSL
#define FILTER_KINDS_GLSL

#include "../features.glsl"
#include "../layout.glsl"

// Whether the device's own sampler is to follow the footprint.
bool is_anisotropic(const Sampler how) { return HAS(FILTERS, FILTER_ANISOTROPIC) && how.min_filter == FILTER_ANISOTROPIC; }

const uint INTEGRABLE = (1u << FILTER_NEAREST) | (1u << FILTER_LINEAR);

// Whether beams know the integral of what it magnifies, and whether that has no steps.
bool is_integrable(const Sampler how) { return HAS(INTEGRABLE, how.mag_filter); }

bool is_continuous(const Sampler how) { return MODE_IS(FILTERS, FILTER_LINEAR, how.mag_filter); }

#endif
