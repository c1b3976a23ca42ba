// The scene buffer and its access, in units of 16 bytes; the records are in src/schema/header.rs and records.rs.
#ifndef LAYOUT_GLSL
#define LAYOUT_GLSL

#include "schema/numbers.glsl"
#include "opaque.glsl"
#include "real.glsl"

layout(std430, set = 0, binding = BINDING_SCENE) readonly buffer SceneBuffer { uvec4 scene[]; };

// The first 16 KiB of the scene buffer as uniforms, which devices read fastest: header, short lists.
layout(std140, set = 0, binding = BINDING_HEAD) uniform SceneHead { uvec4 head[HEAD_UNITS]; };

#define READ_HEAD(at) OPAQUE(head[at])
#define READ_SCENE(at) scene[at]

#include "schema/records.glsl"

Header load_header() { return header_in_head(0u); }

#endif
