// The axes of a footprint in texels, from the changes of texture coordinates: the same for 2D textures,
// volumes and faces of cubes. Twin: src/oracle/footprint_axes.rs.
#ifndef FOOTPRINT_AXES_GLSL
#define FOOTPRINT_AXES_GLSL

#include "texture.glsl"

#if SOURCE != SOURCE_NONE

// Squares of the footprint's axes (singular values of its Jacobian) in texels of level 0, and the unit vector
// of coefficients with which dx and dy combine to the major axis.
struct FootprintEllipse {
    float major;
    float minor;
    vec2 along;
};

// The largest change, in tiles, which also replaces NaN and infinity; its square in texels is still finite.
const float WIDEST_CHANGE = 1e9;

vec3 bounded_change(vec3 d) { return mix(vec3(WIDEST_CHANGE), d, lessThanEqual(abs(d), vec3(WIDEST_CHANGE))); }

// Converts a direction to a position on its face of the cube; 2D and 3D coordinates are unchanged. Changes
// become finite.
Coordinate in_texture(const Texture image, Coordinate c, out uint face) {
    face = 0u;
    if (!MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_CUBE, image.kind)) {
        if (FILTERED) {
            c.dx = bounded_change(c.dx);
            c.dy = bounded_change(c.dy);
        }
        return c;
    }
    vec3 stm = on_cube_face(c.at, face);
    Coordinate on_face = Coordinate(vec3(within_face(stm), 0.0), vec3(0.0), vec3(0.0));
    if (FILTERED) {
        // Directions have any length: none is squared.
        vec3 unit = vec3(stm.xy / stm.z, 1.0);
        on_face.dx = bounded_change(vec3(face_uv_change(unit, along_cube_face(c.dx, face) / stm.z), 0.0));
        on_face.dy = bounded_change(vec3(face_uv_change(unit, along_cube_face(c.dy, face) / stm.z), 0.0));
    }
    return on_face;
}

FootprintEllipse texel_spread(const Texture image, const Coordinate c) {
    vec3 size = vec3(image.size.xy, MODE_IS(TEXTURE_KINDS, TEXTURE_KIND_VOLUME, image.kind) ? image.size.z : 0u);
    vec3 x = c.dx * size;
    vec3 y = c.dy * size;
    float xx = dot3(x, x);
    float yy = dot3(y, y);
    float xy = dot3(x, y);
    float middle = 0.5 * (xx + yy);
    float half_difference = 0.5 * (xx - yy);
    float radius = sqrt(half_difference * half_difference + xy * xy);
    float major = middle + radius;
    float minor = max(xx * (yy / major) - xy * (xy / major), 0.0);
    // Of the two forms of the eigenvector the one without cancellation.
    vec2 along = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    float squared = along.x * along.x + along.y * along.y;
    along = squared > 0.0 ? along * inversesqrt(squared) : vec2(1.0, 0.0);
    return FootprintEllipse(major, minor >= 0.0 ? minor : 0.0, along);
}
#endif

#endif
