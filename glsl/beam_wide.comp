#version 460
// Renders by one beam a pixel of a scene in f64.
#define WIDE
#extension GL_GOOGLE_include_directive : require
#include "shared/beam_main.glsl"
