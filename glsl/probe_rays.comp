#version 460
// Answers rays from a list.
#define SOURCE 0
#extension GL_GOOGLE_include_directive : require
#include "shared/probe_rays_main.glsl"
