// Numbers that are the same for all threads, in a form that hides this from the driver. Where a condition or
// the end of a loop depends on nothing but uniforms and push constants, lavapipe (Mesa 22.3.6,
// lvp_inline_uniforms.c) puts their values into the shader, and makes it again at each submission. Of beams,
// whose loops lie five deep, NVIDIA's compiler (driver 580) loses some threads where it knows that others go the same
// way; their shader defines HIDE_UNIFORMS for all devices.
#ifndef OPAQUE_GLSL
#define OPAQUE_GLSL

#include "schema/numbers.glsl"

#ifdef HIDE_UNIFORMS
const bool OPAQUE_UNIFORMS = true;
#else
layout(constant_id = ID_OPAQUE_UNIFORMS) const bool OPAQUE_UNIFORMS = true; // src/render/mod.rs: on lavapipe alone
#endif

// Workgroups lie in x and y, so that this adds a zero that is known at run time.
#define OPAQUE(number) ((number) + (OPAQUE_UNIFORMS ? gl_WorkGroupID.z : 0u))

#endif
