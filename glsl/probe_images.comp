#version 460
// Looks up with the texels of a texture in an image.
#define SOURCE 2
#extension GL_GOOGLE_include_directive : require
#include "shared/probe_main.glsl"
