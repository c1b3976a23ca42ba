// The texels of a cube around a position on one of its faces: beyond an edge those of the adjacent face.
// Twin: src/oracle/filter/cube.rs.
#ifndef CUBE_GLSL
#define CUBE_GLSL

#include "../texture.glsl"

#if SOURCE != SOURCE_NONE

// Returns the direction from a cube's centre to a point in a face's plane, (s, t) in [-1, 1] on the face.
vec3 face_direction(uint face, vec2 st) {
    float side = (face & 1u) != 0u ? -1.0 : 1.0;
    return face < 2u ? vec3(side, -st.y, -side * st.x)
                     : (face < 4u ? vec3(st.x, side, side * st.y) : vec3(side * st.x, -st.y, side));
}

// Projects a point in a face's plane to the face behind it.
vec3 refaced(vec3 at, inout uint face) {
    uint other;
    vec3 stm = on_cube_face(face_direction(face, 2.0 * at.xy - 1.0), other);
    face = other;
    return vec3(within_face(stm), 0.0);
}

// Returns the texel at a position on a face, or beyond its edge: that of the adjacent face which the extended
// plane of the face covers there.
ivec3 cube_texel(uint face, ivec2 at, int size) {
    if (all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(size)))) return ivec3(at, face);
    vec2 st = (2.0 * vec2(at) + 1.0) / float(size) - 1.0;
    uint other;
    vec2 uv = face_uv(on_cube_face(face_direction(face, st), other));
    return ivec3(clamp(ivec2(floor(uv * float(size))), ivec2(0), ivec2(size - 1)), other);
}
#endif

#endif
