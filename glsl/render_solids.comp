#version 460
// Renders with volumes and cubes beside flat textures in images.
#define SOURCE 3
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
