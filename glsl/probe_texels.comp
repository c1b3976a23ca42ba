#version 460
// Looks up with the texels of a texture in a texel buffer.
#define SOURCE 1
#extension GL_GOOGLE_include_directive : require
#include "shared/probe_main.glsl"
