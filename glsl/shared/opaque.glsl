// Values that are uniform across all threads, in a form that hides this from the driver. If a condition or
// the end of a loop depends on nothing but uniforms and push constants, lavapipe (Mesa 22.3.6,
// lvp_inline_uniforms.c) inlines their values into the shader, and recompiles it at each submission. In the
// beam shader, whose loops are nested five deep, NVIDIA's compiler (driver 580) loses some threads if it
// knows that others take the same path; it defines HIDE_UNIFORMS for all devices.
#ifndef OPAQUE_GLSL
#define OPAQUE_GLSL

#include "schema/numbers.glsl"

#ifdef HIDE_UNIFORMS
const bool OPAQUE_UNIFORMS = true;
#else
layout(constant_id = ID_OPAQUE_UNIFORMS) const bool OPAQUE_UNIFORMS = true; // src/render/mod.rs: on lavapipe alone
#endif

// Workgroups extend in x and y only, so this adds a zero that is known at run time.
#define OPAQUE(number) ((number) + (OPAQUE_UNIFORMS ? gl_WorkGroupID.z : 0u))

#endif
