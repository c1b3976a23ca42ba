// Model `unlit`: the colour itself, without any light. Twin: src/oracle/bsdf/unlit.rs.
#ifndef UNLIT_GLSL
#define UNLIT_GLSL

// Radiance that a surface of this colour sends on by itself.
vec3 unlit_emitted(vec3 color) { return color; }

#endif
