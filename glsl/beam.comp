#version 460
// Renders by one beam a pixel.
#extension GL_GOOGLE_include_directive : require
#include "shared/beam_main.glsl"
