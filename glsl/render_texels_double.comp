#version 460
// Renders with the texels of a texture in a texel buffer, with geometry in f64.
#define DOUBLE
#define SOURCE 1
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
