#version 460
// Renders with the texels of a texture in an image.
#define SOURCE 2
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
