#version 460
// Traces cones with the texels of a texture in a texel buffer.
#define SOURCE 1
#extension GL_GOOGLE_include_directive : require
#include "shared/cone_main.glsl"
