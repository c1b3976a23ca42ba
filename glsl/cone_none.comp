#version 460
// Traces cones through scenes without textures.
#define SOURCE 0
#extension GL_GOOGLE_include_directive : require
#include "shared/cone_main.glsl"
