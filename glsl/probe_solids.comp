#version 460
// Looks up with volumes and cubes beside flat textures in images.
#define SOURCE 3
#extension GL_GOOGLE_include_directive : require
#include "shared/probe_main.glsl"
