#version 460
// Renders with volumes and cubes beside flat textures in images, with geometry in f64.
#define DOUBLE
#define SOURCE 3
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
