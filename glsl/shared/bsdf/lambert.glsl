// Model `lambert`: albedo/pi, whatever the two directions are. Twin: src/oracle/bsdf/lambert.rs.
#ifndef LAMBERT_GLSL
#define LAMBERT_GLSL

// The lobe that the albedo colours, over 1/pi; there is no other.
vec2 lambert_lobes() { return vec2(1.0, 0.0); }

#endif
