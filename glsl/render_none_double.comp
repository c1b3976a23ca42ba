#version 460
// Renders scenes without textures, with geometry in f64.
#define DOUBLE
#define SOURCE 0
#extension GL_GOOGLE_include_directive : require
#include "shared/render_main.glsl"
