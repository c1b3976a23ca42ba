#version 460
// Surveys the picture: which triangles the rays of each cell may meet.
#extension GL_GOOGLE_include_directive : require
#include "shared/tile_culling_main.glsl"
