#version 460
// Traces cones with the texels of a texture in an image.
#define SOURCE 2
#extension GL_GOOGLE_include_directive : require
#include "shared/cone_main.glsl"
