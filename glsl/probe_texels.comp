#version 460
#define SOURCE 1
#extension GL_GOOGLE_include_directive : require
#include "shared/probe_main.glsl"
