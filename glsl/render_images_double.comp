#version 460
// Renders with the texels of a texture in an image, with geometry in f64.
#define DOUBLE
#define SOURCE 2
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
