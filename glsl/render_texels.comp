#version 460
// Renders with the texels of a texture in a texel buffer.
#define SOURCE 1
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
