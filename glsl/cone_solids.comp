#version 460
// Traces cones with volumes and cubes beside flat textures in images.
#define SOURCE 3
#extension GL_GOOGLE_include_directive : require
#include "shared/cone_main.glsl"
