// Surface point -> texture coordinate. Planes and `planar` are affine in the position; triangles
// interpolate their vertices' uv; `cylindrical`: u = phi/2pi, v = height; `spherical`: u = theta/pi,
// v = phi/2pi, theta from +axis, phi from +x towards +z. Scale, rotation, offset come last; the
// affine and vertex kinds have them folded in by the host, with whole tiles taken out.
#ifndef MAPPING_GLSL
#define MAPPING_GLSL

#include "math.glsl"

vec2 texture_coordinate(Map map, vec3 p, vec2 vertex_uv) {
    uint kind = map.link.x;
    if (MODE_IS(MAPPINGS, MAP_VERTEX_UV, kind)) return vertex_uv;
    vec2 xy = vec2(affine(map.x, p), affine(map.y, p));
    if (MODE_IS(MAPPINGS, MAP_AFFINE, kind)) return xy;
    float z = affine(map.z, p);
    float turn = atan2_accurate(z, xy.x) * (0.5 / PI);
    turn = turn < 0.0 ? turn + 1.0 : turn;
    vec2 uv = vec2(turn, xy.y);
    if (MODE_IS(MAPPINGS, MAP_SPHERICAL, kind)) {
        precise float across = sqrt(xy.x * xy.x + z * z);
        uv = vec2(atan2_accurate(across, xy.y) * (1.0 / PI), turn);
    }
    precise vec2 mapped = vec2((map.matrix.x * uv.x + map.matrix.y * uv.y) + map.offset.x,
                               (map.matrix.z * uv.x + map.matrix.w * uv.y) + map.offset.y);
    return mapped;
}

#endif
